#include "app/setup/boundaries_of_scene.hpp"

#include <stdexcept>

#include "io/scene/record_file.hpp"
#include "io/scene/scene.hpp"
#include "solver/boundary/column_beside.hpp"

namespace talus {

namespace {

/// Makes the conditions of a stage one after the other, from their options.
template <int D>
class BoundaryBuilder {
 public:
  BoundaryBuilder(const Scene& scene, const Mesh<D>& mesh, const CellOccupancy<D>& has_particles, Communicator& ranks,
                  const std::string& stage, bool first, SceneErrorCollector& errors, Setup<D>& setup, BoundaryConditions<D>& all)
      : folder_(folder_of(scene)),
        mesh_(mesh),
        has_particles_(has_particles),
        stage_(stage),
        first_(first),
        up_(upright_of(scene).head<D>()),
        ranks_(ranks),
        errors_(errors),
        setup_(setup),
        all_(all)
  {}
  /// Those that move on others come last.
  void add(const std::vector<BoundaryOptions>& boundaries)
  {
    const auto names = wall_names(boundaries);
    for (const bool on_others : {false, true})
      for (std::size_t i = 0; i < names.size(); ++i)
        std::visit(
            [&]<class Options>(const Options& options) {
              with_condition_of<Options, D>([&]<class C>() {
                if (MovesOnBase<C> == on_others)
                  add_one<C>(names[i], options);
              });
            },
            boundaries[i]);
  }

 private:
  template <class C>
  void add_one(const std::string& name, const typename C::Options& options)
  {
    ConditionSetup<D> made_from{.mesh = mesh_, .facets = {}, .up = up_, .record = {}, .holder_of = {}, .column_beside = {}};
    if constexpr (requires { options.record; })
      if (options.record)
        made_from.record = record_of(options.where, *options.record);
    if constexpr (is_on_facets<C>) {
      if (const auto facets = mesh_.facet_set(options.on))
        add_on_facets<C>(name, options, *facets, made_from);
      else
        errors_.unknown_group(options.where, "on", "facet", options.on, mesh_.facet_set_names());
    } else if (const auto nodes = mesh_.node_set(options.on)) {
      if constexpr (std::is_same_v<C, Fixed<D>>)
        note_floor(options);
      BoundaryCondition<D> condition{.name = name, .kind = C::make(options, made_from)};
      if (options.acts_in(stage_))
        all_.add(std::move(condition), mesh_, *nodes);
      else
        all_.add(std::move(condition));
    } else {
      errors_.unknown_group(options.where, "on", "node, facet or cell", options.on, mesh_.node_set_names());
    }
  }
  /// Material that flows out over fixed facets is held back.
  void note_floor(const typename Fixed<D>::Options& options)
  {
    const auto facets = mesh_.facet_set(options.on);
    const auto is_soil = [](const Material& material) { return material.law().description().has_strength; };
    if (!first_ || !options.acts_in(stage_) || !facets || std::ranges::none_of(setup_.state.materials, is_soil))
      return;
    Index covered = 0, open = 0;  // of those that bear what lies on them
    for (const Facet facet : *facets)
      if (const Vec<D> outwards = mesh_.area_vector(facet); outwards.dot(up_) < -0.5 * outwards.norm())
        ++(has_particles_(facet.cell) ? covered : open);
    if (covered > 0 && open > 0)
      setup_.notes.push_back(
          fmt::format("\"{}\" is fixed: what flows out over it is held back by about half a cell and stops too early; friction with the "
                      "tangent of its own angle does not hold it back",
                      options.on));
  }
  template <class C>
  void add_on_facets(const std::string& name, const typename C::Options& options, const std::vector<Facet>& group,
                     ConditionSetup<D>& made_from)
  try {
    const std::vector<Facet> facets = mesh_.both_sides_of_cuts(has_particles_.orient_facets(group));
    made_from.facets = facets;
    made_from.holder_of = [&](Index node) { return all_.holder_of(node); };
    made_from.column_beside = [&] { return column_beside<D>(mesh_, facets, up_, setup_.state.particles, setup_.state.materials, ranks_); };
    C kind = C::make(options, made_from);
    if constexpr (requires { kind.note(options); })
      if (first_)
        setup_.notes.push_back(kind.note(options));
    if (!options.acts_in(stage_))
      return all_.add({.name = name, .kind = std::move(kind)});
    if constexpr (ActsOnPlanes<C>)
      if (const Index inside = has_particles_.inside_material(group); inside > 0 && facets.size() == group.size() && !C::two_sided)
        setup_.warnings.push_back(fmt::format(
            "{}: {} of the {} facets of \"{}\" have material on both sides{}: a {} wall holds that on one of them, and which is not said",
            to_string(options.where), inside, group.size(), options.on, stage_.empty() ? "" : fmt::format(" in stage \"{}\"", stage_),
            C::Options::name));
    all_.add({.name = name, .kind = std::move(kind)}, mesh_, facets);
  } catch (const std::invalid_argument& e) {
    errors_.add(options.where, "on", e.what());
  }

  std::optional<Record> record_of(const SourceLocation& where, const RecordOptions& options)
  {
    std::optional<Record> record;
    try {
      record = read_record((folder_ / options.file).lexically_normal(), options);
    } catch (const SceneErrors& e) {
      errors_.add(where, "record.file", e);
    }
    if (!record || !first_)
      return record;
    setup_.notes.push_back(describe(options, *record));
    constexpr Real noticed = 0.01;  // fraction of the peak
    if (const Real left = std::abs(record->velocity.back()); left > noticed * record->peak_velocity())
      setup_.warnings.push_back(
          fmt::format("{}: \"{}\" ends with {:.3g} m/s, and its velocity stays so after its end; record.baseline takes such a drift off",
                      to_string(where), options.file, left));
    return record;
  }

  std::filesystem::path folder_;
  const Mesh<D>& mesh_;
  const CellOccupancy<D>& has_particles_;
  const std::string& stage_;
  bool first_;
  Vec<D> up_;
  Communicator& ranks_;
  SceneErrorCollector& errors_;
  Setup<D>& setup_;
  BoundaryConditions<D>& all_;
};

}  // namespace

template <int D>
void add_boundaries(const Scene& scene, const Mesh<D>& mesh, const CellOccupancy<D>& has_particles, Communicator& ranks,
                    const std::string& stage, bool first, SceneErrorCollector& errors, Setup<D>& setup, BoundaryConditions<D>& all)
{
  BoundaryBuilder<D>(scene, mesh, has_particles, ranks, stage, first, errors, setup, all).add(scene.boundaries);
}

template void add_boundaries<2>(const Scene&, const Mesh<2>&, const CellOccupancy<2>&, Communicator&, const std::string&, bool,
                                SceneErrorCollector&, Setup<2>&, BoundaryConditions<2>&);
template void add_boundaries<3>(const Scene&, const Mesh<3>&, const CellOccupancy<3>&, Communicator&, const std::string&, bool,
                                SceneErrorCollector&, Setup<3>&, BoundaryConditions<3>&);

}  // namespace talus
