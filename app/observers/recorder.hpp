#pragma once
// Watches a run: files at their times, accounts, progress, and what the summary needs when the run is over or has failed.
#include <filesystem>

#include "app/observers/body_forces.hpp"
#include "app/observers/history.hpp"
#include "app/observers/progress.hpp"
#include "app/observers/runout.hpp"
#include "app/observers/schedule.hpp"
#include "io/output/run_summary.hpp"
#include "io/output/vtk.hpp"
#include "solver/run_view.hpp"

namespace talus {

/// State of the run when it was last seen sound.
template <int D>
struct LastSeen {
  Clock clock;
  Timings timings;
  MassLedger<D> mass;
  Real mass_there{};  ///< of the particles [kg]
  LimitMonitor watched;
  EnergyNow energy;
  MomentumNow<D> momentum;
  static constexpr auto fields()
  {
    return std::tuple{saved("clock", &LastSeen::clock),           saved("timings", &LastSeen::timings), saved("mass", &LastSeen::mass),
                      saved("mass_there", &LastSeen::mass_there), saved("watched", &LastSeen::watched), saved("energy", &LastSeen::energy),
                      saved("momentum", &LastSeen::momentum)};
  }
};

/// What a run that goes on in a folder of its own has left in the folder that it comes from.
struct FilesOfEarlierRun {
  std::int64_t files = 0;  ///< the first ones of all
  int particle_files = 0, mesh_files = 0;
  Real time = -1;  ///< rows of the history up to then [s]
  static constexpr auto fields()
  {
    return std::tuple{saved("files", &FilesOfEarlierRun::files), saved("particle_files", &FilesOfEarlierRun::particle_files),
                      saved("mesh_files", &FilesOfEarlierRun::mesh_files), saved("time", &FilesOfEarlierRun::time)};
  }
};

template <int D>
class Recorder {
 public:
  /// `outputs` and the stages must outlive the recorder.  `made_by` is told in each file for ParaView.
  Recorder(std::filesystem::path folder, const OutputSpec& outputs, const std::vector<Stage>& stages, bool quiet, std::string made_by);

  void watch(const RunView<D>& view, RunEvent moment);
  /// Goes on with the files of a run whose state has been taken over, this recorder's fields() as well: what they hold beyond the time of
  /// the view is dropped.  Says in words what should be there and is not, on the root.
  std::vector<std::string> resume(const RunView<D>& view);
  /// Whether fields() that were taken over may be those of a run with so many walls and bodies, and particles at the start.
  bool fits(std::size_t walls, std::size_t bodies, Index particles) const;
  /// Goes on from such a state with files of its own, in another folder.
  void begin_again(const RunView<D>& view);
  /// What has been written is on the disk when it returns.
  void flush() const;
  void stage_done(const StageResult& result) { stages_.push_back(result); }
  /// What a stage has changed before it begins, a line for each.
  void changed(const std::vector<std::string>& lines) { changes_.insert(changes_.end(), lines.begin(), lines.end()); }

  const LastSeen<D>& last_seen() const noexcept { return last_; }
  std::span<const StageResult> stages() const noexcept { return stages_; }
  const std::vector<std::string>& changes() const noexcept { return changes_; }
  /// Written to the folder, relative to it.
  std::span<const std::string> files() const noexcept { return std::span(files_).subspan(static_cast<std::size_t>(elsewhere_.files)); }
  std::string last_output() const { return last_output_.empty() ? "" : (folder_ / last_output_).string(); }
  Real output_seconds() const noexcept { return output_seconds_; }
  Real bytes_per_particle() const noexcept { return bytes_per_particle_; }
  const RanksSummary& ranks() const noexcept { return ranks_; }  ///< as of the end of the last stage
  const std::vector<BodySummary>& bodies() const noexcept { return bodies_; }
  const Runout<D>& runout() const noexcept { return runout_; }
  static constexpr auto fields()
  {
    return std::tuple{saved("accounts", &Recorder::accounts_),
                      saved("body_forces", &Recorder::body_forces_),
                      saved("particle_times", &Recorder::particle_times_),
                      saved("mesh_times", &Recorder::mesh_times_),
                      saved("history_times", &Recorder::history_times_),
                      saved("particle_files", &Recorder::particle_files_),
                      saved("mesh_files", &Recorder::mesh_files_),
                      saved("particle_time", &Recorder::particle_time_),
                      saved("mesh_time", &Recorder::mesh_time_),
                      saved("history_time", &Recorder::history_time_),
                      saved("history_state", &Recorder::history_state_),
                      saved("stage_start", &Recorder::stage_start_),
                      saved("done_before", &Recorder::done_before_),
                      saved("last", &Recorder::last_),
                      saved("stages", &Recorder::stages_),
                      saved("changes", &Recorder::changes_),
                      saved("files", &Recorder::files_),
                      saved("elsewhere", &Recorder::elsewhere_),
                      saved("last_output", &Recorder::last_output_),
                      saved("bodies", &Recorder::bodies_),
                      saved("runout", &Recorder::runout_),
                      saved("output_seconds", &Recorder::output_seconds_),
                      saved("bytes_per_particle", &Recorder::bytes_per_particle_)};
  }

 private:
  void open(const RunView<D>& view);
  void welcome(const RunView<D>& view);
  void go_on(const RunView<D>& view);
  std::vector<std::string> drop_later(const RunView<D>& view);
  void name_lists();
  void warn(const RunView<D>& view) const;
  void write(const RunView<D>& view, bool last);
  void write_particles_file(const RunView<D>& view);
  void write_mesh_file(const RunView<D>& view);
  void write_runout(const RunView<D>& view, bool last);
  void name(const std::string& file);
  std::filesystem::path particle_file(int n) const { return folder_ / fmt::format("particles_{:04}.vtp", n); }
  std::filesystem::path mesh_file(int n) const { return folder_ / fmt::format("mesh_{:04}.vtu", n); }

  std::filesystem::path folder_;
  std::string made_by_;
  const OutputSpec& outputs_;
  const std::vector<Stage>& stage_list_;
  BalanceHistory<D> accounts_;
  BodyForces<D> body_forces_;
  Progress progress_;
  Schedule particle_times_, mesh_times_, history_times_;
  std::optional<HistoryWriter<D>> history_;
  HistoryState<D> history_state_;  // of history_, as of its last row
  PvdSeries particle_series_, mesh_series_;
  int particle_files_ = 0, mesh_files_ = 0;
  Real particle_time_ = -1, mesh_time_ = -1, history_time_ = -1;  // of the last ones written
  Real stage_start_ = 0, done_before_ = 0;
  RanksSummary ranks_;
  Traffic traffic_begin_;  // when the first step was begun
  std::int64_t step_begin_ = 0;
  LastSeen<D> last_;
  std::vector<StageResult> stages_;
  std::vector<std::string> changes_;
  std::vector<std::string> files_;
  FilesOfEarlierRun elsewhere_;
  std::string last_output_;  // relative as well
  std::vector<BodySummary> bodies_;
  Runout<D> runout_;
  Real output_seconds_ = 0, bytes_per_particle_ = 0;
};

extern template class Recorder<2>;
extern template class Recorder<3>;

}  // namespace talus
