#include "app/commands/bench/bench_measure.hpp"

#include <unistd.h>

#include "app/observers/recorder.hpp"
#include "core/parallel/threads.hpp"
#include "io/files/atomic_file.hpp"

namespace talus {

namespace {

/// A folder that is gone afterwards.
class Scratch {
 public:
  Scratch() : path_(std::filesystem::temp_directory_path() / fmt::format("talus-bench-{}", ::getpid()))
  {
    std::filesystem::create_directories(path_);
  }
  ~Scratch()
  {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  const std::filesystem::path& path() const noexcept { return path_; }

 private:
  std::filesystem::path path_;
};

template <int D>
BenchResult measure_block(const BenchSetting& setting, const BenchPlan& plan)
{
  auto block = bench_block<D>(setting, plan.particles, plan.all_steps());
  BenchResult result;
  result.setting = setting;
  result.particles = block.setup.state.particles.size();
  std::optional<Scratch> scratch;
  std::optional<Recorder<D>> recorder;
  const std::vector<Stage> stages = block.setup.stages;
  if (block.scene.outputs.history) {
    block.scene.outputs.history->every = block.setup.limits.longest;  // a row each step
    scratch.emplace();
    write_whole(scratch->path() / "summary.json", "{}\n");  // by which the recorder knows that its folder is still there
    recorder.emplace(scratch->path(), block.scene.outputs, stages, true, "");
  }
  Laps laps(plan);
  simulate<D>(block.scene, std::move(block.mesh), std::move(block.setup),
              {[&](const RunView<D>& view, RunEvent event) {
                 if (recorder)
                   recorder->watch(view, event);
                 if (event == RunEvent::step_done && view.state.clock.step == plan.all_steps()) {
                   result.bytes_held = bytes_per_particle(view);
                   result.bytes_moved = bytes_moved(view);
                 }
                 if (event == RunEvent::step_done)
                   laps.step_done(view.state.timings.particle_steps, phases_of(view.state.timings));
               },
               [](const RunView<D>&, const StageResult&) {}});
  laps.fill(result);
  return result;
}

}  // namespace

Measured measured(std::vector<Real> values)
{
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return {(values[(n - 1) / 2] + values[n / 2]) / 2, values.front(), values.back()};
}

Laps::Totals phases_of(const Timings& t)
{
  return {{"locate", t.locate}, {"scatter", t.scatter}, {"nodes", t.nodes}, {"gather", t.gather}, {"stress", t.stress}};
}

void Laps::step_done(Real particle_steps, const Totals& phases)
{
  ++steps_;
  if (steps_ >= plan_.warm_up && (steps_ - plan_.warm_up) % plan_.steps == 0)
    marks_.push_back({Clock::now(), std::clock(), particle_steps, phases});
}

void Laps::fill(BenchResult& result) const
{
  constexpr Real nano = 1e9;
  const std::size_t n_phases = marks_.front().phases.size();
  std::vector<Real> whole, cpu;
  std::vector<std::vector<Real>> of_phase(n_phases + 1);
  for (std::size_t i = 1; i < marks_.size(); ++i) {
    const Mark &from = marks_[i - 1], &to = marks_[i];
    const Real scale = nano / (to.particle_steps - from.particle_steps);
    whole.push_back(scale * std::chrono::duration<Real>(to.time - from.time).count());
    cpu.push_back(scale * static_cast<Real>(to.cpu - from.cpu) / CLOCKS_PER_SEC);
    Real rest = whole.back();
    for (std::size_t k = 0; k < n_phases; ++k) {
      of_phase[k].push_back(scale * (to.phases[k].second - from.phases[k].second));
      rest -= of_phase[k].back();
    }
    of_phase[n_phases].push_back(rest);
  }
  result.steps = plan_.steps;
  result.ns = measured(whole);
  result.cpu = measured(cpu);
  result.repeats = whole;
  for (std::size_t k = 0; k < n_phases; ++k)
    result.phases.push_back({std::string(marks_.front().phases[k].first), measured(of_phase[k]).median});
  result.phases.push_back({"rest", measured(of_phase[n_phases]).median});
}

template <int D>
Real bytes_moved(const RunView<D>& view)
{
  constexpr std::array<std::string_view, 5> constants{"id", "cell", "mass", "volume0", "start"};
  const auto bytes = [](const auto& column) { return static_cast<Real>(column.size() * sizeof(column[0])); };
  const Real of_nodes = 2 * (bytes(view.fields.front().nodes.sum) + bytes(view.fields.front().nodes.motion));
  if (view.strips != nullptr)
    return (static_cast<Real>(view.strips->bytes_moved()) + of_nodes) / static_cast<Real>(view.strips->size());
  Real total = of_nodes;
  view.state.particles.for_each_column([&](std::string_view name, std::string_view, const auto& column) {
    const bool changes = std::find(constants.begin(), constants.end(), name) == constants.end();
    total += (changes ? 2 : 1) * static_cast<Real>(bytes_of(column));
  });
  for (const Material& material : view.state.materials)
    total += 2 * static_cast<Real>(material.history.bytes());
  return total / static_cast<Real>(view.state.particles.size());
}

template Real bytes_moved<2>(const RunView<2>&);
template Real bytes_moved<3>(const RunView<3>&);

BenchResult measure(const BenchSetting& setting, const BenchPlan& plan)
{
  const int before = threads();
  set_threads(setting.threads);
  BenchResult result = setting.dimension == 2 ? measure_block<2>(setting, plan) : measure_block<3>(setting, plan);
  set_threads(before);
  return result;
}

}  // namespace talus
