#pragma once
// summary.json: what was run, with what, how it went, what it cost, and how well the balances close.
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
  Real mass{};  ///< kg at the start, or when it appeared
  static constexpr auto fields()
  {
    return std::tuple{saved("name", &BodySummary::name), saved("material", &BodySummary::material), saved("law", &BodySummary::law),
                      saved("particles", &BodySummary::particles), saved("mass", &BodySummary::mass)};
  }
};

struct StageSummary {
  std::string kind;  ///< "geostatic" or "run"
  std::int64_t steps{};
  Real duration{};                          ///< simulated [s]
  std::optional<Real> residual;             ///< unbalanced nodal force over total load at the end, where the stage looks for it
  std::string result;                       ///< "reached", "not converged", ...
  std::optional<Real> first_residual = {};  ///< the same in the first step: how far the stage began from balance
  std::string name{};                       ///< that the scene gave to it, or the same as the kind
};

/// How well a balance closes: |sum that should vanish| over the named scale.
struct Closure {
  Real relative{}, limit{};                                   ///< it closes up to the limit
  std::string relative_to;                                    ///< the scale, in words
  bool closes() const noexcept { return relative <= limit; }  // not for NaN
};

/// Terms are signed as they enter the sum.
struct EnergyAudit {
  std::vector<NamedValue> terms;  ///< J: kinetic energy, work of gravity, of loads, of walls, of stress, damping, transfer
  Closure closure;
};

/// Of momentum or of its moment about the origin.
struct MomentumAudit {
  std::vector<Real> start, end, impulse;  ///< kg m/s or kg m^2/s, a number per component; impulse of everything outside the bodies
  Closure closure;
  std::vector<Real> transfer_loss = {};  ///< of the moment: what particles and nodes lost between them [kg m^2/s]
  Real transfer_share{};                 ///< its modulus over the scale of the closure
};

struct MassAudit {
  Real start{}, end{}, removed{};  ///< kg
  std::int64_t particles_removed{};
  Closure closure{};
  Real placed{}, taken{};  ///< kg, by stages
  std::int64_t particles_placed{}, particles_taken{};
};

/// What the guards saw.
struct WatchSummary {
  Real fastest{}, speed_limit{};       ///< m/s
  Real gain{}, gain_limit{};           ///< energy that nothing did work for, over the largest term
  std::int64_t speeding{}, gaining{};  ///< steps and looks beyond the limits
};

/// Where bodies came from that a run did not fill itself.
struct OriginSummary {
  std::string file;                                             ///< checkpoint
  std::string title, scene_file, version, commit, mesh_digest;  ///< of the run that wrote it
  std::int64_t step{};
  Real time{};  ///< s
  struct Taken {
    std::string body, from;
    std::int64_t particles;
  };
  std::vector<Taken> bodies;
};

/// How a run was shared out, and what that took; a step's numbers are those of the rank that has most of it.
struct RanksSummary {
  int count = 1;
  Real imbalance = 1;   ///< particles of the rank with most, over their mean, at the end
  Real cells_held = 1;  ///< over own cells
  Real messages{};      ///< to single ranks in a step
  Real bytes{};         ///< of these
  Real collectives{};   ///< in a step
  Real collective_bytes{};
  Real particles_moved{};     ///< of all ranks in a step, over the particles
  std::int64_t rebalances{};  ///< times that the run was shared out anew
  Real rebalancing{};         ///< what that took, all in all [s]
};

/// Everything summary.json holds.  Optional parts that are empty are left out of the file.
struct RunSummary {
  std::string title;
  std::string scene_file;
  std::string scene_text;              ///< echo, byte for byte
  std::vector<std::string> overrides;  ///< what --set changed of it
  std::string version, commit, compiler, build;
  RunStatus status = RunStatus::done;
  std::string message;  ///< why it failed

  int dimension{};
  std::string kernel, transfer, precision;
  int threads{};
  RanksSummary ranks;

  std::int64_t mesh_nodes{}, mesh_cells{};
  std::int64_t nodes_as_corners{};  ///< on curved or creased boundaries, where the kernel finds no positive weights along the boundary
  std::string scene_digest;         ///< of the text and of what changed it
  std::string mesh_digest;          ///< of nodes, cells and groups: runs with the same have the same mesh
  std::vector<NamedValue> mesh_quality;
  std::vector<BodySummary> bodies;
  std::optional<OriginSummary> origin;
  std::vector<StageSummary> stages;
  std::vector<std::string> changes;  ///< that stages made before their first steps, in words

  std::int64_t steps{};
  Real simulated_time{};                 ///< s
  std::vector<NamedValue> wall_seconds;  ///< by phase: mesh, build, each verb of the step, output
  Real wall_total{};                     ///< s
  Real particle_steps_per_second{};
  Real bytes_per_particle{};
  std::int64_t peak_memory_bytes{};  ///< resident set

  std::optional<EnergyAudit> energy;
  std::optional<MomentumAudit> momentum, angular_momentum;
  std::optional<MassAudit> mass;
  WatchSummary watch;
  std::vector<NamedValue> runout;  ///< at the last look, where the scene asks for it

  std::vector<std::string> warnings;
  std::vector<std::string> files;  ///< written by the run, relative to its folder

  /// Program and inputs in one line, for files that may be moved away from the summary.
  std::string made_by() const;
};

/// The text of summary.json.  Numbers keep all their digits; those that are not finite become null.
std::string to_json(const RunSummary& summary);

/// Writes summary.json as a whole or not at all; EnvironmentError naming the file.
void write_summary(const std::filesystem::path& file, const RunSummary& summary);

}  // namespace talus
