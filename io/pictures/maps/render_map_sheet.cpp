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

void add_frame(Sheet& sheet, const Place& place, const Shown& shown, const std::array<std::string, 2>& axes)
{
  const Real tip = 0.3 * sheet.letter();
  sheet.line({{place.left, place.bottom},
              {place.right, place.bottom},
              {place.right, place.top},
              {place.left, place.top},
              {place.left, place.bottom}},
             ink);
  Real last = -1e30;
  for (const auto& [value, text] : ticks(shown.low[0], shown.high[0])) {
    const Real x = std::lerp(place.left, place.right, (value - shown.low[0]) / (shown.high[0] - shown.low[0]));
    sheet.line({{x, place.bottom}, {x, place.bottom - tip}}, ink);
    const Real room = 0.6 * sheet.letter() * (static_cast<Real>(text.size()) + 1);
    if (x - last < room)
      continue;  // numbers would overlap
    sheet.text(text, x, place.bottom - 3.2 * tip, Side::centre);
    last = x;
  }
  for (const auto& [value, text] : ticks(shown.low[1], shown.high[1])) {
    const Real y = std::lerp(place.bottom, place.top, (value - shown.low[1]) / (shown.high[1] - shown.low[1]));
    sheet.line({{place.left, y}, {place.left - tip, y}}, ink);
    sheet.text(text, place.left - 2 * tip, y, Side::right);
  }
  sheet.text(axes[0], (place.left + place.right) / 2, place.bottom - 7.5 * tip, Side::centre);
  sheet.text(axes[1], 1.1 * sheet.letter(), (place.bottom + place.top) / 2, Side::centre, {.vertical = true});
}

}  // namespace talus::render
