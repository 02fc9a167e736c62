#pragma once
// Loads: gravity at the nodes, body forces depending on position and time, tractions carried by particles, by facets of the mesh or by the
// surface of a body.
#include <functional>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "core/particles.hpp"
#include "core/time_table.hpp"
#include "mesh/mesh.hpp"
#include "solver/loads/surface_load.hpp"
#include "solver/state/ledger.hpp"
#include "solver/state/nodes.hpp"
#include "solver/state/owned_nodes.hpp"
#include "solver/state/sums.hpp"
#include "solver/state/tracked_ids.hpp"
#include "solver/strips/strip.hpp"

namespace talus {

/// Gravity, which is added at the nodes exactly; `ramp` is the factor of the stage for all loads.
template <int D>
struct Gravity {
  Vec<D> acceleration = Vec<D>::Zero();  ///< [m/s^2]
  Table table;
  Vec<D> operator()(Real time, Real ramp) const noexcept { return ramp * table(time) * acceleration; }
};

/// A force per mass [m/s^2] as a function of position and time, such as that of a manufactured solution.
template <int D>
struct BodyForce {
  /// Writes the acceleration at each position.  Called by several threads at once; must not throw.
  std::function<void(std::span<const Vec<D>> places, Real time, std::span<Vec<D>> accelerations)> acceleration;
  bool at_start = false;  ///< whether positions are the initial ones (particles.x0, which must be stored) instead of the present ones
};

/// A traction that the first layer of particles behind a facet group carries.  Each facet's area is divided among the particles of the cell
/// behind it; a pressure turns and stretches with the surface, n da = J F^-T N dA (Nanson).
template <int D>
struct ParticleTraction {
  Vec<D> traction = Vec<D>::Zero();  ///< traction per initial area [Pa]
  Real pressure{};                   ///< pressure [Pa], positive in compression
  Table table;
  SourceLocation where;
  std::vector<std::int64_t> id;  ///< ids of the particles that carry it, ascending
  std::vector<Vec<D>> area;      ///< share of each particle in the initial outward area vector [m^(D-1)]
};

/// A traction on facets of the mesh; it acts while there is mass at their nodes.
template <int D>
struct MeshTraction {
  Vec<D> traction = Vec<D>::Zero();
  Real pressure{};
  Table table;
  SourceLocation where;
  std::vector<Index> node;    ///< ascending
  std::vector<Vec<D>> area;   ///< share of the outward area vector [m^(D-1)]
  std::vector<Real> measure;  ///< share of the area [m^(D-1)]
  /// Open water: a pressure of unit_weight [N/m^3] times the depth below a level.
  Real unit_weight{};
  Table level;               ///< its elevation in time [m]
  std::vector<Real> height;  ///< of the nodes [m]; empty without open water

  /// The pressure at a node [Pa].
  Real pressure_at(std::size_t k, Real time) const noexcept
  {
    return height.empty() ? pressure : pressure + unit_weight * std::max(level(time) - height[k], Real{0});
  }
};

template <int D>
struct Loads {
  Gravity<D> gravity;
  std::vector<BodyForce<D>> of_place;
  std::vector<ParticleTraction<D>> on_particles;
  std::vector<MeshTraction<D>> on_mesh;
  std::vector<SurfaceLoad<D>> on_surfaces;
  bool any_on_particles() const noexcept { return !of_place.empty() || !on_particles.empty(); }
};

/// The part of a mesh traction on this rank, with local numbers of nodes.
template <int D>
void restrict_to(const Subdomain& subdomain, MeshTraction<D>& load);

/// Divides the facets' area among the particles of the cells behind them.  Facets without a particle behind them are left out; the caller
/// may compare the areas.
template <int D>
ParticleTraction<D> carried_by_particles(const Mesh<D>& mesh, std::span<const Facet> facets, const Particles<D>& particles);
/// Divides the facets' area among their nodes.
template <int D>
MeshTraction<D> carried_by_mesh(const Mesh<D>& mesh, std::span<const Facet> facets);

/// The ids of particles that carry a traction, once for each traction.
template <int D>
std::vector<std::int64_t> ids_of(const std::vector<ParticleTraction<D>>& loads)
{
  std::vector<std::int64_t> ids;
  for (const ParticleTraction<D>& load : loads)
    ids.insert(ids.end(), load.id.begin(), load.id.end());
  return ids;
}

/// Computes the forces [N] on n particles of a strip at their present positions, into columns.applied.  `carriers` are the ids of particles
/// that carry tractions.
template <int D>
void find_forces(const Loads<D>& loads, Real time, Real ramp, const TrackedIds& carriers, const StripColumns<D>& columns, std::size_t n);

/// Sums over the particles of a body in a block of the forces that act on them in a step.
template <int D>
struct ParticleLoadSums {
  ForceAndMoment<D> force{};
  Real work = 0;  ///< force times displacement [J]

  /// Adds n particles of a strip, which are where the forces were computed.
  void add_forces(const StripColumns<D>& columns, std::size_t n) noexcept
  {
    for (std::size_t i = 0; i < n; ++i)
      force += ForceAndMoment<D>::at(columns.x.of(i), columns.applied.of(i));
  }
  /// Adds n particles that have moved since.
  void add_work(const StripColumns<D>& columns, std::size_t n) noexcept
  {
    for (std::size_t i = 0; i < n; ++i)
      work += columns.applied.of(i).dot(columns.x.of(i)) - columns.applied.of(i).dot(columns.before.of(i));
  }
};

/// Adds the work [J] of mesh tractions over a step: impulse times the mean of old and new velocity of the `own` nodes.
template <int D>
void add_work(const Loads<D>& loads, Real time, Real ramp, const OwnNodes& own, const Nodes<D>& nodes, ExactSums<Real>& total);

/// Adds mesh tractions to the force of nodes that have mass, and those on `own` nodes to `total`.
template <int D>
void apply(const Loads<D>& loads, Real time, Real ramp, const Mesh<D>& mesh, const OwnNodes& own, std::span<NodeSum<D>> sum,
           ExactSums<ForceAndMoment<D>>& total);

}  // namespace talus
