#pragma once
// The text file of samples that the key `record` of a boundary condition names.
#include <filesystem>
#include <string>

#include "core/recorded_motion.hpp"

namespace talus {

/// The motion [m/s].  Throws SceneErrors with file, line and column of all errors: lines without two numbers, times that do not increase,
/// fewer than two samples.
Record read_record(const std::filesystem::path& file, const RecordOptions& spec);

/// A line with its duration, its peaks, and velocity and displacement at its end.
std::string describe(const RecordOptions& spec, const Record& record);

}  // namespace talus
