#pragma once
// The texts of a picture: title, time, colour bar, length scale or axes, notes.
#include "io/pictures/render_canvas.hpp"
#include "io/pictures/render_sheet.hpp"

namespace talus::render {

inline constexpr Colour start_colour{0, 0, 0};  // colour of the initial outline

/// Adds a colour bar on the right of the panel, in a window of that size [pixels].
void add_colour_bar(Sheet& sheet, const Scale& scale, const std::string& label, const std::string& unit, const Panel& panel,
                    const std::array<Real, 2>& size);
/// Adds a length scale of a round length, at most `longest` pixels, to the right of a position on the sheet.
void add_length(Sheet& sheet, Real pixels_per_metre, Real longest, const std::array<Real, 2>& place);

void add_words(Sheet& sheet, const Picture& picture, const Cloud& cloud);

}  // namespace talus::render
