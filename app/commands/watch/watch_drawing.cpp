#include "app/commands/watch/watch_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mesh/geometry/spacing.hpp"

namespace talus {

namespace {

constexpr int dots_across = 2, dots_down = 4;  // of a letter

/// Colours of the 256 of a terminal from dark blue over green to yellow.
constexpr std::array<int, 12> palette{54, 55, 61, 25, 31, 30, 36, 35, 71, 112, 148, 226};

Vec3 cross(const Vec3& a, const Vec3& b) { return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}; }

/// Right and up on the screen, and towards the eye.
struct Eye {
  Vec3 right = Vec3::UnitX(), up = Vec3::UnitY(), towards = Vec3::UnitZ();
};

Eye eye_of(const DrawingStyle& style, int dimension)
{
  if (dimension == 2)
    return {};
  Eye eye;
  eye.towards = style.view.normalized();
  const Vec3 right = cross(style.up, eye.towards);
  eye.right = right.norm() > 0 ? Vec3(right.normalized()) : Vec3(Vec3::UnitX());
  eye.up = cross(eye.towards, eye.right);
  return eye;
}

struct Dot {
  Real depth = -std::numeric_limits<Real>::infinity(), value = 0;
  bool set = false;
};

/// A sheet of dots, the lowest row last.
class DotSheet {
 public:
  DotSheet(int columns, int rows)
      : across_(columns * dots_across), down_(rows * dots_down), dots_(static_cast<std::size_t>(across_ * down_))
  {}

  void put(int i, int j, Real depth, Real value)
  {
    if (i < 0 || j < 0 || i >= across_ || j >= down_)
      return;
    Dot& dot = dots_[static_cast<std::size_t>(j * across_ + i)];
    if (depth >= dot.depth)
      dot = {depth, value, true};
  }

  /// `colour`: what switches a terminal to the colour of a value; empty for none.
  template <class Colour>
  std::vector<std::string> lines(Colour&& colour) const
  {
    std::vector<std::string> all;
    for (int row = 0; row < down_ / dots_down; ++row) {
      std::string line, last;
      for (int column = 0; column < across_ / dots_across; ++column) {
        const auto [bits, value] = letter(column, row);
        if (bits == 0) {
          line += ' ';
          continue;
        }
        if (const std::string now = colour(value); now != last)
          line += last = now;
        line += braille(bits);
      }
      line.erase(line.find_last_not_of(' ') + 1);
      all.push_back(line + (last.empty() ? "" : "\033[0m"));
    }
    return all;
  }

 private:
  /// Which dots of a letter are set, and the mean of their values.
  std::pair<unsigned, Real> letter(int column, int row) const
  {
    static constexpr std::array<std::array<unsigned, dots_across>, dots_down> bit{{{1, 8}, {2, 16}, {4, 32}, {64, 128}}};
    unsigned bits = 0;
    Real sum = 0;
    int n = 0;
    for (int j = 0; j < dots_down; ++j)
      for (int i = 0; i < dots_across; ++i)
        if (const Dot& dot = dots_[static_cast<std::size_t>((row * dots_down + j) * across_ + column * dots_across + i)]; dot.set) {
          bits |= bit[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)];
          sum += dot.value;
          ++n;
        }
    return {bits, n > 0 ? sum / n : 0};
  }
  /// U+2800 and the letters behind it, in UTF-8.
  static std::string braille(unsigned bits)
  {
    return {static_cast<char>(0xE2), static_cast<char>(0xA0 + (bits >> 6U)), static_cast<char>(0x80 + (bits & 63U))};
  }

  int across_, down_;
  std::vector<Dot> dots_;
};

std::array<Real, 2> finite_range_of(std::span<const Real> values)
{
  constexpr Real infinity = std::numeric_limits<Real>::infinity();
  std::array<Real, 2> range{infinity, -infinity};
  for (const Real value : values)
    if (std::isfinite(value))
      range = {std::min(range[0], value), std::max(range[1], value)};
  return range[0] <= range[1] ? range : std::array{0.0, 0.0};
}

std::string colour_of(Real value, const std::array<Real, 2>& range)
{
  const Real share = range[1] > range[0] ? (value - range[0]) / (range[1] - range[0]) : 0;
  const auto step = std::isfinite(share) ? std::clamp<Real>(share, 0, 1) * (palette.size() - 1) : 0;
  return fmt::format("\033[38;5;{}m", palette[static_cast<std::size_t>(std::lround(step))]);
}

std::string legend(const Cloud& cloud, const std::array<Real, 2>& range, bool colours)
{
  std::string scale;
  for (std::size_t step = 0; colours && step < palette.size(); ++step)
    scale += fmt::format("\033[38;5;{}m\u2588", palette[step]);
  scale += colours ? "\033[0m" : "to";
  return fmt::format("{}{}  {:.4g} {} {:.4g}", cloud.label, cloud.unit.empty() ? "" : fmt::format(" [{}]", cloud.unit), range[0], scale,
                     range[1]);
}

}  // namespace

std::vector<std::string> drawn(const Cloud& cloud, const DrawingStyle& style)
{
  const std::size_t n = cloud.places.size() / 3;
  if (n == 0)
    return {};
  const Eye eye = eye_of(style, cloud.dimension);
  std::vector<Vec3> on_screen(n);
  Vec3 low = Vec3::Constant(std::numeric_limits<Real>::infinity()), high = -low;
  for (std::size_t p = 0; p < n; ++p) {
    const Vec3 x = Eigen::Map<const Vec3>(cloud.places.data() + 3 * p);
    on_screen[p] = {x.dot(eye.right), x.dot(eye.up), x.dot(eye.towards)};
    low = low.cwiseMin(on_screen[p]);
    high = high.cwiseMax(on_screen[p]);
  }
  const Real radius = drawn_radius(cloud.places, cloud.dimension);
  const Vec3 extent = high - low + Vec3::Constant(2 * radius);
  const Real scale = std::min(style.columns * dots_across / extent[0], style.rows * dots_down / extent[1]);  // dots per metre
  if (!std::isfinite(scale) || !(scale > 0))  // a damaged file: no place, or places without a distance that is a number
    return {};
  const auto letters = [&](Real metres, int dots) { return std::max(1, static_cast<int>(std::ceil(metres * scale / dots - 1e-9))); };
  DotSheet sheet(letters(extent[0], dots_across), letters(extent[1], dots_down));
  for (std::size_t p = 0; p < n; ++p) {
    const Real u = (on_screen[p][0] - low[0] + radius) * scale, v = (high[1] + radius - on_screen[p][1]) * scale, r = radius * scale;
    const int around = static_cast<int>(r);
    const int i = static_cast<int>(u), j = static_cast<int>(v);
    for (int di = -around; di <= around; ++di)
      for (int dj = -around; dj <= around; ++dj)
        if (di * di + dj * dj <= r * r)
          sheet.put(i + di, j + dj, on_screen[p][2], cloud.values[p]);
  }
  const std::array<Real, 2> range = style.range.value_or(finite_range_of(cloud.values));
  auto lines = sheet.lines([&](Real value) { return style.colours ? colour_of(value, range) : std::string(); });
  lines.push_back(legend(cloud, range, style.colours));
  return lines;
}

}  // namespace talus
