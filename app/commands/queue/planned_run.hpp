#pragma once
// Runs started by another command, each in its own process: their input, their state, and those in progress.
#include <array>
#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/output/summary_json.hpp"
#include "io/system/child_process.hpp"

namespace talus {

/// A scene with changes, and the results folder.
struct PlannedRun {
  std::vector<std::string> changes;  ///< changes as for --set
  std::filesystem::path folder;
  std::string scene_digest, mesh_digest;  ///< digests of the present scene and mesh; the latter is empty if it was not computed
};

enum class CaseState : std::uint8_t { to_run, not_ended, stopped, failed, done };
constexpr std::array<std::string_view, 5> enum_names(CaseState) { return {"to be run", "not ended", "stopped", "failed", "done"}; }

/// The state of a run according to its folder.
struct CaseStatus {
  CaseState state = CaseState::to_run;
  std::string why;                   ///< why existing results do not count; or the message of a failed run
  std::optional<Real> goes_on_from;  ///< time of the newest checkpoint of this run [s]
  SummaryBack summary;               ///< only if it belongs to this run
};

/// The state of a run.  Results of another text, other changes or another mesh (if its digest is known) do not belong to it.
CaseStatus status_of(const PlannedRun& run, bool quick);

/// Whether another process is writing to the folder, as far as the file system supports locks.
bool is_at_work(const PlannedRun& run);

/// The changes as text: "materials[0].cohesion=20e3, mesh.size=0.1".
std::string in_words(const PlannedRun& run);

/// The command of the run for the user, relative to the present folder.
std::string command_of(const std::filesystem::path& scene, const PlannedRun& run, bool quick);

/// The number of simultaneous runs, and of threads for each.
struct SideBySide {
  std::size_t jobs;
  std::optional<int> threads;  ///< nothing: left to the launcher
};
/// Divides the cores; values that are not given follow from those that are.
SideBySide divide_cores(std::optional<int> jobs, std::optional<int> threads, bool has_launcher, std::size_t n_runs);

/// The runs in progress.  Their output is in FOLDER.log beside their folder.
class ChildRuns {
 public:
  ChildRuns(std::optional<std::string> launcher, std::optional<int> threads, bool quick)
      : launcher_(std::move(launcher)), threads_(threads), quick_(quick)
  {}

  /// Starts a run, or resumes it according to `status`.  Throws EnvironmentError.
  void start(std::size_t number, const std::filesystem::path& scene, const PlannedRun& run, const CaseStatus& status);

  struct Ended {
    std::size_t number;
    int code;
    Real seconds;
  };
  /// Waits a little; returns the runs that have ended.
  std::vector<Ended> look();

  /// Asks the runs to write checkpoints and end.
  void ask_to_end();
  /// Whether a run with this exit code was stopped before it had anything to save.
  bool ended_before_its_first_step(int code) const noexcept;

  std::size_t count() const noexcept { return running_.size(); }

  /// The reason why a run ended without being done.
  std::string why(const PlannedRun& run, int code, const CaseStatus& status) const;

 private:
  struct Running {
    std::size_t number;
    ChildProcess process;
    std::chrono::steady_clock::time_point begun;
  };
  std::optional<std::string> launcher_;
  std::optional<int> threads_;
  bool quick_;
  std::vector<Running> running_;
  bool told_to_end_ = false;
};

/// Exit codes of a run that was told to stop, and of one that failed by its physics.
inline constexpr int run_was_stopped = 4, run_failed = 1;

}  // namespace talus
