#pragma once
// Data that no step changes: the mesh and its part on this rank, loads, limits and options.  Stages may change them between two steps.
#include <memory>
#include <utility>
#include <vector>

#include "core/nonlinear_solver.hpp"
#include "core/parallel/communicator.hpp"
#include "core/particles.hpp"
#include "mesh/locate.hpp"
#include "mesh/part.hpp"
#include "solver/contact/contacts.hpp"
#include "solver/contact/cut_law.hpp"
#include "solver/flow/flow.hpp"
#include "solver/loads/loads.hpp"
#include "solver/loads/water.hpp"
#include "solver/options/limit_options.hpp"
#include "solver/options/reference_options.hpp"
#include "solver/options/resample_options.hpp"
#include "solver/options/transfer_options.hpp"
#include "solver/particles/removal.hpp"
#include "solver/rigid/rigid_body.hpp"
#include "solver/state/owned_nodes.hpp"

namespace talus {

class ConstitutiveLaw;

/// Optional columns of particles.
struct WantedColumns {
  bool affine = false;        ///< an affine velocity field different from L
  bool applied = false;       ///< forces on particles
  bool volume_ratio = false;  ///< a law averages its volume
  bool viscous = false;       ///< a law has bulk viscosity
  bool pore = false;          ///< there is pore water
  bool flow = false;          ///< it flows
  bool jump_stress = false;   ///< a stage without inertia, and a kernel that averages gradients
  bool side = false;          ///< there are sheets
  bool reference = false;     ///< a body has a reference configuration
  bool domain = false;        ///< particles of a body are split
};
/// The parts of a scene other than bodies and their boundary conditions.
template <int D>
struct SceneConditions {
  TransferOptions transfer{.scheme = Scheme::flip};  ///< plain unless set-up says otherwise
  Loads<D> loads;
  Water water;
  Flow flow;
  Exits exits;
  Contacts contacts;
  std::vector<CutLaw> cuts;  ///< by number of the cut of the mesh
  RigidScene<D> rigid;
  std::vector<ReferenceOptions> references;                ///< of each body; none: all are renewed in each step
  std::vector<std::optional<ResampleOptions>> resampling;  ///< of each body; none: particles stay what they are
  RunLimits limits;
  std::vector<std::shared_ptr<const ConstitutiveLaw>> laws_of_user;  ///< of all stages
};

template <int D>
struct Problem : SceneConditions<D> {
  Mesh<D> mesh;
  Locator<D> locator;
  Communicator* ranks = &one_rank();  ///< communicator of the run
  Subdomain subdomain;                ///< part of the mesh on this rank
  OwnNodes own;
  WantedColumns columns;
  NonlinearSolver* equations = nullptr;  ///< for stages that solve for equilibrium

  /// Velocity fields of bodies in contact; with sheets there are as many again, behind the sheets.
  std::size_t fields_in_front() const noexcept { return static_cast<std::size_t>(this->contacts.n_fields); }
  std::size_t n_fields() const noexcept { return fields_in_front() * (this->rigid.any_sheet() ? 2 : 1); }
  std::size_t field_of(Index body, bool behind) const noexcept { return this->contacts.field_of(body) + (behind ? fields_in_front() : 0); }

  explicit Problem(Mesh<D> m) : mesh(std::move(m)), locator(mesh), own(all_nodes(mesh)) {}
};

/// The number of rings of cells around own cells on each rank.  Stencils and rows of operators reach one ring, the construction of
/// operators one more.  Nodes of small mass of other ranks whose hosts are own nodes are two rings away, with all cells around them.
inline constexpr int rings_held = 3;

}  // namespace talus
