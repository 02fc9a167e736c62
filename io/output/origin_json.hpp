#pragma once
// The origin of the results of a run: program, method and machine, from its summary.json.
#include <filesystem>
#include <string>

namespace talus {

struct RunOrigin {
  std::string status, version, commit, compiler, build, kernel, transfer, precision, threads;  ///< "unknown" if not in the file
};

/// Throws EnvironmentError with the name of the file if it cannot be read or is not a summary of a run.
RunOrigin read_origin(const std::filesystem::path& summary);

}  // namespace talus
