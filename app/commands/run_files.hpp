#pragma once
// The files that a run writes at its beginning.
#include <filesystem>
#include <optional>

#include "app/observers/checkpoints.hpp"
#include "io/output/run_summary.hpp"
#include "mesh/mesh.hpp"

namespace talus {

/// Whether a run continues in the results folder of the run that it resumes.
bool goes_on_in_place(const CheckpointList* from, const std::filesystem::path& folder);

/// Writes summary, mesh and initial state at the start.  An existing mesh file is kept: it is that of the run, or was changed by the user.
/// `initial`: the file of the initial state, which is copied.
template <int D>
void write_first_files(const std::filesystem::path& place, const RunSummary& summary, const Mesh<D>& mesh,
                       const std::optional<std::filesystem::path>& initial);

}  // namespace talus
