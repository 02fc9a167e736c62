#pragma once
// A run in memory: what it is about, its state, room for a step and the transfer of its kernel.
#include <memory>
#include <optional>
#include <span>

#include "solver/model/transfer.hpp"
#include "solver/state/sums.hpp"

namespace talus {

template <int D>
struct Model {
  Problem<D> problem;
  State<D> state;
  Workspace<D> work;
  std::unique_ptr<Transfer<D>> transfer;

  /// A model of one rank without particles.
  Model(Mesh<D> mesh, std::unique_ptr<Transfer<D>> of_kernel)
      : problem(std::move(mesh)), work(problem.mesh.n_nodes()), transfer(std::move(of_kernel))
  {}
  /// Becomes that of one of several ranks, its mesh being their part of a larger one.  Every rank has to join.
  void join(Communicator& others, Subdomain part);
  Index n_bodies() const noexcept { return static_cast<Index>(state.bodies.size()); }
};

/// Makes the columns of particles that are not there as they are of particles at rest; what comes from another run is kept.
template <int D>
void fill_columns(const WantedColumns& wanted, Particles<D>& particles);

/// Sizes what depends on the particles and finds their cells; once, when bodies, walls and loads are in place.  `to_come` are laws that bodies
/// take on later: what they need is there from the beginning.
template <int D>
void make_ready(Model<D>& m, std::span<const std::vector<Material>> to_come = {});

/// To be called when rows of particles have changed: finds the rows of tracked particles.
template <int D>
void update_tracked_rows(Model<D>& m);

/// To be called when particles have been replaced; their cells are known.  Every rank has to call it.
template <int D>
void update_rows(Model<D>& m);

/// To be called when the state has been replaced.  Where ranks share the run each has some of the particles, in cells of the whole mesh: they go
/// to the ranks whose cells these are.  Every rank has to call it.
template <int D>
void adopt_state(Model<D>& m);

/// To be called when the last boundary condition has been added.
template <int D>
void bind_boundary_conditions(Model<D>& m);

/// The pore water that the law of a body sees at a time; nothing where it sees total stress.
template <int D>
std::optional<PoreWater> pore_water(const Model<D>& m, Index body, Real time);

/// Mass, momentum and energy of the particles of all ranks.  Every rank has to ask.
template <int D>
Totals<D> totals(const Model<D>& m);

/// Energy dissipated by the laws so far, of all ranks [J].  Every rank has to ask.
template <int D>
Real plastic_work(const std::vector<Material>& materials, const CellOrder& order, const Particles<D>& particles, Communicator& ranks);
template <int D>
Real plastic_work(const Model<D>& m)
{
  return plastic_work(m.state.materials, m.work.order, m.state.particles, *m.problem.ranks);
}

}  // namespace talus
