#include "app/setup/surface_loads.hpp"

#include <algorithm>
#include <cmath>

#include "app/setup/body_sides.hpp"
#include "core/parallel/communicator.hpp"

namespace talus {

namespace {

/// The side of a square or a cube that is cut into D! cells of the volume of this one [m].
template <int D>
Real cell_size(const Mesh<D>& mesh, Index cell)
{
  constexpr Real cells = D == 2 ? 2 : 6;
  return std::pow(cells * mesh.volume(cell), Real{1} / D);
}

/// Cells of depth over which the load is handed from the surface into the body, and the least for which the measured errors hold
/// (benchmarks/loaded_surface).
constexpr Real cells_of_reach = 5, least_cells = 4;
/// Share of the depth of a thin body.
constexpr Real share_of_depth = 0.8;
/// Cells beyond the reach whose particles keep their depth too: mean depths around nodes decide where the load ends.
constexpr Real cells_beyond = 3;

/// A particle near a side as ranks send it.
template <int D>
struct TaggedSide {
  std::int64_t id;
  std::array<Real, 2 * D + 1> numbers;
};

/// What each rank has found of its own particles becomes that of all, in the order of ids.  Every rank has to ask.
template <int D>
void join(Communicator& ranks, std::vector<TaggedSide<D>>& all)
{
  const auto by_id = [](const TaggedSide<D>& a, const TaggedSide<D>& b) { return a.id < b.id; };
  std::sort(all.begin(), all.end(), by_id);
  if (ranks.alone())
    return;
  const auto of_ranks = gather_rows<TaggedSide<D>>(ranks, all);
  all.clear();
  for (const auto& of_rank : of_ranks)
    all.insert(all.end(), of_rank.begin(), of_rank.end());
  std::sort(all.begin(), all.end(), by_id);
  const auto bytes = std::as_bytes(std::span(all));
  std::vector<std::byte> letter(bytes.begin(), bytes.end());
  ranks.broadcast(letter, 0);
  all = rows_of<TaggedSide<D>>({std::move(letter)}).front();
}

template <int D>
class SurfaceLoadBuilder {
 public:
  SurfaceLoadBuilder(const BodySpec& body, const TractionSpec& spec, const Mesh<D>& mesh, Communicator& ranks, Setup<D>& setup)
      : spec_(spec), mesh_(mesh), ranks_(ranks), setup_(setup)
  {
    const auto found = std::ranges::find(setup.state.bodies, body.name, &Body::name);
    load_.body = static_cast<Index>(found - setup.state.bodies.begin());
    load_.traction = vector_of<D>(spec.traction);
    load_.pressure = spec.water_level ? spec.unit_weight : spec.pressure.value_or(0);
    if (spec.water_level)
      load_.water_level = Table{{{0, *spec.water_level}}};
    load_.table = spec.table;
    load_.where = spec.where;
  }

  void build(const BodySide<D>& side)
  {
    load_.is_closed = side.is_closed;
    if (!side.is_whole)
      find_near(side);
    setup_.conditions.loads.on_surfaces.push_back(std::move(load_));
  }

 private:
  /// Calls f(particle) for those of the body on this rank.
  template <class F>
  void for_each(F&& f) const
  {
    const Body& body = setup_.state.bodies[static_cast<std::size_t>(load_.body)];
    for (Index row = body.begin; row < body.end; ++row)
      f(static_cast<std::size_t>(row));
  }

  void find_near(const BodySide<D>& side)
  {
    const Particles<D>& particles = setup_.state.particles;
    constexpr Real next_to_it = 3;
    Real size = 0;  // of the cells beside the side
    for_each([&](std::size_t p) {
      const Real of_cell = cell_size(mesh_, particles.cell[p]);
      if (side.near(particles.x[p]).depth < next_to_it * of_cell)
        size = std::max(size, of_cell);
    });
    size = ranks_.max(size);
    const Real wanted = cells_of_reach * size, depth = side.thickness(wanted / share_of_depth);
    load_.reach = std::min(wanted, share_of_depth * depth);
    load_.deep = load_.reach + cells_beyond * size;
    if (depth < least_cells * size)
      warn_of_thin_body(depth / size);

    std::vector<TaggedSide<D>> all;
    for_each([&](std::size_t p) {
      const NearSide<D> near = side.near(particles.x[p]);
      if (near.depth >= load_.deep)
        return;
      TaggedSide<D>& one = all.emplace_back();
      one.id = particles.id[p];
      one.numbers[0] = near.depth;
      std::copy(near.normal.begin(), near.normal.end(), one.numbers.begin() + 1);
      std::copy(near.carrier.begin(), near.carrier.end(), one.numbers.begin() + 1 + D);
    });
    join(ranks_, all);
    std::vector<std::int64_t> ids;
    for (const TaggedSide<D>& one : all) {
      ids.push_back(one.id);
      load_.side.push_back(
          {one.numbers[0], Eigen::Map<const Vec<D>>(one.numbers.data() + 1), Eigen::Map<const Vec<D>>(one.numbers.data() + 1 + D)});
    }
    load_.near = TrackedIds(std::move(ids));
  }

  void warn_of_thin_body(Real cells)
  {
    setup_.warnings.push_back(fmt::format(
        "{}: the body is {:.2g} cells deep behind \"{}\", and the load needs {:.0f}: expect errors of the stress there of about 2 % "
        "with 3 cells and 5 % with 2; take smaller cells",
        to_string(spec_.where), cells, spec_.on, least_cells));
  }

  const TractionSpec& spec_;
  const Mesh<D>& mesh_;
  Communicator& ranks_;
  Setup<D>& setup_;
  SurfaceLoad<D> load_;
};

}  // namespace

const BodySpec* body_of_side(const Scene& scene, const std::string& name)
{
  const auto found = std::ranges::find_if(scene.bodies, [&](const BodySpec& body) { return name.starts_with(body.name + ":"); });
  return found == scene.bodies.end() ? nullptr : &*found;
}

template <int D>
std::vector<std::string> sides_of_bodies(const Scene& scene)
{
  std::vector<std::string> names;
  for (const BodySpec& body : scene.bodies)
    if (body.shape)
      for (const std::string& side : side_names<D>(*body.shape))
        names.push_back(body.name + ":" + side);
  return names;
}

template <int D>
void add_surface_load(const BodySpec& body, const TractionSpec& spec, const Mesh<D>& mesh, Communicator& ranks, SceneErrorCollector& errors,
                      Setup<D>& setup)
{
  if (!body.shape)
    return errors.add(
        spec.where, "on",
        fmt::format("body \"{}\" fills no shape, so its sides have no names: sides of regions are facet groups, REGION:SIDE", body.name));
  const std::string name = spec.on.substr(body.name.size() + 1);
  const auto side = side_of<D>(*body.shape, name);
  if (!side)
    return errors.add(spec.where, "on",
                      fmt::format("the shape of body \"{}\" has no side \"{}\"; it has {}", body.name, name,
                                  fmt::join(side_names<D>(*body.shape), ", ")));
  if (spec.carried_by == Carrier::mesh)
    return errors.add(spec.where, "carried_by", fmt::format("\"{}\" is a side of a body and moves with it: leave carried_by out", spec.on));
  if (side->is_whole && !spec.traction.empty())
    return errors.add(spec.where, "traction",
                      fmt::format("a traction needs a side: \"{}\" is the whole surface, on which a pressure may act", spec.on));
  SurfaceLoadBuilder<D>(body, spec, mesh, ranks, setup).build(*side);
}

template std::vector<std::string> sides_of_bodies<2>(const Scene&);
template std::vector<std::string> sides_of_bodies<3>(const Scene&);
template void add_surface_load<2>(const BodySpec&, const TractionSpec&, const Mesh<2>&, Communicator&, SceneErrorCollector&, Setup<2>&);
template void add_surface_load<3>(const BodySpec&, const TractionSpec&, const Mesh<3>&, Communicator&, SceneErrorCollector&, Setup<3>&);

}  // namespace talus
