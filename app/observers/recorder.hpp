#pragma once
// Observer of a run that writes files at their times, balances and progress, and collects the data for the summary.
#include <filesystem>

#include "app/observers/body_forces.hpp"
#include "app/observers/frame_output.hpp"
#include "app/observers/history.hpp"
#include "app/observers/progress.hpp"
#include "app/observers/runout.hpp"
#include "app/observers/schedule.hpp"
#include "io/output/run_summary.hpp"
#include "io/output/vtk.hpp"
#include "solver/particles/resample.hpp"
#include "solver/run_view.hpp"

namespace talus {

/// The last valid state of the run.
template <int D>
struct LastSeen {
  Clock clock;
  Timings timings;
  MassLedger<D> mass;
  Real mass_there{};  ///< mass of the particles [kg]
  LimitMonitor monitor;
  Real unsettled{};  ///< of FlowLedger
  ResampleLedger resampling;
  EnergyNow energy;
  MomentumNow<D> momentum;
  static constexpr auto fields()
  {
    return std::tuple{
        saved("clock", &LastSeen::clock),           saved("timings", &LastSeen::timings), saved("mass", &LastSeen::mass),
        saved("mass_there", &LastSeen::mass_there), saved("watched", &LastSeen::monitor), saved("unsettled", &LastSeen::unsettled),
        saved("resampling", &LastSeen::resampling), saved("energy", &LastSeen::energy),   saved("momentum", &LastSeen::momentum)};
  }
};

/// The output of an earlier run whose continuation has its own folder.
struct FilesOfEarlierRun {
  std::int64_t files = 0;  ///< number of files, from the first one
  int particle_files = 0, mesh_files = 0;
  Real time = -1;  ///< time of the last row of the history [s]
  static constexpr auto fields()
  {
    return std::tuple{saved("files", &FilesOfEarlierRun::files), saved("particle_files", &FilesOfEarlierRun::particle_files),
                      saved("mesh_files", &FilesOfEarlierRun::mesh_files), saved("time", &FilesOfEarlierRun::time)};
  }
};

template <int D>
class Recorder {
 public:
  /// `outputs` and the stages must outlive the recorder.  `made_by` is written into each file for ParaView.
  Recorder(std::filesystem::path folder, const OutputSpec& outputs, const std::vector<Stage>& stages, bool quiet, std::string made_by);

  /// Columns that the history gets besides its own; to be called before the run begins or goes on.
  void add_columns(OwnColumns<D> columns) { own_columns_ = std::move(columns); }
  /// The history, if one is written and the run has begun.
  const HistoryWriter<D>* history() const noexcept { return history_ ? &*history_ : nullptr; }

  void watch(const RunView<D>& view, RunEvent event);
  /// Continues the files of a run whose state, including fields() of this recorder, has been read: entries after the time of the view are
  /// dropped.  Returns descriptions of missing files, on the root.
  std::vector<std::string> resume(const RunView<D>& view);
  /// Whether fields() read from a checkpoint have the sizes for this number of walls, bodies, and initial particles.
  bool fits(std::size_t walls, std::size_t bodies, const KnownIds& ids) const;
  /// Continues from such a state with new files in another folder.
  void begin_again(const RunView<D>& view);
  /// Returns when the frame that is being written is on the disk.  Throws EnvironmentError if it could not be written.
  void finish_frame();
  /// A function that returns when everything that is written by now is on the disk, the frame included.  Any thread may call it while the
  /// recorder exists.  It throws EnvironmentError.  On the root.
  std::function<void()> flush() const;
  void stage_done(const StageResult& result) { stages_.push_back(result); }
  /// Records the changes by a stage before it begins, one line each.
  void changed(const std::vector<std::string>& lines) { changes_.insert(changes_.end(), lines.begin(), lines.end()); }

  const LastSeen<D>& last_seen() const noexcept { return last_; }
  std::span<const StageResult> stages() const noexcept { return stages_; }
  const std::vector<std::string>& changes() const noexcept { return changes_; }
  /// The files written to the folder, relative to it.
  std::span<const std::string> files() const noexcept { return std::span(files_).subspan(static_cast<std::size_t>(elsewhere_.files)); }
  std::string last_output() const { return last_output_.empty() ? "" : (folder_ / last_output_).string(); }
  /// Wall times of output, and of the phases of the steps, in this run: without those of an earlier one that it continues [s].
  Real output_seconds() const noexcept { return output_seconds_ - output_begin_; }
  Timings step_seconds() const noexcept;
  Real bytes_per_particle() const noexcept { return bytes_per_particle_; }
  const RanksSummary& ranks() const noexcept { return ranks_; }  ///< at the end of the last stage
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
                      saved("last_output", &Recorder::newest_output_),
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
  void write_frame(const RunView<D>& view, bool particles, bool mesh);
  void write_runout(const RunView<D>& view, bool last);
  void name(const std::string& file);
  std::filesystem::path rigid_file(int n) const { return folder_ / fmt::format("rigid_{:04}.vtu", n); }
  std::filesystem::path particle_file(int n) const { return folder_ / fmt::format("particles_{:04}.vtp", n); }
  std::filesystem::path mesh_file(int n) const { return folder_ / fmt::format("mesh_{:04}.vtu", n); }

  std::filesystem::path folder_;
  const OutputSpec& outputs_;
  const std::vector<Stage>& stage_list_;
  BalanceHistory<D> accounts_;
  BodyForces<D> body_forces_;
  Progress progress_;
  Schedule particle_times_, mesh_times_, history_times_;
  OwnColumns<D> own_columns_;
  std::optional<HistoryWriter<D>> history_;
  HistoryState<D> history_state_;  // state of history_ at its last row
  FrameOutput frames_;
  int particle_files_ = 0, mesh_files_ = 0;
  bool has_rigid_ = false;                                        // whether the scene has rigid bodies
  Real particle_time_ = -1, mesh_time_ = -1, history_time_ = -1;  // times of the last files or rows [s]
  Real stage_start_ = 0, done_before_ = 0;
  RanksSummary ranks_;
  Traffic traffic_begin_;  // at the beginning of the first step
  std::int64_t step_begin_ = 0;
  Timings timings_begin_;
  Real output_begin_ = 0;
  LastSeen<D> last_;
  std::vector<StageResult> stages_;
  std::vector<std::string> changes_;
  std::vector<std::string> files_;
  FilesOfEarlierRun elsewhere_;
  std::string last_output_;         // on the disk, relative to the folder
  std::string newest_output_;       // the same once the frame that is being written is on the disk, as it is when a checkpoint appears
  std::vector<std::string> frame_;  // files of the frame that is being written
  bool frame_has_particles_ = false;
  std::vector<BodySummary> bodies_;
  Runout<D> runout_;
  Real output_seconds_ = 0, bytes_per_particle_ = 0;
};

extern template class Recorder<2>;
extern template class Recorder<3>;

}  // namespace talus
