// Choice of frames, colours and camera: equal for all pictures of one call, so that they can be compared.
#include "io/pictures/render.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>

#include "core/error.hpp"
#include "io/pictures/ground_file.hpp"
#include "io/pictures/render_canvas.hpp"
#include "io/pictures/render_data.hpp"
#include "io/pictures/render_outline.hpp"
#include "io/pictures/render_rigid.hpp"
#include "io/pictures/render_series.hpp"
#include "mesh/geometry/spacing.hpp"

namespace talus::render {

namespace {

namespace fs = std::filesystem;

constexpr int default_width = 1280, lowest = 420, highest = 960;  // in pixels

std::string file_name(const std::string& label, std::size_t frame)
{
  std::string name = label;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return fmt::format("{}_{:04}.png", name, frame);
}

fs::path picture_path(const Settings& settings, std::size_t frame, const std::string& label)
{
  const fs::path out = settings.out.value_or(settings.folder / "pictures");
  return out.extension() == ".png" ? out : out / file_name(label, frame);
}

/// The function that reads the field to be shown.
auto cloud_reader(const Settings& settings)
{
  return [&settings](const fs::path& file) { return read_cloud(file, settings.field); };
}

std::array<Real, 2> range_of(const Settings& settings, FrameSeries& frames, const Cloud& last)
{
  if (const auto* numbers = std::get_if<std::array<Real, 2>>(&settings.range))
    return *numbers;
  Extent extent(settings.log);
  extent.add(last.value);
  if (std::get<RangeOf>(settings.range) == RangeOf::whole)
    for (std::size_t f = 0; f + 1 < frames.size(); ++f)
      if (const auto cloud = frames.read(f, cloud_reader(settings)))
        extent.add(cloud->value);
  return extent.range(settings.map == Map::coolwarm);
}

std::vector<Vec3> corners_of(const std::array<Real, 4>& window) { return {{window[0], window[1], 0}, {window[2], window[3], 0}}; }

/// Sets size and camera so that all points of `shape` are visible.
void place_camera(const Settings& settings, const std::vector<Vec3>& shape, Picture& picture)
{
  const bool flat = picture.dimension == 2;
  const Viewpoint from = flat ? Viewpoint{Vec3::UnitZ(), Vec3::UnitY()} : viewpoint(settings.view, settings.up);
  const Real wanted = height_for(default_width, aspect_of(settings.window ? corners_of(*settings.window) : shape, from));
  picture.size = settings.size.value_or(std::array{default_width, 2 * static_cast<int>(std::clamp<Real>(wanted, lowest, highest) / 2)});
  const Panel panel = panel_of(picture.size);
  const Real aspect = panel.width() * picture.size[0] / (panel.height() * picture.size[1]);
  picture.camera =
      settings.window ? window_camera(*settings.window, aspect) : fit_camera(shape, from, !flat && settings.perspective, aspect);
  zoom_in(settings.zoom, picture.camera);
  for (std::size_t d = 0; d < settings.look_at.size(); ++d)
    picture.camera.centre[static_cast<Index>(d)] = settings.look_at[d];
}

/// The cloud without the particles beyond the plane.
Cloud clipped(Cloud cloud, const Plane& plane)
{
  std::size_t saved = 0;
  for (std::size_t p = 0; p < cloud.x.size(); ++p)
    if (plane.normal.dot(cloud.x[p]) <= plane.offset) {
      cloud.x[saved] = cloud.x[p];
      cloud.ids[saved] = cloud.ids[p];
      cloud.value[saved++] = cloud.value[p];
    }
  cloud.x.resize(saved);
  cloud.ids.resize(saved);
  cloud.value.resize(saved);
  return cloud;
}

std::string words_of(const Plane& plane)
{
  for (Index d = 0; d < 3; ++d)
    if (plane.normal.cwiseAbs().sum() == plane.normal[d])
      return fmt::format("cut at {} = {:g} m", "xyz"[d], plane.offset / plane.normal[d]);
  return fmt::format("cut by ({:g}, {:g}, {:g}) x = {:g} m", plane.normal[0], plane.normal[1], plane.normal[2], plane.offset);
}

/// The lines of the mesh; none if its file is damaged, as a picture of the particles is still useful.
Lines mesh_lines(const fs::path& folder, MeshLines which)
try {
  return read_mesh_lines(folder, which);
} catch (const EnvironmentError& damaged) {
  fmt::print(stderr, "warning: the mesh is left out: {}\n", damaged.what());
  return {};
}

/// The ground; none if its file is damaged.
std::optional<RigidGround> ground_in(const fs::path& folder, int dimension)
try {
  return read_ground(folder, dimension);
} catch (const EnvironmentError& damaged) {
  fmt::print(stderr, "warning: the ground is left out: {}\n", damaged.what());
  return std::nullopt;
}

/// The rigid bodies at a time [s]; none if their file is damaged.
std::optional<StoredMesh> rigid_at(const fs::path& folder, Real time)
try {
  return read_rigid(folder, time);
} catch (const EnvironmentError& damaged) {
  fmt::print(stderr, "warning: the rigid bodies are left out: {}\n", damaged.what());
  return std::nullopt;
}

Picture compose(const Settings& settings, FrameSeries& series, const RunFacts& facts, const Cloud& first, const Cloud& last)
{
  Picture picture;
  picture.dimension = facts.dimension;
  picture.title = settings.title;
  picture.scale = {settings.map, range_of(settings, series, last), settings.log};
  picture.radius = settings.radius.value_or(drawn_radius(numbers_of(first.x), facts.dimension));
  if (facts.dimension == 2)
    picture.spread = Spread(first.ids, first.volume);
  std::vector<Vec3> shape = first.x;
  shape.insert(shape.end(), last.x.begin(), last.x.end());
  if (const auto frames = chosen(settings.frames, series.size()); frames.size() == 1)
    if (const auto one = series.read(frames[0], cloud_reader(settings)))
      shape.insert(shape.end(), one->x.begin(), one->x.end());
  for (const Real time : {series.time(0), series.time(series.size() - 1)})
    if (const auto rigid = rigid_at(settings.folder, time))
      for (std::size_t n = 0; n < rigid->nodes.size(); n += 3)
        shape.emplace_back(rigid->nodes.data() + n);
  place_camera(settings, shape, picture);
  if (settings.ground) {
    picture.ground = ground_in(settings.folder, facts.dimension);
    picture.upwards = settings.up.normalized();
    picture.clip = settings.clip;
  }
  const bool asked = std::find(settings.given.begin(), settings.given.end(), "--mesh") != settings.given.end();
  // otherwise the lines of the air above the ground
  picture.mesh_lines = picture.ground && facts.dimension == 3 && !asked ? MeshLines::none : settings.mesh;
  picture.mesh = mesh_lines(settings.folder, picture.mesh_lines);
  if (picture.ground && !picture.ground->layers.empty())
    picture.notes.emplace_back("brown: where layers end at the start");
  if (settings.start_outline)
    picture.start =
        outline_of(series.first([](const fs::path& file) { return read_bodies(file, std::nullopt); }), facts.dimension, picture.camera);
  if (settings.clip)
    picture.notes.push_back(words_of(*settings.clip));
  return picture;
}

}  // namespace

void make_pictures(const Settings& settings, const std::function<void(const fs::path&)>& written)
{
  const char* display = std::getenv("DISPLAY");
  if (display == nullptr || *display == '\0')
    throw EnvironmentError("there is no display (DISPLAY is not set): use `talus render`, or xvfb-run -a talus-render ...");
  FrameSeries series(particle_files(settings.folder));
  const RunFacts facts = series.first([&](const fs::path& file) { return facts_of(file, series.size()); });
  std::vector<std::string> problems;
  check(settings, facts, problems);
  require_none(problems);
  Picture picture = compose(settings, series, facts, series.first(cloud_reader(settings)), series.last(cloud_reader(settings)));
  bool any = false;
  for (const std::size_t frame : chosen(settings.frames, series.size())) {
    auto cloud = series.read(frame, cloud_reader(settings));
    if (!cloud)
      continue;
    if (settings.clip) {
      cloud = clipped(*std::move(cloud), *settings.clip);
      picture.notes.back() = words_of(*settings.clip) + (cloud->x.empty() ? ": no particle is left" : "");
    }
    picture.time = series.time(frame);
    picture.rigid = rigid_at(settings.folder, picture.time);
    const fs::path png = picture_path(settings, frame, cloud->label);
    draw(picture, *cloud, png);
    written(png);
    any = true;
  }
  if (!any)
    throw EnvironmentError("none of the frames that are asked for can be read");
}

}  // namespace talus::render
