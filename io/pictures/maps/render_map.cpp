#include "io/pictures/maps/render_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "io/files/result_files.hpp"
#include "io/output/csv.hpp"
#include "io/pictures/maps/render_map_painter.hpp"
#include "io/pictures/maps/render_map_sheet.hpp"
#include "io/pictures/render_legend.hpp"
#include "io/terrain/raster_file.hpp"

namespace talus::render {

namespace {

namespace fs = std::filesystem;

/// The raster of that name; throws if it does not exist.
Raster read_map(const fs::path& folder, std::string_view name) { return read_raster(folder / "maps" / (std::string(name) + ".tif")); }

bool has_map(const fs::path& folder, std::string_view name) { return fs::exists(folder / "maps" / (std::string(name) + ".tif")); }

fs::path folder_for(const MapSettings& settings) { return settings.out.value_or(settings.folder / "pictures"); }

std::vector<fs::path> sections_in(const fs::path& folder)
{
  std::vector<fs::path> files;
  std::error_code not_there;
  for (const auto& entry : fs::directory_iterator(folder / "sections", not_there))
    if (entry.path().extension() == ".csv")
      files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

/// The files of frames in the order of their numbers.
std::vector<fs::path> frames_in(const fs::path& folder)
{
  std::vector<fs::path> files;
  for (int n = 0;; ++n) {
    fs::path file = folder / "maps" / fmt::format("thickness_{:04}.tif", n);
    if (!fs::exists(file))
      return files;
    files.push_back(std::move(file));
  }
}

/// The times of frames from the table of the run.
std::vector<Real> times_of_frames(const fs::path& folder, std::size_t n)
{
  const HistoryTable table = read_history(folder / "runout.csv");
  const auto frame = table["frame"], time = table["time"];
  std::vector<Real> times(n, std::numeric_limits<Real>::quiet_NaN());
  for (std::size_t row = 0; frame && time && row < table.rows(); ++row)
    for (std::size_t i = 0; i < n; ++i)
      if ((*frame)[row] == static_cast<Real>(i))
        times[i] = (*time)[row];
  return times;
}

/// Removes cells that were never as thick as the threshold, so that single distant particles do not exaggerate the affected area.
void leave_out_unreached(const std::vector<Real>& arrival, Raster& raster)
{
  for (std::size_t c = 0; c < std::min(arrival.size(), raster.values.size()); ++c)
    if (std::isnan(arrival[c]))
      raster.values[c] = arrival[c];
}

const MapKind& kind_of(std::string_view name) { return *std::ranges::find(map_kinds, name, &MapKind::name); }

void draw_frames(const MapSettings& settings, const std::function<void(const fs::path&)>& written)
{
  const MapPainter painter(settings);
  const auto files = frames_in(settings.folder);
  const std::vector<Real> times = times_of_frames(settings.folder, files.size());
  const std::vector<Real> arrival = has_map(settings.folder, "arrival") ? read_map(settings.folder, "arrival").values : std::vector<Real>();
  const auto frame_of = [&](const fs::path& file) {
    Raster raster = read_raster(file);
    leave_out_unreached(arrival, raster);
    return raster;
  };
  Extent extent(settings.log);
  for (const fs::path& file : files)
    extent.add(frame_of(file).values);
  const auto range = settings.range.value_or(extent.range(false));
  MapKind kind = kind_of("thickness");
  kind.title = "thickness";
  for (std::size_t n = 0; n < files.size(); ++n) {
    const fs::path png = folder_for(settings) / files[n].filename().replace_extension(".png");
    painter.draw(frame_of(files[n]), kind, range, fmt::format("t = {:.4g} s", times[n]), png);
    written(png);
  }
}

/// Draws a line for each surface, and fills the area between the ground before and the surface after.
void draw_section(const MapSettings& settings, const fs::path& file, const fs::path& png)
{
  struct Curve {
    const char *column, *words;
    Colour colour;
  };
  constexpr std::array curves{Curve{"base", "base", {110, 110, 110}}, Curve{"surface_max", "highest surface", {213, 94, 0}},
                              Curve{"surface", "surface after", {0, 114, 178}}, Curve{"ground", "ground before", {38, 38, 38}}};
  const HistoryTable table = read_history(file);
  const std::vector<Real>& along = table.values.front();
  std::vector<Real> heights;
  for (const Curve& curve : curves)
    if (const auto values = table[curve.column])
      heights.insert(heights.end(), values->begin(), values->end());
  const auto [low, high] = range_of(heights);
  const Real margin = 0.06 * (high - low);
  const Shown shown{{along.front(), low - margin}, {along.back(), high + margin}};
  // Without vertical exaggeration if the section is then high enough to be readable.
  const Real aspect = (shown.high[0] - shown.low[0]) / (shown.high[1] - shown.low[1]);
  constexpr Real flattest = 3.5;
  const MapLayout layout = layout_for(std::min(aspect, flattest), settings.size);
  const Place& place = layout.place;
  on_sheet(layout, png, [&](vtkRenderer*, Sheet& sheet) {
    const auto x_of = [&](Real x) { return std::lerp(place.left, place.right, (x - shown.low[0]) / (shown.high[0] - shown.low[0])); };
    const auto y_of = [&](Real y) { return std::lerp(place.bottom, place.top, (y - shown.low[1]) / (shown.high[1] - shown.low[1])); };
    if (const auto ground = table["ground"], surface = table["surface"]; ground && surface)
      for (std::size_t i = 0; i + 1 < along.size(); ++i) {
        const Real sum = (*ground)[i] + (*ground)[i + 1] + (*surface)[i] + (*surface)[i + 1];
        const Real rise = (*surface)[i] + (*surface)[i + 1] - (*ground)[i] - (*ground)[i + 1];
        if (std::isnan(sum) || rise == 0)
          continue;
        sheet.area({{x_of(along[i]), y_of((*ground)[i])},
                    {x_of(along[i + 1]), y_of((*ground)[i + 1])},
                    {x_of(along[i + 1]), y_of((*surface)[i + 1])},
                    {x_of(along[i]), y_of((*surface)[i])}},
                   rise > 0 ? Colour{200, 222, 240} : Colour{245, 222, 205});
      }
    Real y = place.top - 0.9 * sheet.letter();
    for (const Curve& curve : curves) {
      const auto values = table[curve.column];
      if (!values)
        continue;
      std::vector<std::array<Real, 2>> line;
      for (std::size_t i = 0; i <= along.size(); ++i) {
        if (i < along.size() && !std::isnan((*values)[i]))
          line.push_back({x_of(along[i]), y_of((*values)[i])});
        else if (line.size() > 1)
          sheet.line(std::exchange(line, {}), curve.colour);
        else
          line.clear();
      }
      const Real left = place.right + 0.8 * sheet.letter();
      sheet.line({{left, y}, {left + sheet.letter(), y}}, curve.colour);
      sheet.text(curve.words, left + 1.3 * sheet.letter(), y, Side::left, {.size = 0.85});
      y -= 1.4 * sheet.letter();
    }
    add_frame(sheet, place, shown, {"distance [m]", "elevation [m]"});
    const Real exaggeration = (place.height() / (shown.high[1] - shown.low[1])) / (place.width() / (shown.high[0] - shown.low[0]));
    add_title(sheet, layout, settings.title,
              fmt::format("section {}{}", file.stem().string(),
                          exaggeration > 1.01 ? fmt::format(", heights {:.2g} times", exaggeration) : std::string()));
  });
}

}  // namespace

void draw_maps(const MapSettings& settings, const std::function<void(const fs::path&)>& written)
{
  if (settings.frames)
    return draw_frames(settings, written);
  const auto wanted = [&](std::string_view name, bool by_default) {
    return settings.only.empty() ? by_default : std::ranges::find(settings.only, name) != settings.only.end();
  };
  std::optional<MapPainter> painter;
  const std::vector<fs::path> sections = wanted("sections", true) ? sections_in(settings.folder) : std::vector<fs::path>();
  if (sections.empty() && !settings.only.empty() && wanted("sections", false))
    throw Error(fmt::format("--only sections: there are none in {}", (settings.folder / "sections").string()));
  for (const MapKind& kind : map_kinds) {
    if (!wanted(kind.name, !is_surface(kind.name)))
      continue;
    if (!has_map(settings.folder, kind.name)) {
      if (!settings.only.empty())
        throw Error(fmt::format("--only {}: there is no {}", kind.name, (settings.folder / "maps" / kind.name).string() + ".tif"));
      continue;
    }
    if (!painter)
      painter.emplace(settings);
    Raster raster = read_map(settings.folder, kind.name);
    if (!is_surface(kind.name) && kind.name != "source" && kind.name != "erosion" && has_map(settings.folder, "arrival"))
      leave_out_unreached(read_map(settings.folder, "arrival").values, raster);
    Extent extent(settings.log);
    extent.add(raster.values);
    const fs::path png = folder_for(settings) / fmt::format("map_{}.png", kind.name);
    painter->draw(raster, kind, settings.range.value_or(extent.range(false)), "", png);
    written(png);
  }
  for (const fs::path& file : sections) {
    const fs::path png = folder_for(settings) / fmt::format("section_{}.png", file.stem().string());
    draw_section(settings, file, png);
    written(png);
  }
}

}  // namespace talus::render
