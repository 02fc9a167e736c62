#pragma once
// The sheet of a map or a section: size, position of the panel, its frame with ticks, texts.
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>

#include <array>
#include <filesystem>
#include <optional>
#include <string>

#include "io/pictures/render_camera.hpp"
#include "io/pictures/render_png.hpp"
#include "io/pictures/render_sheet.hpp"
#include "io/pictures/render_words.hpp"

namespace talus::render {

std::array<Real, 2> range_of(const std::vector<Real>& values);

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

/// The position of a panel with the given width over height, and the size of the picture around it.
struct MapLayout {
  std::array<int, 2> size;  ///< size of the picture [pixels]
  Place place;
};
MapLayout layout_for(Real aspect, const std::optional<std::array<int, 2>>& wanted);

/// A window with one renderer, texts and a panel.
template <class Draw>
void on_sheet(const MapLayout& layout, const std::filesystem::path& png, Draw&& draw)
{
  vtkNew<vtkRenderWindow> window;
  prepare(window, layout.size);
  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(1, 1, 1);
  window->AddRenderer(renderer);
  Sheet sheet(renderer, letter_height * oversampling * layout.size[0]);
  draw(renderer.Get(), sheet);
  save(window, png);
}

void add_title(Sheet& sheet, const MapLayout& layout, const std::string& title, const std::string& note);

/// Draws lines around a panel, ticks with numbers at round values below and on the left, and the names of the axes.
void add_frame(Sheet& sheet, const Place& place, const Shown& shown, const std::array<std::string, 2>& axes);

}  // namespace talus::render
