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

const GravitySpec* gravity_of(const Scene& scene)
{
  for (const LoadSpec& load : scene.loads)
    if (const auto* gravity = std::get_if<GravitySpec>(&load))
      return gravity;
  return nullptr;
}

/// Warns of material below the level of the pond on the upper side of the mesh, unless it has open water of its own there.
template <int D>
void warn_of_dry_boundary(const PondSpec& pond, const Flow& flow, const Mesh<D>& mesh, const CellOccupancy<D>& at_start,
                          std::vector<std::string>& warnings)
{
  const Real level = std::ranges::max(flow.pond->points, {}, [](const auto& point) { return point[1]; })[1];
  const auto is_dry = [&](Facet facet) {
    const auto nodes = mesh.nodes_of(facet);
    const auto has_head = [&](const HeadBoundary& head) {
      return !head.drained && std::ranges::all_of(nodes, [&](Index n) { return std::ranges::binary_search(head.nodes, n); });
    };
    return at_start(facet.cell) && mesh.area_vector(facet)[D - 1] > 0 && std::ranges::none_of(flow.heads, has_head) &&
           std::ranges::any_of(nodes, [&](Index n) { return mesh.node(n)[D - 1] < level; });
  };
  Real area = 0;
  for (const Facet facet : mesh.boundary_facets())
    area += is_dry(facet) ? mesh.area_vector(facet)[D - 1] : 0;
  if (area > 0)
    warnings.push_back(
        fmt::format("{}: {:.3g} {} of the ground below its level lie on the boundary of the mesh, where no pond stands: leave room for a "
                    "layer of cells "
                    "above the ground, or give water.flow.heads there",
                    to_string(pond.where), area, D == 2 ? "m" : "m^2"));
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
  if (spec.pond)
    flow.pond = scaled(spec.pond->level, spec.pond->table);
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
  if (spec.pond)
    warn_of_dry_boundary(*spec.pond, flow, mesh, at_start, warnings);
  if (spec.pond && !scene.water->table && !scene.initial)
    warnings.push_back(
        fmt::format("{}: without water.table the pore pressure below the pond begins at zero: give a table", to_string(spec.pond->where)));
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
  const GravitySpec* gravity = gravity_of(scene);
  if (!scene.water || !scene.water->flow || gravity == nullptr)  // without gravity water has no weight
    return loads;
  for (const HeadSpec& head : scene.water->flow->heads)
    if (const auto facets = mesh.facet_set(head.on)) {
      MeshTraction<D> load = carried_by_mesh<D>(mesh, at_start.orient_facets(*facets));
      load.where = head.where;
      load.unit_weight = scene.water->unit_weight;
      load.table = gravity->table;  // as the pore pressure behind it
      load.level = scaled(head.level, head.table);
      for (const Index n : load.node)
        load.height.push_back(mesh.node(n)[D - 1]);
      loads.push_back(std::move(load));
    }
  return loads;
}

template <int D>
std::vector<SurfaceLoad<D>> pond_of(const Scene& scene, const Flow& flow, const std::vector<Body>& bodies)
{
  std::vector<SurfaceLoad<D>> loads;
  const GravitySpec* gravity = gravity_of(scene);
  if (!flow.pond || gravity == nullptr)
    return loads;
  for (std::size_t body = 0; body < bodies.size(); ++body) {
    SurfaceLoad<D>& load = loads.emplace_back();
    load.body = static_cast<Index>(body);
    load.pressure = flow.unit_weight;
    load.water_level = flow.pond;
    load.table = gravity->table;  // as the pore pressure at the surface
    load.where = scene.water->flow->pond->where;
    load.is_closed = true;
    load.ends_at_walls = true;
  }
  return loads;
}

template std::vector<SurfaceLoad<2>> pond_of(const Scene&, const Flow&, const std::vector<Body>&);
template std::vector<SurfaceLoad<3>> pond_of(const Scene&, const Flow&, const std::vector<Body>&);
template std::vector<MeshTraction<2>> open_water_of(const Scene&, const Mesh<2>&, const CellOccupancy<2>&);
template std::vector<MeshTraction<3>> open_water_of(const Scene&, const Mesh<3>&, const CellOccupancy<3>&);
template Flow flow_of(const Scene&, const Mesh<2>&, const CellOccupancy<2>&, const std::vector<Body>&, SceneErrorCollector&,
                      std::vector<std::string>&);
template Flow flow_of(const Scene&, const Mesh<3>&, const CellOccupancy<3>&, const std::vector<Body>&, SceneErrorCollector&,
                      std::vector<std::string>&);

}  // namespace talus
