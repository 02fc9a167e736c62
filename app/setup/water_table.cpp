#include "app/setup/water_table.hpp"

#include <cmath>

#include "app/setup/setup.hpp"
#include "io/terrain/surface_file.hpp"
#include "mesh/ground.hpp"

namespace talus {

namespace {

/// A table may lie above so much of the plan of the ground and is cut there; where it lies above more, the scene is about a lake.
constexpr Real most_cut = 0.5;
/// Above the ground by less than this share of a piece of it, a table lies at the ground.
constexpr Real at_the_ground = 0.01;
/// Gravity may lean so far from the vertical (sine), as where the axes of a scene follow a slope.
constexpr Real steepest_axes = 0.87;

/// A table that is not given by its depth, over places on the map where there is one; none if something is wrong with it.
template <int D>
Surface surface_of(const Scene& scene, const SurfaceSpec& spec, const Mesh<D>& mesh, SceneErrorCollector& errors,
                   std::vector<std::string>& warnings)
{
  const bool on_map = D == 3 || (scene.mesh.terrain && scene.mesh.terrain->section);
  MapPlan plan{.directory = folder_of(scene), .crs = mesh.map() ? mesh.map()->crs : "", .is_line = !on_map, .ground = {}};
  std::vector<SceneError> problems;
  std::vector<std::string> repairs;
  std::optional<SurfaceRead> read;
  try {
    read = read_surface(spec, plan, problems, repairs);
  } catch (const EnvironmentError& e) {
    errors.add(spec.where, "file", e.what());
  }
  for (const SceneError& problem : problems)
    errors.add(problem.where, "", problem.message);
  for (const std::string& repair : repairs)
    warnings.push_back(fmt::format("{}: {}", to_string(spec.where), repair));
  return read ? read->at : Surface();
}

template <int D>
std::string in_words(const Vec<D>& x)
{
  return fmt::format("({:.6g})", fmt::join(x.begin(), x.end(), ", "));
}

/// How far a table lies above the ground.
template <int D>
struct WaterAboveGround {
  Real area = 0, flooded = 0;       ///< of the plan [m^(D-1)]
  Real least, most;                 ///< above the ground [m]; < 0 below it
  Vec<D> deepest = Vec<D>::Zero();  ///< where it is most
};

/// The level of the pond of a scene at the start [m]: where the ground lies below it, water does not end at the ground.
Real pond_at_start(const Scene& scene)
{
  const auto& flow = scene.water->flow;
  return flow && flow->pond ? flow->pond->level * flow->pond->table(0) : -std::numeric_limits<Real>::infinity();
}

template <int D, class Table_>
WaterAboveGround<D> flood_of(const Ground<D>& ground, Real pond, const Table_& table)
{
  constexpr Real none_yet = std::numeric_limits<Real>::infinity();
  WaterAboveGround<D> flood{.least = none_yet, .most = -none_yet};
  for (const auto& piece : ground.pieces()) {
    Vec<D> middle = Vec<D>::Zero();
    for (const Vec<D>& corner : piece.corners)
      middle += corner / D;
    const Real above = table(middle) - std::max(middle[D - 1], pond);
    if (std::isnan(above))
      continue;  // found at the nodes too
    flood.area += piece.area;
    if (above > at_the_ground * (piece.corners[1] - piece.corners[0]).norm())
      flood.flooded += piece.area;
    flood.least = std::min(flood.least, above);
    if (above > flood.most)
      flood.most = above, flood.deepest = middle;
  }
  return flood;
}

/// Complains, or warns, of a table above the ground.
template <int D>
void judge(const WaterAboveGround<D>& flood, const SourceLocation& where, SceneErrorCollector& errors, std::vector<std::string>& warnings)
{
  if (flood.flooded == 0)
    return;
  const Real share = flood.flooded / flood.area;
  const char* unit = D == 2 ? "m" : "m^2";
  const std::string found =
      fmt::format("the water table lies above the ground over {:.3g} {} of {:.3g} {} of its plan, by up to {:.3g} m at {}", flood.flooded,
                  unit, flood.area, unit, flood.most, in_words<D>(flood.deepest));
  if (share > most_cut)
    errors.add(where, "",
               fmt::format("{}: open water has no weight here, and a table is cut at the ground for up to {:.0f} % of it only; bring "
                           "the table down to the ground (depth: 0 is a table at the ground everywhere)",
                           found, 100 * most_cut));
  else
    warnings.push_back(fmt::format("{}: {}: it is cut at the ground there, and the water above has no weight", to_string(where), found));
}

template <int D>
void check_gravity(const Scene& scene, SceneErrorCollector& errors)
{
  for (const LoadSpec& load : scene.loads)
    if (const auto* gravity = std::get_if<GravitySpec>(&load); gravity != nullptr && gravity->acceleration.size() == D) {
      const Vec<D> g = Eigen::Map<const Vec<D>>(gravity->acceleration.data());
      if (const Vec<D> level = g - g[D - 1] * Vec<D>::Unit(D - 1); g[D - 1] >= 0 || level.norm() > steepest_axes * g.norm())
        errors.add(scene.water->where, "",
                   fmt::format("elevations are measured along {}, and gravity does not point down that way: {}", D == 2 ? "y" : "z",
                               in_words<D>(g)));
    }
}

/// The table at the nodes; none if something is wrong with it.
template <int D>
std::vector<Real> table_at_nodes(const Scene& scene, const SurfaceSpec& spec, const Mesh<D>& mesh, const std::function<bool(Index)>& filled,
                                 SceneErrorCollector& errors, std::vector<std::string>& warnings)
{
  const Ground<D> ground(mesh, filled);
  const Surface given = spec.depth ? Surface() : surface_of(scene, spec, mesh, errors, warnings);
  if (!given && !spec.depth)
    return {};
  const auto table = [&](const Vec<D>& x) {
    const auto place = Ground<D>::plan(x);
    if (spec.depth)
      return ground(place) - *spec.depth;
    return given(mesh.map() ? mesh.map()->to_map(place[0], place[1]) : place);
  };
  const Real pond = pond_at_start(scene);
  judge(flood_of<D>(ground, pond, table), spec.where, errors, warnings);

  std::vector<Real> at_nodes(static_cast<std::size_t>(mesh.n_nodes()));
  parallel_for(mesh.n_nodes(), [&](Index n) {
    const Vec<D>& x = mesh.node(n);
    const Real top = ground(Ground<D>::plan(x));
    at_nodes[static_cast<std::size_t>(n)] = top < pond ? pond : std::min(table(x), top);  // NaN if the table is, in this order
  });
  std::vector<std::uint8_t> needed(at_nodes.size(), 0);
  for (Index c = 0; c < mesh.n_cells(); ++c)
    for (const Index n : mesh.cell(c))
      needed[static_cast<std::size_t>(n)] |= static_cast<std::uint8_t>(filled(c));
  Index unknown = 0, unknown_in_material = none;
  for (std::size_t n = 0; n < at_nodes.size(); ++n)
    if (std::isnan(at_nodes[n])) {
      ++unknown;
      if (needed[n] != 0 && unknown_in_material == none)
        unknown_in_material = static_cast<Index>(n);
      at_nodes[n] = mesh.low()[D - 1];
    }
  if (unknown_in_material != none)
    errors.add(
        spec.where, "",
        fmt::format("the water table is not known everywhere above the bodies: not at {}", in_words<D>(mesh.node(unknown_in_material))));
  else if (unknown > 0)
    warnings.push_back(
        fmt::format("{}: the water table is not known at {} nodes of the mesh, where no body is at the start: there is no "
                    "water there",
                    to_string(spec.where), unknown));
  return at_nodes;
}

}  // namespace

template <int D>
Water water_of(const Scene& scene, const Mesh<D>& mesh, const std::vector<Body>& bodies, const std::function<bool(Index)>& filled,
               SceneErrorCollector& errors, std::vector<std::string>& warnings)
{
  Water water;
  if (!scene.water)
    return water;
  const WaterSpec& spec = *scene.water;
  check_gravity<D>(scene, errors);
  water.unit_weight = spec.unit_weight, water.suction = spec.suction;
  for (const Body& body : bodies)
    water.drained.push_back(is_drained(spec, body.name) ? 1 : 0);
  if (spec.table)
    water.table = table_at_nodes(scene, *spec.table, mesh, filled, errors, warnings);
  else  // water that flows, and has no pressure at the start
    water.table.assign(static_cast<std::size_t>(mesh.n_nodes()), mesh.low()[D - 1]);
  return water;
}

template <int D>
std::vector<Real> table_of_stage(const Scene& scene, const StageWaterSpec& spec, const Mesh<D>& mesh,
                                 const std::function<bool(Index)>& filled, SceneErrorCollector& errors, std::vector<std::string>& warnings)
{
  return table_at_nodes(scene, spec.table, mesh, filled, errors, warnings);
}

template <int D>
void saturate(const Scene& scene, Index stage, const Mesh<D>& mesh, const Water& water, const std::vector<Body>& bodies,
              Particles<D>& particles)
{
  for (const BodySpec& spec : scene.bodies) {
    const auto body = std::find_if(bodies.begin(), bodies.end(), [&](const Body& b) { return b.name == spec.name; });
    if (!water.any() || !spec.saturated_density || body == bodies.end() || presence_of(spec.name, scene.stages).from != stage)
      continue;
    parallel_for(body->size(), [&](Index i) {
      const auto p = static_cast<std::size_t>(body->begin + i);
      if (depth_below_table(mesh, water, particles.cell[p], particles.x[p]) > 0)
        particles.mass.set(p, *spec.saturated_density * particles.volume0[p]);
    });
  }
}

template <int D>
Index count_wet(const Mesh<D>& mesh, const Water& water, const Body& body, const Particles<D>& particles)
{
  if (!water.any())
    return 0;
  return parallel_sum<Index>(body.size(), [&](Index i) {
    const auto p = static_cast<std::size_t>(body.begin + i);
    return depth_below_table(mesh, water, particles.cell[p], particles.x[p]) > 0 ? 1 : 0;
  });
}

template Water water_of<2>(const Scene&, const Mesh<2>&, const std::vector<Body>&, const std::function<bool(Index)>&, SceneErrorCollector&,
                           std::vector<std::string>&);
template Water water_of<3>(const Scene&, const Mesh<3>&, const std::vector<Body>&, const std::function<bool(Index)>&, SceneErrorCollector&,
                           std::vector<std::string>&);
template std::vector<Real> table_of_stage<2>(const Scene&, const StageWaterSpec&, const Mesh<2>&, const std::function<bool(Index)>&,
                                             SceneErrorCollector&, std::vector<std::string>&);
template std::vector<Real> table_of_stage<3>(const Scene&, const StageWaterSpec&, const Mesh<3>&, const std::function<bool(Index)>&,
                                             SceneErrorCollector&, std::vector<std::string>&);
template void saturate<2>(const Scene&, Index, const Mesh<2>&, const Water&, const std::vector<Body>&, Particles<2>&);
template void saturate<3>(const Scene&, Index, const Mesh<3>&, const Water&, const std::vector<Body>&, Particles<3>&);
template Index count_wet<2>(const Mesh<2>&, const Water&, const Body&, const Particles<2>&);
template Index count_wet<3>(const Mesh<3>&, const Water&, const Body&, const Particles<3>&);

}  // namespace talus
