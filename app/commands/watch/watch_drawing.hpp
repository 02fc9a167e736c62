#pragma once
// Particles drawn in the letters of a terminal: braille, two by four dots each.
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace talus {

struct Cloud {
  int dimension = 2;
  std::vector<Real> places;  ///< 3 numbers a particle [m]
  std::vector<Real> values;  ///< one a particle
  std::string label, unit;   ///< of the values
};

struct DrawingStyle {
  int columns = 78, rows = 16;                         ///< letters, at most
  bool colours = false;                                ///< of the terminal, 256
  Vec3 view = Vec3(0.4, -1, 0.5), up = Vec3::UnitZ();  ///< 3-D: from the particles to the eye, and up
  std::optional<std::array<Real, 2>> range;            ///< of the colours; default that of the values
};

/// Lines of text, then one that explains the colours, if there are any.
std::vector<std::string> drawn(const Cloud& cloud, const DrawingStyle& style);

}  // namespace talus
