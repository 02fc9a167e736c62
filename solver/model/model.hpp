#pragma once
// A run in memory: the problem, its state, the workspace of a step and the transfer of its kernel.
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
  Model(Mesh<D> mesh, std::unique_ptr<Transfer<D>> of_kernel) : problem(std::move(mesh)), transfer(std::move(of_kernel)) { add_field(); }
  /// Turns the model of a single rank into that of one of several ranks, whose mesh is their part of a larger one.  Collective.
  void join(Communicator& others, Subdomain part);
  /// Adds nodes for a velocity field.  Collective.
  void add_field();
  Index n_bodies() const noexcept { return static_cast<Index>(state.bodies.size()); }
};

/// Fills missing columns of particles with the values of particles at rest; columns from another run are kept.
template <int D>
void fill_columns(const WantedColumns& wanted, Particles<D>& particles);

/// Allocates what depends on the particles and finds their cells.  To be called once, when bodies, walls and loads are complete.  `to_come`
/// are laws that bodies get in later stages: what these need is allocated from the beginning.
template <int D>
void make_ready(Model<D>& m, std::span<const std::vector<Material>> to_come = {});

/// To be called after particles have been replaced and their cells are known.
template <int D>
void update_rows(Model<D>& m);

/// To be called after the state has been replaced.  With several ranks each has some of the particles, with cells of the whole mesh; they
/// are sent to the owners of these cells.  Collective.
template <int D>
void adopt_state(Model<D>& m);

/// To be called after the last boundary condition has been added.
template <int D>
void bind_boundary_conditions(Model<D>& m);

/// Whether rigid bodies read the affine fields of particles, which are then kept in strips.  With reference configurations they are not about
/// present positions.
template <int D>
bool rigid_bodies_use_affine_fields(const Model<D>& m);

/// Moves the particles into strips, in which steps keep them, unless they are there.  Collective.
template <int D>
void begin_sweeps(Model<D>& m);
/// Moves them back into their columns.
template <int D>
void end_sweeps(Model<D>& m);
/// Copies the particles into their columns, to be read, and drops the copy.
template <int D>
void copy_to_columns(Model<D>& m);
template <int D>
void drop_copy(Model<D>& m);
/// Particles that later steps do not change.
template <int D>
struct ParticleCopy {
  std::vector<Body> bodies;
  std::vector<Material> materials;
  Particles<D> particles;
};
/// Takes the copy in the columns out of the model, after making it if there is none; the strips keep the particles.  Nothing where the
/// particles are in their columns only.
template <int D>
std::optional<ParticleCopy<D>> take_copy(Model<D>& m);
/// The number of particles on this rank, wherever they are.
template <int D>
Index n_particles(const Model<D>& m) noexcept
{
  return m.work.strips ? m.work.strips->size() : m.state.particles.size();
}

/// The pore water for the law of a body at a time; nothing where the law uses total stress.
template <int D>
std::optional<PoreWater> pore_water(const Model<D>& m, Index body, Real time);

/// Computes the forces of loads at a time on n particles of a strip, into their column; does nothing in scenes without such loads.
template <int D>
void find_forces(const Model<D>& m, Real time, const StripColumns<D>& columns, std::size_t n);

/// Mass [kg], momentum [kg m/s] and energy [J] of the particles of all ranks.  Collective.
template <int D>
Totals<D> totals(const Model<D>& m);

}  // namespace talus
