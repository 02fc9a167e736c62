#pragma once
// The results of two runs, laid side by side: one table each of particles, nodes, cells and the history.
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/commands/diff/diff_command.hpp"
#include "app/commands/diff/differences.hpp"

namespace talus {

using RunFolders = std::array<std::filesystem::path, 2>;

/// Unit and number of components of a field in one of the runs.
struct FieldShape {
  std::string unit;
  int components = 1;
  friend bool operator==(const FieldShape&, const FieldShape&) = default;
};

/// One line of the table.
struct FieldLine {
  std::string name;
  std::array<std::optional<FieldShape>, 2> shape;  ///< nothing where the run does not have the field
  Real scale = 0;                                  ///< largest value in both runs at all times
  Gap gap = {};
  std::string where = {};     ///< the largest difference
  std::string obstacle = {};  ///< why values could not be compared; they count as different

  bool differs() const noexcept { return !obstacle.empty() || gap.differing > 0; }
};

/// Particles, nodes, cells or rows of the history of both runs.
struct FieldTable {
  std::string title, item;                  ///< what the items are called, many and one
  std::vector<std::string> names = {};      ///< of all fields, in the order of the files
  std::vector<FieldLine> lines = {};        ///< of those that are asked for
  std::size_t times = 0;                    ///< compared
  std::vector<std::string> one_sided = {};  ///< times and items that only one run has, in words
};

/// Whether a file is there and can be looked at.
bool is_there(const std::filesystem::path& file);

/// Error, EnvironmentError: results that cannot be read or compared.
std::vector<FieldTable> compare_all(const RunFolders& folders, const DiffOptions& options);

}  // namespace talus
