#pragma once
// Lines, areas and texts over a picture.
#include <array>
#include <string>
#include <vector>

#include "io/pictures/render_colours.hpp"

class vtkRenderer;

namespace talus::render {

inline constexpr Colour ink{38, 38, 38};

/// The channels of a colour in [0, 1], as VTK needs them.
Vec3 channels(const Colour& colour);

enum class Side : std::uint8_t { left, centre, right };
struct Style {
  Real size = 1;  ///< relative to the usual letter height
  bool bold = false, vertical = false;
};

/// Draws on a renderer that covers the whole window; positions are pixels from its lower left corner.
class Sheet {
 public:
  /// letter: height of usual letters [pixels].
  Sheet(vtkRenderer* renderer, Real letter) : renderer_(renderer), letter_(letter) {}

  void line(const std::vector<std::array<Real, 2>>& points, const Colour& colour) { polygon(points, colour, false); }
  void area(const std::vector<std::array<Real, 2>>& corners, const Colour& colour) { polygon(corners, colour, true); }
  /// Draws a text; (x, y) is the middle of its height at the left end, centre or right end.  Returns its length [pixels].
  Real text(const std::string& words, Real x, Real y, Side side = Side::left, Style style = {});
  Real letter() const noexcept { return letter_; }

 private:
  void polygon(const std::vector<std::array<Real, 2>>& corners, const Colour& colour, bool filled);
  vtkRenderer* renderer_;
  Real letter_;
};

}  // namespace talus::render
