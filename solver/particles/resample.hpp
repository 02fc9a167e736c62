#pragma once
// Particles that the motion draws apart are split; those that it crowds together are merged.
#include <span>
#include <utility>
#include <vector>

#include "core/parallel/communicator.hpp"
#include "mesh/locate.hpp"
#include "solver/options/resample_options.hpp"
#include "solver/particles/staged_bodies.hpp"
#include "solver/state/ledger.hpp"
#include "solver/state/tracked_ids.hpp"

namespace talus {

// A particle covers a domain with the edges R, which begin as a square or cube of its volume and deform with it.  Where a domain is longer than
// a cell, nodes beside its middle see no material: the body comes apart (numerical fracture), and where shear has made it thin as well,
// particles gather in lines.  It is then cut in the middle: with R = U S V^T, s the largest number of S, u and w its columns of U and V,
//
//     x +- s/4 u,   v +- C s/4 u,   mass, initial and present volume halved,   R (I - w w^T / 2)
//
// and everything else copied [splitting by accumulated stretch: Ma, Zhang, Lian & Zhou 2009, CMES 39, 101; resampling of shear flows: Yue,
// Smith, Batty, Zheng & Grinspun 2015, ACM Trans. Graph. 34, 160].  Mass, momentum, the sum of m C and the volume integrals of stress and
// history stay; the part s^2/16 m (C u) u^T of the affine momentum becomes one of positions and velocities.  Halves are at most the size of
// the cell from where the particle was.  Not split are particles of cells that are full already, and matter that has expanded eightfold.
//
// A cell with more particles of a body than allowed merges the pair of the least distance, then the next, until it has no more.  With weights
// by mass for x, v, C, by initial volume for F and the history, by volume for stress,
//
//     m = m1 + m2,   x = sum m x / m,   v = sum m v / m,   C = sum m C / m,   V0, V summed,   det F made V / V0,   R a square or cube of V
//
// so mass, momentum, the sum of m C, plastic work and heat stay; the kinetic energy of the difference of v is lost, and counted.  Where the
// mean of both F has lost half of its determinant, F is that of the larger particle.

/// What is to be done to rows of particles.
template <int D>
struct ResamplePlan {
  struct Split {
    Index row;
    Vec<D> offset;    ///< of the new places from the old one, and the opposite of it [m]
    Vec<D> material;  ///< the unit vector w
  };
  std::vector<Split> split;                    ///< in ascending order of rows
  std::vector<std::pair<Index, Index>> merge;  ///< the first has the lower id, and stays
  std::size_t size() const noexcept { return split.size() + merge.size(); }
};

/// Finds what is to be done.  Particles in `kept` are neither split nor merged, and none is split whose halves would lie outside the mesh.
template <int D>
ResamplePlan<D> plan_resampling(const Mesh<D>& mesh, const Locator<D>& locator, std::span<const std::optional<ResampleOptions>> options,
                                const TrackedIds& kept, const std::vector<Body>& bodies, const Particles<D>& particles,
                                const CellOrder& order);

/// What changes with particles that are split and merged.
template <int D>
struct ResampleSums {
  Real splits{}, merges{};  ///< numbers
  Real kinetic{};           ///< kinetic energy lost [J]
  ForceAndMoment<D> momentum{};
};

/// New particles have ids from here on, above those of all bodies of a scene.
inline constexpr std::int64_t first_resampled_id = std::int64_t{1} << 40;

/// The ids that particles of a run can have.
struct KnownIds {
  std::int64_t of_scene, splits;  ///< numbers of particles: of all bodies at first, and of those split since
  bool has(std::int64_t id) const noexcept
  {
    return (0 <= id && id < of_scene) || (first_resampled_id <= id && id - first_resampled_id < splits);
  }
};

/// Splits and merges; adds what changes to `sums`.  `splits` is how many particles of all ranks have been split before: new ids follow in the
/// order of the ids of those that are split.  Cells of new particles are those of the old ones; the next step finds theirs, as it does for
/// all that have left their cells.  Collective.
template <int D>
void resample(const ResamplePlan<D>& plan, std::int64_t splits, Communicator& ranks, std::vector<Body>& bodies,
              std::vector<Material>& materials, Particles<D>& particles, ExactSums<ResampleSums<D>>& sums);

}  // namespace talus
