#pragma once
// What the balances at the end of a run say against it.
#include <string>
#include <vector>

#include "io/report.hpp"

namespace talus {

/// Energy that particles and nodes lose between them is like a part of the material's resistance; beyond this share of the plastic work
/// the answer is one of the mesh.
inline constexpr Real most_transfer_loss = 0.1;

/// In words, one entry each: balances that do not close, and a transfer loss beyond most_transfer_loss.  Empty if all is well.
std::vector<std::string> failed_accounts(const RunSummary& summary);

}  // namespace talus
