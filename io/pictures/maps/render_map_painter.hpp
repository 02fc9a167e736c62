#pragma once
// Paints maps pixel by pixel: first the ground, then the values on it.
#include <filesystem>
#include <string>
#include <vector>

#include "io/files/result_files.hpp"
#include "io/pictures/maps/render_map_sheet.hpp"
#include "io/pictures/settings/picture_settings.hpp"
#include "mesh/geometry/hillshade.hpp"
#include "mesh/geometry/raster.hpp"

namespace talus::render {

/// The value at every pixel of a panel.
class PixelField {
 public:
  PixelField(const Raster& raster, const std::vector<Real>& values, const Shown& shown, int width, int height)
      : width_(width), height_(height)
  {
    const PlanGrid grid = grid_of(raster);
    at_.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    for (int j = 0; j < height; ++j)
      for (int i = 0; i < width; ++i)
        at_.push_back(sampled(
            grid, values,
            {std::lerp(shown.low[0], shown.high[0], (i + 0.5) / width), std::lerp(shown.low[1], shown.high[1], (j + 0.5) / height)}));
  }
  Real at(int i, int j) const
  {
    const auto row = static_cast<std::size_t>(std::clamp(j, 0, height_ - 1)),
               column = static_cast<std::size_t>(std::clamp(i, 0, width_ - 1));
    return at_[row * static_cast<std::size_t>(width_) + column];
  }
  /// Whether f(value) differs between this pixel and its neighbours, so that a line passes here.
  template <class F>
  bool changes(int i, int j, F&& f) const
  {
    const auto here = f(at(i, j));
    return here != f(at(i + 1, j)) || here != f(at(i, j + 1)) || here != f(at(i + 1, j + 1));
  }
  int width() const noexcept { return width_; }
  int height() const noexcept { return height_; }

 private:
  int width_, height_;
  std::vector<Real> at_;
};

struct PaintedPanel {
  int width, height;
  std::vector<Vec3> colour;  ///< by pixel, from the lower left
  Vec3& at(int i, int j) { return colour[static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i)]; }
};

/// Paints all maps of one run, which have the same ground.
class MapPainter {
 public:
  explicit MapPainter(const MapSettings& settings);

  void draw(const Raster& raster, const MapKind& kind, const std::array<Real, 2>& range, const std::string& note,
            const std::filesystem::path& png) const;

 private:
  int width() const { return static_cast<int>(layout_.place.width()); }
  int height() const { return static_cast<int>(layout_.place.height()); }

  const MapSettings& settings_;
  Raster ground_;
  Shown shown_;
  MapLayout layout_;
  PixelField light_, elevation_;
  Real step_;
  PaintedPanel paper_;
};

}  // namespace talus::render
