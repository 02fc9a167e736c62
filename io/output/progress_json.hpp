#pragma once
// progress.json: how far a run is, for whoever follows it.
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "core/types.hpp"

namespace talus {

struct RunProgress {
  Real done = 0, total = 0;  ///< simulated time of all stages [s]
  Real done_before = 0;      ///< of it, before this process went on with the run
  Real time = 0, dt = 0;     ///< clock of the run, last step [s]
  std::int64_t step = 0;
  std::string stage;
  Real elapsed = 0;  ///< of this process [s]
  Real particle_steps_per_second = 0;

  Real share() const noexcept { return total > 0 ? std::min(done / total, 1.0) : 0; }
  /// Seconds until the end at the speed so far; nothing as long as nothing is done.
  std::optional<Real> left() const noexcept;
};

/// Rewrites the file as a whole, without waiting for the disk; where that fails it stays as it was.
void write_progress(const std::filesystem::path& file, const RunProgress& progress);

/// Nothing if there is no such file, or it is none.
std::optional<RunProgress> read_progress(const std::filesystem::path& file);

}  // namespace talus
