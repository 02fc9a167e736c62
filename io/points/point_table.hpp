#pragma once
// A file of points as a table of columns, whatever its format.
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "io/scene/scene_start_state.hpp"

namespace talus {

struct PointColumn {
  std::string name, unit;                    ///< unit as in the file; empty for none
  std::vector<Real> values;                  ///< NaN where there is no number
  std::map<std::size_t, std::string> words;  ///< entries that are no finite numbers, by row
};

struct PointFile {
  std::filesystem::path file;
  std::vector<PointColumn> columns;
  std::vector<int> line;  ///< in the file, of each row; empty: rows have no lines
  int heading = 0;        ///< line of the names; 0: none
  std::size_t rows() const noexcept { return columns.empty() ? 0 : columns.front().values.size(); }
  /// Where a row is, and its name in messages: "" or "point 12".
  SourceLocation where(std::size_t row) const;
  std::string named(std::size_t row) const;
};

/// Reads a text with a heading (entries between commas, semicolons, tabs or blanks; `#` begins a comment), or VTK's .vtu or .vtp.  Vectors and
/// tensors of VTK become columns with the endings _x, _y, _z and _xx, _yy, _zz, _xy, _yz, _xz, and positions x, y, z.  Throws SceneErrors with
/// lines, EnvironmentError for a file that is not there or cannot be read.
PointFile read_point_table(const std::filesystem::path& file, PointsOf data);

}  // namespace talus
