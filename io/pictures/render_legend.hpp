#pragma once
// The words of a picture: title, time, colour bar, length scale or axes, notes.
#include "io/pictures/render_canvas.hpp"
#include "io/pictures/render_sheet.hpp"

namespace talus::render {

inline constexpr Colour start_colour{0, 0, 0};  // of the outline at the start

/// On the right of a panel, of a window of that size [pixels].
void add_colour_bar(Sheet& sheet, const Scale& scale, const std::string& label, const std::string& unit, const Panel& panel,
                    const std::array<Real, 2>& size);
/// A round length to measure by, no longer than so many pixels, from a place on the sheet to the right.
void add_length(Sheet& sheet, Real pixels_per_metre, Real longest, const std::array<Real, 2>& place);

void add_words(Sheet& sheet, const Picture& picture, const Cloud& cloud);

}  // namespace talus::render
