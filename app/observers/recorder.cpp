#include "app/observers/recorder.hpp"

#include "core/stop_watch.hpp"

#include <algorithm>

#include "app/observers/results.hpp"
#include "app/observers/rigid_frame.hpp"
#include "app/observers/summary_parts.hpp"
#include "core/print.hpp"
#include "io/files/manifest.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

/// The interval of an output; infinite if the scene does not have it.
template <class Spec>
Real every(const std::optional<Spec>& spec)
{
  return spec ? spec->every : std::numeric_limits<Real>::infinity();
}

Real total(std::span<const Stage> stages)
{
  Real sum = 0;
  for (const Stage& stage : stages)
    sum += stage.duration;
  return sum;
}

}  // namespace

template <int D>
Recorder<D>::Recorder(std::filesystem::path folder, const OutputSpec& outputs, const std::vector<Stage>& stages, bool quiet,
                      std::string made_by)
    : folder_(std::move(folder)),
      outputs_(outputs),
      stage_list_(stages),
      body_forces_(outputs.history && !outputs.history->bodies.empty()),
      progress_(quiet || !world().is_root(), world().is_root() ? folder_ / progress_file : fs::path()),
      particle_times_(every(outputs.particles)),
      mesh_times_(every(outputs.mesh)),
      history_times_(every(outputs.history)),
      frames_(folder_, made_by),
      runout_(folder_, outputs.runout)
{}

template <int D>
void Recorder<D>::open(const RunView<D>& view)
{
  traffic_begin_ = view.problem.ranks->traffic();
  bytes_per_particle_ = talus::bytes_per_particle(view);
  for (std::size_t b = 0; b < view.state.bodies.size(); ++b)
    bodies_.push_back(summary_of(view, b));
  has_rigid_ = !view.state.rigid.empty();
  if (outputs_.history) {
    history_.emplace(folder_ / "history.csv", *outputs_.history, own_columns_, view);
    history_state_ = history_->state();
  }
  name_lists();
}

/// Adds bodies that were not there before.
template <int D>
void Recorder<D>::welcome(const RunView<D>& view)
{
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (bodies_[b].particles > 0)
      continue;
    bodies_[b] = summary_of(view, b);
    if (history_ && bodies_[b].particles > 0)
      history_->follow_anew(bodies_[b].name, view);
  }
  if (history_)
    history_state_ = history_->state();
}

/// Adds the files that a run writes at its beginning.
template <int D>
void Recorder<D>::name_lists()
{
  if (outputs_.history)
    files_.push_back("history.csv");
  if (runout_.has_begun())
    files_.push_back("runout.csv");
  if (outputs_.particles)
    files_.push_back("particles.pvd");
  if (outputs_.mesh)
    files_.push_back("mesh.pvd");
  if (outputs_.particles && has_rigid_)
    files_.push_back("rigid.pvd");
}

template <int D>
void Recorder<D>::go_on(const RunView<D>& view)
{
  has_rigid_ = !view.state.rigid.empty();
  traffic_begin_ = view.problem.ranks->traffic(), step_begin_ = view.state.clock.step;
  timings_begin_ = view.state.timings, output_begin_ = output_seconds_;
  if (outputs_.history)
    history_.emplace(folder_ / "history.csv", *outputs_.history, own_columns_, view, history_state_);
  runout_.go_on(view);
  last_output_ = newest_output_;
  progress_.resume(done_before_ + view.state.clock.time - stage_start_, view.state.timings.particle_steps);
}

template <int D>
std::vector<std::string> Recorder<D>::resume(const RunView<D>& view)
{
  go_on(view);
  std::vector<std::string> missing;
  view.problem.ranks->together([&] { missing = drop_later(view); });
  return missing;
}

template <int D>
std::vector<std::string> Recorder<D>::drop_later(const RunView<D>& view)
{
  std::vector<std::string> missing;
  for (const std::string& file : files())
    if (std::error_code unreadable; !fs::exists(folder_ / file, unreadable))
      missing.push_back(fmt::format("{} is not there any more", (folder_ / file).string()));
  if (history_ && history_time_ > elsewhere_.time && history_->last_time() != history_time_)
    missing.push_back(fmt::format("{} lacks what was there up to t = {:.6g} s", (folder_ / "history.csv").string(), history_time_));
  frames_.resume(view.state.clock.time);
  const auto check_series = [&](const PvdSeries& series, int written, const char* name) {
    if (series.size() != static_cast<std::size_t>(written))
      missing.push_back(fmt::format("{} names {} files, {} had been written", (folder_ / name).string(), series.size(), written));
  };
  if (outputs_.particles)
    check_series(frames_.particle_series(), particle_files_ - elsewhere_.particle_files, "particles.pvd");
  if (outputs_.mesh)
    check_series(frames_.mesh_series(), mesh_files_ - elsewhere_.mesh_files, "mesh.pvd");
  if (!runout_.drop_later() && elsewhere_.time < 0)
    missing.push_back(fmt::format("{} lacks rows that had been written", (folder_ / "runout.csv").string()));
  const auto remove = [](const fs::path& file) {
    set_aside_unless_proved(file);
    return fs::remove(file);
  };
  for (int n = particle_files_; remove(particle_file(n)) | remove(rigid_file(n)); ++n) {
  }
  for (int n = mesh_files_; remove(mesh_file(n)); ++n) {
  }
  return missing;
}

template <int D>
void Recorder<D>::begin_again(const RunView<D>& view)
{
  go_on(view);
  elsewhere_ = {static_cast<std::int64_t>(files_.size()), particle_files_, mesh_files_, view.state.clock.time};
  last_output_.clear();
  newest_output_.clear();
  name_lists();
}

template <int D>
bool Recorder<D>::fits(std::size_t walls, std::size_t bodies, const KnownIds& ids) const
{
  if (!body_forces_.fits(bodies))
    return false;
  if (!outputs_.history)
    return true;
  const auto known = [&](std::int64_t id) { return ids.has(id); };  // it may have been deleted
  return history_state_.impulse.size() == walls && history_state_.angular.size() == walls &&
         history_state_.given.size() == outputs_.history->bodies.size() &&
         history_state_.followed.size() == outputs_.history->points.size() && std::ranges::all_of(history_state_.followed, known);
}

template <int D>
Timings Recorder<D>::step_seconds() const noexcept
{
  Timings seconds = last_.timings;
  for (Real Timings::*const phase : {&Timings::locate, &Timings::scatter, &Timings::nodes, &Timings::gather, &Timings::stress})
    seconds.*phase -= timings_begin_.*phase;
  return seconds;
}

template <int D>
void Recorder<D>::finish_frame()
{
  if (!frames_.is_pending())
    return;
  const std::exception_ptr failure = Communicator::caught([&] { frames_.wait(); });
  const std::vector<std::string>& written = frames_.written();
  if (frame_has_particles_ && !written.empty())  // the particles are written first
    last_output_ = written.front();
  std::erase_if(files_, [&](const std::string& file) {
    return std::ranges::find(frame_, file) != frame_.end() && std::ranges::find(written, file) == written.end();
  });
  if (failure)
    std::rethrow_exception(failure);
}

template <int D>
std::function<void()> Recorder<D>::flush() const
{
  std::vector<const HistoryFile*> tables;
  if (history_)
    tables.push_back(&history_->table());
  if (runout_.table() != nullptr)
    tables.push_back(runout_.table());
  return [frame = frames_.result(), tables] {
    if (frame.valid())
      frame.get();
    for (const HistoryFile* const table : tables)
      table->flush();
  };
}

template <int D>
void Recorder<D>::watch(const RunView<D>& view, RunEvent event)
{
  if (event == RunEvent::step_begins || event == RunEvent::given_up)
    return;
  if (frames_.is_done())  // so that a failure ends the run soon
    finish_frame();
  if (event != RunEvent::step_done)
    view.fetch_particles();
  accounts_.see(view, event);
  body_forces_.see(view, event);
  const bool first = event == RunEvent::stage_begins && view.state.stage.number == 0;
  if (first)
    open(view);
  else if (event == RunEvent::stage_begins)
    welcome(view);
  if (event == RunEvent::stage_begins)
    stage_start_ = view.state.clock.time;
  if (event == RunEvent::stage_begins && outputs_.runout && !runout_.has_begun() && view.stage_kind != "geostatic" &&
      view.stage_kind != "static") {
    runout_.begin(view);
    name("runout.csv");
  }
  if (event == RunEvent::step_done)
    progress_.step(done_before_ + view.state.clock.time - stage_start_,
                   done_before_ + total(std::span<const Stage>(stage_list_).subspan(static_cast<std::size_t>(view.state.stage.number))),
                   view.state.clock, view.stage_name, view.state.timings.particle_steps);

  StopWatch watch;
  if (first || event != RunEvent::stage_begins)  // the beginning of a later stage is the end of the previous one
    write(view, event == RunEvent::stage_done);
  write_runout(view, event == RunEvent::stage_done);
  if (event == RunEvent::stage_done && view.state.stage.number + 1 == static_cast<Index>(stage_list_.size()))
    finish_frame();  // the run is not over before it is on the disk
  watch.lap(output_seconds_);

  warn(view);
  last_.clock = view.state.clock, last_.timings = view.state.timings;
  last_.mass = view.state.mass, last_.monitor = view.state.monitor, last_.unsettled = view.state.flow.unsettled;
  last_.resampling = view.state.resampling;
  if (event != RunEvent::stage_done)
    return;
  done_before_ += view.state.clock.time - stage_start_;  // a stage that seeks equilibrium may end early
  last_.mass_there = totals(view).mass, last_.energy = accounts_.energy(view), last_.momentum = accounts_.momentum(view);
  ranks_ = ranks_of(view, traffic_begin_, step_begin_);
}

/// Prints a warning the first time that a limit is exceeded without stopping the run.
template <int D>
void Recorder<D>::warn(const RunView<D>& view) const
{
  if (!view.problem.ranks->is_root())
    return;
  const LimitMonitor &now = view.state.monitor, &before = last_.monitor;
  const auto warning = [&](const std::string& what) {
    say(stderr, "warning: step {}, t = {:.6g} s: {}\n", view.state.clock.step, view.state.clock.time, what);
  };
  if (const Index failed = view.state.mass.failed_count - last_.mass.failed_count; failed > 0)
    warning(fmt::format("failed and deleted: {}{}", now.failure, failed > 1 ? fmt::format("; and {} more", failed - 1) : ""));
  if (now.speeding > 0 && before.speeding == 0)
    warning(fmt::format("a particle moves at {:.4g} m/s, beyond watch.speed = {:.4g} m/s", now.fastest, view.problem.limits.speed));
  if (now.gaining > 0 && before.gaining == 0)
    warning(fmt::format("the energy grows by what nothing did work for, {:.3g} of its largest term, beyond watch.energy_gain = {:.3g}",
                        now.gain, view.problem.limits.gain));
  if (view.state.flow.unsettled > 0 && last_.unsettled == 0)
    warning(
        fmt::format("what pores hold was not found to the accuracy asked: {:.3g} of the water is missing, asked {:.3g}; see water_defect",
                    view.state.flow.missing, FlowLedger::tolerance));
}

template <int D>
void Recorder<D>::write(const RunView<D>& view, bool last)
{
  const Real time = view.state.clock.time;
  const bool particles = particle_times_.due(time) || (last && outputs_.particles && particle_time_ != time);
  const bool mesh = view.state.clock.step > 0 && (mesh_times_.due(time) || (last && outputs_.mesh && mesh_time_ != time));
  const bool history = history_ && (history_times_.due(time) || (last && history_time_ != time));
  if (particles || mesh || history)
    view.problem.ranks->together([&] { require_results(folder_); });
  if (particles || mesh)
    write_frame(view, particles, mesh);
  if (history) {
    history_->append(view, accounts_, body_forces_);
    history_state_ = history_->state();
    history_time_ = time;
  }
}

template <int D>
void Recorder<D>::write_frame(const RunView<D>& view, bool particles, bool mesh)
{
  finish_frame();
  view.fetch_particles();
  Frame frame;
  frame.time = view.state.clock.time;
  frame_.clear();
  frame_has_particles_ = particles;
  if (particles && has_rigid_) {
    frame.rigid = rigid_of_frame(view, rigid_file(particle_files_));
    frame_.push_back(frame.rigid->file.filename().string());
  }
  if (particles) {
    frame.particles = particles_of_frame(view, outputs_, particle_file(particle_files_++));
    frame_.push_back(frame.particles->file.filename().string());
    newest_output_ = frame_.back();
    particle_time_ = frame.time;
  }
  if (mesh) {
    frame.mesh = mesh_of_frame(view, outputs_, mesh_file(mesh_files_++));
    frame_.push_back(frame.mesh->file.filename().string());
    mesh_time_ = frame.time;
  }
  files_.insert(files_.end(), frame_.begin(), frame_.end());
  frames_.write(*view.problem.ranks, std::move(frame));
  if (!view.problem.ranks->alone())  // it is written already
    finish_frame();
}

template <int D>
void Recorder<D>::write_runout(const RunView<D>& view, bool last)
{
  if (!runout_.has_begun())
    return;
  for (const std::string& file : runout_.see(view, last))
    name(file);
  if (last)
    for (const std::string& file : runout_.write_maps(view))
      name(file);
}

/// Adds a file to the list, unless it is there already.
template <int D>
void Recorder<D>::name(const std::string& file)
{
  const auto named = files();
  if (std::find(named.begin(), named.end(), file) == named.end())
    files_.push_back(file);
}

template class Recorder<2>;
template class Recorder<3>;

}  // namespace talus
