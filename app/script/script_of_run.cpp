#include "app/script/script_of_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "app/script/script_arrays.hpp"
#include "core/parallel/communicator.hpp"
#include "core/stop_watch.hpp"
#include "io/system/memory.hpp"
#include "io/system/traps.hpp"

namespace talus {

namespace {

/// The particles as a script sees them during one call.  Arrays that the script keeps own it, so that it outlives the call then.
template <int D>
struct SeenParticles {
  std::optional<ParticleCopy<D>> copy = {};  ///< nothing while they are those of the run
};

}  // namespace

/// The run during a call of the script.
template <int D>
class ScriptOfRun<D>::Host final : public ScriptHost {
 public:
  explicit Host(std::filesystem::path folder) : folder_(std::move(folder)) {}

  void begin(const RunView<D>& view, std::optional<VelocityChange> velocities) { view_ = &view, change_ = velocities; }
  /// Gives the script what it keeps of the particles, and the run its new velocities.
  void finish()
  {
    if (seen_ && !seen_->copy && seen_.use_count() > 1)
      seen_->copy = view_->take_copy();  // the columns stay where they are in memory: only their owner changes
    seen_.reset();
    if (const auto values = std::exchange(velocities_, nullptr))
      view_->set_velocities(*values, *change_);
  }
  /// The same after an exception, by which the run ends.
  void give_up()
  {
    velocities_.reset();
    finish();
  }

  int dimension() const override { return D; }
  std::string folder() const override { return folder_.string(); }
  ScriptClock clock() const override
  {
    const Clock& now = view_->state.clock;
    return {now.time, now.dt, now.step, std::string(view_->stage_name)};
  }
  std::vector<ScriptBody> bodies() const override
  {
    view_->fetch_particles();
    std::vector<ScriptBody> all;
    for (std::size_t b = 0; b < view_->state.bodies.size(); ++b) {
      const Body& body = view_->state.bodies[b];
      const Material& material = view_->state.materials[b];
      all.push_back({body.name, material.name, std::string(material.law().name()), body.begin, body.end});
    }
    return all;
  }
  std::vector<std::string> particle_names(std::optional<std::size_t> body) const override { return names_of_particles(*view_, body); }
  std::vector<std::string> node_names() const override { return names_of_nodes<D>(); }
  ScriptArray nodes(const std::string& name) override { return nodes_of(*view_, name); }

  ScriptArray particles(const std::string& name, std::optional<std::size_t> body) override
  {
    look();
    if (name == "velocity" && velocities_)
      return set_so_far(body);
    const State<D>& state = view_->state;
    const auto* const copy = seen_->copy ? &*seen_->copy : nullptr;
    return particles_of(*view_, {copy ? copy->particles : state.particles, state.bodies, copy ? copy->materials : state.materials, seen_},
                        name, body);
  }

  std::vector<std::pair<std::string, Real>> history() const override
  {
    std::vector<std::pair<std::string, Real>> row;
    const HistoryWriter<D>* const history = recorder_ != nullptr ? recorder_->history() : nullptr;
    for (std::size_t i = 0; history != nullptr && i < history->last_row().size(); ++i)
      row.emplace_back(history->table().columns()[i].name, history->last_row()[i]);
    return row;
  }

  void set_velocities(std::optional<std::size_t> body, std::span<const Real> values) override
  {
    if (!change_)
      throw std::invalid_argument(
          "velocities can be set in step, and in start of a run that begins: in one that goes on they are those of its checkpoint");
    if (!view_->set_velocities)
      throw std::invalid_argument("velocities cannot be set in a stage that solves for equilibrium");
    look();
    const State<D>& state = view_->state;
    if (!velocities_ || velocities_.use_count() > 1) {  // arrays of the script keep their numbers
      const Real* const first = velocities_ ? velocities_->data() : state.particles.v.row_at(0);
      velocities_ = std::make_shared<std::vector<Real>>(first, first + state.particles.id.size() * D);
    }
    const std::size_t begin = body ? to_size(state.bodies[*body].begin) * D : 0;
    std::ranges::copy(values, velocities_->begin() + static_cast<std::ptrdiff_t>(begin));
  }

  void stop(const std::string& reason) override { reason_ = reason.empty() ? "by its script" : "by its script: " + reason; }

  const std::string& reason() const noexcept { return reason_; }
  void join(const Recorder<D>& recorder) { recorder_ = &recorder; }

 private:
  /// Makes the particles readable.
  void look()
  {
    if (seen_)
      return;
    view_->fetch_particles();
    seen_ = std::make_shared<SeenParticles<D>>();
    if (view_->strips == nullptr)  // the columns are not a copy: steps change them
      seen_->copy = ParticleCopy<D>{view_->state.bodies, view_->state.materials, view_->state.particles};
  }

  ScriptArray set_so_far(std::optional<std::size_t> body) const
  {
    constexpr auto bytes = static_cast<std::int64_t>(sizeof(Real));
    const std::vector<Body>& bodies = view_->state.bodies;
    const auto begin = body ? to_size(bodies[*body].begin) * D : 0;
    const std::int64_t n = body ? bodies[*body].size() : view_->state.particles.size();
    return {'d', velocities_->data() + begin, {n, D}, {D * bytes, bytes}, velocities_};
  }

  std::filesystem::path folder_;
  const Recorder<D>* recorder_ = nullptr;
  const RunView<D>* view_ = nullptr;
  std::optional<VelocityChange> change_;
  std::shared_ptr<SeenParticles<D>> seen_;
  std::shared_ptr<std::vector<Real>> velocities_;  // of all particles, once some were set
  std::string reason_;
};

template <int D>
ScriptOfRun<D>::ScriptOfRun(const Scene& scene, std::filesystem::path folder) : n_stages_(scene.stages.size())
{
  if (!scene.script)
    return;
  where_ = scene.script->where;
  every_ = scene.script->every;
  if (!world().alone())
    throw SceneErrors(where_, "a script sees all particles of a run, which must be on one rank: run it without mpirun");
  const std::filesystem::path file = std::filesystem::path(scene.file).parent_path() / scene.script->file;
  try {
    const TrapsPaused paused;
    script_ = open_python_script(file.string());
  } catch (const RunError& error) {
    throw SceneErrors(where_, fmt::format("the script cannot be used: {}", error.what()));
  }
  if (!script_->columns().empty() && !scene.outputs.history)
    throw SceneErrors(where_, "the script adds columns to history.csv, which the scene does not write: outputs.history is missing");
  host_ = std::make_unique<Host>(std::move(folder));
  keep_freed_memory();  // of the columns that are copied for each call
}

template <int D>
ScriptOfRun<D>::~ScriptOfRun() = default;

/// Calls f() while the host is that of the view.
template <int D>
template <class F>
void ScriptOfRun<D>::visit(const RunView<D>& view, std::optional<VelocityChange> velocities, F&& f)
{
  const TrapsPaused paused;
  host_->begin(view, velocities);
  try {
    f();
  } catch (const RunError& error) {
    host_->give_up();
    throw RunError(fmt::format("step {}, t = {:.6g} s: {}", view.state.clock.step, view.state.clock.time, error.what()));
  } catch (...) {
    host_->give_up();
    throw;
  }
  host_->finish();
}

template <int D>
void ScriptOfRun<D>::call(std::string_view function, const RunView<D>& view, std::optional<VelocityChange> velocities)
{
  if (script_ && script_->has(function))
    visit(view, velocities, [&] { script_->call(function, *host_); });
}

template <int D>
void ScriptOfRun<D>::join(Recorder<D>& recorder)
{
  if (!script_)
    return;
  host_->join(recorder);
  OwnColumns<D> own;
  for (const auto& [name, unit] : script_->columns())
    own.columns.push_back({name, unit == "-" ? "" : unit});
  if (!own.columns.empty())
    own.row = [this](const RunView<D>& view) {
      std::vector<Real> row;
      visit(view, std::nullopt, [&] { row = script_->row(*host_); });
      return row;
    };
  recorder.add_columns(std::move(own));
}

template <int D>
void ScriptOfRun<D>::before_files(const RunView<D>& view, RunEvent event, Real& seconds)
{
  if (!script_ || std::exchange(began_, true))
    return;
  StopWatch watch;
  call(start_function, view,
       event == RunEvent::stage_begins && view.state.clock.step == 0 ? std::optional(VelocityChange::at_start) : std::nullopt);
  watch.lap(seconds);
}

template <int D>
void ScriptOfRun<D>::after_files(const RunView<D>& view, RunEvent event, Real& seconds)
{
  if (!script_)
    return;
  StopWatch watch;
  if (event == RunEvent::step_done && view.state.clock.step % every_ == 0)
    call(step_function, view, VelocityChange::between_steps);
  else if (event == RunEvent::stage_done && static_cast<std::size_t>(view.state.stage.number) + 1 >= n_stages_)
    end(view);
  watch.lap(seconds);
}

template <int D>
std::string ScriptOfRun<D>::reason_to_stop() const
{
  return host_ ? host_->reason() : std::string();
}

template <int D>
void ScriptOfRun<D>::end(const RunView<D>& view)
{
  call(end_function, view, std::nullopt);
}

template class ScriptOfRun<2>;
template class ScriptOfRun<3>;

}  // namespace talus
