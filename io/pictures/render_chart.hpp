#pragma once
// Charts: two columns of a table as a curve, with reference levels.
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace talus::render {

struct Chart {
  std::filesystem::path table;  ///< .csv whose first row names the columns as "name [unit]"
  std::string x, y;             ///< names of columns in the table
  struct Level {
    std::string name;
    Real value;  ///< in the unit of y
  };
  std::vector<Level> levels;  ///< horizontal lines
  std::string title;
  std::filesystem::path out;  ///< .png
};

/// Parses the words of the command line after "chart".  Throws Error with the reason.
Chart parse_chart(std::span<const std::string> arguments);

/// Draws and writes the chart.  Needs a display.  Throws Error if a column is missing, EnvironmentError if a file cannot be read or
/// written.
void draw(const Chart& chart);

}  // namespace talus::render
