#include "app/setup/initial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "app/setup/expression.hpp"
#include "app/setup/laws_in_force.hpp"
#include "app/setup/setup.hpp"
#include "core/parallel/threads.hpp"
#include "io/scene/reader.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

template <class Item>
std::vector<std::string> names_of(const std::vector<Item>& items)
{
  std::vector<std::string> names;
  for (const Item& item : items)
    names.push_back(item.name);
  return names;
}

Index number_of(const std::string& name, const std::vector<std::string>& names)
{
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? none : static_cast<Index>(found - names.begin());
}

/// Which body there becomes which body of the scene.
std::vector<Index> match_bodies(const Scene& scene, const std::vector<std::string>& there, const std::string& run,
                                SceneErrorCollector& errors)
{
  std::vector<Index> source(scene.bodies.size(), none);
  const auto mine = names_of(scene.bodies);
  for (const TakenSpec& taken : scene.initial->bodies) {
    const std::string& name = taken.from.empty() ? taken.body : taken.from;
    const Index from = number_of(name, there);
    source[static_cast<std::size_t>(number_of(taken.body, mine))] = from;
    if (from == none)
      errors.add(taken.where, taken.from.empty() ? "body" : "from",
                 fmt::format("there is no body \"{}\" in {}{}", name, run, suggestion(name, there)));
  }
  if (!scene.initial->bodies.empty())
    return source;
  for (std::size_t b = 0; b < mine.size(); ++b) {
    const BodySpec& body = scene.bodies[b];
    source[b] = number_of(body.name, there);
    if (source[b] == none && !body.fills())
      errors.add(body.where, "",
                 fmt::format("one of region or shape is needed, or a source in initial.bodies: there is no body \"{}\" in {}{}", body.name,
                             run, suggestion(body.name, there)));
    if (source[b] != none && body.fills())
      errors.add(body.where, body.shape ? "shape" : "region",
                 fmt::format("body \"{}\" takes its particles from the one of its name in {}: leave this out, or list in "
                             "initial.bodies those that do",
                             body.name, run));
  }
  if (std::all_of(source.begin(), source.end(), [](Index from) { return from == none; }) &&
      std::all_of(scene.bodies.begin(), scene.bodies.end(), [](const BodySpec& body) { return body.fills(); }))
    errors.add(scene.initial->where, "from",
               fmt::format("no body of this scene has the name of one in {}, which has {}; say in initial.bodies which takes which", run,
                           or_list(there)));
  return source;
}

/// The scene of that run as it was run.
Scene scene_of(const RunIdentity& identity)
try {
  return read_scene_text(identity.scene_file, identity.scene_text, identity.set);
} catch (const SceneErrors& e) {
  throw EnvironmentError(fmt::format("this program does not understand its scene: {}", e.problems().front().message));
}

template <int D>
KeptBodies<D> bodies_of(const Scene& scene)
{
  KeptBodies<D> saved;
  for (const BodySpec& body : scene.bodies)
    saved.bodies.push_back({body.name, 0, 0, body.where});
  saved.laws = laws_of_stages(scene);
  return saved;
}

/// Whether the state is the one that a stage ended with, or a later stage began with.
template <int D>
bool ends_a_stage(const KeptBodies<D>& there)
{
  return there.stage.done || (there.stage.number > 0 && there.clock.step == there.stage.first_step);
}

template <int D>
void warn(const Scene& scene, const RunIdentity& identity, const CheckpointList::Read& read, const KeptBodies<D>& there,
          std::vector<std::string>& warnings)
{
  const std::string where = to_string(scene.initial->where);
  if (!read.reasons.empty())
    warnings.push_back(fmt::format("{}: {}; taking {}", where, read.reasons, read.file.string()));
  if (identity.quick)
    warnings.push_back(fmt::format("{}: {} was left by a quick run, coarse and short", where, read.file.string()));
  if (!ends_a_stage(there))
    warnings.push_back(fmt::format(
        "{}: {} is the state after step {}, t = {:.6g} s, before its stage was over: of a run on its way, stopped or failed, or "
        "one that did not keep its end; with outputs.checkpoint.at_end a run keeps it",
        where, read.file.string(), there.clock.step, there.clock.time));
  if (const auto* stage = scene.stages.empty() ? nullptr : std::get_if<GeostaticSpec>(&scene.stages.front());
      stage != nullptr && stage->ramp > 0)
    warnings.push_back(
        fmt::format("{}: gravity grows from nothing (ramp) under bodies that carry their stress already; without ramp they stay at rest",
                    to_string(stage->where)));
}

}  // namespace

template <int D>
std::optional<InitialState<D>> find_initial_state(const Scene& scene, SceneErrorCollector& errors, std::vector<std::string>& warnings)
{
  if (!scene.initial)
    return std::nullopt;
  const SourceLocation& where = scene.initial->where;
  try {
    const CheckpointList list((folder_of(scene) / scene.initial->from).lexically_normal());
    const RunIdentity& identity = list.identity();
    const Scene other = scene_of(identity);
    if (other.dimension != D) {
      errors.add(where, "from", fmt::format("the bodies there are of {} dimensions, this scene has {}", other.dimension, D));
      return std::nullopt;
    }
    InitialState<D> state;
    state.there = bodies_of<D>(other);
    const CheckpointList::Read read = list.read(state.there);
    warn(scene, identity, read, state.there, warnings);
    state.source = match_bodies(scene, names_of(other.bodies), read.file.string(), errors);
    state.origin = {.file = fs::absolute(read.file).string(),
                    .title = other.title,
                    .scene_file = identity.scene_file,
                    .version = identity.version,
                    .commit = identity.commit,
                    .mesh_digest = fmt::format("{:016x}", static_cast<std::uint64_t>(identity.mesh)),
                    .step = state.there.clock.step,
                    .time = state.there.clock.time,
                    .bodies = {}};
    return state;
  } catch (const EnvironmentError& e) {
    errors.add(where, "from", e.what());
    return std::nullopt;
  }
}

/// Water that flows goes on with its pressures if all bodies through which it flows here have particles of bodies through which it flowed there.
template <int D>
bool carry_flow(const Scene& scene, const KeptBodies<D>& there, std::span<const TakenParticles> all, const std::vector<Body>& bodies,
                Particles<D>& p)
{
  const Particles<D>& from = there.particles;
  if (!scene.water || !scene.water->flow || !there.flow.begun || from.water.empty())
    return false;
  const auto flows = [&](const std::string& body) {
    return std::ranges::any_of(scene.water->flow->bodies, [&](const PoresSpec& one) { return one.body == body; });
  };
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (flows(bodies[b].name) && std::ranges::find(all, b, &TakenParticles::body) == all.end())
      return false;
  p.water.assign(p.id.size(), 0);
  p.water_gradient.assign(p.id.size(), Vec<D>::Zero());
  p.water_at_rest.assign(p.id.size(), 0);
  for (const TakenParticles& taken : all)
    if (flows(bodies[taken.body].name))
      for_each_pair(bodies[taken.body].begin, taken.rows, [&](std::size_t row, std::size_t source) {
        p.water.set(row, from.water[source]), p.water_gradient.set(row, from.water_gradient[source]);
        p.water_at_rest.set(row, from.water_at_rest[source]);
      });
  return true;
}

template <int D>
bool carry_columns(const Scene& scene, const KeptBodies<D>& other, std::span<const TakenParticles> all, const std::vector<Body>& bodies,
                   const std::vector<Material>& materials, SceneErrorCollector& errors, Particles<D>& p)
{
  const Particles<D>& from = other.particles;
  const auto n = p.id.size();
  const auto for_each_taken = [&](auto&& f) {
    for (const TakenParticles& taken : all)
      for_each_pair(bodies[taken.body].begin, taken.rows, [&](std::size_t row, std::size_t source) { f(taken, row, source); });
  };
  if (scene.transfer.own_affine_field() && !from.C.empty()) {
    p.C = p.L;
    if (scene.initial->velocity == Carried::keep)
      for_each_taken([&](const TakenParticles&, std::size_t row, std::size_t there) { p.C.set(row, from.C[there]); });
  }
  if (scene.initial->displacement == Carried::keep && from.x0.empty()) {
    errors.add(scene.initial->where, "displacement", "the run there kept none: it wrote neither displacements nor points");
  } else if (scene.initial->displacement == Carried::keep) {
    p.x0 = p.x;
    for_each_taken([&](const TakenParticles&, std::size_t row, std::size_t there) { p.x0.set(row, from.x0[there]); });
  }
  if (!from.volume_ratio.empty() && std::ranges::any_of(materials, [](const Material& one) { return one.averages_volume; })) {
    p.volume_ratio.assign(n, 1);
    for_each_taken([&](const TakenParticles&, std::size_t row, std::size_t there) { p.volume_ratio.set(row, from.volume_ratio[there]); });
  }
  if (!from.jump_stress.empty()) {
    p.jump_stress.assign(n, Mat<D>::Zero());
    for_each_taken([&](const TakenParticles& taken, std::size_t row, std::size_t there) {
      if (taken.law == materials[taken.body].law().name())
        p.jump_stress.set(row, from.jump_stress[there]);
    });
  }
  if (!from.viscous.empty()) {
    if (std::ranges::any_of(materials, [](const Material& one) { return one.viscosity.has_value(); }))
      p.viscous.assign(n, 0);
    for_each_taken([&](const TakenParticles& taken, std::size_t row, std::size_t there) {
      if (materials[taken.body].viscosity)
        p.viscous.set(row, from.viscous[there]);
      else
        p.stress.set(row, add_diagonal(p.stress[row], from.viscous[there]));
    });
  }
  if (!from.pore.empty()) {
    if (scene.water)
      p.pore.assign(n, 0);
    for_each_taken([&](const TakenParticles& taken, std::size_t row, std::size_t there) {
      if (!scene.water)  // it is gone, and the effective stress is all there is
        p.stress.set(row, add_diagonal(p.stress[row], from.pore[there]));
      else if (is_drained(*scene.water, bodies[taken.body].name))
        p.pore.set(row, from.pore[there]);  // of others the stress stays in total
    });
  }
  return carry_flow(scene, other, all, bodies, p);
}

void carry_history(const Material& from, std::span<const Index> rows, Material& to)
{
  for (const HistoryVariable& variable : to.law().variables())
    for (const HistoryVariable& source : from.law().variables())
      if (variable.key == source.key && variable.components == source.components)
        parallel_for(to.history.size(), [&](Index i) {
          for (int c = 0; c < variable.components; ++c)
            history_value(to, variable, i, c) = history_value(from, source, rows[static_cast<std::size_t>(i)], c);
        });
}

template <int D>
Real settle_stress(const Body& body, std::string_view law_there, Real dt, Communicator& ranks, Material& material, Particles<D>& particles)
{
  constexpr Real round_off = 1e-6;  // relative to the largest stress: chosen when stresses could be in single precision
  const auto compare = [&](bool take_over) {
    const StressFit here = fit_stress(body, material, dt, take_over, particles);
    return StressFit{ranks.max(here.largest), ranks.max(here.apart)};
  };
  const auto fits = [&](const StressFit& fit) { return fit.apart <= round_off * fit.largest; };
  if (material.law().name() == law_there && fits(compare(false)))
    return 0;
  if (material.law().description().starts_from_stress)
    start_from_stress(body, material, particles);
  const StressFit fit = compare(false);
  if (fits(fit))
    return 0;
  compare(true);
  return fit.apart / fit.largest;
}

template bool carry_columns<2>(const Scene&, const KeptBodies<2>&, std::span<const TakenParticles>, const std::vector<Body>&,
                               const std::vector<Material>&, SceneErrorCollector&, Particles<2>&);
template bool carry_columns<3>(const Scene&, const KeptBodies<3>&, std::span<const TakenParticles>, const std::vector<Body>&,
                               const std::vector<Material>&, SceneErrorCollector&, Particles<3>&);
template Real settle_stress<2>(const Body&, std::string_view, Real, Communicator&, Material&, Particles<2>&);
template Real settle_stress<3>(const Body&, std::string_view, Real, Communicator&, Material&, Particles<3>&);
template std::optional<InitialState<2>> find_initial_state<2>(const Scene&, SceneErrorCollector&, std::vector<std::string>&);
template std::optional<InitialState<3>> find_initial_state<3>(const Scene&, SceneErrorCollector&, std::vector<std::string>&);

template <int D>
void set_velocity(const BodySpec& spec, const Mesh<D>& mesh, Communicator& ranks, Index begin, Index end, SceneErrorCollector& errors,
                  Particles<D>& particles)
{
  if (spec.velocity.empty())
    return;
  const auto first = static_cast<std::size_t>(begin), count = static_cast<std::size_t>(end - begin);
  std::vector<Vec3> places(count, Vec3::Zero());
  std::vector<Real> sizes(count);  // of cells [m]
  for (std::size_t p = 0; p < count; ++p) {
    places[p].template head<D>() = particles.x[first + p];
    sizes[p] = std::pow(mesh.volume(particles.cell[first + p]), Real{1} / D);
  }
  for (int d = 0; d < D; ++d) {
    std::string wrong;
    try {
      const std::string& formula = spec.velocity[static_cast<std::size_t>(d)];
      const auto values = evaluate(formula, places);
      const auto slopes = gradients(formula, places, sizes);
      for (std::size_t p = 0; p < count; ++p) {
        Vec<D> v = particles.v[first + p];
        v[d] = values[p];
        particles.v.set(first + p, v);
        Mat<D> L = particles.L[first + p];
        L.row(d) = slopes[p].template head<D>();
        particles.L.set(first + p, L);
      }
    } catch (const std::invalid_argument& e) {
      wrong = e.what();
    }
    if (wrong = ranks.first(wrong); !wrong.empty())
      errors.add(spec.where, fmt::format("velocity[{}]", d), wrong);
  }
}

template void set_velocity<2>(const BodySpec&, const Mesh<2>&, Communicator&, Index, Index, SceneErrorCollector&, Particles<2>&);
template void set_velocity<3>(const BodySpec&, const Mesh<3>&, Communicator&, Index, Index, SceneErrorCollector&, Particles<3>&);

}  // namespace talus
