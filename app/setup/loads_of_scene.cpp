#include "app/setup/loads_of_scene.hpp"

#include <algorithm>
#include <stdexcept>

#include "app/setup/expression.hpp"
#include "app/setup/surface_loads.hpp"
#include "core/parallel/communicator.hpp"

namespace talus {

namespace {

/// What each rank has found behind facets, its own particles, becomes that of all.  Every rank has to ask.
template <int D>
void join(Communicator& ranks, ParticleTraction<D>& load)
{
  struct Loaded {
    std::int64_t id;
    std::array<Real, D> area;
  };
  if (ranks.alone())
    return;
  std::vector<Loaded> all;
  for (std::size_t k = 0; k < load.id.size(); ++k) {
    Loaded& one = all.emplace_back();
    one.id = load.id[k];
    std::copy(load.area[k].begin(), load.area[k].end(), one.area.begin());
  }
  const auto of_ranks = gather_rows<Loaded>(ranks, all);
  all.clear();
  for (const std::vector<Loaded>& of_rank : of_ranks)
    all.insert(all.end(), of_rank.begin(), of_rank.end());
  std::sort(all.begin(), all.end(), [](const Loaded& a, const Loaded& b) { return a.id < b.id; });
  const auto bytes = std::as_bytes(std::span(all));
  std::vector<std::byte> letter(bytes.begin(), bytes.end());
  ranks.broadcast(letter, 0);
  load.id.clear(), load.area.clear();
  const auto letters = rows_of<Loaded>({std::move(letter)});
  for (const Loaded& one : letters.front()) {
    load.id.push_back(one.id);
    load.area.push_back(Eigen::Map<const Vec<D>>(one.area.data()));
  }
}

template <int D>
class LoadBuilder {
 public:
  LoadBuilder(const Scene& scene, const Mesh<D>& mesh, const CellOccupancy<D>& has_particles, const CellOccupancy<D>& at_start,
              Communicator& ranks, SceneErrorCollector& errors, Setup<D>& setup)
      : scene_(scene), mesh_(mesh), has_particles_(has_particles), at_start_(at_start), ranks_(ranks), errors_(errors), setup_(setup)
  {}

  void operator()(const GravitySpec& spec) { setup_.conditions.loads.gravity = {vector_of<D>(spec.acceleration), spec.table}; }
  void operator()(const BodyForceSpec& spec)
  {
    std::vector<Formula> formulas;
    for (std::size_t d = 0; d < spec.acceleration.size(); ++d)
      try {
        formulas.emplace_back(spec.acceleration[d]);
      } catch (const std::invalid_argument& e) {
        errors_.add(spec.where, fmt::format("acceleration[{}]", d), e.what());
      }
    if (formulas.size() < D)
      return;
    const auto evaluate_all = [formulas](std::span<const Vec<D>> places, Real time, std::span<Vec<D>> accelerations) {
      static thread_local std::vector<Vec3> at;
      static thread_local std::vector<Real> values;
      at.assign(places.size(), Vec3::Zero());
      values.resize(places.size());
      for (std::size_t i = 0; i < at.size(); ++i)
        at[i].template head<D>() = places[i];
      for (int d = 0; d < D; ++d) {
        formulas[static_cast<std::size_t>(d)](at, time, values);
        for (std::size_t i = 0; i < values.size(); ++i)
          accelerations[i][d] = values[i];
      }
    };
    setup_.conditions.loads.of_place.push_back({evaluate_all, spec.place == PlaceOf::start});
  }
  void operator()(const TractionSpec& spec)
  {
    const auto found = mesh_.facet_set(spec.on);
    if (!found) {
      if (const BodySpec* body = body_of_side(scene_, spec.on))
        return add_surface_load(*body, spec, mesh_, ranks_, errors_, setup_);
      std::vector<std::string> known = mesh_.facet_set_names();
      for (std::string& side : sides_of_bodies<D>(scene_))
        known.push_back(std::move(side));
      return errors_.unknown_group(spec.where, "on", "facet", spec.on, std::move(known));
    }
    if (spec.water_level)
      return errors_.add(spec.where, "water_level",
                         fmt::format("\"{}\" is a facet group: water acts on sides of bodies that fill a shape, BODY:SIDE", spec.on));
    const std::vector<Facet> facets = mesh_.both_sides_of_cuts(at_start_.orient_facets(*found));
    if (!spec.pressure && facets.size() > found->size())
      return errors_.add(spec.where, "traction",
                         fmt::format("\"{}\" is a cut, and a traction would push both of its sides the same way: give a pressure, which "
                                     "pushes them apart",
                                     spec.on));
    Real area = 0, loaded = 0;
    for (const Facet& facet : facets) {
      area += mesh_.area_vector(facet).norm();
      loaded += has_particles_(facet.cell) ? mesh_.area_vector(facet).norm() : 0;
    }
    if (loaded == 0)
      return errors_.add(spec.where, "on", fmt::format("there are no particles behind the facets of \"{}\" to carry the load", spec.on));
    if (loaded < area * (1 - 1e-9))  // sums of the same areas differ by round-off only
      setup_.warnings.push_back(fmt::format("{}: {:.3g} % of the area of \"{}\" has no particles behind it and carries no load",
                                            to_string(spec.where), 100 * (1 - loaded / area), spec.on));
    if (spec.carried_by == Carrier::particles) {
      auto load = carried_by_particles<D>(mesh_, facets, setup_.state.particles);
      join(ranks_, load);
      setup_.conditions.loads.on_particles.push_back(filled(std::move(load), spec));
    } else {
      setup_.conditions.loads.on_mesh.push_back(filled(carried_by_mesh<D>(mesh_, facets), spec));
    }
  }

 private:
  template <class Load>
  static Load filled(Load load, const TractionSpec& spec)
  {
    load.traction = vector_of<D>(spec.traction);
    load.pressure = spec.pressure.value_or(0);
    load.table = spec.table;
    load.where = spec.where;
    return load;
  }

  const Scene& scene_;
  const Mesh<D>& mesh_;
  const CellOccupancy<D>&has_particles_, &at_start_;
  Communicator& ranks_;
  SceneErrorCollector& errors_;
  Setup<D>& setup_;
};

}  // namespace

template <int D>
void add_loads(const Scene& scene, const Mesh<D>& mesh, const CellOccupancy<D>& has_particles, const CellOccupancy<D>& at_start,
               Communicator& ranks, SceneErrorCollector& errors, Setup<D>& setup)
{
  LoadBuilder<D> builder(scene, mesh, has_particles, at_start, ranks, errors, setup);
  for (const LoadSpec& load : scene.loads)
    std::visit(builder, load);
}

template void add_loads<2>(const Scene&, const Mesh<2>&, const CellOccupancy<2>&, const CellOccupancy<2>&, Communicator&,
                           SceneErrorCollector&, Setup<2>&);
template void add_loads<3>(const Scene&, const Mesh<3>&, const CellOccupancy<3>&, const CellOccupancy<3>&, Communicator&,
                           SceneErrorCollector&, Setup<3>&);

}  // namespace talus
