#include "io/pictures/render_frame.hpp"

#include <cmath>

#include "io/pictures/render_words.hpp"

namespace talus::render {

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
