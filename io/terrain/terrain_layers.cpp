#include "io/terrain/terrain_layers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace talus {

namespace {

/// Sums over columns, for messages.
struct ColumnSums {
  Index columns = 0;
  Real extent = 0;   ///< plan area of the columns, in 2-D length [m^(D-1)]
  Real volume = 0;   ///< volume [m^D]
  Real largest = 0;  ///< largest thickness [m]
  void add(Real around, Real thickness)
  {
    ++columns, extent += around, volume += around * thickness, largest = std::max(largest, thickness);
  }
};

/// The treatment of the columns of a layer.
struct LayerCells {
  ColumnSums filled, blank, crossed, closed;  ///< blank: bottom unknown; crossed: bottom above the surface over it; closed: too thin
};

/// The bottom of layer l below a surface, and the treatment of its columns.
template <int D>
std::pair<std::vector<Real>, LayerCells> bottom_below(const std::vector<Real>& above, const Surface& wanted, const LayerSpec& layer,
                                                      const SurveyedPlan<D>& plan, const Marks& own)
{
  LayerCells fates;
  std::vector<Real> bottom = above;
  for (Index n = 0; n < plan.n_nodes(); ++n) {
    const Real here = wanted(plan.place[n]), thickness = above[n] - here;
    const Real cell = plan.height_of_cells(layer.size, n);
    constexpr Real touching = 1e-3;  // relative to a cell: surfaces that are meant to meet
    const bool is_kept = thickness >= thinnest * cell;
    if (is_kept)
      bottom[n] = here;
    ColumnSums* const fate = is_kept                        ? &fates.filled
                             : std::isnan(here)             ? &fates.blank
                             : thickness < -touching * cell ? &fates.crossed
                             : thickness > touching * cell  ? &fates.closed
                                                            : nullptr;
    if (own[n] != 0 && fate != nullptr)
      fate->add(plan.extent[n], std::isnan(here) ? 0 : std::abs(thickness));
  }
  return {std::move(bottom), fates};
}

/// The reason why nothing is left of a layer.
std::string in_words(const LayerCells& fates, const std::string& upper, std::string_view unit)
{
  std::string text;
  const auto add = [&](const ColumnSums& sums, const std::string& what) {
    if (sums.columns > 0)
      text += fmt::format("{}{} over {:.4g} {}", text.empty() ? "" : ", ", what, sums.extent, unit);
  };
  add(fates.blank, "not known");
  add(fates.crossed, fmt::format("above {} (by {:.4g} m at most)", upper, fates.crossed.largest));
  add(fates.closed, fmt::format("less than a quarter of a cell below {} ({:.4g} m at most)", upper, fates.closed.largest));
  return text.empty() ? "on " + upper : text;
}

template <int D>
void tell(const LayerSpec& layer, const LayerCells& fates, const std::string& upper, std::vector<std::string>& notes)
{
  constexpr std::string_view of_plan = D == 2 ? "m" : "m2", of_layer = D == 2 ? "m2" : "m3";
  const auto note = [&](const std::string& what) {
    notes.push_back(fmt::format("{}: layer \"{}\" {}", to_string(layer.where), layer.name, what));
  };
  const auto& [filled, blank, crossed, closed] = fates;
  if (blank.columns > 0)
    note(fmt::format("has no thickness where its bottom is not known, over {:.4g} {} of the plan", blank.extent, of_plan));
  if (crossed.columns > 0)
    note(fmt::format("has no thickness where its bottom lies above {}, over {:.4g} {} of the plan, by {:.4g} m at most", upper,
                     crossed.extent, of_plan, crossed.largest));
  if (closed.columns > 0)
    note(fmt::format(
        "was closed where it is thinner than a quarter of a cell: {} columns, {:.4g} m at most, {:.3g} {} or {:.2g} % of its volume",
        closed.columns, closed.largest, closed.volume, of_layer, 100 * closed.volume / (closed.volume + filled.volume)));
}

}  // namespace

template <int D>
TerrainLayers lay(const TerrainSpec& spec, const SurveyedPlan<D>& plan, TerrainInput& input, std::vector<SceneError>& problems)
{
  TerrainLayers layers;
  std::vector<Real> above = plan.ground;
  std::string upper = "the ground";
  for (std::size_t l = 0; l < spec.layers.size(); ++l) {
    const LayerSpec& layer = spec.layers[l];
    const auto complain = [&](const SourceLocation& where, std::string what) {
      problems.push_back({where, fmt::format("layer \"{}\" {}", layer.name, what), {}});
    };
    layers.inside.push_back(input.within[l] ? cells_in(*input.within[l], plan) : Marks(plan.n_cells(), 1));
    const Marks own = plan.nodes_of(layers.inside.back());
    auto [bottom, fates] = bottom_below(above, input.bottoms[l], layer, plan, own);
    if (std::find(own.begin(), own.end(), 1) == own.end())
      complain(layer.where, fmt::format("has no part within what is meshed, {}", domain_in_words(input)));
    else if (fates.filled.columns == 0)
      complain(layer.bottom.where, fmt::format("has no thickness anywhere in what is meshed, {}: its bottom is {}", domain_in_words(input),
                                               in_words(fates, upper, D == 2 ? "m" : "m2")));
    else
      tell<D>(layer, fates, upper, input.notes);
    above = bottom;
    layers.bottoms.push_back(std::move(bottom));
    upper = fmt::format("the bottom of layer \"{}\"", layer.name);
  }
  return layers;
}

std::string domain_in_words(const TerrainInput& input)
{
  if (input.is_line && !input.on_map)
    return fmt::format("x = {:.10g} to {:.10g}", input.frame.to_map(input.from)[0], input.frame.to_map(input.to)[0]);
  if (input.is_line) {
    const MapPlace from = input.frame.to_map(input.from), to = input.frame.to_map(input.to);
    return fmt::format("the line from ({:.10g}, {:.10g}) to ({:.10g}, {:.10g})", from[0], from[1], to[0], to[1]);
  }
  const auto [low, high] = bounds_of(input.domain);
  return fmt::format("{:.10g} to {:.10g} east, {:.10g} to {:.10g} north", low[0], high[0], low[1], high[1]);
}

template TerrainLayers lay<2>(const TerrainSpec&, const SurveyedPlan<2>&, TerrainInput&, std::vector<SceneError>&);
template TerrainLayers lay<3>(const TerrainSpec&, const SurveyedPlan<3>&, TerrainInput&, std::vector<SceneError>&);

}  // namespace talus
