#pragma once
// What `talus bench` measured, and its file.
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace talus {

/// A number that was measured several times.
struct Measured {
  Real median{}, least{}, most{};
};

/// What runs: words of a scene, and the block it runs on.
struct BenchSetting {
  std::string kernel, transfer, law;
  int dimension{}, per_cell{}, threads{};
  std::string precision = "double";
  std::string option = {};  ///< what the block has besides, such as "f_bar"; empty for nothing
  bool operator==(const BenchSetting&) const = default;
};

struct BenchPhase {
  std::string name;
  Real ns{};  ///< per particle-step, median
};

struct BenchResult {
  BenchSetting setting;
  std::int64_t particles{}, steps{};  ///< steps of one repeat
  Measured ns;                        ///< wall time per particle-step
  Measured cpu;                       ///< processor time of all threads per particle-step [ns]
  std::vector<BenchPhase> phases;
  std::vector<Real> repeats;  ///< wall time per particle-step of each, in order [ns]
  Real bytes_held{};          ///< columns and history of a particle [B]
  Real bytes_moved{};         ///< per particle-step, the least that memory has to bring and take [B]
  /// Million particle-steps per second and core.
  Real rate() const noexcept { return 1e3 / (ns.median * setting.threads); }
};

struct BenchReport {
  std::string version, commit, compiler, build, flags;
  std::string processor;
  int cores{};
  std::vector<BenchResult> results;
};

/// Writes the file as a whole or not at all; EnvironmentError naming it.
void write_bench(const std::filesystem::path& file, const BenchReport& report);

/// Reads such a file.  SceneErrors: it is not there, or it is something else.
BenchReport read_bench(const std::filesystem::path& file);

}  // namespace talus
