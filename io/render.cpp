// Which frames, which colours, where the camera stands: the same for all pictures of one call, so they can be compared.
#include "io/render.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <numeric>

#include "core/error.hpp"
#include "core/spacing.hpp"
#include "io/render_canvas.hpp"
#include "io/render_data.hpp"

namespace talus::render {

namespace {

namespace fs = std::filesystem;

constexpr int default_width = 1280, lowest = 420, highest = 960;  // pixels

std::vector<std::size_t> chosen(const Settings& settings, std::size_t n)
{
  if (const auto* one = std::get_if<std::size_t>(&settings.frames)) {
    if (*one >= n)
      throw Error(fmt::format("there is no frame {}: the run has frames 0 to {}", *one, n - 1));
    return {*one};
  }
  switch (std::get<Which>(settings.frames)) {
    case Which::first: return {0};
    case Which::last: return {n - 1};
    case Which::all: break;
  }
  std::vector<std::size_t> all(n);
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

/// Finite values only.  A field of one value gets a range around it, so that there is a colour for it.
std::array<Real, 2> range_of(const Cloud& cloud)
{
  std::vector<Real> finite;
  std::copy_if(cloud.value.begin(), cloud.value.end(), std::back_inserter(finite), [](Real v) { return std::isfinite(v); });
  if (finite.empty())
    return {0, 1};
  const auto [low, high] = std::minmax_element(finite.begin(), finite.end());
  const Real largest = std::max(std::abs(*low), std::abs(*high));
  if (*high - *low > 1e-6 * largest)  // single precision in the files carries seven digits
    return {*low, *high};
  return largest > 0 ? std::array{*low - 0.5 * largest, *high + 0.5 * largest} : std::array{0.0, 1.0};
}

bool is_flat(const std::vector<Vec3>& points)
{
  return std::all_of(points.begin(), points.end(), [](const Vec3& x) { return x[2] == 0; });
}

fs::path picture_path(const Settings& settings, std::size_t frame, const Cloud& cloud, bool several)
{
  const fs::path out = settings.out.value_or(settings.folder / "pictures");
  if (out.extension() == ".png") {
    if (several)
      throw Error(fmt::format("--out {}: several frames need a folder", out.string()));
    return out;
  }
  std::string name = cloud.label;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return out / fmt::format("{}_{:04}.png", name, frame);
}

void make_folder(const fs::path& file)
{
  std::error_code failed;
  if (file.has_parent_path())
    fs::create_directories(file.parent_path(), failed);
  if (failed)
    throw EnvironmentError(fmt::format("cannot make the folder {}: {}", file.parent_path().string(), failed.message()));
}

/// Three a point.
std::span<const Real> numbers_of(const std::vector<Vec3>& points)
{
  static_assert(sizeof(Vec3) == 3 * sizeof(Real));
  return {points.empty() ? nullptr : points.front().data(), 3 * points.size()};
}

Picture compose(const Settings& settings, const Cloud& first, const Cloud& last, const std::vector<Vec3>& shape)
{
  Picture picture;
  picture.dimension = is_flat(shape) ? 2 : 3;
  picture.title = settings.title;
  picture.range = settings.range.value_or(range_of(last));
  const bool flat = picture.dimension == 2;
  picture.radius = settings.radius.value_or(drawn_radius(numbers_of(first.x), picture.dimension));
  const Vec3 view = flat ? Vec3::UnitZ() : settings.view, up = flat ? Vec3::UnitY() : settings.up;
  const Real wanted = height_for(default_width, aspect_of(shape, view, up));
  picture.size = settings.size.value_or(std::array{default_width, 2 * static_cast<int>(std::clamp<Real>(wanted, lowest, highest) / 2)});
  const Panel panel = panel_of(picture.size);
  picture.camera = fit_camera(shape, view, up, !flat, panel.width() * picture.size[0] / (panel.height() * picture.size[1]));
  return picture;
}

}  // namespace

void make_pictures(const Settings& settings, const std::function<void(const fs::path&)>& written)
{
  const char* display = std::getenv("DISPLAY");
  if (display == nullptr || *display == '\0')
    throw EnvironmentError("there is no display (DISPLAY is not set): use `talus render`, or xvfb-run -a talus-render ...");
  const auto files = particle_files(settings.folder);
  const auto frames = chosen(settings, files.size());
  const Cloud first = read_cloud(files.front().path, settings.field), last = read_cloud(files.back().path, settings.field);
  std::vector<Vec3> shape;  // everything the camera must see
  const auto add = [&](const Cloud& cloud) { shape.insert(shape.end(), cloud.x.begin(), cloud.x.end()); };
  add(first);
  add(last);
  if (frames.size() == 1 && frames[0] != 0 && frames[0] + 1 != files.size())
    add(read_cloud(files[frames[0]].path, settings.field));
  const Outline outline = settings.mesh ? read_outline(settings.folder) : Outline{};
  Picture picture = compose(settings, first, last, shape);
  for (const std::size_t frame : frames) {
    const Cloud cloud = frame == 0 ? first : frame + 1 == files.size() ? last : read_cloud(files[frame].path, settings.field);
    const fs::path png = picture_path(settings, frame, cloud, frames.size() > 1);
    make_folder(png);
    picture.time = files[frame].time;
    draw(picture, cloud, outline, png);
    written(png);
  }
}

}  // namespace talus::render
