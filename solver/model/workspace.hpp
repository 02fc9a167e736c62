#pragma once
// Data that a step needs and no restart saves: they follow from the state, or are computed anew in every step.
#include <optional>
#include <vector>

#include "core/particle_errors.hpp"
#include "materials/interface/stress_strip.hpp"
#include "solver/boundary/velocity_field.hpp"
#include "solver/contact/contact_nodes.hpp"
#include "solver/contact/cut_nodes.hpp"
#include "solver/contact/wall_gaps.hpp"
#include "solver/flow/pore_pressure.hpp"
#include "solver/loads/loads.hpp"
#include "solver/rigid/rigid_nodes.hpp"
#include "solver/state/cell_order.hpp"
#include "solver/state/nodes.hpp"
#include "solver/state/step_sums.hpp"
#include "solver/state/tracked_ids.hpp"
#include "solver/stress/average_strain.hpp"
#include "solver/stress/average_volume.hpp"
#include "solver/stress/conduct_heat.hpp"
#include "solver/stress/jump_stress.hpp"
#include "solver/strips/particle_strips.hpp"

namespace talus {

template <int D>
struct Workspace {
  std::optional<ParticleStrips<D>> strips;  ///< between begin_sweeps() and end_sweeps(): the particles, instead of their columns
  CellOrder order;
  std::vector<std::uint8_t> renewed;  ///< bodies that take a new reference at the end of this step
  std::vector<std::uint8_t> due;      ///< keys of strips with particles for which their body needs one
  TrackedIds carriers;                ///< particles that carry tractions
  Migration<D> migration;
  ParticleErrors errors;

  std::vector<VelocityField<D>> fields;  ///< one, unless bodies are in contact or there are sheets
  ContactNodes<D> contact;               ///< nodes at which two fields touch
  std::optional<PorePressure<D>> flow;   ///< if water flows through pores
  CutNodes<D> cuts;                      ///< nodes of cuts and their twins
  WallGaps<D> walls;                     ///< where material touches walls with gaps
  Sheets<D> sheets;                      ///< fields in front of and behind sheets
  RigidNodes<D> rigid;                   ///< nodes at which material touches rigid bodies
  StepSums<D> sums;                      ///< sums of the present step
  // Sums over the particles of each body in each block.
  std::vector<StressSums> stress_sums;
  std::vector<ParticleLoadSums<D>> load_sums;             ///< used if loads act on particles
  std::vector<ExactSums<ForceAndMoment<D>>> on_surfaces;  ///< forces of each load on a surface, of the own nodes [N]

  std::vector<AveragedBodies<D>> averaged;   ///< bodies that average their volumes, while particles are in strips
  std::vector<AveragedStrain<D>> softening;  ///< bodies whose softening has a length, while particles are in strips
  std::optional<HeatSums<D>> heat;           ///< used if a body conducts heat
  std::optional<JumpStress<D>> jump_stress;  ///< used if particles have a stress against jumps of gradients, with one velocity field
};

}  // namespace talus
