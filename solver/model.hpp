#pragma once
// Everything a run is made of, by value.
#include "core/fields.hpp"
#include "core/ramp.hpp"
#include "solver/boundary/boundary_conditions.hpp"
#include "solver/boundary/small_mass_nodes.hpp"
#include "solver/halo/halo.hpp"
#include "solver/integrate.hpp"
#include "solver/loads/loads.hpp"
#include "solver/particles/migrate.hpp"
#include "solver/particles/relocate.hpp"
#include "solver/state/ledger.hpp"
#include "solver/state/step_sums.hpp"
#include "solver/state/sums.hpp"
#include "solver/state/tracked_particles.hpp"
#include "solver/state/transfer.hpp"
#include "solver/stress/conduct_heat.hpp"
#include "solver/stress/update_stress.hpp"
#include "solver/transfer/mixed_transfer.hpp"

namespace talus {

struct Clock {
  std::int64_t step = 0;  ///< steps done
  Real time = 0;          ///< of places, deformation and stress [s]
  Real dt = 0;            ///< of the last step [s]
  Real lag = 0;           ///< by how much velocities are behind `time` [s]: half a step, or nothing where they have just been given
  static constexpr auto fields()
  {
    return std::tuple{saved("step", &Clock::step), saved("time", &Clock::time), saved("dt", &Clock::dt), saved("lag", &Clock::lag)};
  }
};

/// What a stage sets for every step it makes, and how far it is.
struct StageState {
  Index number = 0;                                       ///< of the stage
  std::int64_t first_step = 0;                            ///< steps done when it began
  int balanced = 0;                                       ///< steps in balance, one after the other, up to now
  Real damping = 0;                                       ///< local, share of the unbalanced force
  Real first_residual = 0;                                ///< unbalanced force over the loads in its first step
  Real begin = 0, ramp_time = 0;                          ///< [s]; gravity and loads grow from 0 to 1 over [begin, begin + ramp_time]
  Real altitude = std::numeric_limits<Real>::infinity();  ///< least one of the cells that held particles when it began [m]
  Real pull = 0;                                          ///< largest acceleration by forces on particles then [m/s^2]
  RampShape ramp_shape = RampShape::linear;
  bool elastic = false;     ///< yielding suspended
  bool seeks_rest = false;  ///< ends at rest, or is damped
  bool done = false;        ///< it has ended
  Real ramp(Real time) const noexcept { return ramp_time > 0 ? ramp_at(ramp_shape, (time - begin) / ramp_time) : Real{1}; }
  static constexpr auto fields()
  {
    return std::tuple{saved("number", &StageState::number),
                      saved("first_step", &StageState::first_step),
                      saved("balanced", &StageState::balanced),
                      saved("damping", &StageState::damping),
                      saved("altitude", &StageState::altitude),
                      saved("pull", &StageState::pull),
                      saved("begin", &StageState::begin),
                      saved("ramp_time", &StageState::ramp_time),
                      saved("elastic", &StageState::elastic),
                      saved("seeks_rest", &StageState::seeks_rest),
                      saved("done", &StageState::done),
                      saved("first_residual", &StageState::first_residual),
                      saved("ramp_shape", &StageState::ramp_shape)};
  }
};

/// Time spent per phase of the step [s], and the work counted.
struct Timings {
  Real locate{}, scatter{}, nodes{}, gather{}, stress{}, output{};
  Real particle_steps{};
  static constexpr auto fields()
  {
    return std::tuple{saved("locate", &Timings::locate),
                      saved("scatter", &Timings::scatter),
                      saved("nodes", &Timings::nodes),
                      saved("gather", &Timings::gather),
                      saved("stress", &Timings::stress),
                      saved("output", &Timings::output),
                      saved("particle_steps", &Timings::particle_steps)};
  }
};

/// The way of a kernel's particles to the nodes and back; what they deposit is its `Sum`, what they read its `Motion`.
template <int D, Kernel<D> K>
using Through = std::conditional_t<HasOwnValues<K, D>, MixedTransfer<D, K>,
                                   std::conditional_t<HasNodeOperators<K, D>, ProjectedTransfer<D, K>, DirectTransfer<D, K>>>;

/// What no state may pass; see guards.hpp.
struct RunLimits {
  Real speed = std::numeric_limits<Real>::infinity();  ///< of any particle [m/s]
  Real gain = std::numeric_limits<Real>::infinity();   ///< energy that nothing worked for, over the largest term
  Real mass = 1e-9;                                    ///< between particles and nodes, over all of it
  Real least_energy = 0;                               ///< smaller gains are round-off [J]
  Real failed = 0;                                     ///< mass of particles that may fail and be deleted, over all of it
  bool speed_stops = true, gain_stops = true;          ///< otherwise it is only counted
};

/// Columns of particles that not every run has.
struct WantedColumns {
  bool affine = false;        ///< an affine field of its own
  bool applied = false;       ///< forces on particles
  bool volume_ratio = false;  ///< a law averages its volume
  bool viscous = false;       ///< a law has bulk viscosity
  bool pore = false;          ///< there is water
};
/// Makes those that are not there as they are of particles at rest; what comes from another run is kept.
template <int D>
void fill_columns(const WantedColumns& wanted, Particles<D>& particles)
{
  const auto n = particles.id.size();
  if (wanted.affine && particles.C.empty())
    particles.C = particles.L;
  if (wanted.applied)
    particles.applied.assign(n, Vec<D>::Zero()), particles.applied_at.assign(n, 0);
  if (wanted.volume_ratio)
    particles.volume_ratio.resize(n, 1);
  if (wanted.viscous && particles.viscous.empty())
    particles.viscous.assign(n, 0);
  if (wanted.pore && particles.pore.empty())
    particles.pore.assign(n, 0);
}

/// What the guards have seen since the start of the run.
struct LimitMonitor {
  Real speed{};                        ///< of the fastest particle in the last step [m/s]
  Real fastest{};                      ///< the same, in any step
  Real gain{}, mass{};                 ///< largest, as in Guards
  std::int64_t speeding{}, gaining{};  ///< steps, and looks at the sums, beyond the limit
  std::string failure;                 ///< of particles that were deleted for it, the last one
  static constexpr auto fields()
  {
    return std::tuple{saved("speed", &LimitMonitor::speed),       saved("fastest", &LimitMonitor::fastest),
                      saved("gain", &LimitMonitor::gain),         saved("mass", &LimitMonitor::mass),
                      saved("speeding", &LimitMonitor::speeding), saved("gaining", &LimitMonitor::gaining),
                      saved("failure", &LimitMonitor::failure)};
  }
};

/// Rings of cells to be held around own ones.  Stencils and the rows of operators reach one ring, what operators are made from one more; and the
/// slaves of other ranks that may hang on own nodes are two rings away, with all the cells around them.
inline constexpr int rings_held = 3;

/// What is to be known here of nodes that other ranks own.
struct GhostNodes {
  HaloExchange sums;    ///< of hats, where unknowns of own nodes collect from them
  HaloExchange motion;  ///< that own particles read, or the hats that they read
  HaloExchange felt;    ///< accelerations, where hats stand between
};

template <int D, Kernel<D> K>
struct Model {
  Mesh<D> mesh;
  Locator<D> locator;
  K kernel;
  BlockRows<D, typename Through<D, K>::Sum> blocks;

  Communicator* ranks = &one_rank();  ///< that share the run
  Subdomain share;
  Halo<typename Through<D, K>::Sum> halo;
  GhostNodes copies;
  Migration<D> migration;
  OwnNodes own;

  Particles<D> particles;
  WantedColumns columns;
  std::vector<Body> bodies;
  std::vector<AnyBatch> materials;  ///< one per body, same ranges
  CellOrder order;
  FollowedRows followed;  ///< particles that carry tractions

  Nodes<D> nodes;
  ProjectedNodes<D> projected;          ///< if the kernel has a node part
  std::vector<NodeMotion<D>> remapped;  ///< MUSL: remapped velocity in `v`, the step's own in `change`
  SmallMassNodes<D> small_mass_nodes;
  std::optional<StarSums<D, 2>> stars;  ///< if a body averages its volume
  std::optional<HeatSums<D>> heat;      ///< if a body conducts heat
  std::vector<Real> averaged;           ///< volume ratios of average_volume(), scratch
  std::vector<Index> averaged_bodies;   ///< bodies that average_volume() takes as one, scratch
  std::vector<StressSums> stress_sums;  ///< of the particles of each body in each block, scratch

  StepSums<D> sums;  ///< of the step at hand
  Transfer transfer;
  Loads<D> loads;
  Water water;
  BoundaryConditions<D> walls;
  Exits exits;
  Clock clock;
  StageState stage;
  EnergyLedger energy;
  MassLedger<D> mass;
  MomentumLedger<D> momentum;
  Real residual = 0;  ///< of the last step: unbalanced nodal force over loads
  Real crossing = 0;  ///< shortest time in which a wave crosses the cell of a particle [s]; the stable step is a share of it
  RunLimits guards;
  LimitMonitor watched;
  ParticleErrors health;
  Timings timings;

  explicit Model(Mesh<D> m, const Options<K>& options = {})
      : mesh(std::move(m)),
        locator(mesh),
        kernel(make_kernel<K>(mesh, options)),
        blocks(make_block_rows<typename Through<D, K>::Sum>(mesh, [&](Index c) { return kernel.stencil(mesh, c); })),
        halo(blocks.size()),
        own(all_nodes(mesh))
  {
    nodes.sum.resize(static_cast<std::size_t>(mesh.n_nodes()));
    nodes.motion.resize(nodes.sum.size());
    nodes.active.resize(nodes.sum.size());
    if constexpr (HasNodeOperators<K, D>) {
      projected.sum.resize(nodes.sum.size());
      projected.motion.resize(nodes.sum.size());
    }
  }
  /// Becomes that of one of several ranks, its mesh being their part of a larger one.  Every rank has to join.
  void join(Communicator& others, Subdomain part)
  {
    ranks = &others;
    share = std::move(part);
    halo = Halo(*ranks, mesh, share, blocks);
    migration = Migration<D>(*ranks, share);
    own = own_nodes(mesh, share);
    small_mass_nodes = SmallMassNodes<D>(*ranks, mesh, share, own);
    const auto copy = [&](MessageTag topic, const std::vector<std::uint8_t>& wanted) {
      return copies_of_nodes(*ranks, share, topic, wanted);
    };
    std::vector<std::uint8_t> read = nodes_read(share, blocks);
    if constexpr (HasNodeOperators<K, D>) {
      std::vector<std::uint8_t> collected = spread_by_rings(mesh, own.owned, 1);
      for (std::size_t n = 0; n < read.size(); ++n)
        collected[n] |= read[n];
      copies.sums = copy(MessageTag::sums, collected);
      copies.motion = copy(MessageTag::motion, spread_by_rings(mesh, read, 1));
      copies.felt = copy(MessageTag::felt, spread_by_rings(mesh, own.owned, 2));
      projected.find_late(mesh, own);
    } else {
      copies.motion = copy(MessageTag::motion, read);
    }
  }
  Index n_bodies() const noexcept { return static_cast<Index>(bodies.size()); }
  /// What particles read.
  const std::vector<typename Through<D, K>::Motion>& motion() const noexcept
  {
    if constexpr (HasNodeOperators<K, D>)
      return projected.motion;
    else
      return nodes.motion;
  }
};

/// A node with less than this share of the lightest particle around is a slave of its neighbours.  Where weights may be negative, sums
/// cancel and a small mass says nothing about the momentum beside it: there the cut lies above the negative share that moving
/// least squares reach beside a boundary (0.012 of a particle).
inline constexpr Real least_share = 1e-8, least_share_of_signed_weights = 2e-2;

/// Cells whose weights have different signs may leave a node next to nothing of what they bring; velocity and acceleration are then
/// quotients of two small differences.  Measured on two grids that become 4 and two that become 10 times finer from one cell to the
/// next: with 0.1 particles turn inside out on one, with 0.5 one gains 35 times its energy, with 0.3 none breaks.  Where all weights
/// are positive it never matters.
inline constexpr Real least_share_of_cells = 0.3;
/// With a node part, rows of nodes on a wall stay in the wall: a node beside a wall that carries a film has next to no mass, but the
/// film's stress pulls at it.  Its mass is measured by that of the hats around.  On a regular lattice it has 0.4 of their mean under a film
/// half a cell thick and 0.17 under a fifth of one; nodes at free surfaces have about 0.9.
inline constexpr Real least_share_of_hats = 0.2;

/// What goes by rows, after these have changed: where those stand who are followed; scratch.
template <int D, Kernel<D> K>
void update_tracked_rows(Model<D, K>& m)
{
  m.averaged_bodies.reserve(m.bodies.size());
  if (m.stars)
    m.averaged.resize(m.particles.id.size());
  m.followed.find(m.particles.id);
}

/// What the law of a body sees of the water at a time; nothing where it sees total stress.
template <int D, Kernel<D> K>
std::optional<PoreWater> pore_water(const Model<D, K>& m, Index body, Real time)
{
  if (!m.water.drains(body))
    return std::nullopt;
  return PoreWater{m.water, m.stage.ramp(time) * m.loads.gravity.table(time)};
}

/// The particles are others now, in cells that are known: what goes by rows and cells follows.  Every rank has to.
template <int D, Kernel<D> K>
void take_rows(Model<D, K>& m)
{
  sort_by_cell(m.particles.cell, m.particles.id, m.bodies, m.mesh.n_cells(), m.order);
  update_tracked_rows(m);
  if (!m.share.alone())
    m.migration.agree_on_columns(m.particles);
}

/// M is a Model, or what an observer sees of it.  Every rank has to ask.
template <class M>
auto totals(const M& m)
{
  return totals(m.particles, m.order, *m.ranks);
}
/// Energy dissipated by the laws so far [J].  The same.
template <class M>
Real plastic_work(const M& m)
{
  ExactSums<Real> sum;
  for (std::size_t b = 0; b < m.materials.size(); ++b)
    add_plastic_work(m.materials[b], m.order, static_cast<Index>(b), m.particles.volume0, sum);
  m.ranks->sum(sum);
  return sum.value();
}

/// What goes by the walls that act, whose last one has been added.
template <int D, Kernel<D> K>
void bind_walls(Model<D, K>& m)
{
  m.walls.finalize();
  m.nodes.bound.resize(m.nodes.sum.size());
  for (Index node = 0; node < m.mesh.n_nodes(); ++node)
    m.nodes.bound[static_cast<std::size_t>(node)] = m.walls.binds(node) ? 1 : 0;
  m.exits.closed.assign(static_cast<std::size_t>(m.mesh.n_cells()), 0);
  for (const Facet facet : m.walls.closed_facets(m.mesh))
    m.exits.closed[static_cast<std::size_t>(facet.cell)] |= static_cast<std::uint8_t>(1 << facet.local);
}

/// Sizes what depends on the particles and finds their cells; once, when bodies, walls and loads are in place.  `to_come` are laws that bodies
/// take on later: what they need is there from the beginning.
template <int D, Kernel<D> K>
void make_ready(Model<D, K>& m, std::span<const std::vector<AnyBatch>> to_come = {})
{
  if (m.particles.volume.empty())
    m.particles.volume = m.particles.volume0;
  const auto any_material = [&](bool (*has)(const AnyBatch&) noexcept) {
    const auto any_of = [&](const std::vector<AnyBatch>& laws) { return std::any_of(laws.begin(), laws.end(), has); };
    return any_of(m.materials) || std::any_of(to_come.begin(), to_come.end(), any_of);
  };
  m.columns = {.affine = m.transfer.own_affine_field(),
               .applied = m.loads.any_on_particles(),
               .volume_ratio = any_material(averages_volume),
               .viscous = any_material(has_bulk_viscosity),
               .pore = m.water.any()};
  fill_columns(m.columns, m.particles);
  if (any_material(conducts_heat))
    m.share.alone() ? m.heat.emplace(m.mesh) : m.heat.emplace(*m.ranks, m.mesh, m.share);
  if (m.columns.volume_ratio)
    m.share.alone() ? m.stars.emplace(m.mesh) : m.stars.emplace(*m.ranks, m.mesh, m.share);
  if (m.transfer.musl)
    m.remapped.resize(m.nodes.sum.size());
  m.followed = FollowedRows(ids_of(m.loads.on_particles));
  bind_walls(m);
  m.nodes.least_share_of_gross = HasNodeOperators<K, D> && !HasOwnValues<K, D> ? least_share_of_hats : least_share_of_cells;
  m.nodes.least_share = m.kernel.claims().non_negative ? least_share : least_share_of_signed_weights;
  take_rows(m);
  m.mass.start = totals(m).mass;
}

}  // namespace talus
