#include "io/pictures/maps/render_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/error.hpp"
#include "io/files/runout_maps.hpp"
#include "io/output/csv.hpp"
#include "io/pictures/maps/render_map_painter.hpp"
#include "io/pictures/maps/render_section.hpp"
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
  std::sort(files.begin(), files.end());
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

const MapKind& kind_of(std::string_view name)
{
  return *std::find_if(map_kinds.begin(), map_kinds.end(), [&](const MapKind& kind) { return kind.name == name; });
}

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

}  // namespace

void draw_maps(const MapSettings& settings, const std::function<void(const fs::path&)>& written)
{
  if (settings.frames)
    return draw_frames(settings, written);
  const auto wanted = [&](std::string_view name, bool by_default) {
    return settings.only.empty() ? by_default : std::find(settings.only.begin(), settings.only.end(), name) != settings.only.end();
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
