// talus run
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <new>

#include "app/commands/run_command.hpp"
#include "app/commands/run_files.hpp"
#include "app/commands/run_messages.hpp"
#include "app/observers/accounts.hpp"
#include "app/observers/checkpoints.hpp"
#include "app/observers/results.hpp"
#include "app/run/disk_space.hpp"
#include "app/run/new_results.hpp"
#include "app/run/run_phases.hpp"
#include "app/run/summary.hpp"
#include "app/run/thread_choice.hpp"
#include "app/script/script_of_run.hpp"
#include "app/setup/quick.hpp"
#include "app/setup/resumed_scene.hpp"
#include "core/display_text.hpp"
#include "core/parallel/communicator.hpp"
#include "core/parallel/threads.hpp"
#include "core/print.hpp"
#include "io/files/atomic_file.hpp"
#include "io/files/manifest.hpp"
#include "io/load_mesh.hpp"
#include "io/output/summary_json.hpp"
#include "io/scene/reader.hpp"
#include "io/system/signals.hpp"
#include "io/system/traps.hpp"
#include "mesh/digest.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

/// How a run that does not continue in its folder treats existing files.
Replacing replacing(const RunOptions& options) { return {options.force, options.resume ? std::nullopt : std::optional(options.scene)}; }

/// One run in its folder, from mesh to summary.
template <int D>
class Run {
 public:
  /// `from`: the checkpoints to resume, or nullptr.
  Run(Scene scene, fs::path folder, bool quick, const RunOptions& options, const CheckpointList* from)
      : scene_(std::move(scene)), folder_(std::move(folder)), quick_(quick), options_(options), from_(from)
  {}

  void operator()()
  {
    auto mesh = load_mesh<D>(scene_, folder_of(scene_));
    watch_.lap(phases_.mesh);
    auto setup = set_up(scene_, mesh, world());
    watch_.lap(phases_.seeding);
    thread_choice_ = fit_threads(options_.threads, scene_, setup.n_particles);
    if (quick_)
      shorten(world().min(first_step(mesh, setup)), setup.stages, scene_.outputs);
    stages_ = setup.stages;
    notes_ = setup.notes;
    if (from_)
      check_durations(*from_, stages_, options_.set);
    check_sources(setup);
    if (setup.origin && from_)
      setup.origin->file = from_->identity().initial;  // the copy was read
    const std::uint64_t mesh_digest = digest(mesh);
    const RunIdentity identity = identity_of(scene_, quick_, mesh_digest, setup.from_files, setup.origin ? setup.origin->file : "");
    if (from_)
      compare(from_->identity(), identity);
    least_energy_ = setup.conditions.limits.least_energy * least_energy_factor;
    summary_ = begin_summary(scene_, mesh, mesh_digest, setup);

    n_particles_ = setup.n_particles, n_cells_ = mesh.n_cells(), n_nodes_ = mesh.n_nodes();
    if (!world().alone() && world().is_root())
      whole_ = mesh;
    ScriptOfRun<D> script(scene_, folder_);
    Recorder<D> recorder(folder_, scene_.outputs, stages_, options_.quiet, summary_.made_by());
    script.join(recorder);
    Checkpoints<D> checkpoints(folder_, scene_.outputs.checkpoint, identity, options_.until);
    RunCallbacks<D> callbacks{[&](const RunView<D>& view, RunEvent event) {
                                Real seconds = 0;
                                watch_.lap(seconds);
                                (event == RunEvent::stage_begins ? phases_.initial_stress : phases_.steps) += seconds;
                                if (event == RunEvent::step_done)
                                  thread_choice_.took(seconds);
                                const LapAtEnd observed(watch_, phases_.observers);
                                script.before_files(view, event, phases_.script);
                                recorder.watch(view, event);
                                script.after_files(view, event, phases_.script);
                                if (event == RunEvent::step_begins) {
                                  script.stop_if_asked(view, [&](const std::string& why) { checkpoints.see(view, recorder, why); });
                                  set_threads(thread_choice_.next());
                                }
                                if (event == RunEvent::given_up)
                                  checkpoints.write(view, recorder);
                              },
                              [&](const RunView<D>& view, const StageResult& result) {
                                const LapAtEnd observed(watch_, phases_.observers);
                                recorder.stage_done(result);
                                checkpoints.see_end_of_stage(view, recorder, static_cast<Index>(stages_.size()));
                              }};
    fs::path taken;
    const auto laws = setup.laws;
    const StateLimits limits{mesh.n_cells(), static_cast<Index>(stages_.size()), setup.n_particles, laws};
    callbacks.changed = [&](const RunView<D>& view, const Stage& stage, const StageReport& news) {
      recorder.changed(tell_changes(view.state.clock.time, stage.name, news, options_.quiet, summary_.warnings));
    };
    if (from_)
      callbacks.take_over = [&](State<D>& state) { taken = from_->take_over(state, recorder, limits); };
    callbacks.before_copy = [&] { checkpoints.finish(); };
    callbacks.kernel_made = [&](Real seconds) { phases_.kernel = seconds, phases_.build -= seconds; };
    // Only now: errors of the kernel, lack of memory and unreadable input are found before existing results are replaced.
    callbacks.ready = [&](const RunView<D>& view) {
      summary_.nodes_as_corners = world().sum(view.nodes_as_corners);
      check_disk_space(folder_, view, scene_.outputs, time_left(view));
      watch_.lap(phases_.build);
      world().together([&] { prepare(view); });
      watch_.lap(phases_.first_files);
      began_ = true;  // for the other ranks too
      whole_.reset();
      if (from_)
        go_on(view, taken, recorder);
      watch_.lap(phases_.build);
    };
    const auto settle = [&] {  // the first message is the relevant one
      static_cast<void>(Communicator::caught([&] { recorder.finish_frame(); }));
      static_cast<void>(Communicator::caught([&] { checkpoints.finish(); }));
    };
    const auto failed = [&](const char* what, const std::string& way_back = {}) {
      std::string message = what;
      if (!began_)
        return message;
      settle();
      if (!recorder.last_output().empty())
        message += "; last good output " + recorder.last_output();
      if (!checkpoints.last().empty())
        message += "; last checkpoint " + checkpoints.last().string();
      message += way_back;
      try {
        finish(recorder, checkpoints, RunStatus::failed, message);
      } catch (const EnvironmentError&) {  // a full disk stays full: the first message is the relevant one
      }
      return message;
    };
    const StopRequests requests;  // until the summary is written
    try {
      std::optional<FloatingPointTraps> traps(std::in_place);
      simulate(scene_, std::move(mesh), std::move(setup), callbacks, load_balancing_of(mesh_digest, traps));
      finish(recorder, checkpoints, RunStatus::done, "");
    } catch (const Stopped& e) {
      const std::string message = fmt::format("{}; go on with: talus run --resume {}", e.what(), shell_word(folder_));
      finish(recorder, checkpoints, RunStatus::stopped, message);
      throw Stopped(message);
    } catch (const RunError& e) {
      settle();
      throw RunError(failed(e.what(), way_back(checkpoints, recorder.last_seen().clock.step)));
    } catch (const EnvironmentError& e) {
      throw EnvironmentError(failed(e.what()));
    } catch (const std::bad_alloc&) {
      throw EnvironmentError(failed("not enough memory"));
    }
    if (!options_.quiet && world().is_root())
      say(stdout, "{}results in {}; as one page for the browser: talus report {}\n", table(recorder, summary_), folder_.string(),
          shell_word(folder_));
    world().together([&] { tell_failed_accounts(); });
  }

 private:
  bool strict() const noexcept { return scene_.strict || options_.strict; }

  /// Throws RunError if balances do not close and that is an error (strict).
  void tell_failed_accounts() const
  {
    std::fflush(stdout);
    if (!failed_accounts_.empty() && strict())
      throw RunError(strict_message());
    for (const std::string& what : failed_accounts_)
      say(stderr, "warning: {}\n", what);
  }
  std::string strict_message() const { return fmt::format("{} (strict); the results are complete", fmt::join(failed_accounts_, "; ")); }

  bool is_over(const RunView<D>& view) const
  {
    return view.state.stage.done && view.state.stage.number + 1 == static_cast<Index>(stages_.size());
  }

  /// The command that computes the state after the last valid step again, if that is not a checkpoint.
  std::string way_back(const Checkpoints<D>& checkpoints, std::int64_t sound) const
  {
    if (checkpoints.last_step() == sound || resumed_after_ == sound)
      return {};
    return tell_way_back(options_, folder_, quick_, !checkpoints.last().empty(), sound);
  }

  bool in_place() const { return goes_on_in_place(from_, folder_); }

  /// Throws EnvironmentError or SceneErrors if an input of the run lies among the results that would be replaced.
  void check_sources(const Setup<D>& setup)
  {
    if (setup.origin)
      initial_ = setup.origin->file;
    if (in_place())
      return;
    if (from_)
      for (const fs::path& file : from_->files())
        if (lies_in(file, folder_))
          throw EnvironmentError(replaces_source(file, folder_));
    check_start_tables(scene_, setup.start_states, folder_);
    if (initial_ && lies_in(*initial_, folder_))
      throw SceneErrors(scene_.initial->where, replaces_source(*initial_, folder_));
  }

  /// The longest remaining time of all stages [s].
  Real time_left(const RunView<D>& view) const
  {
    Real time = from_ ? 0 - view.state.clock.time : 0;
    for (const Stage& stage : stages_)
      time += stage.duration;
    return std::max(time, 0.0);
  }

  /// Makes the folder with mesh and scene, and a summary with the status "not ended".
  void prepare(const RunView<D>& view)
  {
    if (from_)
      edits_ = find_edits(from_->identity().scene_file, from_->folder(), from_->identity().scene_text, from_->identity().set);
    const Mesh<D>& whole = whole_ ? *whole_ : view.problem.mesh;
    if (in_place()) {
      lock_ = FolderLock(folder_);
      remove_leftovers(folder_);
      adopt_results(folder_);
      began_ = true;
      write_first_files<D>(folder_, summary_, whole, initial_);
      update_scene_copy(folder_, scene_);
    } else {
      NewResults fresh(folder_, replacing(options_));
      write_first_files<D>(fresh.staging(), summary_, whole, initial_);
      if (!fresh.keeps_scene())
        write_whole(fresh.staging() / scene_copy_file, with_changes(scene_.text, scene_.overrides));
      lock_ = fresh.commit();
      began_ = true;
    }
    for (const std::string& warning : summary_.warnings)
      say(stderr, "warning: {}\n", warning);
    if (!options_.quiet)
      say(stdout, "{}: {} particles, {} cells, {} nodes, kernel {}, transfer {}, {}{} thread{}\n", scene_.title, n_particles_, n_cells_,
          n_nodes_, scene_.kernel, summary_.transfer, world().alone() ? "" : fmt::format("{} ranks with ", world().size()), threads(),
          threads() == 1 ? "" : "s");
    if (!options_.quiet && summary_.origin)
      say(stdout, "{}", describe(*summary_.origin));
    for (std::size_t n = 0; n < notes_.size() && !options_.quiet; ++n)
      say(stdout, "  {}\n", notes_[n]);
    std::fflush(stdout);
  }

  void go_on(const RunView<D>& view, const fs::path& taken, Recorder<D>& recorder)
  {
    resumed_after_ = view.state.clock.step;
    std::vector<std::string> news = edits_;
    if (in_place()) {
      std::vector<fs::path> aside;
      world().together([&] { aside = set_aside_newer(folder_, taken); });
      if (!aside.empty())
        news.push_back(tell_set_aside(taken, aside));
      const auto missing = recorder.resume(view);
      news.insert(news.end(), missing.begin(), missing.end());
    } else {
      recorder.begin_again(view);
    }
    for (const std::string& what : news)  // of the root only
      say(stderr, "warning: {}\n", what);
    summary_.warnings.insert(summary_.warnings.end(), news.begin(), news.end());
    if (!options_.quiet && world().is_root())
      say(stdout, "{} step {}, t = {:.6g} s\n", is_over(view) ? "nothing is left to do: the run was over after" : "going on after",
          view.state.clock.step, view.state.clock.time);
  }

  LoadBalancing<D> load_balancing_of(std::uint64_t mesh_digest, std::optional<FloatingPointTraps>& traps)
  {
    const auto whole_mesh = [this, mesh_digest, &traps] {
      traps.reset();  // traps do not apply to meshing
      Mesh<D> again = load_mesh<D>(scene_, folder_of(scene_));
      traps.emplace();
      if (digest(again) != mesh_digest)
        throw EnvironmentError("the mesh is not the one that the run began with: its file has changed since");
      return again;
    };
    const auto stayed = [this](const std::string& why) {
      watch_.lap(phases_.rebalancing);
      summary_.warnings.push_back("the ranks cannot share the run out anew, and go on as they are: " + why);
      if (world().is_root())
        say(stderr, "warning: {}\n", summary_.warnings.back());
    };
    return {options_.rebalance, whole_mesh, phases_.mesh, [this](const Rebalanced& by) { note(by); }, stayed};
  }

  void note(const Rebalanced& by)
  {
    watch_.lap(phases_.rebalancing);
    ++rebalances_;
    rebalancing_ += by.seconds;
    if (!options_.quiet)
      say_rebalanced(by);
  }

  void finish(const Recorder<D>& recorder, const Checkpoints<D>& checkpoints, RunStatus status, const std::string& message)
  {
    if (!world().is_root())
      return;
    require_results(folder_);
    watch_.lap(phases_.end);
    RunSummary summary = summary_;
    summary.threads = thread_choice_.chosen();
    summary.status = status;
    summary.message = message;
    summary.wall_seconds = wall_by_phase(phases_, recorder.step_seconds(), recorder.output_seconds(), checkpoints.seconds());
    summary.wall_total = phases_.total();
    complete(recorder, quick_, summary);
    summary_.stages = summary.stages;
    if (status == RunStatus::done)
      failed_accounts_ = failed_accounts(summary, least_energy_);
    summary.warnings.insert(summary.warnings.begin(), failed_accounts_.begin(), failed_accounts_.end());
    if (!failed_accounts_.empty() && strict())
      summary.status = RunStatus::failed, summary.message = strict_message();
    summary.ranks.rebalances = rebalances_, summary.ranks.rebalancing = rebalancing_;
    summary.files.insert(summary.files.begin(), {"scene.yaml", "mesh.msh", "mesh.vtu"});
    if (summary.origin)
      summary.files.emplace_back(initial_file);
    for (const char* const table : {"history.csv", "runout.csv"})  // tables that are complete: after a failure a row may still follow
      if (status == RunStatus::done && fs::exists(folder_ / table))
        note_result(folder_ / table, folder_ / table);
    write_summary(folder_ / "summary.json", summary);
  }

  Scene scene_;
  fs::path folder_;
  bool quick_;
  const RunOptions& options_;
  const CheckpointList* from_;
  std::optional<std::int64_t> resumed_after_;  // number of steps
  StopWatch watch_;
  RunPhases phases_;
  std::int64_t rebalances_ = 0;
  Real rebalancing_ = 0;                               // time of redistributions [s]
  Index n_particles_ = 0, n_cells_ = 0, n_nodes_ = 0;  // numbers of the whole mesh
  std::optional<Mesh<D>> whole_;                       // on the root of several ranks, until it is written
  std::vector<Stage> stages_;
  std::vector<std::string> notes_;  // notes of the set-up
  std::vector<std::string> edits_;  // edits of the scene of a resumed run; on the root
  RunSummary summary_;              // at the beginning
  std::vector<std::string> failed_accounts_;
  ThreadChoice thread_choice_;
  Real least_energy_ = 0;            // least energy of a balance that is judged [J]
  std::optional<fs::path> initial_;  // initial state of bodies
  bool began_ = false;               // whether the folder belongs to this run
  FolderLock lock_;
};

}  // namespace

void run_scene(const RunOptions& options)
{
  std::optional<CheckpointList> from;
  if (options.resume)
    from.emplace(*options.resume);
  Scene scene = from ? read_again(from->identity(), options.set) : read_scene(options.scene, options.set);
  take_threads(options.threads, scene);
  if (from && !from->folder() && !options.out)
    throw EnvironmentError(fmt::format("{} lies in no folder of a run (DIR/{}, with DIR/summary.json): say with --out where the results go",
                                       options.resume->string(), checkpoint_folder));
  if (from && scene.initial) {
    const fs::path copy = from->folder().value_or(options.resume->parent_path()) / initial_file;
    if (!fs::exists(copy))
      throw EnvironmentError(fmt::format("{} is not there: the state that the run began with, which it needs to go on", copy.string()));
    scene.initial->from = copy.string();
  }
  const bool quick = from ? from->identity().quick : options.quick;
  if (quick)
    coarsen(scene);
  const fs::path folder = options.out ? *options.out : from ? *from->folder() : default_results(options.scene);
  const CheckpointList* const resumed = from ? &*from : nullptr;
  if (!goes_on_in_place(resumed, folder))
    world().together([&] { check_replaceable(folder, replacing(options)); });  // checked again after the mesh was made, which may take long
  if (scene.dimension == 2)
    Run<2>(std::move(scene), folder, quick, options, resumed)();
  else
    Run<3>(std::move(scene), folder, quick, options, resumed)();
}

}  // namespace talus
