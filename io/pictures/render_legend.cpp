// Texts beside, above and below the particles.
#include "io/pictures/render_legend.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/display_text.hpp"
#include "io/pictures/render_png.hpp"
#include "io/pictures/render_words.hpp"

namespace talus::render {

namespace {

using Size = std::array<Real, 2>;  // size of the window [pixels]

/// Adds a length scale below a 2-D picture.
void add_scale(Sheet& sheet, const Picture& picture, const Size& size)
{
  add_length(sheet, panel_of(picture.size).height() * size[1] / (2 * picture.camera.half_height), 0.2 * size[0],
             {1.2 * sheet.letter(), 1.2 * sheet.letter()});
}

/// Adds the directions of the axes to a 3-D picture.
void add_axes(Sheet& sheet, const Picture& picture)
{
  const Vec3 right = picture.camera.up.cross(picture.camera.towards);
  const Vec3& up = picture.camera.up;
  const Real lowest = std::min({up[0], up[1], up[2], 0.0});  // an axis that points down needs room
  const Real arm = 2.2 * sheet.letter(), x0 = 3.4 * sheet.letter(), y0 = 2.6 * sheet.letter() - 0.6 * arm * lowest;
  for (int d = 0; d < 3; ++d) {
    const Real x = right[d], y = up[d];
    if (std::hypot(x, y) < 0.1)
      continue;  // points towards the camera
    sheet.line({{x0, y0}, {x0 + arm * x, y0 + arm * y}}, ink);
    const Real to_text = 1 + 0.25 / std::hypot(x, y);
    sheet.text(std::string(1, "xyz"[d]), x0 + to_text * arm * x, y0 + to_text * arm * y, Side::centre);
  }
}

/// Adds the notes and the meaning of black lines below the particles, from the right.
void add_notes(Sheet& sheet, const Picture& picture, const Size& size)
{
  const Real y = 1.2 * sheet.letter(), gap = 0.5 * sheet.letter(), sample = 1.8 * sheet.letter();
  Real right = panel_of(picture.size).right * size[0];
  for (const std::string& note : picture.notes)
    right -= sheet.text(note, right, y, Side::right) + 2 * gap;
  if (picture.start.ends.empty())
    return;
  right -= sheet.text("outline at the start", right, y, Side::right) + gap;
  sheet.line({{right - sample, y}, {right, y}}, start_colour);
}

}  // namespace

void add_colour_bar(Sheet& sheet, const Scale& scale, const std::string& label, const std::string& unit, const Panel& panel,
                    const Size& size)
{
  const auto [low, high] = scale.range;
  const auto [factor, unit_name] = scaled_unit(unit, std::max(std::abs(low), std::abs(high)));
  const Real left = panel.right * size[0] + 1.2 * sheet.letter(), right = left + sheet.letter();
  const Real bottom = (panel.bottom + 0.06 * panel.height()) * size[1], top = (panel.top - 0.06 * panel.height()) * size[1];
  constexpr int bands = 256;
  for (int b = 0; b < bands; ++b) {
    const Real y0 = bottom + (top - bottom) * b / bands, y1 = bottom + (top - bottom) * (b + 1) / bands;
    sheet.area({{left, y0}, {right, y0}, {right, y1}, {left, y1}}, colour_of(scale.map, (b + 0.5) / bands));
  }
  for (const auto& [value, text] : scale.log ? decades(factor * low, factor * high) : ticks(factor * low, factor * high)) {
    const Real y = std::lerp(bottom, top, scale.share(value / factor));
    sheet.line({{right, y}, {right + 0.3 * sheet.letter(), y}}, ink);
    sheet.text(text, right + 0.5 * sheet.letter(), y);
  }
  const bool bare = unit_name.empty() || unit_name == "-";
  sheet.text(bare ? label : fmt::format("{} [{}]", label, unit_name), size[0] - sheet.letter(), 0.5 * (bottom + top), Side::centre,
             {.vertical = true});
}

void add_length(Sheet& sheet, Real pixels_per_metre, Real longest, const std::array<Real, 2>& place)
{
  const Real length = round_below(longest / pixels_per_metre);
  const Real left = place[0], right = left + length * pixels_per_metre, y = place[1], tip = 0.3 * sheet.letter();
  sheet.line({{left, y + tip}, {left, y - tip}, {left, y}, {right, y}, {right, y + tip}, {right, y - tip}}, ink);
  const bool small = length < 0.1, large = length >= 1000;
  sheet.text(fmt::format("{:g} {}",
                         small   ? 1e3 * length
                         : large ? 1e-3 * length
                                 : length,
                         small   ? "mm"
                         : large ? "km"
                                 : "m"),
             right + 0.5 * sheet.letter(), y);
}

void add_words(Sheet& sheet, const Picture& picture, const Cloud& cloud)
{
  const Size size{static_cast<Real>(oversampling * picture.size[0]), static_cast<Real>(oversampling * picture.size[1])};
  const Real line = size[1] - 1.3 * sheet.letter();
  sheet.text(picture.title, 1.2 * sheet.letter(), line, Side::left, {.size = 1.15, .bold = true});
  sheet.text(fmt::format("t = {:.4g} s", picture.time), size[0] - 0.6 * sheet.letter(), line, Side::right);
  add_colour_bar(sheet, picture.scale, cloud.label, cloud.unit, panel_of(picture.size), size);
  add_notes(sheet, picture, size);
  if (picture.dimension == 2)
    add_scale(sheet, picture, size);
  else
    add_axes(sheet, picture);
}

}  // namespace talus::render
