#pragma once
// convergence.json: the numbers of a scene with cells of several sizes, and what they say of convergence.
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace talus {

struct ConvergenceLevelRecord {
  Real factor{};  ///< of the sizes in the scene [-]
  Real size{};    ///< mean size of the cells [m]
  std::int64_t cells{}, particles{};
  std::vector<std::string> changes;  ///< as for --set
  std::string state;                 ///< "done", "to be run", ...
  std::string folder, command, scene_digest;
};

struct ConvergenceNumberRecord {
  std::string name, unit;
  std::vector<std::optional<Real>> values;  ///< in the order of the levels
  std::string trend, verdict;
  std::optional<Real> order;                      ///< nothing also if it is infinite [-]
  std::optional<Real> extrapolated, uncertainty;  ///< in the unit of the number
};

struct ConvergenceRecord {
  std::string scene, commit;
  Real ratio{}, safety_factor{}, lowest_order{}, highest_order{}, formal_order{};
  std::vector<ConvergenceLevelRecord> levels;  ///< from coarse to fine
  std::vector<ConvergenceNumberRecord> numbers;
  std::vector<std::string> warnings;
};

/// The text of convergence.json.
std::string to_json(const ConvergenceRecord& record);

}  // namespace talus
