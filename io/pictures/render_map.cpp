// Maps are painted pixel by pixel, ground first, then what flowed over it; VTK puts the words around.
#include "io/pictures/render_map.hpp"

#include <fmt/format.h>
#include <vtkActor2D.h>
#include <vtkImageData.h>
#include <vtkImageMapper.h>
#include <vtkNew.h>
#include <vtkProperty2D.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "io/files/runout_maps.hpp"
#include "io/output/csv.hpp"
#include "io/pictures/render_frame.hpp"
#include "io/pictures/render_legend.hpp"
#include "io/pictures/render_png.hpp"
#include "io/pictures/render_words.hpp"
#include "io/terrain/raster_file.hpp"
#include "mesh/geometry/hillshade.hpp"

namespace talus::render {

namespace {

namespace fs = std::filesystem;

constexpr int map_width = 1280, lowest_map = 420, highest_map = 1100;                            // pixels
constexpr Real left_letters = 6.5, below_letters = 3.6, above_letters = 2.6, right_letters = 9;  // around the panel
constexpr int wanted_contours = 20;

/// A colour in doubles while it is mixed.
Vec3 mixed(const Vec3& a, const Vec3& b, Real share) { return a + share * (b - a); }

/// Values at every pixel of a panel.
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
  /// Whether f, of a value, changes beside this pixel: a line is there.
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

struct Paper {
  int width, height;
  std::vector<Vec3> colour;  ///< by pixel, from the lower left
  Vec3& at(int i, int j) { return colour[static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i)]; }
};

/// Every fifth contour is stronger.
Paper paint_ground(const PixelField& elevation, const PixelField& light, Real step)
{
  Paper paper{elevation.width(), elevation.height(), {}};
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

/// What lies on the ground shows its shape; a dark line runs around it, thin ones at the ticks of the colour bar.
void paint_values(const PixelField& values, const PixelField& light, const Scale& scale, const std::vector<Tick>& levels, Paper& paper)
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

void put(vtkRenderer* renderer, const Paper& paper, const Place& place)
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

/// The raster itself must be there for what is drawn; `ground` for what it is drawn on.
Raster read_map(const fs::path& folder, std::string_view name) { return read_raster(folder / "maps" / (std::string(name) + ".tif")); }

bool has_map(const fs::path& folder, std::string_view name) { return fs::exists(folder / "maps" / (std::string(name) + ".tif")); }

std::array<Real, 2> range_of(const std::vector<Real>& values)
{
  Extent extent(false);
  extent.add(values);
  return extent.range(false);
}

/// A place on the sheet for so wide a panel over so high a one, and the size of the picture around it.
struct Layout {
  std::array<int, 2> size;  ///< pixels of the picture
  Place place;
};
Layout layout_for(Real aspect, const std::optional<std::array<int, 2>>& wanted)
{
  const int width = wanted ? (*wanted)[0] : map_width;
  const Real letter = letter_height * width;
  const Real wide = width - (left_letters + right_letters) * letter;
  const int height =
      wanted
          ? (*wanted)[1]
          : 2 * static_cast<int>(std::clamp<Real>(wide / aspect + (above_letters + below_letters) * letter, lowest_map, highest_map) / 2);
  const Real high = height - (above_letters + below_letters) * letter;
  const Real w = std::min(wide, high * aspect), h = w / aspect;
  const Real left = left_letters * letter + (wide - w) / 2, bottom = below_letters * letter + (high - h) / 2;
  const auto pixel = [](Real x) { return std::round(oversampling * x); };
  return {{width, height}, {pixel(left), pixel(bottom), pixel(left + w), pixel(bottom + h)}};
}

/// A window with one renderer, words and a place for the panel.
template <class Draw>
void on_sheet(const Layout& layout, const fs::path& png, Draw&& draw)
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

void add_title(Sheet& sheet, const Layout& layout, const std::string& title, const std::string& note)
{
  const Real line = oversampling * layout.size[1] - 1.3 * sheet.letter();
  sheet.text(title, 1.2 * sheet.letter(), line, Side::left, {.size = 1.15, .bold = true});
  sheet.text(note, oversampling * layout.size[0] - 0.6 * sheet.letter(), line, Side::right);
}

/// An arrow to where north is on a map: up.
void add_north(Sheet& sheet, const Place& place)
{
  const Real x = place.right - 1.6 * sheet.letter(), y = place.top - 3.6 * sheet.letter(), h = 1.6 * sheet.letter();
  sheet.area({{x, y + h}, {x - 0.35 * h, y}, {x, y + 0.3 * h}, {x + 0.35 * h, y}}, ink);
  sheet.text("N", x, y + h + 0.8 * sheet.letter(), Side::centre, {.bold = true});
}

/// All maps of one run lie on the same ground.
class MapPainter {
 public:
  explicit MapPainter(const MapSettings& settings)
      : settings_(settings),
        ground_(read_map(settings.folder, "ground")),
        shown_{{ground_.west, ground_.south}, {ground_.west + ground_.columns * ground_.dx, ground_.south + ground_.rows * ground_.dy}},
        layout_(layout_for(ground_.columns * ground_.dx / (ground_.rows * ground_.dy), settings.size)),
        light_(ground_, hillshade(ground_), shown_, width(), height()),
        elevation_(ground_, ground_.values, shown_, width(), height()),
        step_(settings.contours.value_or(step_of(ground_))),
        paper_(paint_ground(elevation_, light_, step_))
  {}

  void draw(const Raster& raster, const MapKind& kind, const std::array<Real, 2>& range, const std::string& note, const fs::path& png) const
  {
    const Scale scale{settings_.map, range, settings_.log};
    const auto levels = settings_.log ? decades(range[0], range[1]) : ticks(range[0], range[1]);
    Paper paper = paper_;
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

 private:
  int width() const { return static_cast<int>(layout_.place.width()); }
  int height() const { return static_cast<int>(layout_.place.height()); }
  static Real step_of(const Raster& ground)
  {
    const auto range = render::range_of(ground.values);
    return round_below((range[1] - range[0]) / wanted_contours * 1.999);
  }

  const MapSettings& settings_;
  Raster ground_;
  Shown shown_;
  Layout layout_;
  PixelField light_, elevation_;
  Real step_;
  Paper paper_;
};

fs::path folder_for(const MapSettings& settings) { return settings.out.value_or(settings.folder / "pictures"); }

/// A line per surface; what lies between the ground before and the surface after is filled.
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
  const auto [low, high] = render::range_of(heights);
  const Real margin = 0.06 * (high - low);
  const Shown shown{{along.front(), low - margin}, {along.back(), high + margin}};
  // Not exaggerated where that leaves enough to see.
  const Real aspect = (shown.high[0] - shown.low[0]) / (shown.high[1] - shown.low[1]);
  constexpr Real flattest = 3.5;
  const Layout layout = layout_for(std::min(aspect, flattest), settings.size);
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

/// In the order of their numbers.
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

/// As the table of the run tells.
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

/// What never was as thick as the threshold is left out: single particles far out would make it seem more than it is.
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
