#pragma once
// What no step changes: the mesh and its part of this rank, loads, limits and options.  Stages may change it between two steps.
#include <utility>

#include "core/parallel/communicator.hpp"
#include "core/particles.hpp"
#include "mesh/locate.hpp"
#include "mesh/part.hpp"
#include "solver/loads/loads.hpp"
#include "solver/loads/water.hpp"
#include "solver/options/limit_options.hpp"
#include "solver/options/transfer_options.hpp"
#include "solver/particles/relocate.hpp"
#include "solver/state/owned_nodes.hpp"

namespace talus {

/// Columns of particles that not every run has.
struct WantedColumns {
  bool affine = false;        ///< an affine field of its own
  bool applied = false;       ///< forces on particles
  bool volume_ratio = false;  ///< a law averages its volume
  bool viscous = false;       ///< a law has bulk viscosity
  bool pore = false;          ///< there is water
};
/// What a scene prescribes besides the bodies and their boundary conditions.
template <int D>
struct SceneConditions {
  TransferOptions transfer{.scheme = Scheme::flip};  ///< plain unless set-up says otherwise
  Loads<D> loads;
  Water water;
  Exits exits;
  RunLimits limits;
};

template <int D>
struct Problem : SceneConditions<D> {
  Mesh<D> mesh;
  Locator<D> locator;
  Communicator* ranks = &one_rank();  ///< of the run
  Subdomain share;                    ///< of this rank
  OwnNodes own;
  WantedColumns columns;

  explicit Problem(Mesh<D> m) : mesh(std::move(m)), locator(mesh), own(all_nodes(mesh)) {}
};

/// Rings of cells to be held around own ones.  Stencils and the rows of operators reach one ring, what operators are made from one more; and the
/// nodes of small mass of other ranks that may hang on own nodes are two rings away, with all the cells around them.
inline constexpr int rings_held = 3;

}  // namespace talus
