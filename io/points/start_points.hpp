#pragma once
// A table of points -> the state of a body at these points, in the units and with the signs of Talus.
#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/types.hpp"
#include "io/scene/scene_start_state.hpp"
#include "materials/interface/history_rows.hpp"

namespace talus {

/// Columns that the table does not have are empty.
struct StartPoints {
  std::vector<std::array<Real, 3>> x;                              ///< [m]
  std::vector<Sym3> stress;                                        ///< tension positive [Pa]
  bool is_effective = false;                                       ///< what the stress is
  std::vector<Real> pore;                                          ///< pore pressure, compression positive [Pa]
  std::vector<std::array<Real, 3>> velocity, displacement;         ///< [m/s], [m]
  std::vector<std::pair<std::string, std::vector<Real>>> history;  ///< by the key of the history variable, in its unit
  std::vector<std::string> used, unused;                           ///< names of columns
  Index merged = 0;                                                ///< points that were another one once more
};

/// Reads the table of a body whose law has the scalar history variables `history`.  In 2 dimensions z is not needed, and of the shear stress
/// only xy.  Throws SceneErrors with file and line: columns that are missing or there twice, entries that are no finite numbers, units that
/// are not known, points at one place with different values, tensors that are not symmetric, fewer points than a plane needs;
/// EnvironmentError if the file cannot be read.
StartPoints read_start_points(const StartStateSpec& spec, const std::filesystem::path& file, int dimension,
                              std::span<const HistoryVariable> history);

}  // namespace talus
