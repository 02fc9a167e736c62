#pragma once
// What the balances at the end of a run say against it.
#include <string>
#include <vector>

#include "io/output/run_summary.hpp"

namespace talus {

/// Energy that particles and nodes lose between them is like a part of the material's resistance; beyond this share of the plastic work
/// the answer is one of the mesh.
inline constexpr Real most_transfer_loss = 0.1;
/// The same of angular momentum, of the moments of all momentum there was and was given.
inline constexpr Real most_angular_loss = 0.1;

/// A strain so small that the energy of bodies which nowhere exceed it is not judged: they hardly moved, and what the first and the last
/// step leave open beside their stress is as large as all works together.
inline constexpr Real least_strain_judged = 1e-4;
/// Its energy over that below which gains are round-off (Guards::least_energy, of a strain of 1e-6).
inline constexpr Real least_energy_factor = (least_strain_judged / 1e-6) * (least_strain_judged / 1e-6);

/// In words, one entry each: balances that do not close, and transfer losses beyond those above.  Empty if all is well.  The loss of
/// energy is judged if one of the terms is more than `least_energy` [J].
std::vector<std::string> failed_accounts(const RunSummary& summary, Real least_energy);

}  // namespace talus
