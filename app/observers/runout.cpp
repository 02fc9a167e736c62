#include "app/observers/runout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "app/observers/results.hpp"
#include "app/observers/runout_distance.hpp"
#include "io/files/atomic_file.hpp"
#include "io/system/traps.hpp"
#include "io/terrain/raster_file.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

constexpr Real no_value = std::numeric_limits<Real>::quiet_NaN();
constexpr Real never = std::numeric_limits<Real>::infinity();
constexpr Real threshold_of_cell = 0.1;
constexpr auto terrain_group = "terrain";

template <int D>
Vec3 in_space(const Vec<D>& v)
{
  Vec3 x = Vec3::Zero();
  x.template head<D>() = v;
  return x;
}

struct NodeSizes {
  Real size{}, count{};
};

/// Mean size of the cells of the whole mesh [m].
template <int D>
Real mean_size(const RunView<D>& view)
{
  ExactSums<NodeSizes> sum;
  for (Index n = 0; n < view.problem.mesh.n_nodes(); ++n)
    if (view.problem.share.alone() || view.problem.share.owns_node(n))
      sum.add({view.problem.mesh.node_size(n), 1});
  view.problem.ranks->sum(sum);
  const NodeSizes all = sum.value();
  return all.size / all.count;
}

/// f(cell, elevation) for the cells whose centre a facet lies over or under.
template <int D, class F>
void for_each_cell_of(const Mesh<D>& mesh, Facet facet, const PlanGrid& grid, const PlanAxes& axes, F&& f)
{
  std::array<Vec3, D> corner;
  const auto nodes = mesh.nodes_of(facet);
  Vec<2> low = Vec<2>::Constant(never), high = -low;
  const auto plan = [&](const Vec3& x) { return D == 2 ? Vec<2>(x[axes.plan[0]], 0) : Vec<2>(x[axes.plan[0]], x[axes.plan[1]]); };
  for (std::size_t k = 0; k < D; ++k) {
    corner[k] = in_space<D>(mesh.node(nodes[k]));
    low = low.cwiseMin(plan(corner[k])), high = high.cwiseMax(plan(corner[k]));
  }
  const auto first = [](Real at, Real begin, Real d, Index n) {
    return static_cast<Index>(std::clamp(std::floor((at - begin) / d - 0.5), Real{0}, static_cast<Real>(n - 1)));
  };
  const auto elevation = [&](const Vec3& x) { return axes.sign * x[axes.vertical]; };
  const Vec<2> a = plan(corner[0]), ab = plan(corner[1]) - a, ac = D == 2 ? Vec<2>(0, 1) : Vec<2>(plan(corner[D - 1]) - a);
  const Real area = ab[0] * ac[1] - ab[1] * ac[0];
  if (area == 0)
    return;                   // vertical
  constexpr Real rim = 1e-9;  // of the facet: centres on an edge belong to both sides
  for (Index row = D == 2 ? 0 : first(low[1], grid.south, grid.dy, grid.rows);
       row <= (D == 2 ? 0 : std::min(grid.rows - 1, first(high[1], grid.south, grid.dy, grid.rows) + 1)); ++row)
    for (Index column = first(low[0], grid.west, grid.dx, grid.columns);
         column <= std::min(grid.columns - 1, first(high[0], grid.west, grid.dx, grid.columns) + 1); ++column) {
      const auto centre = grid.centre(column, row);
      const Vec<2> p = Vec<2>(centre[0], D == 2 ? Real{0} : centre[1]) - a;
      const Real s = (p[0] * ac[1] - p[1] * ac[0]) / area, t = (ab[0] * p[1] - ab[1] * p[0]) / area;
      if (s >= -rim && t >= -rim && s + t <= 1 + rim)
        f(grid.cell(column, row),
          (1 - s - t) * elevation(corner[0]) + s * elevation(corner[1]) + (D == 3 ? t * elevation(corner[D - 1]) : 0));
    }
}

void raise(std::vector<Real>& to, const std::vector<Real>& values)
{
  for (std::size_t c = 0; c < to.size(); ++c)
    to[c] = std::isnan(to[c]) ? values[c] : std::isnan(values[c]) ? to[c] : std::max(to[c], values[c]);
}

/// Over a sum that may be nothing.
Real over(Real sum, Real whole) { return std::isgreater(whole, 0) ? sum / whole : no_value; }  // NaN is nothing, too

void write_map(const fs::path& file, const Raster& raster)
{
  const TrapsPaused paused;
  write_raster(file, raster);
}

std::vector<Real> without_zeros(std::vector<Real> values)
{
  std::replace(values.begin(), values.end(), Real{0}, no_value);
  return values;
}

}  // namespace

template <int D>
PlanAxes plan_axes(const Vec<D>& gravity)
{
  PlanAxes axes;
  axes.up = gravity.norm() > 0 ? Vec3(-in_space<D>(gravity).normalized()) : D == 2 ? Vec3(Vec3::UnitY()) : Vec3(Vec3::UnitZ());
  axes.up.cwiseAbs().maxCoeff(&axes.vertical);
  axes.sign = axes.up[axes.vertical] < 0 ? -1 : 1;
  axes.plan =
      D == 2 ? std::array<Index, 2>{1 - axes.vertical, none} : std::array<Index, 2>{(axes.vertical + 1) % 3, (axes.vertical + 2) % 3};
  return axes;
}

template <int D>
struct Runout<D>::Moved {
  std::int64_t id, eroded;
  std::array<Real, 3> start, place;  // [m]
  Real mass, volume, speed;          // [kg], [m^D], [m/s]
  Vec3 then() const { return Eigen::Map<const Vec3>(start.data()); }
  Vec3 now() const { return Eigen::Map<const Vec3>(place.data()); }
  Real side() const { return D == 2 ? std::sqrt(volume) : std::cbrt(volume); }
};

template <int D>
struct Runout<D>::CellValue {
  std::int64_t cell;
  Real value;
};

template <int D>
Runout<D>::Runout(fs::path folder, const std::optional<RunoutSpec>& spec)
    : folder_(std::move(folder)),
      spec_(spec),
      times_(spec ? spec->every : never),
      frame_times_(spec ? spec->frames_every.value_or(never) : never)
{}

/// What follows from the mesh and the spec.
template <int D>
void Runout<D>::lay_out(const RunView<D>& view)
{
  axes_ = plan_axes<D>(view.problem.loads.gravity.acceleration);
  map_ = view.problem.mesh.map();
  const Real cell = spec_->cell ? *spec_->cell : mean_size(view);
  constexpr Real round_off = 1e-9;
  const auto fit = [&](Index axis, Real& begin, Real& d, Index& n) {
    const Real extent = view.problem.mesh.high()[axis] - view.problem.mesh.low()[axis];
    begin = view.problem.mesh.low()[axis];
    constexpr Real most = std::numeric_limits<Index>::max();  // for which there is no memory
    n = static_cast<Index>(std::clamp(std::ceil(extent / cell - round_off), Real{1}, most));
    d = extent / n;
  };
  fit(axes_.plan[0], grid_.west, grid_.dx, grid_.columns);
  if constexpr (D == 3)
    fit(axes_.plan[1], grid_.south, grid_.dy, grid_.rows);
  else
    grid_.rows = 1;
  moved_ = reach_rule(spec_, cell).moved;
  threshold_ = spec_->threshold.value_or(threshold_of_cell * cell);
}

template <int D>
std::array<Real, 2> Runout<D>::on_plan(const Vec3& x) const
{
  return {x[axes_.plan[0]], D == 3 ? x[axes_.plan[1]] : 0};
}

/// What the ranks have found in each cell, as pick(a, b) of what two of them have; NaN is nothing.  On the root.
template <int D>
template <class Pick>
std::vector<Real> Runout<D>::joined(Communicator& ranks, const std::vector<Real>& here, Pick&& pick) const
{
  if (ranks.alone())
    return here;
  std::vector<CellValue> rows;
  for (std::size_t c = 0; c < here.size(); ++c)
    if (!std::isnan(here[c]))
      rows.push_back({static_cast<std::int64_t>(c), here[c]});
  std::vector<Real> all(ranks.is_root() ? here.size() : 0, no_value);
  for (const std::vector<CellValue>& of_rank : gather_rows<CellValue>(ranks, rows))
    for (const CellValue& one : of_rank) {
      Real& value = all[static_cast<std::size_t>(one.cell)];
      value = std::isnan(value) ? one.value : pick(value, one.value);
    }
  return all;
}

/// How high particles reach over each cell, whether they have moved or not.
template <int D>
std::vector<Real> Runout<D>::tops(const RunView<D>& view) const
{
  std::vector<Real> top(grid_.size(), no_value);
  std::vector<CellShare> shares;
  const Particles<D>& p = view.state.particles;
  for (std::size_t row = 0; row < p.id.size(); ++row) {
    const Vec3 x = in_space<D>(p.x[row]);
    const Real side = D == 2 ? std::sqrt(p.volume[row]) : std::cbrt(p.volume[row]);
    spread(grid_, on_plan(x), side, shares);
    for (const CellShare& in : shares)
      top[in.cell] = std::fmax(top[in.cell], elevation(x) + side / 2);
  }
  return joined(*view.problem.ranks, top, [](Real a, Real b) { return std::max(a, b); });
}

template <int D>
void Runout<D>::begin(const RunView<D>& view)
{
  lay_out(view);
  begun_ = true;
  start_ = view.state.clock.time;
  std::vector<Real> lowest(grid_.size(), no_value), terrain = lowest;
  for (const Facet facet : view.problem.mesh.boundary_facets())
    if (in_space<D>(view.problem.mesh.area_vector(facet)).dot(axes_.up) < 0)
      for_each_cell_of(view.problem.mesh, facet, grid_, axes_, [&](std::size_t c, Real z) { lowest[c] = std::fmin(lowest[c], z); });
  const auto of_terrain = view.problem.mesh.facet_set(terrain_group);
  for (const Facet facet : of_terrain.value_or(std::vector<Facet>()))
    for_each_cell_of(view.problem.mesh, facet, grid_, axes_, [&](std::size_t c, Real z) { terrain[c] = std::fmax(terrain[c], z); });
  base_ = joined(*view.problem.ranks, lowest, [](Real a, Real b) { return std::min(a, b); });
  terrain = joined(*view.problem.ranks, terrain, [](Real a, Real b) { return std::max(a, b); });
  surface_ = tops(view);
  raise(surface_, base_);
  ground_ = surface_;
  if (of_terrain)
    for (std::size_t c = 0; c < ground_.size(); ++c)
      ground_[c] = std::isnan(terrain[c]) ? ground_[c] : terrain[c];
  surface_max_ = surface_;
  const std::size_t n = base_.size();  // none but on the root
  for (auto* map : {&thickness_, &thickness_max_, &speed_max_, &intensity_max_, &source_, &erosion_})
    map->assign(n, 0);
  arrival_.assign(n, no_value);
  still_since_ = start_;
  view.problem.ranks->together([&] { file_.emplace(folder_ / "runout.csv", columns_of_file()); });
}

template <int D>
void Runout<D>::go_on(const RunView<D>& view)
{
  if (!begun_)
    return;
  lay_out(view);
  for (const auto* map : {&ground_, &base_, &surface_, &surface_max_, &thickness_, &thickness_max_, &speed_max_, &intensity_max_, &arrival_,
                          &source_, &erosion_})
    if (map->size() != grid_.size())
      throw EnvironmentError(fmt::format("the maps of the checkpoint have {} cells, those of the scene {}", map->size(), grid_.size()));
  view.problem.ranks->together(
      [&] { file_.emplace(HistoryFile::resume(folder_ / "runout.csv", columns_of_file(), view.state.clock.time)); });
}

template <int D>
bool Runout<D>::drop_later() const
{
  for (int n = frames_; fs::remove(frame_file(n)); ++n) {
  }
  return !begun_ || file_->last_time() == time_ || time_ < 0;
}

template <int D>
void Runout<D>::flush() const
{
  if (file_)
    file_->flush();
}

template <int D>
std::vector<typename Runout<D>::Moved> Runout<D>::gather_moved(const RunView<D>& view) const
{
  const auto among = [](const std::vector<std::string>& names, const Body& body) {
    return std::find(names.begin(), names.end(), body.name) != names.end();
  };
  const Particles<D>& p = view.state.particles;
  std::vector<Moved> here;
  for (const Body& body : view.state.bodies) {
    if (!spec_->bodies.empty() && !among(spec_->bodies, body))
      continue;
    const std::int64_t eroded = among(spec_->eroded, body) ? 1 : 0;
    for (auto row = static_cast<std::size_t>(body.begin); row < static_cast<std::size_t>(body.end); ++row) {
      const Vec3 then = in_space<D>(p.x0[row]), now = in_space<D>(p.x[row]);
      if ((now - then).norm() >= moved_)
        here.push_back({p.id[row],
                        eroded,
                        {then[0], then[1], then[2]},
                        {now[0], now[1], now[2]},
                        p.mass[row],
                        p.volume[row],
                        Vec<D>(p.v[row]).norm()});
    }
  }
  std::vector<Moved> all;
  for (const std::vector<Moved>& of_rank : gather_rows<Moved>(*view.problem.ranks, here))
    all.insert(all.end(), of_rank.begin(), of_rank.end());
  std::sort(all.begin(), all.end(), [](const Moved& a, const Moved& b) { return a.id < b.id; });
  return all;
}

template <int D>
void Runout<D>::count_on_cells(const std::vector<Moved>& moved, Real since_start)
{
  const Real area = grid_.area();
  std::vector<Real> flow(grid_.size(), 0);  // volume times speed over the area
  for (auto* map : {&thickness_, &source_, &erosion_})
    map->assign(grid_.size(), 0);
  std::vector<CellShare> shares;
  for (const Moved& p : moved) {
    spread(grid_, on_plan(p.now()), p.side(), shares);
    for (const CellShare& in : shares) {
      thickness_[in.cell] += in.share * p.volume / area;
      flow[in.cell] += in.share * p.volume * p.speed / area;
    }
    spread(grid_, on_plan(p.then()), p.side(), shares);
    for (const CellShare& in : shares) {
      source_[in.cell] += in.share * p.volume / area;
      erosion_[in.cell] += p.eroded != 0 ? in.share * p.volume / area : 0;
    }
  }
  now_.area = 0, now_.thickest = 0;
  Real lying = 0;
  for (std::size_t c = 0; c < grid_.size(); ++c) {
    const Real h = thickness_[c];
    thickness_max_[c] = std::max(thickness_max_[c], h);
    now_.thickest = std::max(now_.thickest, h);
    if (h < threshold_)
      continue;
    now_.area += area;
    lying += h * area;
    const Real speed = flow[c] / h;
    speed_max_[c] = std::max(speed_max_[c], speed);
    intensity_max_[c] = std::max(intensity_max_[c], h * speed * speed);
    if (std::isnan(arrival_[c]))
      arrival_[c] = since_start;
  }
  now_.mean = over(lying, now_.area);
}

template <int D>
void Runout<D>::count_altogether(const std::vector<Moved>& moved)
{
  std::vector<Vec3> then, now;
  std::vector<Real> masses, speeds;
  Vec3 moment = Vec3::Zero(), moment_then = Vec3::Zero();
  Real mass = 0, mass_times_speed = 0;
  now_.volume = now_.entrained = now_.kinetic = now_.fastest = 0;
  for (const Moved& p : moved) {
    then.push_back(p.then()), now.push_back(p.now()), masses.push_back(p.mass), speeds.push_back(p.speed);
    mass += p.mass, mass_times_speed += p.mass * p.speed;
    moment += p.mass * p.now(), moment_then += p.mass * p.then();
    now_.volume += p.volume;
    now_.entrained += p.eroded != 0 ? p.volume : 0;
    now_.kinetic += p.mass * p.speed * p.speed / 2;
    now_.fastest = std::max(now_.fastest, p.speed);
  }
  now_.mean_speed = mass > 0 ? mass_times_speed / mass : 0;
  now_.bulk = not_exceeded_by(speeds, masses, spec_->mass_share);
  const auto reach = reach_of(then, now, masses, axes_.up, spec_->mass_share);
  const Vec3 nowhere = Vec3::Constant(no_value);
  now_.front = reach ? reach->front : nowhere;
  now_.height = reach ? reach->height : no_value, now_.length = reach ? reach->length : no_value;
  now_.centre = reach ? Vec3(moment / mass) : nowhere;
  const Vec3 way = reach ? Vec3((moment - moment_then) / mass) : nowhere;
  now_.centre_height = 0 - way.dot(axes_.up), now_.centre_length = on_the_level(way, axes_.up).norm();
}

/// On average it would come less far than a cell of the maps in as much time as has passed since looks began: what the maps show changes no more.
template <int D>
bool Runout<D>::at_rest() const
{
  return now_.mean_speed * (time_ - start_) < (D == 3 ? std::max(grid_.dx, grid_.dy) : grid_.dx);
}

template <int D>
void Runout<D>::look(const RunView<D>& view, bool with_frame)
{
  const std::vector<Moved> moved = gather_moved(view);
  std::vector<Real> top = tops(view);
  time_ = view.state.clock.time;
  view.problem.ranks->together([&] {
    raise(top, base_);
    surface_ = std::move(top);
    raise(surface_max_, surface_);
    count_on_cells(moved, time_ - start_);
    count_altogether(moved);
    fastest_ = std::max(fastest_, now_.fastest), thickest_ = std::max(thickest_, now_.thickest);
    if (!at_rest())
      still_since_ = never;
    else if (!std::isfinite(still_since_))
      still_since_ = time_;
    std::vector<Real> values = row(time_);
    if (spec_->frames_every)
      values.push_back(with_frame ? frames_ : no_value);
    file_->append(values);
  });
}

template <int D>
std::vector<std::string> Runout<D>::see(const RunView<D>& view, bool last)
{
  const Real since_start = view.state.clock.time - start_;
  const bool due = times_.due(since_start), frame_due = frame_times_.due(since_start);
  if ((due || frame_due || last) && time_ != view.state.clock.time) {
    view.problem.ranks->together([&] { require_results(folder_); });
    look(view, frame_due);
  }
  if (!frame_due)
    return {};
  const fs::path file = frame_file(frames_++);
  view.problem.ranks->together([&] { write_map(file, raster(without_zeros(thickness_), "m")); });
  return {fs::path(map_folder) / file.filename()};
}

template <int D>
fs::path Runout<D>::frame_file(int n) const
{
  return folder_ / map_folder / fmt::format("thickness_{:04}.tif", n);
}

/// As the files have them: without a value where nothing has moved.
template <int D>
std::vector<typename Runout<D>::NamedMap> Runout<D>::maps() const
{
  const std::vector<const std::vector<Real>*> all{&ground_,    &base_,          &surface_, &surface_max_, &thickness_, &thickness_max_,
                                                  &speed_max_, &intensity_max_, &arrival_, &source_,      &erosion_};
  std::vector<NamedMap> named;
  for (std::size_t m = 0; m < map_kinds.size(); ++m) {
    const std::string_view name = map_kinds[m].name;
    const bool zero_is_a_value = is_surface(name) || name == "arrival";
    if (name != "erosion" || !spec_->eroded.empty())
      named.push_back({map_kinds[m], zero_is_a_value ? *all[m] : without_zeros(*all[m])});
  }
  return named;
}

template <int D>
std::array<Real, 2> Runout<D>::on_map(const std::array<Real, 2>& place) const
{
  return map_ ? map_->to_map(place[0], D == 3 ? place[1] : 0) : place;
}

template <int D>
Raster Runout<D>::raster(const std::vector<Real>& values, std::string_view unit) const
{
  const auto corner = on_map({grid_.west, grid_.south});
  Raster raster;
  raster.columns = grid_.columns, raster.rows = grid_.rows;
  raster.west = corner[0], raster.south = corner[1];
  raster.dx = grid_.dx, raster.dy = grid_.dy;
  raster.values = values;
  raster.crs = map_ ? map_->crs : "";
  raster.unit = unit;
  return raster;
}

/// A table of all maps at places of the plan.
template <int D>
std::string Runout<D>::section_text(const std::vector<std::array<Real, 2>>& places, const std::vector<Real>& distances) const
{
  constexpr std::string_view letters = "xyz";
  std::vector<CsvColumn> heads{{"distance", "m"}};
  if (map_)
    heads.insert(heads.end(), {{"east", "m"}, {"north", "m"}});
  else
    for (std::size_t d = 0; d < D - 1; ++d)
      heads.push_back({std::string(1, letters[static_cast<std::size_t>(axes_.plan[d])]), "m"});
  const std::vector<NamedMap> all = maps();
  for (const NamedMap& map : all)
    heads.push_back({std::string(map.kind.name), std::string(map.kind.unit)});
  std::string text;
  for (std::size_t i = 0; i < heads.size(); ++i)
    text += (i > 0 ? "," : "") + csv_cell(csv_heading(heads[i]));
  text += '\n';
  const auto put = [&](Real value) { text += std::isnan(value) ? "," : fmt::format(",{}", value); };
  for (std::size_t i = 0; i < places.size(); ++i) {
    text += fmt::format("{}", distances[i]);
    const auto shown = on_map(places[i]);
    for (std::size_t d = 0; d < (map_ ? 2 : D - 1); ++d)
      put(shown[d]);
    for (const NamedMap& map : all)
      put(sampled(grid_, map.values, places[i]));
    text += '\n';
  }
  return text;
}

namespace {

/// Points along a line, so far apart at most, its corners among them, and how far along each is.
void walk(const std::vector<std::array<Real, 2>>& corners, Real step, std::vector<std::array<Real, 2>>& places,
          std::vector<Real>& distances)
{
  Real begin = 0;
  places = {corners.front()}, distances = {0};
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const auto &a = corners[i], &b = corners[i + 1];
    const Real length = std::hypot(b[0] - a[0], b[1] - a[1]);
    const auto n = std::max(1, static_cast<int>(std::ceil(length / step - 1e-9)));
    for (int k = 1; k <= n; ++k) {
      const Real share = static_cast<Real>(k) / n;
      places.push_back({std::lerp(a[0], b[0], share), std::lerp(a[1], b[1], share)});
      distances.push_back(begin + share * length);
    }
    begin += length;
  }
}

}  // namespace

template <int D>
std::vector<std::string> Runout<D>::write_maps(const RunView<D>& view)
{
  std::vector<std::string> files;
  const auto write_section = [&](const std::string& name, const std::vector<std::array<Real, 2>>& places,
                                 const std::vector<Real>& distances) {
    const fs::path file = fs::path(section_folder) / (name + ".csv");
    view.problem.ranks->together([&] { write_whole(folder_ / file, section_text(places, distances)); });
    files.push_back(file);
  };
  std::vector<std::array<Real, 2>> places;
  std::vector<Real> distances;
  if constexpr (D == 2) {
    for (Index column = 0; column < grid_.columns; ++column) {
      places.push_back(grid_.centre(column, 0));
      distances.push_back(places.back()[0] - grid_.west);
    }
    write_section("plane", places, distances);
    return files;
  }
  for (const NamedMap& map : maps())
    for (const char* ending : {".tif", ".csv"}) {
      if (ending == std::string_view(".csv") && !spec_->csv)
        continue;
      const fs::path file = fs::path(map_folder) / (std::string(map.kind.name) + ending);
      view.problem.ranks->together([&] { write_map(folder_ / file, raster(map.values, map.kind.unit)); });
      files.push_back(file);
    }
  const std::array<Real, 2> origin = map_ ? map_->origin : std::array<Real, 2>{0, 0};
  for (const SectionSpec& section : spec_->sections) {
    std::vector<std::array<Real, 2>> corners;
    for (const std::vector<Real>& corner : section.along)
      corners.push_back({corner[0] - origin[0], corner[1] - origin[1]});
    walk(corners, std::min(grid_.dx, grid_.dy), places, distances);
    write_section(section.name, places, distances);
  }
  return files;
}

template <int D>
std::vector<CsvColumn> Runout<D>::columns() const
{
  constexpr std::string_view letters = "xyz";
  const char *area = D == 2 ? "m" : "m^2", *volume = D == 2 ? "m^2" : "m^3";
  std::vector<std::string> places;
  if (map_)
    places = {"east", "north"};
  else
    for (std::size_t d = 0; d < D - 1; ++d)
      places.emplace_back(1, letters[static_cast<std::size_t>(axes_.plan[d])]);
  std::vector<CsvColumn> all{{"time", "s"}};
  const auto place = [&](const std::string& what) {
    for (const std::string& axis : places)
      all.push_back({fmt::format("{}_{}", what, axis), "m"});
    all.push_back({what + "_elevation", "m"});
  };
  place("front");
  all.insert(all.end(), {{"H", "m"}, {"L", "m"}, {"H/L"}});
  place("centre");
  all.insert(all.end(), {{"centre_H", "m"},
                         {"centre_L", "m"},
                         {"centre_H/L"},
                         {"volume", volume},
                         {"area", area},
                         {"mean_thickness", "m"},
                         {"largest_thickness", "m"},
                         {"largest_speed", "m/s"},
                         {"mean_speed", "m/s"},
                         {"bulk_speed", "m/s"},
                         {"kinetic", "J"}});
  if (!spec_->eroded.empty())
    all.push_back({"entrained", volume});
  return all;
}

/// With the number of the view that was written at a look.
template <int D>
std::vector<CsvColumn> Runout<D>::columns_of_file() const
{
  std::vector<CsvColumn> all = columns();
  if (spec_->frames_every)
    all.push_back({"frame"});
  return all;
}

/// One number a column.
template <int D>
std::vector<Real> Runout<D>::row(Real time) const
{
  std::vector<Real> row{time};
  const auto place = [&](const Vec3& x) {
    const auto shown = on_map(on_plan(x));
    row.push_back(shown[0]);
    if (D == 3 || map_)
      row.push_back(shown[1]);
    row.push_back(elevation(x));
  };
  place(now_.front);
  row.insert(row.end(), {now_.height, now_.length, over(now_.height, now_.length)});
  place(now_.centre);
  row.insert(row.end(), {now_.centre_height, now_.centre_length, over(now_.centre_height, now_.centre_length), now_.volume, now_.area,
                         now_.mean, now_.thickest, now_.fastest, now_.mean_speed, now_.bulk, now_.kinetic});
  if (!spec_->eroded.empty())
    row.push_back(now_.entrained);
  return row;
}

template <int D>
std::vector<NamedValue> Runout<D>::numbers() const
{
  if (!begun_ || time_ < 0)
    return {};
  std::vector<NamedValue> all{{"begin", start_, "s"}};
  const auto heads = columns();
  const auto values = row(time_);
  for (std::size_t i = 1; i < heads.size(); ++i)
    if (heads[i].name != "largest_thickness" && heads[i].name != "largest_speed")
      all.push_back({heads[i].name, values[i], heads[i].unit});
  all.push_back({"angle_of_reach", std::atan2(now_.height, now_.length) * 180 / std::numbers::pi, "deg"});
  all.push_back({"largest_thickness", thickest_, "m"});
  all.push_back({"largest_speed", fastest_, "m/s"});
  all.push_back({"mass_share", spec_->mass_share, ""});
  all.push_back({"stopped", std::isfinite(still_since_) ? still_since_ : no_value, "s"});
  return all;
}

template PlanAxes plan_axes<2>(const Vec<2>&);
template PlanAxes plan_axes<3>(const Vec<3>&);
template class Runout<2>;
template class Runout<3>;

}  // namespace talus
