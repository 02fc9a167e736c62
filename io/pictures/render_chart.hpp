#pragma once
// A chart: two columns of a table as a curve, and levels it is compared with.
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace talus::render {

struct Chart {
  std::filesystem::path table;  ///< .csv whose first row names the columns, "name [unit]"
  std::string x, y;             ///< columns as they are named there
  struct Level {
    std::string name;
    Real value;  ///< in the unit of y
  };
  std::vector<Level> levels;     ///< horizontal lines
  std::vector<Level> uprights;   ///< vertical lines, in the unit of x
  std::string curve = "driven";  ///< name of the curve
  bool marks = false;            ///< a mark at each row
  bool log = false;              ///< y by its logarithm
  std::string title;
  std::filesystem::path out;  ///< .png
};

/// Bars to either side of a line: what a number is in two cases of each of several keys.
struct Tornado {
  struct Bar {
    std::string name;
    Real low, high;
  };
  std::vector<Bar> bars;  ///< from the top
  Real base = 0;          ///< where the line is
  std::string x, title;   ///< "name [unit]"
  std::filesystem::path out;
};
/// Words of the command line, after "tornado".  Error, saying what is wrong.
Tornado parse_tornado(std::span<const std::string> arguments);
/// As draw() of a chart.
void draw(const Tornado& tornado);

/// Words of the command line, after "chart".  Error, saying what is wrong.
Chart parse_chart(std::span<const std::string> arguments);

/// Draws and writes.  Needs a display.  Error if a column is not there; EnvironmentError if a file cannot be read or written.
void draw(const Chart& chart);

}  // namespace talus::render
