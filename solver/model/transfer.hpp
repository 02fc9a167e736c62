#pragma once
// The part of a step that depends on the kernel, behind an interface: everything above sees no kernel.
#include <cstdint>
#include <functional>
#include <vector>

#include "solver/model/problem.hpp"
#include "solver/model/state.hpp"
#include "solver/model/workspace.hpp"

namespace talus {

template <int D>
struct Model;

/// Which nodes have too little mass to move by themselves, see NodeSum.
struct LeastShares {
  Real of_particles;  ///< of the lightest particle around
  Real of_gross;      ///< of the mass without signs
};

/// Transfer between particles and nodes by the shape functions of one kernel.  Each function is called once in a step, or less often; loops over
/// particles are behind them.
template <int D>
class Transfer {
 public:
  /// To be called when the velocity gradients of a body in a block of cells are new, while its particles are still in the cache.
  using StressUpdate = std::function<void(Index body, Index block)>;

  Transfer() = default;
  Transfer(const Transfer&) = delete;
  Transfer& operator=(const Transfer&) = delete;
  virtual ~Transfer() = default;

  /// Becomes that of one of several ranks.  Every rank has to call it.
  virtual void join(const Problem<D>& problem) = 0;
  /// Sizes what depends on the options of the run; once, before the first step.
  virtual void prepare(const TransferOptions& options) = 0;

  /// Mass, momentum and force of every particle, into the rows of its block (P2G).
  virtual void particles_to_nodes(Model<D>& m) = 0;
  /// Rows of blocks and ranks -> sums of the nodes, in a fixed order.
  virtual void assemble_nodes(Model<D>& m) = 0;
  /// The part of the net accelerations of nodes, `felt`, that particles feel.
  virtual void filter_acceleration(Model<D>& m) = 0;
  /// Starts the exchange of the motion of nodes with other ranks.
  virtual void send_motion(Model<D>& m) = 0;
  /// Velocity, velocity gradient and position of every particle (G2P), with or without the second pass of MUSL; `to`: when the velocities of
  /// boundaries are prescribed.
  virtual void nodes_to_particles(Model<D>& m, const Kick& kick, Real dt, const StressUpdate& update) = 0;

  virtual LeastShares least_shares() const = 0;
  /// Appends the nodes that move particles in a cell.
  virtual void add_nodes_of_cell(const Mesh<D>& mesh, Index cell, std::vector<Index>& nodes) const = 0;
  /// How many nodes of this rank are treated as corners because no positive weights keep linear fields there.
  virtual std::int64_t nodes_as_corners(const OwnNodes& own) const = 0;
  /// Memory that the transfer takes [B].
  virtual std::int64_t bytes() const = 0;
};

}  // namespace talus
