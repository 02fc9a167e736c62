#include "app/setup/setup.hpp"

#include <algorithm>
#include <cmath>

#include "app/observers/field_columns.hpp"
#include "app/observers/history.hpp"
#include "app/observers/runout.hpp"
#include "app/setup/body_options.hpp"
#include "app/setup/boundaries_of_scene.hpp"
#include "app/setup/checks/coarse_cells.hpp"
#include "app/setup/checks/kernel_choice.hpp"
#include "app/setup/checks/thin_layers.hpp"
#include "app/setup/contacts_of_scene.hpp"
#include "app/setup/flow_of_scene.hpp"
#include "app/setup/loads_of_scene.hpp"
#include "app/setup/rigid_of_scene.hpp"
#include "app/setup/seed.hpp"
#include "app/setup/stages_of_scene.hpp"
#include "app/setup/start_states.hpp"
#include "app/setup/water_table.hpp"
#include "core/parallel/communicator.hpp"
#include "core/parallel/threads.hpp"
#include "io/system/process.hpp"
#include "mesh/digest.hpp"

namespace talus {

std::string describe(const OriginSummary& origin)
{
  std::string text = fmt::format("  from {}, step {}, t = {:.6g} s of \"{}\":\n", origin.file, origin.step, origin.time, origin.title);
  for (const auto& [body, from, particles] : origin.bodies)
    text += fmt::format("    body \"{}\": the {} particles of \"{}\"\n", body, particles, from);
  return text;
}

std::string describe(const TransferOptions& transfer)
{
  std::string text(enum_names(transfer.scheme)[static_cast<std::size_t>(transfer.scheme)]);
  if (transfer.uses_musl())
    text += ", musl";
  const bool undamped = transfer.pic_damping_time && std::isinf(*transfer.pic_damping_time);
  if (transfer.pic_damping_time)
    text += undamped ? ", undamped" : fmt::format(", damped in {:.3g} s", *transfer.pic_damping_time);
  if (transfer.pic_damping_crossings)
    text += fmt::format("{} {:.6g} crossing times of a cell",
                        undamped                    ? "; in stages that seek rest damped in"
                        : transfer.pic_damping_time ? "; in stages that seek rest in"
                                                    : ", damped in",
                        *transfer.pic_damping_crossings);
  return text;
}

void take_threads(std::optional<int> asked, const Scene& scene)
{
  const Index wanted = asked.value_or(scene.threads);
  if (wanted > 0)
    use_threads(wanted, asked ? "--threads" : "threads in " + scene.file);
  else if (!world().alone())
    set_threads(std::max(1, threads() / ranks_on_this_machine()));
}

std::filesystem::path folder_of(const Scene& scene) { return std::filesystem::path(scene.file).parent_path(); }

namespace {

/// Speeds of waves, and the energy of all particles if they moved with the speed of theirs.
struct Waves {
  Real fastest = 0, energy = 0;  ///< [m/s], [J]
};

template <int D>
Waves waves_in(const Mesh<D>& mesh, const Setup<D>& setup, Communicator& ranks)
{
  const Particles<D>& particles = setup.state.particles;
  CellOrder order;
  sort_by_cell(particles.cell, particles.id, setup.state.bodies, mesh.n_cells(), order);
  Real least = std::numeric_limits<Real>::infinity();  // minus the speed of the fastest
  ExactSums<Real> energy;
  for (Index b = 0; b < static_cast<Index>(setup.state.materials.size()); ++b) {
    const Material& material = setup.state.materials[static_cast<std::size_t>(b)];
    const auto speed = [&](Index i) { return material.wave_speed(i, particles.F[static_cast<std::size_t>(material.begin + i)]); };
    least = parallel_min(material.size(), least, [&](Index i) { return -speed(i); });
    add_particles(order, {b, b + 1}, energy, [&](Index row) {
      const Real c = speed(row - material.begin);
      return 0.5 * particles.mass[static_cast<std::size_t>(row)] * c * c;
    });
  }
  ranks.sum(energy);
  return {std::max(Real{0}, -ranks.min(least)), energy.value()};
}

/// What loads and walls can make of a particle within the mesh [m/s]; infinite where that cannot be told.
template <int D>
Real driven_speed(const Mesh<D>& mesh, const Setup<D>& setup, Communicator& ranks)
{
  if (!setup.conditions.loads.of_place.empty())
    return std::numeric_limits<Real>::infinity();
  const Real size = (mesh.high() - mesh.low()).norm();
  Real speed = 0;
  for (const BoundaryCondition<D>& condition : setup.state.boundary.conditions())
    speed = std::max(speed, condition.peak_speed());
  speed +=
      std::sqrt(2 * setup.conditions.loads.gravity.acceleration.norm() * setup.conditions.loads.gravity.table.largest_magnitude() * size);
  Real pressure = 0;  // on the thinnest layer that carries it, over the size of the mesh
  const auto press = [&](const auto& load) {
    pressure = std::max(pressure, (load.traction.norm() + std::abs(load.pressure)) * load.table.largest_magnitude());
  };
  std::ranges::for_each(setup.conditions.loads.on_particles, press);
  std::ranges::for_each(setup.conditions.loads.on_mesh, press);
  for (const MeshTraction<D>& load : setup.conditions.loads.on_mesh)
    if (!load.height.empty())  // open water
      pressure = std::max(pressure, load.unit_weight * std::max(load.level.largest_magnitude() - mesh.low()[D - 1], Real{0}) *
                                        load.table.largest_magnitude());
  for (const SurfaceLoad<D>& load : setup.conditions.loads.on_surfaces)
    pressure = std::max(pressure, (load.traction.norm() + std::abs(load.pressure) * load.largest_height(mesh.low()[D - 1])) *
                                      load.table.largest_magnitude());
  if (pressure > 0) {
    Real layer = std::numeric_limits<Real>::infinity();  // [kg/m^2]
    for (Index row = 0; row < setup.state.particles.size(); ++row) {
      const auto p = static_cast<std::size_t>(row);
      layer =
          std::min(layer, setup.state.particles.mass[p] / setup.state.particles.volume0[p] * mesh.altitude(setup.state.particles.cell[p]));
    }
    speed += std::sqrt(2 * pressure * size / ranks.min(layer));
  }
  return speed;
}

/// How fast particles may be, and how much energy may come from nowhere, before a run is taken for broken: as the scene says; without a word of
/// it, limits that no sound run comes near.  Every rank has to ask.
template <int D>
RunLimits run_limits_of(const Scene& scene, const Mesh<D>& mesh, const Setup<D>& setup, Communicator& ranks)
{
  constexpr Real far_beyond = 10;
  constexpr Real least_strain = 1e-6;  // waves of less are not looked at
  const Waves waves = waves_in(mesh, setup, ranks);
  Real start = 0;
  for (Index row = 0; row < setup.state.particles.size(); ++row)
    start = std::max(start, setup.state.particles.v[static_cast<std::size_t>(row)].norm());
  start = ranks.max(start);
  const Real fastest = scene.watch.on_speed == LimitAction::ignore || scene.watch.speed ? 0 : driven_speed(mesh, setup, ranks);
  return {scene.watch, far_beyond * (waves.fastest + start + fastest), least_strain * least_strain * waves.energy};
}

template <int D>
std::uint64_t digest_of_files(const Scene& scene, const Setup<D>& setup)
{
  std::vector<Real> numbers = setup.conditions.water.table;
  numbers.insert(numbers.end(), setup.start_digest.begin(), setup.start_digest.end());
  for (const StageChange<D>& change : setup.changes)
    if (change.table)
      numbers.insert(numbers.end(), change.table->begin(), change.table->end());
  for (const BoundaryCondition<D>& condition : setup.state.boundary.conditions())
    if (const Record* record = condition.record())
      for (const std::vector<Real>* part : {&record->time, &record->velocity, &record->acceleration})
        numbers.insert(numbers.end(), part->begin(), part->end());
  for (std::size_t r = 0; r < scene.rigid.size(); ++r) {
    const RigidSpec& spec = scene.rigid[r];
    const FacetSurface<D>* facets = setup.conditions.rigid.bodies[r].shape->facets();
    if ((spec.file.empty() && spec.sheet_file.empty()) || !facets)
      continue;
    numbers.insert(numbers.end(), setup.state.rigid[r].x.begin(), setup.state.rigid[r].x.end());  // corners are about it
    for (const Vec<D>& corner : facets->corners())
      numbers.insert(numbers.end(), corner.begin(), corner.end());
    for (const auto& facet : facets->facets())
      std::ranges::transform(facet, std::back_inserter(numbers), [](Index corner) { return static_cast<Real>(corner); });
  }
  return digest(std::span<const Real>(numbers));
}

bool wants_displacement(const OutputSpec& outputs)
{
  if (outputs.runout || (outputs.history && (!outputs.history->points.empty() || !outputs.history->moved.empty())))
    return true;
  if (!outputs.particles)
    return false;
  const auto fields = particle_fields_of(outputs);
  return std::ranges::find(fields, "displacement") != fields.end();
}

/// A table that no drained body reaches down to is hardly meant.  Every rank has to ask.
template <int D>
void warn_if_dry(const Mesh<D>& mesh, Communicator& ranks, Setup<D>& setup)
{
  const std::vector<std::uint8_t>& drained = setup.conditions.water.drained;
  if (std::ranges::none_of(drained, [](std::uint8_t is) { return is != 0; }))
    return;
  std::int64_t wet = 0;
  for (std::size_t b = 0; b < setup.state.bodies.size(); ++b)
    if (setup.conditions.water.drains(static_cast<Index>(b)))
      wet += count_wet(mesh, setup.conditions.water, setup.state.bodies[b], setup.state.particles);
  if (ranks.sum(wet) == 0)
    setup.warnings.emplace_back("no particle of a drained body lies below the water table at the start");
}

/// Pores that stay full above the table pull with a suction that grows without bound, and make the soil too strong.  Every rank has to ask.
template <int D>
void warn_of_suction(const Mesh<D>& mesh, Communicator& ranks, Setup<D>& setup)
{
  const SceneConditions<D>& conditions = setup.conditions;
  if (conditions.loads.gravity.acceleration.isZero(0))
    return;
  for (std::size_t b = 0; b < setup.state.bodies.size(); ++b) {
    const Body& body = setup.state.bodies[b];
    const auto number = static_cast<Index>(b);
    if (!conditions.flow.flows(number) || conditions.flow.bodies[b].retention.entry > 0)
      continue;
    const std::int64_t dry = ranks.sum(std::int64_t{body.size()} - count_wet(mesh, conditions.water, body, setup.state.particles));
    if (dry > 0)
      setup.warnings.push_back(fmt::format(
          "{} particles of body \"{}\" lie above the water table at the start, and its pores stay full there: where water sinks, "
          "suction grows without bound and makes the soil too strong, which is unsafe; give its pores a retention (water.flow)",
          dry, body.name));
  }
}

/// sqrt(h/g) [s], in which a body that falls from rest covers half of h, the median altitude of the cells in which bodies are placed, also
/// those of later stages [m]; 0 without gravity [m/s^2].
template <int D>
Real fall_time(const Mesh<D>& mesh, const CellOccupancy<D>& has_particles, Real gravity)
{
  std::vector<Real> altitudes;
  for (Index c = 0; c < mesh.n_cells(); ++c)
    if (has_particles(c))
      altitudes.push_back(mesh.altitude(c));
  if (altitudes.empty() || gravity <= 0)
    return 0;
  const auto median = altitudes.begin() + static_cast<std::ptrdiff_t>(altitudes.size() / 2);
  std::ranges::nth_element(altitudes, median);
  return std::sqrt(*median / gravity);
}

/// Sections that leave the mesh, walls of the history that have no area.
template <int D>
void check_outputs(const Scene& scene, const Mesh<D>& mesh, const Vec<D>& gravity, SceneErrorCollector& errors)
{
  if (const auto& history = scene.outputs.history)
    for (const WallSpec& wall : history->walls)
      if (!facets_of_wall(mesh, wall.on))
        errors.add(wall.where, "on", fmt::format("wall \"{}\" is on nodes, not on facets: it has no area", wall.on));
  if (D == 2 || !scene.outputs.runout)
    return;
  const PlanAxes axes = plan_axes<D>(gravity);
  for (const SectionSpec& section : scene.outputs.runout->sections)
    for (std::size_t i = 0; i < section.along.size(); ++i)
      for (std::size_t d = 0; d < 2; ++d) {
        const Real shift = mesh.map() ? mesh.map()->origin[d] : 0;
        const Real low = mesh.low()[axes.plan[d]] + shift, high = mesh.high()[axes.plan[d]] + shift;
        if (const Real x = section.along[i][d]; !(low <= x && x <= high))
          errors.add(
              section.where, "along",
              fmt::format("corner {} is outside of the mesh: {:.10g} m does not lie between {:.10g} and {:.10g} m", i + 1, x, low, high));
      }
}

/// Where surfaces are extended, what lies beside them does not rest under its weight.
void warn_of_creeping_surfaces(const Scene& scene, const std::vector<Stage>& stages, std::vector<std::string>& warnings)
{
  if (scene.kernel != "projected" || !scene.projected || scene.projected->surfaces != AtSurfaces::extended)
    return;
  if (const auto stage = std::ranges::find_if(stages, &Stage::seeks_rest); stage != stages.end())
    warnings.push_back(
        fmt::format("{}: stage \"{}\" seeks rest and may not find it: with `projected: {{surfaces: extended}}` material beside a "
                    "free surface creeps along it under its weight; leave the key out",
                    to_string(stage->where), stage->name));
}

}  // namespace

template <int D>
Setup<D> set_up(const Scene& scene, const Mesh<D>& mesh, Communicator& ranks)
{
  SceneErrorCollector errors(scene);
  Setup<D> setup;
  setup.warnings = mesh.notes();
  Seeds<D> seeds = seed(scene, mesh, ranks, errors, setup.warnings);
  setup.state.particles = std::move(seeds.particles);
  setup.n_particles = seeds.n_particles;
  setup.state.bodies = std::move(seeds.bodies);
  setup.state.materials = std::move(seeds.materials);
  setup.origin = std::move(seeds.origin);
  setup.state.clock.lag = seeds.lag;
  setup.state.energy.largest_before = seeds.largest_before;
  setup.state.flow.begun = seeds.water_flows_on;
  setup.state.empty_cells = std::move(seeds.empty_cells);
  const CellOccupancy<D> has_particles(mesh, setup.state.particles, setup.state.bodies, ranks, [](const std::string&) { return true; });
  const CellOccupancy<D> at_start(mesh, setup.state.particles, setup.state.bodies, ranks,
                                  [&](const std::string& body) { return presence_of(body, scene.stages).from == 0; });
  const std::string first_stage = scene.stages.empty() ? "" : changes_of(scene.stages.front()).label;
  add_boundaries(scene, mesh, at_start, ranks, first_stage, true, errors, setup, setup.state.boundary);
  add_loads(scene, mesh, has_particles, at_start, ranks, errors, setup);
  setup.conditions.contacts = contacts_of(scene, setup.state.bodies, errors, setup.warnings);
  for (const ContactLaw& law : setup.conditions.contacts.laws)
    setup.notes.push_back(describe(law));
  setup.conditions.cuts = cuts_of(scene);
  for (const CutLaw& law : setup.conditions.cuts)
    setup.notes.push_back(describe(law));
  setup.conditions.references = references_of(scene);
  for (std::size_t body = 0; body < scene.bodies.size(); ++body)
    if (const ReferenceOptions& reference = setup.conditions.references[body]; reference.update != ReferenceUpdate::always)
      setup.notes.push_back(describe(scene.bodies[body].name, reference));
  setup.conditions.resampling = resampling_of(scene);
  for (std::size_t body = 0; body < scene.bodies.size(); ++body)
    if (const std::optional<ResampleOptions>& resample = setup.conditions.resampling[body])
      setup.notes.push_back(describe(scene.bodies[body].name, *resample));
  add_rigid_bodies(scene, mesh, ranks, errors, setup);
  warn_of_thin_layers(scene, mesh, setup.state.particles, setup.state.bodies, setup.state.materials, setup.conditions.contacts, ranks,
                      setup.warnings);
  warn_of_coarse_cells(scene, mesh, setup.state.particles, setup.state.bodies, setup.state.materials, ranks, setup.warnings);
  set_stages(scene, errors, setup);
  warn_of_creeping_surfaces(scene, setup.stages, setup.warnings);
  setup.conditions.water = water_of(
      scene, mesh, setup.state.bodies, [&](Index cell) { return at_start(cell); }, errors, setup.warnings);
  setup.conditions.flow = flow_of(scene, mesh, at_start, setup.state.bodies, errors, setup.warnings);
  for (MeshTraction<D>& load : open_water_of(scene, mesh, at_start))
    setup.conditions.loads.on_mesh.push_back(std::move(load));
  for (SurfaceLoad<D>& load : pond_of<D>(scene, setup.conditions.flow, setup.state.bodies))
    setup.conditions.loads.on_surfaces.push_back(std::move(load));
  saturate(scene, 0, mesh, setup.conditions.water, setup.state.bodies, setup.state.particles);
  set_start_states(scene, mesh, ranks, errors, setup);
  if (scene.water && scene.water->table) {
    warn_if_dry(mesh, ranks, setup);
    warn_of_suction(mesh, ranks, setup);
  }
  check_laws(scene, errors);
  check_room(scene, mesh, setup, ranks, errors);
  check_overlaps(scene, mesh, setup, ranks, errors);
  check_outputs<D>(scene, mesh, setup.conditions.loads.gravity.acceleration, errors);
  ranks.agree(Communicator::caught([&] { errors.throw_if_any(); }));

  setup.conditions.exits.policy = scene.on_exit;
  setup.limits.cfl = scene.time.cfl.value();
  setup.limits.longest = scene.time.max_step.value_or(setup.limits.longest);
  setup.limits.shortest = scene.time.min_step;
  const auto from_start = [](const BodyForce<D>& load) { return load.at_start; };
  if (setup.state.particles.x0.empty() &&
      (scene.script || wants_displacement(scene.outputs) || std::ranges::any_of(setup.conditions.loads.of_place, from_start)))
    setup.state.particles.x0 = setup.state.particles.x;
  setup.conditions.limits = run_limits_of(scene, mesh, setup, ranks);
  set_changes(scene, mesh, ranks, setup);
  const Gravity<D>& gravity = setup.conditions.loads.gravity;
  setup.conditions.transfer =
      scene.transfer.with_damping(fall_time(mesh, has_particles, gravity.table.largest_magnitude() * gravity.acceleration.norm()),
                                  any_flows(setup.state.materials, setup.laws));
  setup.from_files = digest_of_files(scene, setup);
  return setup;
}

template <int D>
void restrict_to(const Subdomain& subdomain, Setup<D>& setup)
{
  setup.state.boundary.restrict_to(subdomain);
  restrict_to(subdomain, setup.conditions.water);
  restrict_to(subdomain, setup.conditions.flow);
  for (MeshTraction<D>& load : setup.conditions.loads.on_mesh)
    restrict_to(subdomain, load);
}

template void restrict_to<2>(const Subdomain&, Setup<2>&);
template void restrict_to<3>(const Subdomain&, Setup<3>&);
template Setup<2> set_up<2>(const Scene&, const Mesh<2>&, Communicator&);
template Setup<3> set_up<3>(const Scene&, const Mesh<3>&, Communicator&);

}  // namespace talus
