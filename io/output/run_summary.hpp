#pragma once
// The contents of summary.json: scene, program, result, cost and balances of a run.
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/fields.hpp"

namespace talus {

enum class RunStatus : std::uint8_t { done, failed, stopped };
constexpr std::array<std::string_view, 3> enum_names(RunStatus) { return {"done", "failed", "stopped"}; }

/// A named number with its unit: work terms, qualities, wall seconds.
struct NamedValue {
  std::string name;
  Real value{};
  std::string unit = {};
};

struct BodySummary {
  std::string name, material, law;
  std::int64_t particles{};
  Real mass{};  ///< mass at the start, or when it appeared [kg]
  static constexpr auto fields()
  {
    return std::tuple{saved("name", &BodySummary::name), saved("material", &BodySummary::material), saved("law", &BodySummary::law),
                      saved("particles", &BodySummary::particles), saved("mass", &BodySummary::mass)};
  }
};

struct StageSummary {
  std::string kind;  ///< "geostatic" or "run"
  std::int64_t steps{};
  Real duration{};                          ///< simulated time [s]
  std::optional<Real> residual;             ///< unbalanced nodal force over total load at the end, in stages that seek equilibrium [-]
  std::string result;                       ///< "reached", "not converged", ...
  std::optional<Real> first_residual = {};  ///< unbalanced force in the first step: the distance of the initial state from equilibrium [-]
  std::string name{};                       ///< name in the scene, or the kind
};

/// The relative error of a balance: |sum that should vanish| over the named scale.
struct Closure {
  Real relative{}, limit{};                                   ///< relative error; criterion for a closed balance
  std::string relative_to;                                    ///< description of the scale
  bool closes() const noexcept { return relative <= limit; }  // false for NaN
};

/// The energy balance.  Terms have the sign with which they enter the sum.
struct EnergyAudit {
  std::vector<NamedValue> terms;  ///< J: kinetic energy, work of gravity, of loads, of walls, of stress, damping, transfer
  Closure closure;
};

/// The balance of momentum or of angular momentum.
struct MomentumAudit {
  std::vector<Real> start, end, impulse;  ///< kg m/s or kg m^2/s, a number per component; impulse: of everything outside the bodies
  Closure closure;
  std::vector<Real> transfer_loss = {};  ///< angular momentum: loss between particles and nodes [kg m^2/s]
  Real transfer_share{};                 ///< its magnitude over the scale of the closure [-]
};

struct MassAudit {
  Real start{}, end{}, removed{};  ///< kg
  std::int64_t particles_removed{};
  Closure closure{};
  Real placed{}, taken{};  ///< changes by stages [kg]
  std::int64_t particles_placed{}, particles_taken{};
};

/// The quantities that the run limits were compared with.
struct WatchSummary {
  Real fastest{}, speed_limit{};       ///< m/s
  Real gain{}, gain_limit{};           ///< energy gain without work, relative to the largest energy term [-]
  std::int64_t speeding{}, gaining{};  ///< numbers of steps and checks beyond the limits
};

/// The origin of bodies that come from another run.
struct OriginSummary {
  std::string file;                                             ///< name of the checkpoint
  std::string title, scene_file, version, commit, mesh_digest;  ///< of the run that wrote it
  std::int64_t step{};
  Real time{};  ///< time of the checkpoint [s]
  struct Taken {
    std::string body, from;
    std::int64_t particles;
  };
  std::vector<Taken> bodies;
};

/// A body that starts with the state of a table.
struct StartStateSummary {
  std::string body, file;
  std::int64_t points{}, particles{};
  std::int64_t beyond_yield{};  ///< particles whose stress lies beyond the yield surface
  Real largest_return{};        ///< of their stress to it, over the largest stress of the body [-]
  Real farthest{};              ///< largest distance of a particle from its nearest point [m]
};

/// The distribution of a run among ranks and its cost; numbers per step are those of the rank with the largest value.
struct RanksSummary {
  int count = 1;
  Real imbalance = 1;   ///< largest number of particles of a rank over the mean, at the end
  Real cells_held = 1;  ///< cells in the rank's part over own cells
  Real messages{};      ///< messages to single ranks per step
  Real bytes{};         ///< bytes of these messages per step
  Real collectives{};   ///< collective calls per step
  Real collective_bytes{};
  Real particles_moved{};     ///< particles that change their rank per step, over all particles
  std::int64_t rebalances{};  ///< number of redistributions
  Real rebalancing{};         ///< total time of redistributions [s]
};

/// The contents of summary.json.  Empty optional parts are left out of the file.
struct RunSummary {
  std::string title;
  std::string scene_file;
  std::string scene_text;              ///< text of the scene, byte for byte
  std::vector<std::string> overrides;  ///< changes by --set
  std::string version, commit, compiler, build;
  RunStatus status = RunStatus::done;
  std::string message;  ///< reason of a failure

  int dimension{};
  std::string kernel, transfer;
  int threads{};
  RanksSummary ranks;

  std::int64_t mesh_nodes{}, mesh_cells{};
  /// Nodes on curved or creased boundaries for which the kernel finds no positive weights along the boundary.
  std::int64_t nodes_as_corners{};
  std::string scene_digest;  ///< digest of the text and of the changes
  std::string mesh_digest;   ///< digest of nodes, cells and groups: equal for equal meshes
  std::vector<NamedValue> mesh_quality;
  std::vector<BodySummary> bodies;
  std::optional<OriginSummary> origin;
  std::vector<StartStateSummary> start_states;
  std::vector<StageSummary> stages;
  std::vector<std::string> changes;  ///< changes made by stages before their first steps, in words

  std::int64_t steps{};
  Real simulated_time{};                 ///< simulated time [s]
  std::vector<NamedValue> wall_seconds;  ///< wall time by phase: set-up, each phase of the step, output, checkpoints
  Real wall_total{};                     ///< wall time in total [s]
  Real particle_steps_per_second{};
  Real bytes_per_particle{};
  std::int64_t peak_memory_bytes{};  ///< largest resident set [B]

  std::optional<EnergyAudit> energy;
  std::optional<MomentumAudit> momentum, angular_momentum;
  std::optional<MassAudit> mass;
  WatchSummary watch;
  std::vector<NamedValue> runout;  ///< at the last sample, if the scene has outputs.runout

  std::vector<std::string> warnings;
  std::vector<std::string> files;  ///< files written by the run, relative to its folder

  /// Program and inputs in one line, for files that may be moved away from the summary.
  std::string made_by() const;
};

/// The text of summary.json.  Numbers have all their digits; those that are not finite are null.
std::string to_json(const RunSummary& summary);

/// Writes summary.json atomically; throws EnvironmentError with the name of the file.
void write_summary(const std::filesystem::path& file, const RunSummary& summary);

}  // namespace talus
