#pragma once
// Checkpoints: the state of a run in a file, when it is due and when somebody asks the run to stop; and the way back.
#include <chrono>

#include "app/observers/recorder.hpp"
#include "io/checkpoint/array_file.hpp"
#include "solver/model/model.hpp"

namespace talus {

/// Which run a checkpoint belongs to.
struct RunIdentity {
  std::string version, commit, compiler, build;  ///< of the program; `build`: its type and flags
  std::string scene_file;                        ///< absolute path
  std::string scene_text;                        ///< as it was read
  std::vector<std::string> set;                  ///< what --set changed
  bool quick = false;
  std::int64_t mesh = 0;        ///< its digest
  std::int64_t from_files = 0;  ///< digest of records and of the water table
  std::string initial;          ///< checkpoint of another run that it began with, if it did
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

template <int D>
class Checkpoints {
 public:
  /// They go to folder/checkpoints.
  Checkpoints(std::filesystem::path folder, const CheckpointSpec& spec, RunIdentity identity,
              std::optional<std::int64_t> until = std::nullopt);

  /// Before each step: writes one if it is due.  Stopped after writing one because of a signal, or where steps are done `until` which the
  /// run was to go.  EnvironmentError: it could not be written; older ones are left as they are.
  void see(const RunView<D>& view, const Recorder<D>& recorder);
  /// After a stage, the recorder knowing its result: writes one at the end of the run if the scene wants it.
  void see_end_of_stage(const RunView<D>& view, const Recorder<D>& recorder, Index n_stages);
  /// Writes one now.  EnvironmentError.
  void write(const RunView<D>& view, const Recorder<D>& recorder);
  /// The last one written, empty if there is none, and the steps done then.
  const std::filesystem::path& last() const noexcept { return last_; }
  std::optional<std::int64_t> last_step() const noexcept { return last_.empty() ? std::nullopt : std::optional(at_->step); }

 private:
  using Watch = std::chrono::steady_clock;
  bool due(const Clock& clock) const;

  std::filesystem::path folder_;
  CheckpointSpec spec_;
  RunIdentity identity_;
  std::optional<std::int64_t> until_;
  std::filesystem::path last_;
  std::optional<Clock> at_;  // of the last one, or of the first look
  Watch::time_point when_ = Watch::now();
};

/// What a state must fit to be one of this scene.
struct StateLimits {
  Index cells, stages, particles;                 ///< particles: of all bodies as they are placed
  std::span<const std::vector<Material>> laws{};  ///< of the bodies in each stage
};

/// The bodies of a run, read by themselves.
template <int D>
struct KeptBodies {
  Particles<D> particles;
  std::vector<Body> bodies;
  std::vector<Material> materials;
  Clock clock;
  StageState stage;
  EnergyLedger energy;
  std::vector<std::vector<Material>> laws;  ///< of each stage, to be there already
};

/// Checkpoints to go on from, the newest first.
class CheckpointList {
 public:
  /// A checkpoint, or the folder of a run.  EnvironmentError: there is none that can be read, or they are of another format.
  explicit CheckpointList(const std::filesystem::path& at);

  const RunIdentity& identity() const noexcept { return identity_; }
  /// How far the run was.
  const Clock& clock() const noexcept { return clock_; }
  const StageState& stage() const noexcept { return stage_; }
  std::span<const std::filesystem::path> files() const noexcept { return files_; }
  /// Folder of the run, where they lie in one.
  const std::optional<std::filesystem::path>& folder() const noexcept { return folder_; }
  /// Puts the newest state that is whole in the place of what is there, and says which file had it.  One that is damaged is named on standard
  /// error, and the one before it is taken.  Of several ranks each takes a slice of the particles, whose cells are of the whole mesh: see
  /// adopt_state().  EnvironmentError: none is whole and fits.
  template <int D>
  std::filesystem::path take_over(State<D>& state, Recorder<D>& recorder, const StateLimits& limits) const;
  /// Which file was read, and why newer ones were not.
  struct Read {
    std::filesystem::path file;
    std::string reasons;
  };
  /// The bodies of the newest state that is whole.  Their number, the laws and the precision of the particles must be there already.
  /// EnvironmentError: none is whole, or they are others.
  template <int D>
  Read read(KeptBodies<D>& saved) const;

 private:
  /// f(file) for the newest one for which it throws no EnvironmentError.
  template <class F>
  Read newest(F&& f) const;

  std::vector<std::filesystem::path> files_;
  std::optional<std::filesystem::path> folder_;
  RunIdentity identity_;
  Clock clock_;
  StageState stage_;
};

/// Renames the checkpoints of a run's folder that are newer than the one it goes on from: they are of a way that is left now, or damaged, and
/// would be taken for the newest of this one.  Returns their new names.
std::vector<std::filesystem::path> set_aside_newer(const std::filesystem::path& folder, const std::filesystem::path& taken);

extern template class Checkpoints<2>;
extern template class Checkpoints<3>;
extern template std::filesystem::path CheckpointList::take_over<2>(State<2>&, Recorder<2>&, const StateLimits&) const;
extern template std::filesystem::path CheckpointList::take_over<3>(State<3>&, Recorder<3>&, const StateLimits&) const;
extern template CheckpointList::Read CheckpointList::read<2>(KeptBodies<2>&) const;
extern template CheckpointList::Read CheckpointList::read<3>(KeptBodies<3>&) const;

}  // namespace talus
