#pragma once
// The words of a picture: title, time, colour bar, length scale or axes, notes.
#include "io/render_canvas.hpp"
#include "io/render_sheet.hpp"

namespace talus::render {

inline constexpr Colour start_colour{0, 0, 0};  // of the outline at the start

void add_words(Sheet& sheet, const Picture& picture, const Cloud& cloud);

}  // namespace talus::render
