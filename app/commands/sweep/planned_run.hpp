#pragma once
// Runs that another command starts, each a process of its own: what they are made from, how far they have come, those at work now.
#include <array>
#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/output/summary_json.hpp"
#include "io/system/child_process.hpp"

namespace talus {

/// A scene with changes, and the folder for its results.
struct PlannedRun {
  std::vector<std::string> changes;  ///< as --set takes them
  std::filesystem::path folder;
  std::string scene_digest, mesh_digest;  ///< what it would be made from now; that of the mesh empty where nobody asked for it
};

enum class CaseState : std::uint8_t { to_run, not_ended, stopped, failed, done };
constexpr std::array<std::string_view, 5> enum_names(CaseState) { return {"to be run", "not ended", "stopped", "failed", "done"}; }

/// What the folder of a run says of it.
struct CaseStatus {
  CaseState state = CaseState::to_run;
  std::string why;                   ///< results there are not of this run; or it failed with this message
  std::optional<Real> goes_on_from;  ///< time of the newest checkpoint of this run [s]
  SummaryBack summary;               ///< of this run only
};

/// Results that were made from another text, other changes or another mesh (where its digest is known) are not those of the run.
CaseStatus status_of(const PlannedRun& run, bool quick);

/// Another process is writing there now, as far as the file system knows.
bool is_at_work(const PlannedRun& run);

/// "materials[0].cohesion=20e3, mesh.size=0.1"
std::string in_words(const PlannedRun& run);

/// The command that makes it, for people: in the folder from which the paths count.
std::string command_of(const std::filesystem::path& scene, const PlannedRun& run, bool quick);

/// How many runs are made side by side, and with how many threads each.
struct SideBySide {
  std::size_t jobs;
  std::optional<int> threads;  ///< nothing: the launcher's business
};
/// What is not asked for is the cores over what is.
SideBySide divide_cores(std::optional<int> jobs, std::optional<int> threads, bool has_launcher, std::size_t n_runs);

/// Runs at work.  What they say stands beside their folder, in FOLDER.log.
class ChildRuns {
 public:
  ChildRuns(std::optional<std::string> launcher, std::optional<int> threads, bool quick)
      : launcher_(std::move(launcher)), threads_(threads), quick_(quick)
  {}

  /// Begins, or goes on where `status` says so.  EnvironmentError.
  void start(std::size_t number, const std::filesystem::path& scene, const PlannedRun& run, const CaseStatus& status);

  struct Ended {
    std::size_t number;
    int code;
    Real seconds;
  };
  /// Waits a little; tells those that have ended.
  std::vector<Ended> look();

  /// They leave checkpoints and end.
  void ask_to_end();
  /// Whether a run that ended with this code was told to before there was anything to keep.
  bool ended_before_its_first_step(int code) const noexcept;

  std::size_t count() const noexcept { return running_.size(); }

  /// Why one ended that is not done.
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

/// Exit code of a run that was told to stop, and of one that failed at its own physics.
inline constexpr int run_was_stopped = 4, run_failed = 1;

}  // namespace talus
