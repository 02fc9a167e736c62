#pragma once
// Stress that particles have against displacements that averaged gradients do not see.
#include <numeric>

#include "solver/halo/halo_exchange.hpp"
#include "solver/stress/empty_cell_stress.hpp"
#include "solver/stress/gradient_jumps.hpp"
#include "solver/strips/strips_in_cells.hpp"

namespace talus {

/// Of the stiffness against jumps in cells that are full, that of the part of a cell that is not.
inline constexpr Real share_of_empty = 0.1;

/// Calls f(cell, columns, place in them) for each particle in strips, in parallel; those of one cell in the order of groups.  Particles that
/// a step has moved are in the cell that they come from.
template <int D, class F>
void for_each_in_cells(const ParticleStrips<D>& strips, F&& f)
{
  std::vector<Index> groups(to_size(strips.groups()));
  std::iota(groups.begin(), groups.end(), Index{0});
  parallel_for_uneven(strips.blocks(), [&](Index block) {
    for_each_cell_of(strips, std::span<const Index>(groups), block, [&](Index cell, auto&& runs) {
      runs([&](const ParticlesInCell<D>& run) {
        for (std::size_t p = run.begin; p < run.end; ++p)
          f(cell, run.columns, p);
      });
    });
  });
}

/// Sums by cell over its particles on this rank.
template <int D>
struct JumpSums {
  std::vector<Real> volume;         ///< [m^D]
  std::vector<Mat<D>> jump_stress;  ///< volume times the stress q against jumps [N m]
  std::vector<Sym3> stress;         ///< volume times stress [N m]
  std::vector<Mat3> F;              ///< initial volume times deformation gradient [m^D]

  JumpSums() = default;
  /// Stress and F only if `of_material`.
  JumpSums(const Mesh<D>& mesh, const ParticleStrips<D>& strips, bool of_material)
      : volume(to_size(mesh.n_cells()), 0), jump_stress(volume.size(), Mat<D>::Zero())
  {
    if (of_material)
      stress.assign(volume.size(), Sym3::Zero()), F.assign(volume.size(), Mat3::Zero());
    for_each_in_cells(strips, [&](Index cell, const StripColumns<D>& columns, std::size_t p) {
      const Real of_particle = columns.volume.of(p);
      const std::size_t c = to_size(cell);
      volume[c] += of_particle;
      if (columns.jump_stress)
        jump_stress[c] += of_particle * columns.jump_stress.of(p);
      if (of_material)
        stress[c] += of_particle * columns.stress.of(p), F[c] += columns.volume0.of(p) * columns.F.of(p);
    });
  }
  /// What a sum of volume times q is for the whole cell: the part that is not filled adds a share.
  Mat<D> in_cell(const Mesh<D>& mesh, Index c, const Mat<D>& sum) const
  {
    const Real filled = volume[to_size(c)], empty = std::max(mesh.volume(c) - filled, Real{0});
    return filled > 0 ? Mat<D>((1 + share_of_empty * empty / filled) * sum) : Mat<D>(Mat<D>::Zero());
  }
};

/// In steps the stress q that stages without inertia have left, see JumpForces, stays what it is.  Its forces keep the balance that these
/// stages have found.  A cell that had no particles loses its stress when it gets some, or is not beside the surface any more.
template <int D>
class JumpStress {
 public:
  JumpStress(Communicator& ranks, const Subdomain& subdomain, const Mesh<D>& mesh)
  {
    if (!subdomain.alone())
      cells_ = copies_of_cells(ranks, subdomain, MessageTag::cells, mesh.n_cells());
  }

  /// Finds the forces at the nodes [N], of the particles in strips and of empty cells.  Collective.
  void find(const Mesh<D>& mesh, const Subdomain& subdomain, const ParticleStrips<D>& strips, EmptyCellStress<D>& of_empty)
  {
    JumpSums<D> sums(mesh, strips, false);
    for (Index c = 0; c < mesh.n_cells(); ++c)
      sums.jump_stress[to_size(c)] = sums.in_cell(mesh, c, sums.jump_stress[to_size(c)]);
    if (!subdomain.alone()) {
      cells_.send(sums.volume, Numbers{}), cells_.take(sums.volume, Numbers{});
      cells_.send(sums.jump_stress, Numbers{}), cells_.take(sums.jump_stress, Numbers{});
    }
    GradientJumps<D> jumps(mesh, sums.volume, sums.volume);
    if (!of_empty.empty()) {
      std::vector<std::uint8_t> is_beside(sums.volume.size(), 0);
      for (const auto& one : jumps.cells())
        is_beside[to_size(one.cell)] = sums.volume[to_size(one.cell)] > 0 ? 0 : 1;
      of_empty.keep_if(subdomain, [&](Index c) { return is_beside[to_size(c)] != 0; });
      of_empty.for_each(subdomain, [&](Index c, const Mat<D>& q) { sums.jump_stress[to_size(c)] = share_of_empty * mesh.volume(c) * q; });
    }
    force_.assign(to_size(mesh.n_nodes()), Vec<D>::Zero());
    jumps.add_forces(mesh, sums.jump_stress, force_);
  }
  const std::vector<Vec<D>>& forces() const noexcept { return force_; }  ///< by node

 private:
  HaloExchange cells_;
  std::vector<Vec<D>> force_;  ///< by node
};

}  // namespace talus
