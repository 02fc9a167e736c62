#include "app/observers/balance_errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace talus {

namespace {

Real term(const EnergyAudit& energy, std::string_view name)
{
  const auto found = std::find_if(energy.terms.begin(), energy.terms.end(), [&](const NamedValue& value) { return value.name == name; });
  return found == energy.terms.end() ? 0 : found->value;
}

Real largest_term(const EnergyAudit& energy)
{
  Real largest = 0;
  for (const char* name : {"gravity_work", "load_work", "wall_work", "kinetic_start", "kinetic", "strain", "plastic", "friction"})
    largest = std::max(largest, std::abs(term(energy, name)));
  return largest;
}

/// The transfer loss, judged only if the plastic work is not small compared with the largest energy term.
std::string transfer_loss(const EnergyAudit& energy)
{
  constexpr Real matters = 0.01;  // relative to the largest term
  const Real largest = largest_term(energy);
  const Real lost = term(energy, "transfer_loss"), plastic = term(energy, "plastic");
  if (!(plastic > matters * largest) || !(lost > most_transfer_loss * plastic))
    return {};
  return fmt::format(
      "particles and nodes lost {:.3g} J between them (transfer_loss), {:.3g} of the plastic work, more than {:.2g} of it: the mesh "
      "resists "
      "the motion as a part of the material would; compare with cells half as large",
      lost, lost / plastic, most_transfer_loss);
}

}  // namespace

std::vector<std::string> failed_accounts(const RunSummary& summary, Real least_energy)
{
  std::vector<std::string> failed;
  const auto judge = [&](std::string_view what, const auto& audit) {
    if (audit && !audit->closure.closes())
      failed.push_back(fmt::format("the balance of {} does not close: {:.2g} of the {} is not accounted for, more than {:.2g}", what,
                                   audit->closure.relative, audit->closure.relative_to, audit->closure.limit));
  };
  judge("mass", summary.mass);
  judge("momentum", summary.momentum);
  judge("angular momentum", summary.angular_momentum);
  if (summary.angular_momentum && summary.angular_momentum->transfer_share > most_angular_loss)
    failed.push_back(
        fmt::format("particles and nodes lost {:.3g} of the angular momentum between them (transfer_loss), more than {:.2g}: bodies "
                    "turn as the mesh allows; compare with cells half as large",
                    summary.angular_momentum->transfer_share, most_angular_loss));
  judge("energy", summary.energy);
  if (!summary.energy || largest_term(*summary.energy) < least_energy)
    return failed;
  if (const std::string what = transfer_loss(*summary.energy); !what.empty())
    failed.push_back(what);
  return failed;
}

}  // namespace talus
