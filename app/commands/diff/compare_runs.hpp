#pragma once
// Comparison of the results of two runs: one table each for particles, nodes, cells and the history.
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/commands/diff/diff_command.hpp"
#include "app/commands/diff/differences.hpp"

namespace talus {

using RunFolders = std::array<std::filesystem::path, 2>;

/// The unit and number of components of a field in one run.
struct FieldShape {
  std::string unit;
  int components = 1;
  friend bool operator==(const FieldShape&, const FieldShape&) = default;
};

/// One line of the table.
struct FieldLine {
  std::string name;
  std::array<std::optional<FieldShape>, 2> shape;  ///< nothing if the run does not have the field
  Real scale = 0;                                  ///< largest value in both runs at all times
  Gap gap = {};
  std::string where = {};     ///< position of the largest difference
  std::string obstacle = {};  ///< reason why values could not be compared; they count as different

  bool differs() const noexcept { return !obstacle.empty() || gap.differing > 0; }
};

/// The fields of particles, nodes, cells or rows of the history of both runs.
struct FieldTable {
  std::string title, item;                  ///< name of the items in plural and singular
  std::vector<std::string> names = {};      ///< names of all fields, in the order of the files
  std::vector<FieldLine> lines = {};        ///< lines of the requested fields
  std::size_t times = 0;                    ///< number of compared times
  std::vector<std::string> one_sided = {};  ///< descriptions of times and items that only one run has
};

/// Whether a file exists and is accessible.
bool is_there(const std::filesystem::path& file);

/// Compares all tables.  Throws Error or EnvironmentError if results cannot be read or compared.
std::vector<FieldTable> compare_all(const RunFolders& folders, const DiffOptions& options);

}  // namespace talus
