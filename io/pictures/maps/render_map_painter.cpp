#include "io/pictures/maps/render_map_painter.hpp"

#include <fmt/format.h>
#include <vtkActor2D.h>
#include <vtkImageData.h>
#include <vtkImageMapper.h>
#include <vtkProperty2D.h>

#include <algorithm>
#include <cmath>

#include "io/pictures/render_legend.hpp"
#include "io/terrain/raster_file.hpp"

namespace talus::render {

namespace {

namespace fs = std::filesystem;

constexpr int wanted_contours = 20;

/// A mixture of two colours, in doubles.
Vec3 mixed(const Vec3& a, const Vec3& b, Real share) { return a + share * (b - a); }

/// Paints the shaded ground with contours; every fifth contour is stronger.
PaintedPanel paint_ground(const PixelField& elevation, const PixelField& light, Real step)
{
  PaintedPanel paper{elevation.width(), elevation.height(), {}};
  paper.colour.assign(static_cast<std::size_t>(paper.width) * static_cast<std::size_t>(paper.height), Vec3::Constant(255));
  for (int j = 0; j < paper.height; ++j)
    for (int i = 0; i < paper.width; ++i) {
      const Real z = elevation.at(i, j);
      if (std::isnan(z))
        continue;
      Vec3& colour = paper.at(i, j);
      colour = Vec3::Constant(50 + 200 * light.at(i, j));
      const auto band = [](Real width) { return [width](Real value) { return std::isnan(value) ? -1e300 : std::floor(value / width); }; };
      if (elevation.changes(i, j, band(5 * step)))
        colour = mixed(colour, {90, 70, 50}, 0.85);
      else if (elevation.changes(i, j, band(step)))
        colour = mixed(colour, {110, 90, 70}, 0.4);
    }
  return paper;
}

/// Paints values, shaded by the ground, with a dark outline and thin lines at the ticks of the colour bar.
void paint_values(const PixelField& values, const PixelField& light, const Scale& scale, const std::vector<Tick>& levels,
                  PaintedPanel& paper)
{
  const auto level = [&](Real value) {
    if (std::isnan(value))
      return -1;
    return static_cast<int>(std::count_if(levels.begin(), levels.end(), [&](const Tick& tick) { return value >= tick.value; }));
  };
  for (int j = 0; j < paper.height; ++j)
    for (int i = 0; i < paper.width; ++i) {
      const Real value = values.at(i, j);
      Vec3& colour = paper.at(i, j);
      if (!std::isnan(value)) {
        const Real lit = std::isnan(light.at(i, j)) ? 1 : light.at(i, j);
        const Colour plain = scale.colour(value);
        colour = mixed(colour, (0.65 + 0.45 * lit) * Vec3(plain[0], plain[1], plain[2]), 0.85).cwiseMin(255);
      }
      if (values.changes(i, j, [](Real v) { return std::isnan(v); }))
        colour = Vec3(20, 20, 20);
      else if (!std::isnan(value) && values.changes(i, j, level))
        colour = mixed(colour, Vec3(20, 20, 20), 0.6);
    }
}

void put(vtkRenderer* renderer, const PaintedPanel& paper, const Place& place)
{
  vtkNew<vtkImageData> image;
  image->SetDimensions(paper.width, paper.height, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  auto* to = static_cast<unsigned char*>(image->GetScalarPointer());
  for (const Vec3& colour : paper.colour)
    for (const Real channel : colour)
      *to++ = static_cast<unsigned char>(std::lround(channel));
  vtkNew<vtkImageMapper> mapper;
  mapper->SetInputData(image);
  mapper->SetColorWindow(255);
  mapper->SetColorLevel(127.5);
  vtkNew<vtkActor2D> actor;
  actor->SetMapper(mapper);
  actor->SetPosition(place.left, place.bottom);
  renderer->AddActor2D(actor);
}

/// Adds an arrow to the north, which is upwards on a map.
void add_north(Sheet& sheet, const Place& place)
{
  const Real x = place.right - 1.6 * sheet.letter(), y = place.top - 3.6 * sheet.letter(), h = 1.6 * sheet.letter();
  sheet.area({{x, y + h}, {x - 0.35 * h, y}, {x, y + 0.3 * h}, {x + 0.35 * h, y}}, ink);
  sheet.text("N", x, y + h + 0.8 * sheet.letter(), Side::centre, {.bold = true});
}

Real step_of(const Raster& ground)
{
  const auto range = range_of(ground.values);
  return round_below((range[1] - range[0]) / wanted_contours * 1.999);
}

}  // namespace

MapPainter::MapPainter(const MapSettings& settings)
    : settings_(settings),
      ground_(read_raster(settings.folder / "maps" / "ground.tif")),
      shown_{{ground_.west, ground_.south}, {ground_.west + ground_.columns * ground_.dx, ground_.south + ground_.rows * ground_.dy}},
      layout_(layout_for(ground_.columns * ground_.dx / (ground_.rows * ground_.dy), settings.size)),
      light_(ground_, hillshade(ground_), shown_, width(), height()),
      elevation_(ground_, ground_.values, shown_, width(), height()),
      step_(settings.contours.value_or(step_of(ground_))),
      paper_(paint_ground(elevation_, light_, step_))
{}

void MapPainter::draw(const Raster& raster, const MapKind& kind, const std::array<Real, 2>& range, const std::string& note,
                      const fs::path& png) const
{
  const Scale scale{settings_.map, range, settings_.log};
  const auto levels = settings_.log ? decades(range[0], range[1]) : ticks(range[0], range[1]);
  PaintedPanel paper = paper_;
  const PixelField values(raster, raster.values, shown_, width(), height());
  paint_values(values, light_, scale, levels, paper);
  on_sheet(layout_, png, [&](vtkRenderer* renderer, Sheet& sheet) {
    put(renderer, paper, layout_.place);
    const bool on_map = !ground_.crs.empty();
    add_frame(sheet, layout_.place, shown_,
              on_map ? std::array<std::string, 2>{"east [m]", "north [m]"}
                     : std::array<std::string, 2>{settings_.axes[0] + " [m]", settings_.axes[1] + " [m]"});
    if (on_map)
      add_north(sheet, layout_.place);
    add_title(sheet, layout_, settings_.title, note);
    const std::array<Real, 2> size{oversampling * Real(layout_.size[0]), oversampling * Real(layout_.size[1])};
    const Place& place = layout_.place;
    const Panel panel{place.left / size[0], place.bottom / size[1], place.right / size[0], place.top / size[1]};
    add_colour_bar(sheet, scale, std::string(kind.title), std::string(kind.unit), panel, size);
    const Real y = 0.9 * sheet.letter();
    add_length(sheet, place.width() / (shown_.high[0] - shown_.low[0]), 0.2 * place.width(), {1.2 * sheet.letter(), y});
    sheet.text(fmt::format("contours of the ground every {:g} m", step_), size[0] - 0.6 * sheet.letter(), y, Side::right);
  });
}

}  // namespace talus::render
