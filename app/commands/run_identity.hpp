#pragma once
// What tells one run from another: its program, scene, mesh and files.
#include "app/observers/checkpoints.hpp"

namespace talus {

/// Of this program and a scene; `mesh` and `from_files` are digests, `initial` is the file that bodies begin with, or empty.
RunIdentity identity_of(const Scene& scene, bool quick, std::uint64_t mesh, std::uint64_t from_files, const std::string& initial);

/// EnvironmentError: the mesh, or what other files say, is not that of the checkpoint. Another program is a warning.
void compare(const RunIdentity& then, const RunIdentity& now);

}  // namespace talus
