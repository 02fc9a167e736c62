#pragma once
// The text file of samples that the key `record` of a boundary condition names.
#include <filesystem>
#include <string>

#include "core/recorded_motion.hpp"

namespace talus {

/// The motion [m/s].  Throws SceneErrors with file, line and column of all that is wrong in the file: not two numbers in a line, times that
/// do not increase, fewer than two samples.
Record read_record(const std::filesystem::path& file, const RecordOptions& spec);

/// Its duration, its peaks and what is left of it at its end, in a line.
std::string describe(const RecordOptions& spec, const Record& record);

}  // namespace talus
