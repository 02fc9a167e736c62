#pragma once
// Errors of a run according to its balances.
#include <string>
#include <vector>

#include "io/output/run_summary.hpp"

namespace talus {

/// Largest accepted energy loss between particles and nodes, relative to the plastic work: the loss acts like a part of the material's
/// resistance, and beyond this limit the result depends on the mesh.
inline constexpr Real most_transfer_loss = 0.1;
/// Largest accepted loss of angular momentum, relative to the sum of all angular momentum at the start and given.
inline constexpr Real most_angular_loss = 0.1;

/// The strain up to which the energy of bodies is not judged: they hardly moved, and errors of the first and the last step are as large as
/// all works together.
inline constexpr Real least_strain_judged = 1e-4;
/// The energy of that strain over the limit below which energy gains are round-off (RunLimits::least_energy, of a strain of 1e-6).
inline constexpr Real least_energy_factor = (least_strain_judged / 1e-6) * (least_strain_judged / 1e-6);

/// Descriptions of balances that do not close, and of transfer losses beyond the limits above.  Empty if there are none.  The loss of
/// energy is judged if one of the terms is more than `least_energy` [J].
std::vector<std::string> failed_accounts(const RunSummary& summary, Real least_energy);

}  // namespace talus
