#pragma once
// What is summed up in the course of a step, and becomes numbers at its end, once for all ranks.
#include "core/parallel/communicator.hpp"
#include "solver/state/ledger.hpp"
#include "solver/state/node_work.hpp"

namespace talus {

template <int D>
struct StepSums {
  ExactSums<RemovedParticles<D>> departed;
  Real largest_set_back = 0;                           ///< farthest way on which a particle was set back onto a wall [m]
  ExactSums<ForceAndMoment<D>> on_particles, on_mesh;  ///< forces of loads [N]
  ExactSums<BoundaryWork> at_nodes;                    ///< work of walls on nodes
  ExactSums<BoundaryWork> beyond_nodes;                ///< on slaves and hats, of which the kinetic energy of nodes knows nothing
  ExactSums<NodeWork<D>> nodes;
  ExactSums<Balance> balance;
  ExactSums<Real> work_on_mesh, work_on_particles, internal;  ///< of loads, and stress power times dt [J]
  ExactSums<Real> remap;                                      ///< see EnergyLedger [J]
  ExactSums<Real> particles;                                  ///< their number
  Digits digits;                                              ///< of these and of the pushes of walls, kept from step to step
  void clear() noexcept
  {
    largest_set_back = 0;
    departed.clear(), on_particles.clear(), on_mesh.clear(), at_nodes.clear(), beyond_nodes.clear();
    nodes.clear(), balance.clear(), work_on_mesh.clear(), work_on_particles.clear(), internal.clear(), remap.clear();
    particles.clear();
  }
};

}  // namespace talus
