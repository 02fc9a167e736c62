#include "io/terrain_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "io/cell_count.hpp"
#include "io/terrain_input.hpp"
#include "io/terrain_plan.hpp"
#include "mesh/quality.hpp"

namespace talus {

namespace {

constexpr Real infinity = std::numeric_limits<Real>::infinity();
constexpr Real thinnest = 0.25;  // of a cell: thinner ones would cost short steps, and hold little

/// Areas in the plan of a scene in 3-D, lengths in 2-D.
template <int D>
constexpr std::string_view extent_unit = D == 2 ? "m" : "m2";
template <int D>
constexpr std::string_view volume_unit = D == 2 ? "m2" : "m3";

std::string in_words(const Place& place) { return fmt::format("({:.10g}, {:.10g})", place[0], place[1]); }

template <int D>
Real extent(const Plan<D>& plan, Index c)
{
  const auto& n = plan.cells[c];
  if constexpr (D == 2) {
    return std::abs(plan.nodes[n[1]][0] - plan.nodes[n[0]][0]);
  } else {
    const Vec<2> a = plan.nodes[n[1]] - plan.nodes[n[0]], b = plan.nodes[n[2]] - plan.nodes[n[0]];
    return std::abs(a[0] * b[1] - a[1] * b[0]) / 2;
  }
}

/// From where to where something goes along x, or east and north.
template <int D>
std::string span_in_words(const std::pair<Place, Place>& bounds)
{
  const auto& [low, high] = bounds;
  return D == 2 ? fmt::format("{:.10g} to {:.10g}", low[0], high[0])
                : fmt::format("{:.10g} to {:.10g} east, {:.10g} to {:.10g} north", low[0], high[0], low[1], high[1]);
}

/// One layer after the other from the ground down; what gives way is counted.
struct Count {
  Real extent = 0, largest = 0, volume = 0;
  Index columns = 0;
  void add(Real share, Real thickness) { ++columns, extent += share, volume += share * thickness, largest = std::max(largest, thickness); }
};

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
      sizes_.strips.push_back({finer.along.empty() ? steepest_descent(finer) : line_of(finer), finer.width, finer.size});
    throw_if_any();
    plan_ = make_plan<D>(input_, sizes_, mesh_.where);
    if (plan_.cells.empty())
      complain(spec_.where, "the domain holds no cell");
    throw_if_any();
    measure_plan();
    ground();
    throw_if_any();
    layers();
    throw_if_any();
    air();
    obstacles();
    throw_if_any();
    return mesh_of(stack());
  }

 private:
  void complain(const Where& where, std::string message) { problems_.push_back({where, std::move(message), {}}); }
  void note(std::string message) { input_.notes.push_back(fmt::format("{}: {}", to_string(spec_.where), message)); }
  void throw_if_any()
  {
    if (!problems_.empty())
      throw SceneErrors(std::move(problems_));
  }

  /// Before anything is made: the plan alone may be more than there is room for.
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

  Line line_of(const FinerSpec& finer)
  {
    Line line;
    for (const auto& place : finer.along)
      line.push_back({place[0], place.size() > 1 ? place[1] : 0});
    if (input_.on_map && std::any_of(finer.along.begin(), finer.along.end(), [](const auto& place) { return place.size() != 2; }))
      complain(finer.where, "every point of along has two numbers, [east, north]");
    return line;
  }

  Place place_of(Index node) const { return on_map<D>(input_.frame, plan_.nodes[node]); }

  void measure_plan()
  {
    extent_.assign(plan_.cells.size(), 0);
    extent_of_node_.assign(plan_.nodes.size(), 0);
    for (Index c = 0; c < static_cast<Index>(plan_.cells.size()); ++c) {
      extent_[c] = extent<D>(plan_, c);
      for (const Index n : plan_.cells[c])
        extent_of_node_[n] += extent_[c] / D;
    }
  }

  /// Plan cells whose centre lies in an area.
  std::vector<std::uint8_t> cells_in(const Area& area) const
  {
    std::vector<std::uint8_t> inside(plan_.cells.size(), 0);
    for (std::size_t c = 0; c < inside.size(); ++c) {
      Vec<D - 1> centre = Vec<D - 1>::Zero();
      for (const Index n : plan_.cells[c])
        centre += plan_.nodes[n] / D;
      inside[c] = area.contains(on_map<D>(input_.frame, centre)) ? 1 : 0;
    }
    return inside;
  }
  std::vector<std::uint8_t> nodes_of(const std::vector<std::uint8_t>& cells) const
  {
    std::vector<std::uint8_t> nodes(plan_.nodes.size(), 0);
    for (std::size_t c = 0; c < cells.size(); ++c)
      for (const Index n : plan_.cells[c])
        nodes[n] |= cells[c];
    return nodes;
  }
  bool holds_none(const std::vector<std::uint8_t>& cells) const { return std::find(cells.begin(), cells.end(), 1) == cells.end(); }

  std::string domain_in_words() const
  {
    if (D == 2)
      return span_in_words<2>({input_.frame.to_map(input_.from), input_.frame.to_map(input_.to)});
    return span_in_words<3>(bounds_of(input_.domain));
  }

  void ground()
  {
    ground_.resize(plan_.nodes.size());
    Index unknown = 0;
    Place first{};
    for (Index n = 0; n < static_cast<Index>(ground_.size()); ++n) {
      ground_[n] = input_.ground(place_of(n));
      if (std::isfinite(ground_[n]))
        continue;
      if (unknown++ == 0)
        first = place_of(n);
    }
    if (unknown > 0)
      complain(spec_.ground.where,
               fmt::format(
                   "the ground is not known at {} of {} places, the first at {}; what is meshed goes from {}: make the domain smaller or "
                   "the ground larger",
                   unknown, ground_.size(), in_words(first), domain_in_words()));
  }

  Real height_of_cells(const std::optional<Real>& own, Index node) const
  {
    return own.value_or(sizes_.size) * sizes_(place_of(node)) / sizes_.size;
  }

  void layers()
  {
    std::vector<Real> above = ground_;
    for (std::size_t l = 0; l < n_layers_; ++l) {
      const LayerSpec& layer = spec_.layers[l];
      inside_.push_back(input_.within[l] ? cells_in(*input_.within[l]) : std::vector<std::uint8_t>(plan_.cells.size(), 1));
      if (holds_none(inside_.back())) {
        complain(layer.where, fmt::format("within: no part of it lies in what is meshed, {}", domain_in_words()));
        continue;
      }
      above = bottom_below(above, l);
      bottoms_.push_back(above);
    }
  }

  std::vector<Real> bottom_below(const std::vector<Real>& above, std::size_t l)
  {
    const LayerSpec& layer = spec_.layers[l];
    const std::vector<std::uint8_t> own = nodes_of(inside_[l]);
    Count unknown, crossed, closed, kept;
    std::vector<Real> bottom = above;
    for (Index n = 0; n < static_cast<Index>(bottom.size()); ++n) {
      const Real here = input_.bottoms[l](place_of(n)), thickness = above[n] - here;
      const Real share = own[n] != 0 ? extent_of_node_[n] : 0;
      const Real least = thinnest * height_of_cells(layer.size, n);
      if (share == 0) {
        bottom[n] = thickness >= least ? here : above[n];
        continue;
      }
      constexpr Real touching = 1e-3;  // of a cell: surfaces that are meant to meet
      if (std::isnan(here))
        unknown.add(share, 0);
      else if (thickness < -touching * least)
        crossed.add(share, -thickness);
      else if (thickness < least && thickness > touching * least)
        closed.add(share, thickness);
      else if (thickness >= least)
        kept.add(share, thickness), bottom[n] = here;
    }
    report(layer, l, unknown, crossed, closed, kept);
    return bottom;
  }

  void report(const LayerSpec& layer, std::size_t l, const Count& unknown, const Count& crossed, const Count& closed, const Count& kept)
  {
    const std::string upper = l == 0 ? "the ground" : fmt::format("the bottom of layer \"{}\"", spec_.layers[l - 1].name);
    if (kept.columns == 0) {
      std::string why;
      const auto add = [&](const Count& count, const std::string& what) {
        if (count.columns > 0)
          why += fmt::format("{}{} over {:.4g} {}", why.empty() ? "" : ", ", what, count.extent, extent_unit<D>);
      };
      add(unknown, "not known");
      add(crossed, fmt::format("above {} (by {:.4g} m at most)", upper, crossed.largest));
      add(closed, fmt::format("less than a quarter of a cell below {} ({:.4g} m at most)", upper, closed.largest));
      return complain(layer.bottom.where, fmt::format("layer \"{}\" has no thickness anywhere in what is meshed, {}: its bottom is {}",
                                                      layer.name, domain_in_words(), why.empty() ? "on " + upper : why));
    }
    if (unknown.columns > 0)
      note(fmt::format("layer \"{}\" has no thickness where its bottom is not known, over {:.4g} {} of the plan", layer.name,
                       unknown.extent, extent_unit<D>));
    if (crossed.columns > 0)
      note(fmt::format("layer \"{}\" has no thickness where its bottom lies above {}, over {:.4g} {} of the plan, by {:.4g} m at most",
                       layer.name, upper, crossed.extent, extent_unit<D>, crossed.largest));
    if (closed.columns > 0)
      note(fmt::format(
          "layer \"{}\" was closed where it is thinner than a quarter of a cell: {} columns, {:.4g} m at most, {:.3g} {} or {:.2g} % "
          "of its volume",
          layer.name, closed.columns, closed.largest, closed.volume, volume_unit<D>, 100 * closed.volume / (closed.volume + kept.volume)));
  }

  /// Thickness of layer l over a plan node.
  Real thickness(std::size_t l, Index n) const { return (l == 0 ? ground_[n] : bottoms_[l - 1][n]) - bottoms_[l][n]; }

  std::size_t layer_named(const std::string& name) const
  {
    const auto found = std::find_if(spec_.layers.begin(), spec_.layers.end(), [&](const LayerSpec& layer) { return layer.name == name; });
    return found == spec_.layers.end() ? 0 : static_cast<std::size_t>(found - spec_.layers.begin());
  }

  /// Plan cells with air above the ground: all, or those that a line falling from the layer reaches.
  void air()
  {
    has_air_.assign(plan_.cells.size(), spec_.air ? 1 : 0);
    if (!spec_.air || !spec_.air->reach)
      return;
    const Real fall = std::tan(*spec_.air->reach * std::numbers::pi / 180);
    const std::size_t l = layer_named(spec_.air->of);
    struct Source {
      Place place;
      Real height;
    };
    std::vector<Source> sources, highest;
    const auto own = nodes_of(inside_[l]);
    for (Index n = 0; n < static_cast<Index>(plan_.nodes.size()); ++n)
      if (own[n] != 0 && thickness(l, n) > 0)
        sources.push_back({place_of(n), ground_[n]});
    std::sort(sources.begin(), sources.end(), [](const Source& a, const Source& b) { return a.height > b.height; });
    const auto line_over = [&](const Place& place) {
      Real best = -infinity;
      for (const Source& source : highest)
        best = std::max(best, source.height - fall * std::hypot(place[0] - source.place[0], place[1] - source.place[1]));
      return best;
    };
    for (const Source& source : sources)
      if (line_over(source.place) < source.height)  // no other line passes above its own
        highest.push_back(source);
    std::vector<std::uint8_t> reached(plan_.nodes.size());
    for (Index n = 0; n < static_cast<Index>(reached.size()); ++n)
      reached[n] = line_over(place_of(n)) >= ground_[n] || (own[n] != 0 && thickness(l, n) > 0) ? 1 : 0;
    for (std::size_t c = 0; c < has_air_.size(); ++c)
      has_air_[c] = std::any_of(plan_.cells[c].begin(), plan_.cells[c].end(), [&](Index n) { return reached[n] != 0; }) ? 1 : 0;
  }

  void obstacles()
  {
    obstacle_of_cell_.assign(plan_.cells.size(), none);
    for (std::size_t o = 0; o < spec_.obstacles.size(); ++o) {
      const ObstacleSpec& obstacle = spec_.obstacles[o];
      const auto inside = cells_in(input_.obstacles[o]);
      if (holds_none(inside)) {
        complain(obstacle.where, fmt::format("obstacle \"{}\" lies outside what is meshed, {}", obstacle.name, domain_in_words()));
        continue;
      }
      bool in_air = false;
      for (std::size_t c = 0; c < inside.size(); ++c) {
        if (inside[c] == 0)
          continue;
        in_air = in_air || has_air_[c] != 0;
        if (obstacle_of_cell_[c] != none) {
          complain(obstacle.where,
                   fmt::format("obstacle \"{}\" overlaps \"{}\"", obstacle.name, spec_.obstacles[obstacle_of_cell_[c]].name));
          break;
        }
        obstacle_of_cell_[c] = static_cast<Index>(o);
      }
      if (!in_air)
        complain(obstacle.where,
                 fmt::format("obstacle \"{}\" stands where there is no air: the line of air.reach, {:.4g} degrees, does not "
                             "come so far",
                             obstacle.name, spec_.air->reach.value_or(0)));
    }
    for (std::size_t c = 0; c < has_air_.size(); ++c)  // over the whole of each
      if (obstacle_of_cell_[c] != none)
        has_air_[c] = 1;
  }

  /// How high the obstacles are: over their own plan cells, and in between by their distances, so that the cells beside them fit.
  std::vector<Real> shelf() const
  {
    std::vector<Real> height(plan_.nodes.size(), 0);
    for (std::size_t c = 0; c < plan_.cells.size(); ++c)
      if (obstacle_of_cell_[c] != none)
        for (const Index n : plan_.cells[c])
          height[n] = std::max(height[n], spec_.obstacles[obstacle_of_cell_[c]].height);
    for (Index n = 0; n < static_cast<Index>(height.size()); ++n) {
      if (height[n] > 0)
        continue;
      Real sum = 0, weights = 0;
      for (std::size_t o = 0; o < input_.obstacles.size(); ++o) {
        Real nearest = infinity;
        for (const Line& ring : input_.obstacles[o].rings)
          nearest = std::min(nearest, distance(ring, place_of(n)));
        const Real weight = 1 / (nearest * nearest + 1e-6);
        sum += weight * spec_.obstacles[o].height;
        weights += weight;
      }
      height[n] = sum / weights;
    }
    return height;
  }

  // Slabs from the bottom up: the layers, the shelf of the obstacles if there are any, the air.  Groups: the layers, then air.
  Index air_group() const { return static_cast<Index>(n_layers_); }
  Index shelf_slab() const { return spec_.obstacles.empty() ? none : static_cast<Index>(n_layers_); }

  Stack<D> stack() const
  {
    Stack<D> stack{plan_, n_layers_ > 0 ? bottoms_.back() : ground_, {}};
    for (std::size_t l = n_layers_; l-- > 0;) {
      Slab& slab = stack.slabs.emplace_back();
      slab.top = l == 0 ? ground_ : bottoms_[l - 1];
      for (std::size_t c = 0; c < plan_.cells.size(); ++c) {
        std::size_t owner = l;
        while (owner < n_layers_ && inside_[owner][c] == 0)
          ++owner;
        slab.group.push_back(owner < n_layers_ ? static_cast<Index>(owner) : none);
      }
      add_heights(spec_.layers[l].size, slab);
    }
    if (!spec_.air)
      return stack;
    const auto aired = nodes_of(has_air_);
    const std::vector<Real> shelf_height = spec_.obstacles.empty() ? std::vector<Real>{} : shelf();
    if (!shelf_height.empty()) {
      Slab& slab = stack.slabs.emplace_back();
      for (std::size_t n = 0; n < ground_.size(); ++n)
        slab.top.push_back(ground_[n] + aired[n] * shelf_height[n]);
      for (std::size_t c = 0; c < plan_.cells.size(); ++c)
        slab.group.push_back(has_air_[c] != 0 && obstacle_of_cell_[c] == none ? air_group() : none);
      add_heights(spec_.air->size, slab);
    }
    Slab& slab = stack.slabs.emplace_back();
    for (Index n = 0; n < static_cast<Index>(ground_.size()); ++n) {
      const Real top = ground_[n] + aired[n] * spec_.air->height;
      // What is left above an obstacle as high as the air, or nearly, is closed.
      const bool thin = !shelf_height.empty() && spec_.air->height - shelf_height[n] < thinnest * height_of_cells(spec_.air->size, n);
      slab.top.push_back(thin ? stack.slabs[n_layers_].top[n] : top);
    }
    for (std::size_t c = 0; c < plan_.cells.size(); ++c)
      slab.group.push_back(has_air_[c] != 0 ? air_group() : none);
    add_heights(spec_.air->size, slab);
    return stack;
  }

  void add_heights(const std::optional<Real>& own, Slab& slab) const
  {
    for (Index n = 0; n < static_cast<Index>(plan_.nodes.size()); ++n)
      slab.height.push_back(height_of_cells(own, n));
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
  /// Slab of a layer, or beneath everything.
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

  /// Cells that are nearly flat are told.
  void judge(const MeshData<D>& data)
  {
    constexpr Real poor = 0.02;  // mean ratio: some ten times as long as thick
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
      note(fmt::format(
          "{} of {} cells are nearly flat (mean ratio below {}), the worst, {:.2g}, at {}: steep ground or areas with sides close "
          "together; see talus mesh",
          count, data.cells.size(), poor, worst, in_words(on_map<D>(input_.frame, Vec<D - 1>(where.template head<D - 1>())))));
  }

  // --- the line of steepest descent

  /// From the centre of a layer's thickness down over the ground, until no place around is lower.
  Line steepest_descent(const FinerSpec& finer)
  {
    const std::size_t l = layer_named(finer.down_from);
    const auto start = centre_of(l);
    if (!start) {
      complain(finer.where, fmt::format("down_from: layer \"{}\" has no thickness", finer.down_from));
      return {};
    }
    Line line{*start};
    const Real stride = 2 * sizes_.size;
    while (const auto next = lower_place(line.back(), stride))
      line.push_back(*next);
    return line;
  }

  bool is_in_domain(const Place& place) const
  {
    if constexpr (D == 3)
      return input_.domain.contains(place);
    const Real x =
        (place[0] - input_.frame.origin[0]) * input_.frame.along[0] + (place[1] - input_.frame.origin[1]) * input_.frame.along[1];
    return x >= input_.from && x <= input_.to;
  }

  /// The lowest place on the smallest circle around that has one lower than its centre; larger circles lead over small pits.
  std::optional<Place> lower_place(const Place& from, Real stride) const
  {
    constexpr int directions = D == 3 ? 36 : 2;
    constexpr Real widest = 8;  // strides
    for (Real radius = stride; radius <= widest * stride; radius *= 2) {
      std::optional<Place> best;
      Real lowest = input_.ground(from);
      for (int i = 0; i < directions; ++i) {
        const Real angle = 2 * std::numbers::pi * i / directions;
        const auto& along = input_.frame.along;
        const Place place{from[0] + radius * (std::cos(angle) * along[0] - std::sin(angle) * along[1]),
                          from[1] + radius * (std::cos(angle) * along[1] + std::sin(angle) * along[0])};
        const Real height = is_in_domain(place) ? input_.ground(place) : infinity;
        if (height < lowest)
          lowest = height, best = place;
      }
      if (best)
        return best;
    }
    return std::nullopt;
  }

  /// Of the thickness of a layer, sampled.
  std::optional<Place> centre_of(std::size_t l) const
  {
    constexpr Index samples = 200;  // along each axis
    Real total = 0;
    Place sum{};
    const auto [low, high] = D == 2 ? std::pair<Place, Place>{{input_.from, 0}, {input_.to, 0}} : bounds_of(input_.domain);
    for (Index j = 0; j < (D == 2 ? 1 : samples); ++j)
      for (Index i = 0; i < samples; ++i) {
        const Real x = low[0] + (high[0] - low[0]) * (i + 0.5) / samples, y = low[1] + (high[1] - low[1]) * (j + 0.5) / samples;
        const Place place = D == 2 ? input_.frame.to_map(x) : Place{x, y};
        if (!is_in_domain(place) || (input_.within[l] && !input_.within[l]->contains(place)))
          continue;
        Real above = input_.ground(place);
        for (std::size_t k = 0; k < l; ++k)
          if (const Real bottom = input_.bottoms[k](place); bottom < above)
            above = bottom;
        if (const Real thick = above - input_.bottoms[l](place); thick > 0) {
          total += thick;
          sum[0] += thick * place[0], sum[1] += thick * place[1];
        }
      }
    if (total == 0)
      return std::nullopt;
    return Place{sum[0] / total, sum[1] / total};
  }

  const MeshSpec& mesh_;
  const TerrainSpec& spec_;
  TerrainInput input_;
  std::size_t n_layers_;
  PlanSizes sizes_{};
  Plan<D> plan_;
  std::vector<Real> extent_, extent_of_node_;      // of plan cells, around plan nodes
  std::vector<Real> ground_;                       // by plan node
  std::vector<std::vector<std::uint8_t>> inside_;  // by layer and plan cell
  std::vector<std::vector<Real>> bottoms_;         // by layer and plan node, after all repairs
  std::vector<std::uint8_t> has_air_;              // by plan cell
  std::vector<Index> obstacle_of_cell_;            // by plan cell
  std::vector<Problem> problems_;
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
    const Place from = D == 2 ? frame.to_map(low[0]) : frame.to_map(low[0], low[1]);
    const Place to = D == 2 ? frame.to_map(high[0]) : frame.to_map(high[0], high[1]);
    text += fmt::format("{}on the map from {} to {}{}{}, heights {:.6g} to {:.6g} m\n", margin, in_words(from), in_words(to),
                        frame.crs.empty() ? "" : ", ", frame.crs.substr(0, 60), low[D - 1], high[D - 1]);
  }
  for (const std::string& name : mesh.cell_set_names()) {
    if (!name.starts_with("layer:"))
      continue;
    const auto cells = *mesh.cell_set(name);
    const Real volume = std::accumulate(cells.begin(), cells.end(), Real{0}, [&](Real sum, Index c) { return sum + mesh.volume(c); });
    text += fmt::format("{}{}: {:.4g} {} in {} cells\n", margin, name, volume, volume_unit<D>, cells.size());
  }
  return text;
}

template MeshData<2> make_terrain<2>(const MeshSpec&, const std::filesystem::path&);
template MeshData<3> make_terrain<3>(const MeshSpec&, const std::filesystem::path&);
template std::string terrain_in_words<2>(const Mesh<2>&, std::string_view);
template std::string terrain_in_words<3>(const Mesh<3>&, std::string_view);

}  // namespace talus
