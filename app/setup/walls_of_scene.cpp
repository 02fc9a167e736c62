#include "app/setup/walls_of_scene.hpp"

#include "app/setup/vertical_axis.hpp"
#include "io/scene/wall_names.hpp"

namespace talus {

namespace {

/// Boundaries, one after the other -> walls of a stage, called by its name.
template <int D>
class WallBuilder {
 public:
  /// `first`: of the first stage, in which what is worth a word is told.
  WallBuilder(const Scene& scene, const Mesh<D>& mesh, const CellOccupancy<D>& has_particles, Communicator& ranks, const std::string& stage,
              bool first, SceneErrorCollector& complaints, Setup<D>& setup, BoundaryConditions<D>& walls)
      : folder_(folder_of(scene)),
        mesh_(mesh),
        has_particles_(has_particles),
        stage_(stage),
        first_(first),
        up_(upright_of(scene).head<D>()),
        ranks_(ranks),
        complaints_(complaints),
        setup_(setup),
        walls_(walls)
  {}
  /// Free fields come last: they stand on others.
  void add(const std::vector<BoundarySpec>& boundaries)
  {
    const auto names = wall_names(boundaries);
    for (const bool free_fields : {false, true})
      for (std::size_t i = 0; i < names.size(); ++i)
        if (std::holds_alternative<FreeFieldSpec>(boundaries[i]) == free_fields) {
          name_ = names[i];
          std::visit(*this, boundaries[i]);
        }
  }

  void operator()(const FixedSpec& spec) { on_nodes(spec, wall_of(spec, WallKind::fixed)); }
  void operator()(const VelocitySpec& spec)
  {
    Wall<D> wall = wall_of(spec, WallKind::velocity);
    set_motion(spec, wall);
    on_nodes(spec, std::move(wall));
  }
  void operator()(const CompliantBaseSpec& spec)
  {
    Wall<D> wall = wall_of(spec, WallKind::compliant_base);
    wall.halfspace = {spec.density, spec.s_wave, spec.p_wave};
    set_motion(spec, wall);
    on_facets(spec, std::move(wall));
  }
  void operator()(const FreeFieldSpec& spec)
  {
    Wall<D> wall = wall_of(spec, WallKind::free_field);
    const auto found = mesh_.facet_set(spec.on);
    if (!found)
      return complaints_.unknown_group(spec.where, "on", "facet", spec.on, mesh_.facet_set_names());
    const std::vector<Facet> facets = has_particles_.orient_facets(*found);
    constexpr Real vertical = 0.01;  // cosine between a facet's normal and the upright
    Index lowest = none;
    for (const Facet facet : facets) {
      const Vec<D> area = mesh_.area_vector(facet);
      if (std::abs(area.dot(up_)) > vertical * area.norm())
        return complaints_.add(spec.where, "on", fmt::format("the facets of \"{}\" are not all upright", spec.on));
      for (const Index n : mesh_.nodes_of(facet))
        if (lowest == none || mesh_.node(n).dot(up_) < mesh_.node(lowest).dot(up_))
          lowest = n;
    }
    const auto column = column_beside<D>(mesh_, facets, up_, setup_.particles, setup_.materials, ranks_);
    wall.foot = lowest == none ? none : walls_.holder_of(lowest);
    if (!column)
      return complaints_.add(
          spec.where, "on",
          fmt::format("behind the facets of \"{}\", from their foot up, there must be particles of laws that have an elastic shear modulus",
                      spec.on));
    if (wall.foot == none)
      return complaints_.add(spec.where, "on",
                             fmt::format("no boundary of type fixed, velocity or compliant_base holds the foot of \"{}\"", spec.on));
    wall.column = *column;
    const Halfspace &lowest_layer = wall.column.layer.front().ground, &highest_layer = wall.column.layer.back().ground;
    if (first_)
      setup_.notes.push_back(fmt::format(
          "free field \"{}\": {} layers over {:.4g} m, shear waves {:.4g} m/s at the foot and {:.4g} m/s at the ground", spec.on,
          wall.column.layer.size(), wall.column.level.back() - wall.column.level.front(), lowest_layer.s_wave, highest_layer.s_wave));
    walls_.add(std::move(wall), mesh_, facets);
  }
  void operator()(const RollerSpec& spec) { on_facets(spec, wall_of(spec, WallKind::roller)); }
  void operator()(const FrictionSpec& spec)
  {
    Wall<D> wall = wall_of(spec, WallKind::friction);
    wall.friction = spec.coefficient;
    on_facets(spec, std::move(wall));
  }

 private:
  template <class Spec>
  Wall<D> wall_of(const Spec& spec, WallKind kind)
  {
    Wall<D> wall;
    wall.name = name_;
    wall.kind = kind;
    wall.where = spec.where;
    return wall;
  }
  template <class Spec>
  void set_motion(const Spec& spec, Wall<D>& wall)
  {
    wall.velocity = vector_of<D>(spec.velocity);
    wall.table = spec.table;
    if (!spec.record)
      return;
    try {
      wall.record = read_record((folder_ / spec.record->file).lexically_normal(), *spec.record);
    } catch (const SceneErrors& e) {
      return complaints_.add(spec.where, "record.file", e);
    }
    if (!first_)
      return;
    setup_.notes.push_back(describe(*spec.record, *wall.record));
    constexpr Real noticed = 0.01;  // share of the peak
    const Real left = std::abs(wall.record->velocity.back());
    if (left > noticed * wall.record->peak_velocity())
      setup_.warnings.push_back(
          fmt::format("{}: \"{}\" ends with {:.3g} m/s, and its velocity stays so after its end; record.baseline takes such a drift off",
                      to_string(spec.where), spec.record->file, left));
  }
  template <class Spec>
  void on_nodes(const Spec& spec, Wall<D> wall)
  {
    const auto nodes = mesh_.node_set(spec.on);
    if (nodes && acts_in(spec, stage_))
      walls_.add(std::move(wall), mesh_, *nodes);
    else if (nodes)
      walls_.add(std::move(wall));
    else
      complaints_.unknown_group(spec.where, "on", "node, facet or cell", spec.on, mesh_.node_set_names());
  }
  template <class Spec>
  void on_facets(const Spec& spec, Wall<D> wall)
  {
    const auto facets = mesh_.facet_set(spec.on);
    if (facets && acts_in(spec, stage_)) {
      if (const Index inside = has_particles_.inside_material(*facets); inside > 0 && wall.kind == WallKind::friction)
        setup_.warnings.push_back(fmt::format(
            "{}: {} of the {} facets of \"{}\" have material on both sides{}: a friction wall holds that on one of them, and "
            "which is not said",
            to_string(spec.where), inside, facets->size(), spec.on, stage_.empty() ? "" : fmt::format(" in stage \"{}\"", stage_)));
      walls_.add(std::move(wall), mesh_, has_particles_.orient_facets(*facets));
    } else if (facets) {
      walls_.add(std::move(wall));
    } else
      complaints_.unknown_group(spec.where, "on", "facet", spec.on, mesh_.facet_set_names());
  }

  std::filesystem::path folder_;
  const Mesh<D>& mesh_;
  const CellOccupancy<D>& has_particles_;
  const std::string& stage_;
  bool first_;
  std::string name_;  // of the wall at hand
  Vec<D> up_;
  Communicator& ranks_;
  SceneErrorCollector& complaints_;
  Setup<D>& setup_;
  BoundaryConditions<D>& walls_;
};

}  // namespace

template <int D>
void add_walls(const Scene& scene, const Mesh<D>& mesh, const CellOccupancy<D>& has_particles, Communicator& ranks,
               const std::string& stage, bool first, SceneErrorCollector& complaints, Setup<D>& setup, BoundaryConditions<D>& walls)
{
  WallBuilder<D>(scene, mesh, has_particles, ranks, stage, first, complaints, setup, walls).add(scene.boundaries);
}

template void add_walls<2>(const Scene&, const Mesh<2>&, const CellOccupancy<2>&, Communicator&, const std::string&, bool,
                           SceneErrorCollector&, Setup<2>&, BoundaryConditions<2>&);
template void add_walls<3>(const Scene&, const Mesh<3>&, const CellOccupancy<3>&, Communicator&, const std::string&, bool,
                           SceneErrorCollector&, Setup<3>&, BoundaryConditions<3>&);

}  // namespace talus
