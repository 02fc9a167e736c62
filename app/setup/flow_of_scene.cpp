#include "app/setup/flow_of_scene.hpp"

#include <fmt/format.h>

#include "app/setup/setup.hpp"

namespace talus {

namespace {

/// The table with all values multiplied.
Table scaled(Real factor, const Table& table)
{
  if (table.points.empty())
    return {{{0, factor}}};
  Table all = table;
  for (auto& [time, value] : all.points)
    value *= factor;
  return all;
}

/// The facets of a group, if there is one.
template <int D>
std::optional<std::vector<Facet>> facets_of(const Mesh<D>& mesh, const CellOccupancy<D>& at_start, const SourceLocation& where,
                                            std::string_view key, const std::string& group, SceneErrorCollector& errors)
{
  const auto found = mesh.facet_set(group);
  if (found)
    return at_start.orient_facets(*found);
  errors.unknown_group(where, key, "facet", group, mesh.facet_set_names());
  return std::nullopt;
}

template <int D>
std::vector<Index> nodes_of(const Mesh<D>& mesh, std::span<const Facet> facets)
{
  std::vector<Index> nodes;
  for (const Facet facet : facets)
    for (const Index n : mesh.nodes_of(facet))
      nodes.push_back(n);
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());  // std::ranges::unique of this library is not for clang
  return nodes;
}

}  // namespace

template <int D>
Flow flow_of(const Scene& scene, const Mesh<D>& mesh, const CellOccupancy<D>& at_start, const std::vector<Body>& bodies,
             SceneErrorCollector& errors, std::vector<std::string>& warnings)
{
  Flow flow;
  if (!scene.water || !scene.water->flow)
    return flow;
  const FlowSpec& spec = *scene.water->flow;
  flow.unit_weight = scene.water->unit_weight;
  flow.surface_drains = spec.surface == SurfaceFlow::drained;
  flow.pace = spec.pace;
  if (spec.rain)
    flow.rain = scaled(spec.rain->rate, spec.rain->table);
  flow.bodies.resize(bodies.size());
  for (const PoresSpec& pores : spec.bodies) {
    const auto body = std::ranges::find(bodies, pores.body, &Body::name);
    if (body == bodies.end())
      continue;  // the rules of the scene complain
    flow.bodies[static_cast<std::size_t>(body - bodies.begin())] = {.flows = true,
                                                                    .porosity = pores.porosity,
                                                                    .permeability = pores.permeability,
                                                                    .bulk_modulus = pores.bulk_modulus,
                                                                    .biot = pores.biot,
                                                                    .retention = {},
                                                                    .follows_pores = pores.kozeny_carman};
    if (pores.retention)
      flow.bodies[static_cast<std::size_t>(body - bodies.begin())].retention = {pores.retention->entry, pores.retention->exponent,
                                                                                pores.retention->residual};
    if (pores.permeability < least_permeability)
      warnings.push_back(
          fmt::format("{}: a permeability of {:.3g} m/s is that of no soil or rock: if it is an intrinsic permeability in "
                      "m^2, water has {:.3g} m/s there",
                      to_string(pores.where), pores.permeability, pores.permeability * 1e7));
  }
  for (std::size_t k = 0; k < spec.drained.size(); ++k)
    if (const auto facets = facets_of(mesh, at_start, spec.where, fmt::format("drained[{}]", k), spec.drained[k], errors))
      flow.heads.push_back({spec.drained[k], nodes_of(mesh, std::span<const Facet>(*facets)), true, {}});
  for (const HeadSpec& head : spec.heads)
    if (const auto facets = facets_of(mesh, at_start, head.where, "on", head.on, errors))
      flow.heads.push_back({head.on, nodes_of(mesh, std::span<const Facet>(*facets)), false, scaled(head.level, head.table)});
  for (const InflowSpec& inflow : spec.inflow)
    if (const auto facets = facets_of(mesh, at_start, inflow.where, "on", inflow.on, errors)) {
      const MeshTraction<D> shares = carried_by_mesh<D>(mesh, *facets);
      flow.inflows.push_back({inflow.on, shares.node, shares.measure, scaled(inflow.rate, inflow.table)});
    }
  if (flow.heads.empty() && !flow.surface_drains)
    warnings.push_back(
        fmt::format("{}: the water can leave nowhere: pressures stay where loads have made them (drained, heads, or a "
                    "surface that is drained)",
                    to_string(spec.where)));
  return flow;
}

template <int D>
std::vector<MeshTraction<D>> open_water_of(const Scene& scene, const Mesh<D>& mesh, const CellOccupancy<D>& at_start)
{
  std::vector<MeshTraction<D>> loads;
  const auto gravity = std::ranges::find_if(scene.loads, [](const LoadSpec& load) { return std::holds_alternative<GravitySpec>(load); });
  if (!scene.water || !scene.water->flow || gravity == scene.loads.end())  // without gravity water has no weight
    return loads;
  for (const HeadSpec& head : scene.water->flow->heads)
    if (const auto facets = mesh.facet_set(head.on)) {
      MeshTraction<D> load = carried_by_mesh<D>(mesh, at_start.orient_facets(*facets));
      load.where = head.where;
      load.unit_weight = scene.water->unit_weight;
      load.table = std::get<GravitySpec>(*gravity).table;  // as the pore pressure behind it
      load.level = scaled(head.level, head.table);
      for (const Index n : load.node)
        load.height.push_back(mesh.node(n)[D - 1]);
      loads.push_back(std::move(load));
    }
  return loads;
}

template std::vector<MeshTraction<2>> open_water_of(const Scene&, const Mesh<2>&, const CellOccupancy<2>&);
template std::vector<MeshTraction<3>> open_water_of(const Scene&, const Mesh<3>&, const CellOccupancy<3>&);
template Flow flow_of(const Scene&, const Mesh<2>&, const CellOccupancy<2>&, const std::vector<Body>&, SceneErrorCollector&,
                      std::vector<std::string>&);
template Flow flow_of(const Scene&, const Mesh<3>&, const CellOccupancy<3>&, const std::vector<Body>&, SceneErrorCollector&,
                      std::vector<std::string>&);

}  // namespace talus
