#pragma once
// The results of `talus bench` and of `talus bench --mpi`, and their files.
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace talus {

/// The statistics of a repeated measurement.
struct Measured {
  Real median{}, least{}, most{};
};

/// A case: words of a scene, and the block that it runs on.
struct BenchSetting {
  std::string kernel, transfer, law;
  int dimension{}, per_cell{}, threads{};
  std::string option = {};  ///< additional feature of the block, such as "f_bar"; empty for none
  bool operator==(const BenchSetting&) const = default;
};

struct BenchPhase {
  std::string name;
  Real ns{};  ///< median wall time per particle-step [ns]
};

struct BenchResult {
  BenchSetting setting;
  std::int64_t particles{}, steps{};  ///< number of particles; steps of one repeat
  Measured ns;                        ///< wall time per particle-step [ns]
  Measured cpu;                       ///< processor time of all threads per particle-step [ns]
  std::vector<BenchPhase> phases;
  std::vector<Real> repeats;  ///< wall time per particle-step of each repeat, in order [ns]
  Real bytes_held{};          ///< memory of columns and history of a particle [B]
  Real bytes_moved{};         ///< least memory traffic per particle-step [B]
  /// Million particle-steps per second and core.
  Real rate() const noexcept { return 1e3 / (ns.median * setting.threads); }
};

struct BenchReport {
  std::string version, commit, compiler, build, flags;
  std::string processor;
  int cores{};
  std::vector<BenchResult> results;
};

/// Writes the file atomically; throws EnvironmentError with its name.
void write_bench(const std::filesystem::path& file, const BenchReport& report);

/// Reads such a file.  Throws SceneErrors if it is missing or of another kind.
BenchReport read_bench(const std::filesystem::path& file);

struct RanksReport {
  std::string version, commit, compiler, build, processor;
  int cores{};  ///< cores of the root's machine
  BenchSetting setting;
  std::int64_t particles{}, cells{}, nodes{};  ///< numbers of the whole model
  int steps{};                                 ///< steps of a repeat
  Measured seconds;                            ///< time of a step on the slowest rank, over the repeats [s]
  /// Columns for each rank: what it owns, holds and sends in a step; seconds of a step by phase in the repeat with the median time.
  std::vector<std::string> columns;
  std::vector<std::vector<Real>> ranks;
};

/// Writes the file atomically; throws EnvironmentError with its name.
void write_ranks(const std::filesystem::path& file, const RanksReport& report);

}  // namespace talus
