#pragma once
// The identity of a run: its program, scene, mesh and files.
#include "app/observers/checkpoints.hpp"

namespace talus {

/// The identity for this program and a scene; `mesh` and `from_files` are digests, `initial` is the file of the initial state, or empty.
RunIdentity identity_of(const Scene& scene, bool quick, std::uint64_t mesh, std::uint64_t from_files, const std::string& initial);

/// Throws EnvironmentError if the mesh, or the contents of other files, differ from those of the checkpoint.  Another program leads to a
/// warning.
void compare(const RunIdentity& then, const RunIdentity& now);

}  // namespace talus
