#pragma once
// Checkpoints: writing the state of a run, when it is due or when the run is asked to stop, and reading it.
#include <chrono>

#include "app/observers/recorder.hpp"
#include "core/parallel/background_task.hpp"
#include "io/checkpoint/array_file.hpp"
#include "solver/model/model.hpp"

namespace talus {

/// The identity of the run that a checkpoint belongs to.
struct RunIdentity {
  std::string version, commit, compiler, build;  ///< of the program; `build`: its type and flags
  std::string scene_file;                        ///< absolute path
  std::string scene_text;                        ///< text of the scene as it was read
  std::vector<std::string> set;                  ///< changes by --set
  bool quick = false;
  std::int64_t mesh = 0;        ///< digest of the mesh
  std::int64_t from_files = 0;  ///< digest of records, of the water table and of the surfaces of rigid bodies
  std::string initial;          ///< initial state from another run, or empty
  static constexpr auto fields()
  {
    return std::tuple{saved("version", &RunIdentity::version),
                      saved("commit", &RunIdentity::commit),
                      saved("compiler", &RunIdentity::compiler),
                      saved("build", &RunIdentity::build),
                      saved("scene_file", &RunIdentity::scene_file),
                      saved("scene", &RunIdentity::scene_text),
                      saved("set", &RunIdentity::set),
                      saved("quick", &RunIdentity::quick),
                      saved("mesh", &RunIdentity::mesh),
                      saved("from_files", &RunIdentity::from_files),
                      saved("initial", &RunIdentity::initial)};
  }
};

/// A run of one rank writes one checkpoint at a time on a thread of its own, while the next steps run: a copy of the particles, which stay in
/// their strips, and of everything else that is saved.  Several ranks write a checkpoint together before the next step, because only their
/// main threads may send messages.  Either way a file appears under its name when it is complete, and the bytes are the same.
template <int D>
class Checkpoints {
 public:
  /// Checkpoints are written to folder/checkpoints.
  Checkpoints(std::filesystem::path folder, const CheckpointSpec& spec, RunIdentity identity,
              std::optional<std::int64_t> until = std::nullopt);

  /// To be called before each step: writes a checkpoint, or begins to, if it is due.  Throws Stopped after writing one because of a signal,
  /// after `until` steps or for `reason`; EnvironmentError if this one or the one before could not be written, with older ones unchanged.
  void see(const RunView<D>& view, Recorder<D>& recorder, std::string reason = {});
  /// To be called after a stage, when the recorder has its result: writes a checkpoint at the end of the run if the scene requests it, and
  /// returns when all are on the disk at the end of the run.
  void see_end_of_stage(const RunView<D>& view, Recorder<D>& recorder, Index n_stages);
  /// Writes a checkpoint.  Throws EnvironmentError.
  void write(const RunView<D>& view, Recorder<D>& recorder);
  /// Returns when the checkpoint that is being written is on the disk.  Throws EnvironmentError if it could not be written.
  void finish();
  /// The last checkpoint on the disk, empty if there is none, and its number of steps.  Not the one that finish() would wait for.
  const std::filesystem::path& last() const noexcept { return last_.file; }
  std::optional<std::int64_t> last_step() const noexcept { return last_.file.empty() ? std::nullopt : std::optional(last_.step); }
  bool is_pending() const noexcept { return pending_.has_value(); }
  /// Wall time that all of them took of the steps [s].
  Real seconds() const noexcept { return seconds_; }

 private:
  using Watch = std::chrono::steady_clock;
  struct Written {
    std::filesystem::path file;
    std::int64_t step = 0;
  };
  bool due(const Clock& clock) const;
  void begin(const RunView<D>& view, Recorder<D>& recorder);

  std::filesystem::path folder_;
  CheckpointSpec spec_;
  RunIdentity identity_;
  std::optional<std::int64_t> until_;
  Written last_;
  std::optional<Written> pending_;         // begun, until finish()
  std::optional<Clock> at_;                // time of the last one, or of the first call
  Watch::time_point when_ = Watch::now();  // end of the last one
  Real seconds_ = 0;
  BackgroundTask task_;  // last: its destructor waits while the others exist
};

/// The sizes of a state of this scene.
struct StateLimits {
  Index cells, stages, particles;                 ///< particles: initial number of all bodies
  std::span<const std::vector<Material>> laws{};  ///< laws of the bodies in each stage
};

/// The bodies of a run, read without the rest of its state.
template <int D>
struct KeptBodies {
  Particles<D> particles;
  std::vector<Body> bodies;
  std::vector<Material> materials;
  Clock clock;
  StageState stage;
  EnergyLedger energy;
  FlowLedger flow;
  EmptyCellStress<D> empty_cells;
  std::vector<std::vector<Material>> laws;  ///< laws of each stage, to be set before reading
};

/// Checkpoints to resume from, the newest first.
class CheckpointList {
 public:
  /// From a checkpoint or a results folder.  Throws EnvironmentError if none can be read, or if they have another format.
  explicit CheckpointList(const std::filesystem::path& at);

  const RunIdentity& identity() const noexcept { return identity_; }
  /// Step and time of the newest checkpoint.
  const Clock& clock() const noexcept { return clock_; }
  const StageState& stage() const noexcept { return stage_; }
  std::span<const std::filesystem::path> files() const noexcept { return files_; }
  /// The results folder, if the checkpoints lie in one.
  const std::optional<std::filesystem::path>& folder() const noexcept { return folder_; }
  /// Replaces the state by the newest one that is valid, and returns the name of its file.  Damaged checkpoints are named on standard
  /// error.  With several ranks each reads a slice of the particles, whose cells are those of the whole mesh: see adopt_state().  Throws
  /// EnvironmentError if none is valid and fits.
  template <int D>
  std::filesystem::path take_over(State<D>& state, Recorder<D>& recorder, const StateLimits& limits) const;
  /// The file that was read, and the reasons why newer ones were not.
  struct Read {
    std::filesystem::path file;
    std::string reasons;
  };
  /// Reads the bodies of the newest valid state.  Their number, the laws and the precision of the particles must be set before.  Throws
  /// EnvironmentError if no state is valid, or if the bodies do not fit.
  template <int D>
  Read read(KeptBodies<D>& saved) const;

 private:
  /// Calls f(file) for the newest checkpoint for which it does not throw EnvironmentError.
  template <class F>
  Read newest(F&& f) const;

  std::vector<std::filesystem::path> files_;
  std::optional<std::filesystem::path> folder_;
  RunIdentity identity_;
  Clock clock_;
  StageState stage_;
};

/// Renames the checkpoints in a results folder that are newer than the one that is resumed: they are damaged or belong to a discarded
/// continuation, and would be taken for the newest.  Returns their new names.
std::vector<std::filesystem::path> set_aside_newer(const std::filesystem::path& folder, const std::filesystem::path& taken);

extern template class Checkpoints<2>;
extern template class Checkpoints<3>;

}  // namespace talus
