#pragma once
// Watches a run: files at their times, accounts, progress, and what the summary needs when the run is over or has failed.
#include <filesystem>

#include "app/history.hpp"
#include "app/progress.hpp"
#include "app/simulate.hpp"
#include "io/report.hpp"
#include "io/vtk.hpp"

namespace talus {

/// Times at which something is written: 0, every, 2 every, ...
class Schedule {
 public:
  explicit Schedule(Real every) : every_(every) {}
  /// True once for each of these times that has come.
  bool due(Real time);

 private:
  Real every_;
  Real next_ = 0;
};

/// State of the run when it was last seen sound.
template <int D>
struct LastSeen {
  Clock clock;
  Timings timings;
  MassLedger mass;
  EnergyNow energy;
  Vec<D> momentum_start = Vec<D>::Zero(), momentum = Vec<D>::Zero(), impulse = Vec<D>::Zero();
  Real momentum_scale{};
  bool momentum_closes = false;
};

template <int D>
class Recorder {
 public:
  /// `outputs` and the stages must outlive the recorder.
  Recorder(std::filesystem::path folder, const OutputSpec& outputs, const std::vector<Stage>& stages, bool quiet);

  void watch(const Frame<D>& frame, Moment moment);
  void stage_done(const StageResult& result) { stages_.push_back(result); }

  const LastSeen<D>& last_seen() const noexcept { return last_; }
  std::span<const StageResult> stages() const noexcept { return stages_; }
  const std::vector<std::string>& files() const noexcept { return files_; }  ///< relative to the folder
  const std::string& last_output() const noexcept { return last_output_; }
  Real output_seconds() const noexcept { return output_seconds_; }
  Real bytes_per_particle() const noexcept { return bytes_per_particle_; }
  const std::vector<BodySummary>& bodies() const noexcept { return bodies_; }

 private:
  void open(const Frame<D>& frame);
  void write(const Frame<D>& frame, bool last);
  void write_particles_file(const Frame<D>& frame);
  void write_mesh_file(const Frame<D>& frame);

  std::filesystem::path folder_;
  const OutputSpec& outputs_;
  const std::vector<Stage>& stage_list_;
  Accounts<D> accounts_;
  Progress progress_;
  Schedule particle_times_, mesh_times_, history_times_;
  std::optional<HistoryWriter<D>> history_;
  PvdSeries particle_series_, mesh_series_;
  int particle_files_ = 0, mesh_files_ = 0;
  Real particle_time_ = -1, mesh_time_ = -1, history_time_ = -1;  // of the last ones written
  Real stage_start_ = 0, done_before_ = 0;
  LastSeen<D> last_;
  std::vector<StageResult> stages_;
  std::vector<std::string> files_;
  std::string last_output_;
  std::vector<BodySummary> bodies_;
  Real output_seconds_ = 0, bytes_per_particle_ = 0;
};

extern template class Recorder<2>;
extern template class Recorder<3>;

}  // namespace talus
