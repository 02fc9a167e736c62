#include "app/observers/runout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "app/observers/results.hpp"
#include "io/files/atomic_file.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

constexpr Real no_value = std::numeric_limits<Real>::quiet_NaN();
constexpr Real never = std::numeric_limits<Real>::infinity();
constexpr Real threshold_of_cell = 0.1;
constexpr auto terrain_group = "terrain";

struct NodeSizes {
  Real size{}, count{};
};

/// The mean size of the cells of the whole mesh [m].
template <int D>
Real mean_size(const RunView<D>& view)
{
  ExactSums<NodeSizes> sum;
  for (Index n = 0; n < view.problem.mesh.n_nodes(); ++n)
    if (view.problem.subdomain.alone() || view.problem.subdomain.owns_node(n))
      sum.add({view.problem.mesh.node_size(n), 1});
  view.problem.ranks->sum(sum);
  const NodeSizes all = sum.value();
  return all.size / all.count;
}

void raise(std::vector<Real>& to, const std::vector<Real>& values)
{
  for (std::size_t c = 0; c < to.size(); ++c)
    to[c] = std::isnan(to[c]) ? values[c] : std::isnan(values[c]) ? to[c] : std::max(to[c], values[c]);
}

std::vector<Real> without_zeros(std::vector<Real> values)
{
  std::replace(values.begin(), values.end(), Real{0}, no_value);
  return values;
}

}  // namespace

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

/// Settings that depend on the mesh.
template <int D>
void Runout<D>::lay_out(const RunView<D>& view)
{
  plan_.dimension = D;
  plan_.axes = plan_axes<D>(view.problem.loads.gravity.acceleration);
  plan_.map = view.problem.mesh.map();
  const Real cell = spec_->cell ? *spec_->cell : mean_size(view);
  constexpr Real round_off = 1e-9;
  const auto fit = [&](Index axis, Real& begin, Real& d, Index& n) {
    const Real extent = view.problem.mesh.high()[axis] - view.problem.mesh.low()[axis];
    begin = view.problem.mesh.low()[axis];
    constexpr Real most = std::numeric_limits<Index>::max();  // more cells do not fit into memory
    n = static_cast<Index>(std::clamp(std::ceil(extent / cell - round_off), Real{1}, most));
    d = extent / n;
  };
  fit(plan_.axes.plan[0], plan_.grid.west, plan_.grid.dx, plan_.grid.columns);
  if constexpr (D == 3)
    fit(plan_.axes.plan[1], plan_.grid.south, plan_.grid.dy, plan_.grid.rows);
  else
    plan_.grid.rows = 1;
  moved_ = reach_rule(spec_, cell).moved;
  threshold_ = spec_->threshold.value_or(threshold_of_cell * cell);
}

/// Combines the values of all ranks in each cell by pick(a, b); NaN means no value.  On the root.
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

/// The highest position of particles over each cell, moved or not.
template <int D>
std::vector<Real> Runout<D>::tops(const RunView<D>& view) const
{
  std::vector<Real> top(plan_.grid.size(), no_value);
  std::vector<CellShare> shares;
  const Particles<D>& p = view.state.particles;
  for (std::size_t row = 0; row < p.id.size(); ++row) {
    const Vec3 x = in_space<D>(p.x[row]);
    const Real side = D == 2 ? std::sqrt(p.volume[row]) : std::cbrt(p.volume[row]);
    spread(plan_.grid, plan_.on_plan(x), side, shares);
    for (const CellShare& in : shares)
      top[in.cell] = std::fmax(top[in.cell], plan_.elevation(x) + side / 2);
  }
  return joined(*view.problem.ranks, top, [](Real a, Real b) { return std::max(a, b); });
}

template <int D>
void Runout<D>::begin(const RunView<D>& view)
{
  lay_out(view);
  begun_ = true;
  start_ = view.state.clock.time;
  std::vector<Real> lowest(plan_.grid.size(), no_value), terrain = lowest;
  for (const Facet facet : view.problem.mesh.boundary_facets())
    if (in_space<D>(view.problem.mesh.area_vector(facet)).dot(plan_.axes.up) < 0)
      for_each_cell_of(view.problem.mesh, facet, plan_.grid, plan_.axes,
                       [&](std::size_t c, Real z) { lowest[c] = std::fmin(lowest[c], z); });
  const auto of_terrain = view.problem.mesh.facet_set(terrain_group);
  for (const Facet facet : of_terrain.value_or(std::vector<Facet>()))
    for_each_cell_of(view.problem.mesh, facet, plan_.grid, plan_.axes,
                     [&](std::size_t c, Real z) { terrain[c] = std::fmax(terrain[c], z); });
  base_ = joined(*view.problem.ranks, lowest, [](Real a, Real b) { return std::min(a, b); });
  terrain = joined(*view.problem.ranks, terrain, [](Real a, Real b) { return std::max(a, b); });
  surface_ = tops(view);
  raise(surface_, base_);
  ground_ = surface_;
  if (of_terrain)
    for (std::size_t c = 0; c < ground_.size(); ++c)
      ground_[c] = std::isnan(terrain[c]) ? ground_[c] : terrain[c];
  surface_max_ = surface_;
  const std::size_t n = base_.size();  // empty except on the root
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
    if (map->size() != plan_.grid.size())
      throw EnvironmentError(
          fmt::format("the maps of the checkpoint have {} cells, those of the scene {}", map->size(), plan_.grid.size()));
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
void Runout<D>::count_on_cells(const std::vector<MovedParticle<D>>& moved, Real since_start)
{
  const Real area = plan_.grid.area();
  std::vector<Real> flow(plan_.grid.size(), 0);  // volume times speed over the area
  for (auto* map : {&thickness_, &source_, &erosion_})
    map->assign(plan_.grid.size(), 0);
  std::vector<CellShare> shares;
  for (const MovedParticle<D>& p : moved) {
    spread(plan_.grid, plan_.on_plan(p.now()), p.side(), shares);
    for (const CellShare& in : shares) {
      thickness_[in.cell] += in.share * p.volume / area;
      flow[in.cell] += in.share * p.volume * p.speed / area;
    }
    spread(plan_.grid, plan_.on_plan(p.then()), p.side(), shares);
    for (const CellShare& in : shares) {
      source_[in.cell] += in.share * p.volume / area;
      erosion_[in.cell] += p.eroded != 0 ? in.share * p.volume / area : 0;
    }
  }
  now_.area = 0, now_.thickest = 0;
  Real lying = 0;
  for (std::size_t c = 0; c < plan_.grid.size(); ++c) {
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

/// Whether the mass would on average move less than a cell of the maps in the time since sampling began, so that the maps no longer change.
template <int D>
bool Runout<D>::at_rest() const
{
  return now_.mean_speed * (time_ - start_) < (D == 3 ? std::max(plan_.grid.dx, plan_.grid.dy) : plan_.grid.dx);
}

template <int D>
void Runout<D>::look(const RunView<D>& view, bool with_frame)
{
  const std::vector<MovedParticle<D>> moved = gather_moved(view, *spec_, moved_);
  std::vector<Real> top = tops(view);
  time_ = view.state.clock.time;
  view.problem.ranks->together([&] {
    raise(top, base_);
    surface_ = std::move(top);
    raise(surface_max_, surface_);
    count_on_cells(moved, time_ - start_);
    count_altogether(moved, plan_.axes.up, spec_->mass_share, now_);
    fastest_ = std::max(fastest_, now_.fastest), thickest_ = std::max(thickest_, now_.thickest);
    if (!at_rest())
      still_since_ = never;
    else if (!std::isfinite(still_since_))
      still_since_ = time_;
    std::vector<Real> values = runout_row(time_, now_, plan_, erodes());
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
    view.fetch_particles();
    look(view, frame_due);
  }
  if (!frame_due)
    return {};
  const fs::path file = frame_file(frames_++);
  view.problem.ranks->together([&] { write_map(file, raster_of(plan_, without_zeros(thickness_), "m")); });
  return {fs::path(map_folder) / file.filename()};
}

template <int D>
fs::path Runout<D>::frame_file(int n) const
{
  return folder_ / map_folder / fmt::format("thickness_{:04}.tif", n);
}

/// The maps as written to files, without values where nothing has moved.
template <int D>
std::vector<NamedMap> Runout<D>::maps() const
{
  const std::vector<const std::vector<Real>*> all{&ground_,    &base_,          &surface_, &surface_max_, &thickness_, &thickness_max_,
                                                  &speed_max_, &intensity_max_, &arrival_, &source_,      &erosion_};
  std::vector<NamedMap> named;
  for (std::size_t m = 0; m < map_kinds.size(); ++m) {
    const std::string_view name = map_kinds[m].name;
    const bool zero_is_a_value = is_surface(name) || name == "arrival";
    if (name != "erosion" || erodes())
      named.push_back({map_kinds[m], zero_is_a_value ? *all[m] : without_zeros(*all[m])});
  }
  return named;
}

template <int D>
std::vector<std::string> Runout<D>::write_maps(const RunView<D>& view)
{
  std::vector<std::string> files;
  const std::vector<NamedMap> all = maps();
  const auto write_section = [&](const std::string& name, const SectionPoints& points) {
    const fs::path file = fs::path(section_folder) / (name + ".csv");
    view.problem.ranks->together([&] { write_whole(folder_ / file, section_text(plan_, all, points)); });
    files.push_back(file);
  };
  if constexpr (D == 2) {
    write_section("plane", points_of_row(plan_.grid));
    return files;
  }
  for (const NamedMap& map : all)
    for (const char* ending : {".tif", ".csv"}) {
      if (ending == std::string_view(".csv") && !spec_->csv)
        continue;
      const fs::path file = fs::path(map_folder) / (std::string(map.kind.name) + ending);
      view.problem.ranks->together([&] { write_map(folder_ / file, raster_of(plan_, map.values, map.kind.unit)); });
      files.push_back(file);
    }
  const std::array<Real, 2> origin = plan_.map ? plan_.map->origin : std::array<Real, 2>{0, 0};
  for (const SectionSpec& section : spec_->sections) {
    std::vector<std::array<Real, 2>> corners;
    for (const std::vector<Real>& corner : section.along)
      corners.push_back({corner[0] - origin[0], corner[1] - origin[1]});
    write_section(section.name, points_along(corners, std::min(plan_.grid.dx, plan_.grid.dy)));
  }
  return files;
}

/// The time with the number of the frame that was written.
template <int D>
std::vector<CsvColumn> Runout<D>::columns_of_file() const
{
  std::vector<CsvColumn> all = runout_columns(plan_, erodes());
  if (spec_->frames_every)
    all.push_back({"frame"});
  return all;
}

template <int D>
std::vector<NamedValue> Runout<D>::numbers() const
{
  if (!begun_ || time_ < 0)
    return {};
  std::vector<NamedValue> all{{"begin", start_, "s"}};
  const auto heads = runout_columns(plan_, erodes());
  const auto values = runout_row(time_, now_, plan_, erodes());
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

template class Runout<2>;
template class Runout<3>;

}  // namespace talus
