#include "app/run/summary.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel/communicator.hpp"
#include "core/parallel/threads.hpp"
#include "core/version.hpp"
#include "io/system/memory.hpp"
#include "mesh/digest.hpp"
#include "mesh/quality.hpp"

namespace talus {

namespace {

/// The energy balance of one stage [J].
EnergyNow balance_of(const StageResult& stage)
{
  const EnergyLedger& e = stage.energy;
  EnergyNow now;
  now.kinetic_start = e.kinetic_start;
  now.kinetic = stage.kinetic_end;
  now.plastic = stage.plastic_end - e.plastic_start + e.plastic_deleted;
  now.strain = e.internal - now.plastic;
  now.friction = 0 - e.friction;  // avoids -0
  now.damping = 0 - e.damping;
  now.carried_away = e.carried_away;
  now.resampled = e.resampled;
  now.gravity = e.gravity;
  now.loads = e.loads;
  now.walls = e.walls;
  now.size = e.largest_seen;
  now.transfer = e.transfer(stage.kinetic_end);
  now.defect = e.defect(stage.kinetic_end);
  return now;
}

std::array<std::pair<std::string_view, Real>, 12> terms_of(const EnergyNow& e)
{
  return {{{"gravity_work", e.gravity},
           {"load_work", e.loads},
           {"wall_work", e.walls},
           {"kinetic_start", e.kinetic_start},
           {"kinetic", e.kinetic},
           {"strain", e.strain},
           {"plastic", e.plastic},
           {"friction", e.friction},
           {"damping", e.damping},
           {"carried_away", e.carried_away},
           {"transfer_loss", e.transfer},
           {"energy_defect", e.defect}}};
}

template <int D>
std::vector<NamedValue> named(const MeshQuality<D>& q)
{
  return {{"smallest_mean_ratio", q.smallest_mean_ratio, ""},
          {"smallest_altitude", q.smallest_altitude, "m"},
          {"median_altitude", q.median_altitude, "m"},
          {"gradation", q.gradation, ""}};
}

/// Criteria for balances that the method satisfies to round-off, and for those that depend on time step and mesh.
constexpr Real exactly = 1e-9, roughly = 5e-2;

Closure closure_of(const EnergyNow& e) { return {share(e.defect, e.largest_term()), roughly, "largest term"}; }

template <int D>
MassAudit audit(const MassLedger<D>& mass, Real there)
{
  MassAudit audit{.start = mass.start, .end = there, .removed = mass.deleted, .particles_removed = mass.deleted_count};
  audit.placed = mass.placed, audit.particles_placed = mass.placed_count;
  audit.taken = mass.taken, audit.particles_taken = mass.taken_count;
  audit.closure = {share(there - mass.due(), mass.start + mass.placed), exactly,
                   mass.placed > 0 ? "mass at the start and placed" : "mass at the start"};
  return audit;
}

template <int D>
EnergyAudit audit(const Recorder<D>& recorder)
{
  EnergyAudit audit;
  const EnergyNow& total = recorder.last_seen().energy;
  for (const auto& [name, value] : terms_of(total))
    audit.terms.push_back({std::string(name), value, "J"});
  if (total.resampled != 0)
    audit.terms.push_back({"resampled", total.resampled, "J"});
  if (total.dissipated() > 0)
    audit.terms.push_back({"unexplained / dissipated", share(total.defect, total.dissipated()), ""});
  for (std::size_t s = 0; recorder.stages().size() > 1 && s < recorder.stages().size(); ++s) {
    const StageResult& stage = recorder.stages()[s];
    const EnergyNow balance = balance_of(stage);
    const std::string prefix = fmt::format("stage {} {}: ", s, stage.name);
    for (const auto& [name, value] : terms_of(balance))
      audit.terms.push_back({prefix + std::string(name), value, "J"});
    if (balance.resampled != 0)
      audit.terms.push_back({prefix + "resampled", balance.resampled, "J"});
    if (balance.dissipated() > 0)
      audit.terms.push_back({prefix + "unexplained / dissipated", share(balance.defect, balance.dissipated()), ""});
  }
  audit.closure = closure_of(total);
  return audit;
}

/// The main results of a slide; empty if nothing has moved.
std::string run_out_lines(const std::vector<NamedValue>& runout)
{
  const auto value = [&](std::string_view name) {
    const auto found = std::find_if(runout.begin(), runout.end(), [&](const NamedValue& number) { return number.name == name; });
    return found == runout.end() ? 0 : found->value;
  };
  if (!(value("volume") > 0))
    return runout.empty() ? "" : "run-out: nothing has moved\n";
  std::string text =
      fmt::format("run-out: H {:.4g} m, L {:.4g} m, H/L {:.3g} (angle of reach {:.3g} deg); of the centre of mass H/L {:.3g}\n", value("H"),
                  value("L"), value("H/L"), value("angle_of_reach"), value("centre_H/L"));
  const auto volume = std::find_if(runout.begin(), runout.end(), [](const NamedValue& number) { return number.name == "volume"; });
  text += fmt::format("  moved {:.4g} {}, at most {:.3g} m thick, at most {:.3g} m/s\n", volume->value, volume->unit,
                      value("largest_thickness"), value("largest_speed"));
  const Real share = value("mass_share");
  const std::string speeds =
      fmt::format("{:.3g} m/s on average, {} {:.3g} m/s", value("mean_speed"),
                  share < 1 ? fmt::format("{:.3g} % of the mass faster than", 100 * (1 - share)) : "the fastest", value("bulk_speed"));
  return text + (std::isnan(value("stopped")) ? fmt::format("  still moving: {}\n", speeds)
                                              : fmt::format("  at rest since t = {:.4g} s: {}\n", value("stopped"), speeds));
}

template <class Vector>
std::vector<Real> numbers(const Vector& v)
{
  return {v.begin(), v.end()};
}
/// In 2-D only one component can differ from zero.
template <int D>
std::vector<Real> turning(const Vec3& v)
{
  return D == 2 ? std::vector{v[2]} : numbers(v);
}

template <int D>
MomentumAudit audit(const MomentumNow<D>& now)
{
  return {numbers(now.start.linear),
          numbers(now.end.linear),
          numbers(now.given.linear),
          {now.linear_defect(), now.most_linear_defect, "momenta at the start and impulses"}};
}
template <int D>
MomentumAudit angular_audit(const MomentumNow<D>& now)
{
  return {turning<D>(now.start.angular), turning<D>(now.end.angular),
          turning<D>(now.given.angular), {now.angular_defect(), roughly, "moments of these"},
          turning<D>(now.lost),          now.angular_loss()};
}

std::string in_words(std::string_view what, const Closure& closure)
{
  return closure.closes() ? fmt::format("{} closes to {:.2g}", what, closure.relative)
                          : fmt::format("{} DOES NOT CLOSE: {:.2g} of the {} is not accounted for, allowed {:.2g}", what, closure.relative,
                                        closure.relative_to, closure.limit);
}

}  // namespace

std::string scene_digest(const Scene& scene)
{
  std::string inputs = scene.text;
  for (const std::string& change : scene.overrides)
    inputs += '\n' + change;
  return digest_text(digest(inputs));
}

std::string digest_text(std::uint64_t digest) { return fmt::format("{:016x}", digest); }

template <int D>
RunSummary begin_summary(const Scene& scene, const Mesh<D>& mesh, std::uint64_t mesh_digest, const Setup<D>& setup)
{
  RunSummary s;
  s.title = scene.title;
  s.scene_file = scene.file;
  s.scene_text = scene.text;
  s.overrides = scene.overrides;
  const Version v = version();
  s.version = v.number, s.commit = v.commit, s.compiler = v.compiler;
  s.build = build_of(v);
  s.status = RunStatus::failed;
  s.message = message_before_the_end;
  s.dimension = scene.dimension;
  s.kernel = scene.kernel;
  s.transfer = describe(setup.conditions.transfer);
  s.ranks.count = world().size();
  s.threads = threads();
  s.mesh_nodes = mesh.n_nodes();
  s.mesh_cells = mesh.n_cells();
  s.scene_digest = scene_digest(scene);
  s.mesh_digest = digest_text(mesh_digest);
  s.mesh_quality = named(quality(mesh));
  s.watch.speed_limit = setup.conditions.limits.speed;
  s.watch.gain_limit = setup.conditions.limits.gain;
  s.warnings = setup.warnings;
  s.origin = setup.origin;
  s.start_states = setup.start_states;
  return s;
}

template <int D>
void complete(const Recorder<D>& recorder, bool quick, RunSummary& s)
{
  const LastSeen<D>& last = recorder.last_seen();
  s.bodies = recorder.bodies();
  s.runout = recorder.runout().numbers();
  s.files.assign(recorder.files().begin(), recorder.files().end());
  for (const StageResult& stage : recorder.stages()) {
    const bool at_rest = stage.kind != "run";
    const bool starts_from_table = s.stages.empty() && !s.start_states.empty();
    const auto if_sought = [](bool sought, Real residual) { return sought ? std::optional(residual) : std::nullopt; };
    s.stages.push_back({stage.kind, stage.steps, stage.end - stage.start, if_sought(at_rest, stage.residual),
                        quick     ? "quick"
                        : at_rest ? "at rest"
                                  : "done",
                        if_sought(at_rest || starts_from_table, stage.first_residual), stage.name});
  }
  s.changes = recorder.changes();
  s.steps = last.clock.step;
  s.simulated_time = last.clock.time;
  const Timings& t = last.timings;
  const Real in_steps = t.locate + t.scatter + t.nodes + t.gather + t.stress;
  s.particle_steps_per_second = in_steps > 0 ? t.particle_steps / in_steps : 0;
  s.bytes_per_particle = recorder.bytes_per_particle();
  s.ranks = recorder.ranks();
  s.peak_memory_bytes = static_cast<std::int64_t>(peak_memory());
  if (!recorder.stages().empty()) {
    s.energy = audit(recorder);
    s.momentum = audit(last.momentum);
    s.angular_momentum = angular_audit(last.momentum);
  }
  s.mass = audit(last.mass, last.mass_there);
  s.watch.fastest = last.monitor.fastest, s.watch.gain = last.monitor.gain;
  s.watch.speeding = last.monitor.speeding, s.watch.gaining = last.monitor.gaining;
  if (last.monitor.speeding > 0)
    s.warnings.push_back(fmt::format("particles moved at up to {:.4g} m/s, beyond watch.speed = {:.4g} m/s, in {} steps",
                                     last.monitor.fastest, s.watch.speed_limit, last.monitor.speeding));
  if (last.monitor.gaining > 0)
    s.warnings.push_back(
        fmt::format("the energy grew by what nothing did work for, up to {:.3g} of its largest term, beyond watch.energy_gain = {:.3g}",
                    last.monitor.gain, s.watch.gain_limit));
  if (last.mass.failed_count > 0)
    s.warnings.push_back(fmt::format("{} particles of {:.3g} kg failed and were deleted; the last: {}", last.mass.failed_count,
                                     last.mass.failed, last.monitor.failure));
  if (last.mass.held_count > 0)
    s.warnings.push_back(fmt::format("particles were set back onto closed walls {} times, by at most {:.3g} m", last.mass.held_count,
                                     last.mass.largest_set_back));
}

template <int D>
std::string table(const Recorder<D>& recorder, const RunSummary& summary)
{
  const LastSeen<D>& last = recorder.last_seen();
  std::string text = fmt::format("{:<16}", "energy [J]");
  std::vector<EnergyNow> balances;
  for (const StageResult& stage : recorder.stages()) {
    text += fmt::format("{:>14}", stage.name);
    balances.push_back(balance_of(stage));
  }
  text += '\n';
  for (std::size_t k = 0; k < terms_of({}).size(); ++k) {
    text += fmt::format("  {:<14}", terms_of({})[k].first);
    for (const EnergyNow& balance : balances)
      text += fmt::format("{:>14.5g}", terms_of(balance)[k].second);
    text += '\n';
  }
  const auto line = [&](std::string_view name, auto&& f) {
    text += fmt::format("  {:<14}", name);
    for (const EnergyNow& balance : balances)
      text += fmt::format("{:>14}", f(balance));
    text += '\n';
  };
  line("open/largest", [](const EnergyNow& b) { return fmt::format("{:.2g}", share(b.defect, b.largest_term())); });
  line("open/dissip.",
       [](const EnergyNow& b) { return b.dissipated() > 0 ? fmt::format("{:.2g}", share(b.defect, b.dissipated())) : std::string("-"); });
  text += run_out_lines(recorder.runout().numbers());
  for (const StageResult& stage : recorder.stages())
    if (stage.solve.increments > 0)
      text += fmt::format("stage {}: {} increments solved, {} cut, in {} iterations of Newton's method and {} of linear systems\n",
                          stage.name, stage.solve.increments, stage.solve.cuts, stage.solve.iterations, stage.solve.linear_iterations);
  for (const StageSummary& stage : summary.stages)
    if (stage.residual)
      text += fmt::format("stage {}: unbalanced force {:.3g} of the loads, {:.3g} when it began\n", stage.name, *stage.residual,
                          stage.first_residual.value_or(0));
    else if (stage.first_residual)
      text += fmt::format("stage {}: unbalanced force {:.3g} of the loads when it began\n", stage.name, *stage.first_residual);
  if (last.resampling.splits + last.resampling.merges > 0)
    text += fmt::format("{} particles were split and {} merged into others, which took {:.4g} J of kinetic energy\n",
                        last.resampling.splits, last.resampling.merges, last.energy.resampled);
  text += fmt::format("mass {:.6g} kg", last.mass.start);
  if (last.mass.placed > 0)
    text += fmt::format(", and {:.6g} kg ({} particles) that stages placed", last.mass.placed, last.mass.placed_count);
  if (last.mass.taken > 0)
    text += fmt::format(", of which stages took {:.6g} kg ({} particles)", last.mass.taken, last.mass.taken_count);
  if (last.mass.deleted_count > 0)
    text += fmt::format(", of which {:.6g} kg ({} particles) left the mesh or failed", last.mass.deleted, last.mass.deleted_count);
  return text + fmt::format("\naudit: {}; {}; {}; {}\n", in_words("mass", audit(last.mass, last.mass_there).closure),
                            in_words("momentum", audit(last.momentum).closure),
                            in_words("angular momentum", angular_audit(last.momentum).closure) +
                                fmt::format(" (transfer loses {:.2g})", last.momentum.angular_loss()),
                            in_words("energy", closure_of(last.energy)));
}

template RunSummary begin_summary<2>(const Scene&, const Mesh<2>&, std::uint64_t, const Setup<2>&);
template RunSummary begin_summary<3>(const Scene&, const Mesh<3>&, std::uint64_t, const Setup<3>&);
template void complete<2>(const Recorder<2>&, bool, RunSummary&);
template void complete<3>(const Recorder<3>&, bool, RunSummary&);
template std::string table<2>(const Recorder<2>&, const RunSummary&);
template std::string table<3>(const Recorder<3>&, const RunSummary&);

}  // namespace talus
