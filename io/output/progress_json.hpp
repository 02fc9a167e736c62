#pragma once
// progress.json: the progress of a run, for programs that follow it.
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "core/types.hpp"

namespace talus {

struct RunProgress {
  Real done = 0, total = 0;  ///< simulated time of all stages [s]
  Real done_before = 0;      ///< part of `done` before this process resumed the run [s]
  Real time = 0, dt = 0;     ///< time of the run, length of the last step [s]
  std::int64_t step = 0;
  std::string stage;
  Real elapsed = 0;  ///< wall-clock time of this process [s]
  Real particle_steps_per_second = 0;

  Real share() const noexcept { return total > 0 ? std::min(done / total, 1.0) : 0; }
  /// The seconds until the end at the mean speed so far; nothing before the first progress.
  std::optional<Real> left() const noexcept;
};

/// Rewrites the file atomically, without a flush to the disk; if that fails the file is unchanged.
void write_progress(const std::filesystem::path& file, const RunProgress& progress);

/// Nothing if the file does not exist or is not valid.
std::optional<RunProgress> read_progress(const std::filesystem::path& file);

}  // namespace talus
