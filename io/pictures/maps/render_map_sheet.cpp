#include "io/pictures/maps/render_map_sheet.hpp"

#include <algorithm>
#include <cmath>

#include "io/pictures/render_legend.hpp"

namespace talus::render {

namespace {

constexpr int map_width = 1280, lowest_map = 420, highest_map = 1100;  // in pixels
// space around the panel, in letter heights
constexpr Real left_letters = 6.5, below_letters = 3.6, above_letters = 2.6, right_letters = 9;

}  // namespace

std::array<Real, 2> range_of(const std::vector<Real>& values)
{
  Extent extent(false);
  extent.add(values);
  return extent.range(false);
}

MapLayout layout_for(Real aspect, const std::optional<std::array<int, 2>>& wanted)
{
  const int width = wanted ? (*wanted)[0] : map_width;
  const Real letter = letter_height * width;
  const Real wide = width - (left_letters + right_letters) * letter;
  const int height =
      wanted
          ? (*wanted)[1]
          : 2 * static_cast<int>(std::clamp<Real>(wide / aspect + (above_letters + below_letters) * letter, lowest_map, highest_map) / 2);
  const Real high = height - (above_letters + below_letters) * letter;
  const Real w = std::min(wide, high * aspect), h = w / aspect;
  const Real left = left_letters * letter + (wide - w) / 2, bottom = below_letters * letter + (high - h) / 2;
  const auto pixel = [](Real x) { return std::round(oversampling * x); };
  return {{width, height}, {pixel(left), pixel(bottom), pixel(left + w), pixel(bottom + h)}};
}

void add_title(Sheet& sheet, const MapLayout& layout, const std::string& title, const std::string& note)
{
  const Real line = oversampling * layout.size[1] - 1.3 * sheet.letter();
  sheet.text(title, 1.2 * sheet.letter(), line, Side::left, {.size = 1.15, .bold = true});
  sheet.text(note, oversampling * layout.size[0] - 0.6 * sheet.letter(), line, Side::right);
}

}  // namespace talus::render
