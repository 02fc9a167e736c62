#pragma once
// The part of a step that depends on the kernel, behind an interface: callers do not depend on the kernel.
#include <cstdint>
#include <functional>
#include <vector>

#include "solver/model/problem.hpp"
#include "solver/model/state.hpp"
#include "solver/model/workspace.hpp"

namespace talus {

template <int D>
struct Model;

/// Limits of mass below which a node does not move by itself, see NodeSum.
struct LeastShares {
  Real of_particles;  ///< relative to the lightest particle around
  Real of_gross;      ///< relative to the sum of absolute masses
};

/// What needs the particles of other blocks between two parts of the pass over particles; empty where there is nothing.
struct BetweenParts {
  // Between motion and stress.
  std::function<void(Index block)> after_motion;  ///< of a block, whose particles are in the cache
  std::function<void()> before_stress;            ///< all particles have moved
  std::function<void(Index block)> before_stress_of_block;
  // Between stress and the sums for the next step.
  std::function<void()> after_stress;
};

/// Transfer between particles and nodes by the shape functions of one kernel.  The functions of a step are called once in it and
/// contain the loop over particles.
template <int D>
class Transfer {
 public:
  Transfer() = default;
  Transfer(const Transfer&) = delete;
  Transfer& operator=(const Transfer&) = delete;
  virtual ~Transfer() = default;

  /// Adapts to the part of the mesh on one of several ranks.  Collective.
  virtual void join(const Problem<D>& problem) = 0;
  /// Allocates what depends on the options of the run and its number of velocity fields; to be called before the first step.  Collective.
  virtual void prepare(const Problem<D>& problem) = 0;

  /// Whether strips are to hold the gradients of particles; otherwise find_gradients() computes them again.
  virtual bool keeps_gradients() const = 0;
  /// Whether gradients at particles are interpolated between means over the cells around nodes, averaged_gradients().
  virtual bool averages_gradients() const = 0;
  /// Adds the particles, as they are, to the rows of their blocks; to be called before the first step after they came into strips.
  virtual void sum_strips(Model<D>& m) = 0;
  /// Sets L and C of the columns of a strip to what they were at the end of the last step, in memory of the calling thread.  May be
  /// called by several threads.
  virtual void find_gradients(Model<D>& m, std::size_t key, Index strip, StripColumns<D>& columns) = 0;
  /// Completes the sums of mass, momentum and force of the particles in the rows of their blocks (P2G): adds those that have changed their
  /// block.  The others were added by the step before.
  virtual void particles_to_nodes(Model<D>& m) = 0;
  /// Adds the rows of blocks and ranks to sums of the nodes, in a fixed order.
  virtual void assemble_nodes(Model<D>& m) = 0;
  /// Symmetric affine FLIP: adds the momentum of affine fields that fit the velocities of the nodes at this time [s]; nothing else does.
  virtual void add_affine_momentum(Model<D>& m, Real time) = 0;
  /// Replaces the net accelerations of nodes, `felt`, by the part that acts on particles.
  virtual void filter_acceleration(Model<D>& m) = 0;
  /// Starts to send the motion of nodes to other ranks.
  virtual void send_motion(Model<D>& m) = 0;
  /// Computes velocity, velocity gradient and position of every particle (G2P), with or without MUSL, its stress, and its contributions to
  /// the sums of the next step; `to` is the time of prescribed velocities.
  virtual void nodes_to_particles(Model<D>& m, const Kick& kick, Real dt, const BetweenParts& between) = 0;

  virtual LeastShares least_shares() const = 0;
  /// Appends the nodes on which the motion of particles in a cell depends.
  virtual void add_nodes_of_cell(const Mesh<D>& mesh, Index cell, std::vector<Index>& nodes) const = 0;
  /// The number of nodes of this rank that are treated as corners because no positive weights are exact for linear fields there.
  virtual std::int64_t nodes_as_corners(const OwnNodes& own) const = 0;
  /// The memory of the nodes and of the transfer [B]: of rows of nodes and cells, those near the particles.  To be called after
  /// begin_sweeps().
  virtual std::int64_t bytes(const Model<D>& m) const = 0;
};

}  // namespace talus
