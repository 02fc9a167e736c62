#include "io/terrain/terrain_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "io/mesh/cell_count.hpp"
#include "io/terrain/terrain_flow.hpp"
#include "io/terrain/terrain_input.hpp"
#include "io/terrain/terrain_layers.hpp"
#include "io/terrain/terrain_plan.hpp"
#include "mesh/quality.hpp"

namespace talus {

namespace {

std::string in_words(const MapPlace& place) { return fmt::format("({:.10g}, {:.10g})", place[0], place[1]); }

bool reaches_beyond(const Area& area, const Area& domain)
{
  const auto [low, high] = bounds_of(area);
  const auto [domain_low, domain_high] = bounds_of(domain);
  return low[0] < domain_low[0] || low[1] < domain_low[1] || high[0] > domain_high[0] || high[1] > domain_high[1];
}

template <int D>
class TerrainMaker {
 public:
  TerrainMaker(const MeshSpec& mesh, const std::filesystem::path& directory)
      : mesh_(mesh), spec_(*mesh.terrain), input_(read_terrain<D>(spec_, directory)), n_layers_(spec_.layers.size())
  {}

  MeshData<D> operator()()
  {
    check_size();
    sizes_.size = *mesh_.size;
    for (const FinerSpec& finer : spec_.refine)
      sizes_.strips.push_back({finer.along.empty() ? line_down_from(finer) : line_of(finer), finer.width, finer.size});
    throw_if_any();
    plan_ = survey<D>(make_plan<D>(input_, sizes_, mesh_.where), input_, sizes_);
    check_ground();
    throw_if_any();
    layers_ = lay(spec_, plan_, input_, problems_);
    throw_if_any();
    air();
    obstacles();
    throw_if_any();
    return mesh_of(stack());
  }

 private:
  void complain(const SourceLocation& where, std::string message) { problems_.push_back({where, std::move(message), {}}); }
  void throw_if_any()
  {
    if (!problems_.empty())
      throw SceneErrors(std::move(problems_));
  }

  /// Throws before anything is made if the plan alone needs too much memory.
  void check_size()
  {
    const auto [low, high] = bounds_of(input_.domain);
    const Real size = *mesh_.size;
    const Real cells = D == 2 ? (input_.to - input_.from) / size : 2 * (high[0] - low[0]) * (high[1] - low[1]) / (size * size);
    check_cells<D>(cells, fmt::format("size {} m", size), mesh_);
    for (const FinerSpec& finer : spec_.refine)
      check_cells<D>(D == 2 ? finer.width / finer.size : 2 * std::pow(finer.width / finer.size, 2),
                     fmt::format("size {} m of a strip", finer.size), mesh_);
  }

  MapLine line_of(const FinerSpec& finer)
  {
    MapLine line;
    for (const auto& place : finer.along)
      line.push_back({place[0], place.size() > 1 ? place[1] : 0});
    if (input_.on_map && std::any_of(finer.along.begin(), finer.along.end(), [](const auto& place) { return place.size() != 2; }))
      complain(finer.where, "every point of along has two numbers, [east, north]");
    return line;
  }

  MapLine line_down_from(const FinerSpec& finer)
  {
    const auto centre = centre_of_layer(input_, layer_named(finer.down_from));
    if (!centre)
      complain(finer.where, fmt::format("down_from: layer \"{}\" has no thickness", finer.down_from));
    return centre ? steepest_descent(input_, *centre, 2 * sizes_.size) : MapLine{};
  }

  void check_ground()
  {
    if (plan_.n_cells() == 0)
      return complain(spec_.where, "the domain holds no cell");
    const auto is_blank = [](Real height) { return !std::isfinite(height); };
    const auto first = std::find_if(plan_.ground.begin(), plan_.ground.end(), is_blank);
    if (first != plan_.ground.end())
      complain(spec_.ground.where,
               fmt::format("the ground is not known at {} of {} places, the first at {}; what is meshed is {}",
                           std::count_if(first, plan_.ground.end(), is_blank), plan_.ground.size(),
                           in_words(plan_.place[static_cast<std::size_t>(first - plan_.ground.begin())]), domain_in_words(input_)));
  }

  std::size_t layer_named(const std::string& name) const
  {
    const auto found = std::find_if(spec_.layers.begin(), spec_.layers.end(), [&](const LayerSpec& layer) { return layer.name == name; });
    return found == spec_.layers.end() ? 0 : static_cast<std::size_t>(found - spec_.layers.begin());
  }

  /// Marks plan cells with air above the ground: all cells, or those that an energy line from the layer reaches.
  void air()
  {
    has_air_.assign(plan_.n_cells(), spec_.air ? 1 : 0);
    if (!spec_.air || !spec_.air->reach)
      return;
    const Real fall = std::tan(*spec_.air->reach * std::numbers::pi / 180);
    const std::size_t l = layer_named(spec_.air->of);
    const auto own = plan_.nodes_of(layers_.inside[l]);
    const std::vector<Real>& top = l == 0 ? plan_.ground : layers_.bottoms[l - 1];
    std::vector<std::array<Real, 3>> sources;
    for (Index n = 0; n < plan_.n_nodes(); ++n)
      if (own[n] != 0 && layers_.bottoms[l][n] < top[n])
        sources.push_back({plan_.place[n][0], plan_.place[n][1], plan_.ground[n]});
    const EnergyLines lines(std::move(sources), fall);
    const auto is_reached = [&](Index n) { return lines.height(plan_.place[n]) >= plan_.ground[n]; };
    for (std::size_t c = 0; c < has_air_.size(); ++c) {
      const auto& nodes = plan_.plan.cells[c];
      has_air_[c] = std::any_of(nodes.begin(), nodes.end(), is_reached) ? 1 : 0;
    }
  }

  void obstacles()
  {
    obstacle_of_cell_.assign(plan_.n_cells(), none);
    for (std::size_t o = 0; o < spec_.obstacles.size(); ++o) {
      const ObstacleSpec& obstacle = spec_.obstacles[o];
      const auto refuse = [&](const std::string& why) { complain(obstacle.where, fmt::format("obstacle \"{}\" {}", obstacle.name, why)); };
      const Marks inside = cells_in(input_.obstacles[o], plan_);
      bool is_anywhere = false, is_in_air = false;
      std::optional<Index> other;
      for (std::size_t c = 0; c < inside.size(); ++c) {
        if (inside[c] == 0)
          continue;
        is_anywhere = true;
        is_in_air = is_in_air || has_air_[c] != 0;
        if (obstacle_of_cell_[c] != none)
          other = obstacle_of_cell_[c];
        obstacle_of_cell_[c] = static_cast<Index>(o);
      }
      if (!is_anywhere)
        refuse(fmt::format("lies outside what is meshed, {}", domain_in_words(input_)));
      else if (other)
        refuse(fmt::format("overlaps \"{}\"", spec_.obstacles[*other].name));
      else if (!is_in_air)
        refuse("stands where there is no air: the lines of air.reach do not come so far");
      else if (D == 3 && reaches_beyond(input_.obstacles[o], input_.domain))
        input_.notes.push_back(fmt::format("{}: obstacle \"{}\" reaches beyond what is meshed, {}, and is cut off there",
                                           to_string(obstacle.where), obstacle.name, domain_in_words(input_)));
    }
    for (std::size_t c = 0; c < has_air_.size(); ++c)  // over all of each marked layer
      if (obstacle_of_cell_[c] != none)
        has_air_[c] = 1;
  }

  /// The height of obstacles: over their own plan cells, and in between interpolated by distance, so that the cells beside them fit.
  std::vector<Real> shelf() const
  {
    std::vector<Real> height(plan_.ground.size(), 0);
    for (std::size_t c = 0; c < plan_.n_cells(); ++c)
      if (obstacle_of_cell_[c] != none)
        for (const Index n : plan_.plan.cells[c])
          height[n] = std::max(height[n], spec_.obstacles[obstacle_of_cell_[c]].height);
    for (Index n = 0; n < plan_.n_nodes(); ++n) {
      if (height[n] > 0)
        continue;
      Real sum = 0, weights = 0;
      for (std::size_t o = 0; o < input_.obstacles.size(); ++o)
        for (const MapLine& ring : input_.obstacles[o].rings) {
          constexpr Real nearest = 1e-3;  // smallest distance [m]
          const Real weight = std::pow(std::max(nearest, distance(ring, plan_.place[n])), -2);
          sum += weight * spec_.obstacles[o].height;
          weights += weight;
        }
      height[n] = sum / weights;
    }
    return height;
  }

  // Slabs from the bottom to the top: the layers, the slab of obstacles if there are any, the air.  Groups: the layers, then air.
  Index air_group() const { return static_cast<Index>(n_layers_); }
  Index shelf_slab() const { return spec_.obstacles.empty() ? none : static_cast<Index>(n_layers_); }

  Stack<D> stack() const
  {
    Stack<D> stack{plan_.plan, n_layers_ > 0 ? layers_.bottoms.back() : plan_.ground, {}};
    for (std::size_t l = n_layers_; l-- > 0;)
      stack.slabs.push_back({l == 0 ? plan_.ground : layers_.bottoms[l - 1], heights(spec_.layers[l].size), owners(l)});
    if (!spec_.air)
      return stack;
    const Marks aired = plan_.nodes_of(has_air_);
    std::vector<Real> ledge(plan_.ground.size(), 0), ground_and_ledge = plan_.ground, top = plan_.ground;
    if (!spec_.obstacles.empty())
      ledge = shelf();
    const std::vector<Real> cells = heights(spec_.air->size);
    for (std::size_t n = 0; n < top.size(); ++n) {
      ground_and_ledge[n] += aired[n] * ledge[n];
      const bool is_thin = spec_.air->height - ledge[n] < thinnest * cells[n];  // above an obstacle nearly as high as the air
      top[n] = is_thin ? ground_and_ledge[n] : plan_.ground[n] + aired[n] * spec_.air->height;
    }
    std::vector<Index> beside, above;
    for (std::size_t c = 0; c < plan_.n_cells(); ++c) {
      above.push_back(has_air_[c] != 0 ? air_group() : none);
      beside.push_back(obstacle_of_cell_[c] == none ? above.back() : none);
    }
    if (!spec_.obstacles.empty())
      stack.slabs.push_back({ground_and_ledge, cells, beside});
    stack.slabs.push_back({top, cells, above});
    return stack;
  }

  std::vector<Real> heights(const std::optional<Real>& said) const
  {
    std::vector<Real> all;
    for (Index n = 0; n < plan_.n_nodes(); ++n)
      all.push_back(plan_.height_of_cells(said, n));
    return all;
  }

  /// For each plan cell the layer l, or the next one below it whose area contains the cell.
  std::vector<Index> owners(std::size_t l) const
  {
    std::vector<Index> owners;
    for (std::size_t c = 0; c < plan_.n_cells(); ++c) {
      std::size_t owner = l;
      while (owner < n_layers_ && layers_.inside[owner][c] == 0)
        ++owner;
      owners.push_back(owner < n_layers_ ? static_cast<Index>(owner) : none);
    }
    return owners;
  }

  MeshData<D> mesh_of(const Stack<D>& stack)
  {
    check_cells<D>(cells_of(stack), fmt::format("size {} m", *mesh_.size), mesh_);
    Columns<D> columns = fill_columns(stack);
    MeshData<D> data;
    data.nodes = std::move(columns.nodes);
    data.cells = std::move(columns.cells);
    for (Index c = 0; c < static_cast<Index>(data.cells.size()); ++c)
      data.cell_sets[group_name(columns.group[c])].push_back(c);
    name_fronts(columns, data);
    name_sides(columns, data);
    if (input_.on_map)
      data.map = input_.frame;
    judge(data);
    data.notes = std::move(input_.notes);
    return data;
  }

  std::string group_name(Index group) const { return group == air_group() ? "air" : "layer:" + spec_.layers[group].name; }
  /// Whether a slab is a layer, or lies below everything.
  bool is_below_ground(Index slab) const { return slab == none || slab < static_cast<Index>(n_layers_); }
  bool is_above_ground(Index slab) const { return slab == none || slab >= static_cast<Index>(n_layers_); }
  bool is_obstacle(Index slab, Index plan_cell) const
  {
    return slab != none && slab == shelf_slab() && obstacle_of_cell_[plan_cell] != none;
  }

  void name_fronts(const Columns<D>& columns, MeshData<D>& data) const
  {
    for (const auto& front : columns.fronts) {
      const auto add = [&](const std::string& name) { data.facet_sets[name].push_back(front.nodes); };
      if (is_obstacle(front.slab_below, front.plan_cell) || is_obstacle(front.slab_above, front.plan_cell)) {
        add("obstacle:" + spec_.obstacles[obstacle_of_cell_[front.plan_cell]].name);
        continue;
      }
      if (front.group_below == none)
        add("base");
      if (is_below_ground(front.slab_below) && is_above_ground(front.slab_above))
        add("terrain");
      if (front.group_below == air_group())
        add("top");
      if (front.group_above != none && front.group_above != air_group())
        add(group_name(front.group_above) + ":bottom");
    }
  }

  void name_sides(const Columns<D>& columns, MeshData<D>& data) const
  {
    for (const auto& side : columns.sides)
      if (side.plan_cell != none && is_obstacle(side.slab, side.plan_cell))
        data.facet_sets["obstacle:" + spec_.obstacles[obstacle_of_cell_[side.plan_cell]].name].push_back(side.nodes);
      else
        data.facet_sets["sides"].push_back(side.nodes);
  }

  /// Adds a note about nearly flat cells.
  void judge(const MeshData<D>& data)
  {
    constexpr Real poor = 0.02;  // mean ratio of cells that are about ten times as long as thick
    Index count = 0;
    Real worst = 1;
    Vec<D> where = Vec<D>::Zero();
    for (const auto& cell : data.cells) {
      Simplex<D> s;
      for (int a = 0; a <= D; ++a)
        s[a] = data.nodes[cell[a]];
      const Real ratio = mean_ratio<D>(s);
      count += ratio < poor ? 1 : 0;
      if (ratio < worst)
        worst = ratio, where = centroid<D>(s);
    }
    if (count > 0)
      input_.notes.push_back(fmt::format(
          "{}: {} of {} cells are nearly flat (mean ratio below {}), the worst, {:.2g}, at {}: ground that is steep, or outlines "
          "close together, for cells of this size",
          to_string(spec_.where), count, data.cells.size(), poor, worst,
          in_words(on_map<D>(input_.frame, Vec<D - 1>(where.template head<D - 1>())))));
  }

  const MeshSpec& mesh_;
  const TerrainSpec& spec_;
  TerrainInput input_;
  std::size_t n_layers_;
  PlanSizes sizes_{};
  SurveyedPlan<D> plan_{};
  TerrainLayers layers_;
  Marks has_air_;                        // by plan cell
  std::vector<Index> obstacle_of_cell_;  // by plan cell; `none` without an obstacle
  std::vector<SceneError> problems_;
};

}  // namespace

template <int D>
MeshData<D> make_terrain(const MeshSpec& spec, const std::filesystem::path& directory)
{
  return TerrainMaker<D>(spec, directory)();
}

template <int D>
std::string terrain_in_words(const Mesh<D>& mesh, std::string_view margin)
{
  std::string text;
  if (mesh.map()) {
    const MapFrame& frame = *mesh.map();
    const auto& low = mesh.low();
    const auto& high = mesh.high();
    const MapPlace from = D == 2 ? frame.to_map(low[0]) : frame.to_map(low[0], low[1]);
    const MapPlace to = D == 2 ? frame.to_map(high[0]) : frame.to_map(high[0], high[1]);
    text += fmt::format("{}on the map from {} to {}{}{}, heights {:.6g} to {:.6g} m\n", margin, in_words(from), in_words(to),
                        frame.crs.empty() ? "" : ", ", frame.crs.substr(0, 60), low[D - 1], high[D - 1]);
  }
  for (const std::string& name : mesh.cell_set_names()) {
    if (!name.starts_with("layer:"))
      continue;
    const auto cells = *mesh.cell_set(name);
    const Real volume = std::accumulate(cells.begin(), cells.end(), Real{0}, [&](Real sum, Index c) { return sum + mesh.volume(c); });
    text += fmt::format("{}{}: {:.4g} {} in {} cells\n", margin, name, volume, D == 2 ? "m2" : "m3", cells.size());
  }
  return text;
}

template MeshData<2> make_terrain<2>(const MeshSpec&, const std::filesystem::path&);
template MeshData<3> make_terrain<3>(const MeshSpec&, const std::filesystem::path&);
template std::string terrain_in_words<2>(const Mesh<2>&, std::string_view);
template std::string terrain_in_words<3>(const Mesh<3>&, std::string_view);

}  // namespace talus
