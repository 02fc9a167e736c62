#pragma once
// Where the results of a run come from: what its summary.json says of program, method and machine.
#include <filesystem>
#include <string>

namespace talus {

struct RunOrigin {
  std::string status, version, commit, compiler, build, kernel, transfer, precision, threads;  ///< "unknown" where the file does not say
};

/// EnvironmentError naming the file: it cannot be read, or is no summary of a run.
RunOrigin read_origin(const std::filesystem::path& summary);

}  // namespace talus
