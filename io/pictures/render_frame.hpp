#pragma once
// A frame with ticks around maps and sections.
#include <array>
#include <string>

#include "io/pictures/render_camera.hpp"
#include "io/pictures/render_sheet.hpp"

namespace talus::render {

/// The range of a panel: coordinates of its low and high corner.
struct Shown {
  std::array<Real, 2> low, high;
};

/// The position of the panel on the sheet [pixels].
struct Place {
  Real left, bottom, right, top;
  Real width() const noexcept { return right - left; }
  Real height() const noexcept { return top - bottom; }
};

/// Draws lines around a panel, ticks with numbers at round values below and on the left, and the names of the axes.
void add_frame(Sheet& sheet, const Place& place, const Shown& shown, const std::array<std::string, 2>& axes);

}  // namespace talus::render
