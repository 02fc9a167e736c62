// The commands talus check, and talus run --dry-run.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/commands/check_command.hpp"
#include "app/commands/run_command.hpp"
#include "app/run/cost_estimate.hpp"
#include "app/run/thread_choice.hpp"
#include "app/setup/checks/kernel_choice.hpp"
#include "app/setup/quick.hpp"
#include "app/setup/water_table.hpp"
#include "core/display_text.hpp"
#include "core/finite_count.hpp"
#include "core/parallel/threads.hpp"
#include "core/stop_watch.hpp"
#include "io/load_mesh.hpp"
#include "io/scene/reader.hpp"
#include "io/scene/scene.hpp"
#include "io/terrain/terrain_mesh.hpp"
#include "mesh/quality.hpp"

namespace talus {

namespace {

constexpr Real megabyte = 1e6, million = 1e6;
/// Limits of the time of a whole run relative to the same number of steps at its start: faster particles need shorter steps, particles at
/// rest less work.  For four of scenes/ the ratio was 1.1 to 2.0, on a machine with other work.
constexpr Real quicker_steps = 0.8, slower_steps = 2.1;

/// A number of steps; two numbers if stages may end early.
struct StepRange {
  std::int64_t least = 0, most = 0;
  StepRange& operator+=(const StepRange& other) noexcept
  {
    least = counted_sum(least, other.least), most = counted_sum(most, other.most);
    return *this;
  }
  Real middle() const noexcept { return static_cast<Real>(least + most) / 2; }
};

std::int64_t steps_of(Real time, Real dt) { return counted(std::ceil(time / dt * (1 - 1e-9))); }
StepRange steps_of(const RestTime& time, Real dt) { return {steps_of(time.soonest, dt), steps_of(time.latest, dt)}; }

/// The range as text, "12" or "12 to 40", multiplied by a factor.
std::string in_words(const StepRange& range, Real factor = 1)
{
  const auto word = [&](std::int64_t n) { return factor == 1 ? count_in_words(n) : fmt::format("{:.3g}", static_cast<Real>(n) * factor); };
  return range.least == range.most ? word(range.least) : fmt::format("{} to {}", word(range.least), word(range.most));
}

/// A line for each stage that ends in equilibrium, whose number of steps is not known beforehand.
std::string describe_rest(const std::vector<Stage>& stages, Real passage, Real dt)
{
  std::string text;
  for (std::size_t s = 0; s < stages.size(); ++s)
    if (const Stage& stage = stages[s]; stage.residual) {
      const RestTime time = time_to_rest(stage, passage);
      text += fmt::format("  stage {} \"{}\" ends at rest, usually after {:.2g} to {:.2g} s, {} steps; at most {:.6g} s, {} steps\n", s,
                          stage.name, time.soonest, time.latest, in_words(steps_of(time, dt)), stage.duration,
                          count_in_words(steps_of(stage.duration, dt)));
    }
  return text;
}

std::string in_megabytes(Real bytes) { return fmt::format("{:.3g} MB", bytes / megabyte); }

/// The files and their sizes, without kinds that do not exist.
std::string describe_disk_use(const FileSizes& one, const DiskUse& use)
{
  std::string text = fmt::format("  disk: at most {} before compression:", in_megabytes(use.bytes));
  const auto add = [&](std::int64_t number, const char* what, Real each) {
    if (number > 0)
      text += fmt::format("{} {} {} of {}", text.ends_with(':') ? "" : ",", count_in_words(number), what, in_megabytes(each));
  };
  add(use.particle_files, "particle files", one.particles);
  add(use.mesh_files, "mesh files", one.mesh);
  add(use.history_rows > 0 ? 1 : 0, "history", static_cast<Real>(use.history_rows) * one.history_row);
  add(use.checkpoints, "checkpoints", one.checkpoint);
  return text + "\n";
}

/// A line for each change by a stage.
template <int D>
std::string describe_changes(const Setup<D>& setup)
{
  std::string text;
  for (std::size_t s = 0; s < setup.changes.size(); ++s) {
    const StageChange<D>& change = setup.changes[s];
    const auto add = [&](const std::string& what) { text += fmt::format("  stage {} \"{}\": {}\n", s, setup.stages[s].name, what); };
    const auto name = [&](Index b) -> const std::string& { return setup.state.bodies[static_cast<std::size_t>(b)].name; };
    for (const Index b : change.vanish)
      add(fmt::format("body \"{}\" vanishes", name(b)));
    for (const auto& [b, becomes] : change.renew)
      add(fmt::format("body \"{}\" {}", name(b), becomes));
    for (const Index b : change.appear)
      add(fmt::format("body \"{}\" appears, {} particles", name(b), change.coming.bodies[static_cast<std::size_t>(b)].size()));
    for (const std::string& what : change.told)
      add(what);
  }
  return text;
}

std::string describe_time(const std::vector<StageTrial>& trials, const std::vector<Stage>& stages, Real passage, Real preparing,
                          Index particles)
{
  if (trials.empty())
    return "  time: the run has too few steps to measure\n";
  std::string text;
  Real usual = 0, least = 0, most = 0, steps = 0;
  std::int64_t made = 0;
  for (const StageTrial& trial : trials) {
    const StepRange range = steps_of(time_to_rest(stages[trial.stage], passage), trial.dt);
    const Real n = range.middle();
    if (trials.size() > 1)
      text += fmt::format("  stage {}: about {} steps of {:.3g} ms: {}\n", trial.name, in_words(range), 1e3 * trial.usual,
                          duration_in_words(n * trial.usual));
    usual += n * trial.usual, least += static_cast<Real>(range.least) * trial.quickest * quicker_steps;
    // A stage that seeks equilibrium may need its whole duration.
    most += static_cast<Real>(steps_of(stages[trial.stage].duration, trial.dt)) * trial.slowest * slower_steps;
    made += trial.made, steps += n;
  }
  return text + fmt::format(
                    "  speed: {:.3g} million particle-steps/s with {} thread{}, measured in {} steps\n"
                    "  time: about {}, likely between {} and {}\n",
                    steps * particles / usual / million, threads(), threads() == 1 ? "" : "s", made, duration_in_words(preparing + usual),
                    duration_in_words(preparing + least), duration_in_words(preparing + most));
}

/// A line on the stress that the law of each body uses, if there is water.
template <int D>
std::string describe_water(const Mesh<D>& mesh, const Setup<D>& setup, const Body& body)
{
  if (!setup.conditions.water.any())
    return "";
  if (!setup.conditions.water.drains(static_cast<Index>(&body - setup.state.bodies.data())))
    return ", total stress";
  return fmt::format(", effective stress, {} below the water table", count_wet(mesh, setup.conditions.water, body, setup.state.particles));
}

/// The distance of nodes from the centres of their cells, and what to do about it.
template <int D>
std::string describe_mesh(const Scene& scene, const StarOffsets<D>& offsets)
{
  std::string text;
  const bool smoothable = scene.kernel == "projected" && scene.mesh.smoothing == 0;  // no other kernel averages gradients at nodes
  for (const std::string& line : {to_string(offsets), smoothable ? advice(offsets) : ""})
    text += line.empty() ? "" : "  " + line;
  return text;
}

/// A line for each kernel or transfer that suits better what the scene does.
template <int D>
std::string describe_advice(const Scene& scene, const Setup<D>& setup, const StarOffsets<D>& offsets)
{
  const KernelUse use{.flows = any_flows(setup.state.materials, setup.laws),
                      .moves = !std::ranges::all_of(setup.stages, &Stage::seeks_rest),
                      .uneven_mesh = offsets.median,
                      .slenderness = slenderness(setup.state.particles, setup.state.bodies)};
  std::string text;
  for (const std::string& line : advice_on_kernel(scene, use))
    text += "  advice: " + line + "\n";
  return text;
}

enum class Times : std::uint8_t { left_out, measured };

/// Prints the errors of a scene and the cost of its run.
template <int D>
void tell_cost(Scene scene, bool quick, Times times, std::optional<int> threads_asked)
{
  StopWatch watch;
  Real preparing = 0;
  auto mesh = load_mesh<D>(scene, folder_of(scene));
  auto setup = set_up(scene, mesh);
  fit_threads(threads_asked, scene, setup.n_particles);
  watch.lap(preparing);
  if (quick)
    shorten(first_step(mesh, setup), setup.stages, scene.outputs);
  const auto warnings = setup.warnings;
  const auto names = setup.state.bodies;
  const Index particles = setup.n_particles, cells = mesh.n_cells(), nodes = mesh.n_nodes();
  const Real duration = total_duration(setup), passage = passage_time<D>(setup, upright_of(scene).template head<D>());
  const std::vector<Stage> stages = setup.stages;
  const std::string transfer = describe(setup.conditions.transfer);
  const std::string terrain = terrain_in_words(mesh, "  ");
  const StarOffsets<D> offsets = star_offsets(mesh);
  const std::string advice = describe_advice(scene, setup, offsets);
  std::string bodies;
  for (std::size_t b = 0; b < setup.state.bodies.size(); ++b)
    if (const Body& body = setup.state.bodies[b]; presence_of(body.name, scene.stages).from == 0)
      bodies += fmt::format("  body \"{}\": {} particles{}\n", body.name, body.size(), describe_water(mesh, setup, body));
  bodies += describe_changes(setup);
  if (setup.origin)
    bodies += describe(*setup.origin);
  for (const std::string& note : setup.notes)
    bodies += fmt::format("  {}\n", note);
  const bool measured = times == Times::measured;
  const auto trials = measured ? try_stages(scene, mesh, setup) : std::vector<StageTrial>{};
  const Estimate cost = estimate(scene, std::move(mesh), std::move(setup));
  for (const std::vector<std::string>& some : {warnings, warnings_of(cost.shared_nodes, names)})
    for (const std::string& warning : some)
      fmt::print(stderr, "warning: {}\n", warning);
  fmt::print("{}\n  {}-D, kernel {}, transfer {}, {} cells, {} nodes, {} particles\n{}{}{}{}", scene.title, D, scene.kernel, transfer,
             cells, nodes, particles, describe_mesh(scene, offsets), advice, terrain, bodies);
  if (const std::string contacts = contacts_in_words(cost.shared_nodes, names); !contacts.empty())
    fmt::print("  {}\n", contacts);
  if (cost.nodes_as_corners > 0)
    fmt::print(
        "  {} of {} nodes lie on curved or creased boundaries where no positive weights along the boundary exist: treated as corners\n",
        cost.nodes_as_corners, nodes);
  StepRange steps;
  for (const Stage& stage : stages)
    steps += steps_of(time_to_rest(stage, passage), stage.equilibrium ? stage.duration / stage.equilibrium->increments : cost.dt);
  fmt::print("  first step {:.3g} s, so about {} steps and {} million particle-steps\n{}", cost.dt, in_words(steps),
             in_words(steps, particles / million), describe_rest(stages, passage, cost.dt));
  fmt::print("  memory: particles {:.1f} MB, mesh {:.1f} MB, nodes {:.1f} MB\n", static_cast<Real>(cost.particle_bytes) / megabyte,
             static_cast<Real>(cost.mesh_bytes) / megabyte, static_cast<Real>(cost.node_bytes) / megabyte);
  fmt::print("{}{}", describe_disk_use(cost.files, disk_use(cost.files, scene.outputs, duration)),
             measured ? describe_time(trials, stages, passage, preparing, particles) : "");
  fmt::print("{}: no errors{}\n", scene.file, measured ? ", nothing was written" : "");
}

void tell_cost(Scene scene, bool quick, Times times, std::optional<int> threads_asked)
{
  if (scene.dimension == 2)
    tell_cost<2>(std::move(scene), quick, times, threads_asked);
  else
    tell_cost<3>(std::move(scene), quick, times, threads_asked);
}

}  // namespace

void check_scene(const std::filesystem::path& file, const std::vector<std::string>& set)
{
  tell_cost(read_scene(file, set), false, Times::left_out, std::nullopt);
}

void dry_run(const RunOptions& options)
{
  Scene scene = read_scene(options.scene, options.set);
  take_threads(options.threads, scene);
  if (options.quick)
    coarsen(scene);
  tell_cost(std::move(scene), options.quick, Times::measured, options.threads);
}

}  // namespace talus
