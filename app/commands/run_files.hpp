#pragma once
// What the folder of a run holds from its beginning.
#include <filesystem>
#include <optional>

#include "app/observers/checkpoints.hpp"
#include "io/output/run_summary.hpp"
#include "mesh/mesh.hpp"

namespace talus {

/// Whether a run goes on in the folder of the run that it comes from, if it comes from any.
bool goes_on_in_place(const CheckpointList* from, const std::filesystem::path& folder);

/// Summary, mesh and state at the start; a mesh that is there is that of the run, or what the user has made of it.  `initial`: the file that bodies begin with,
/// which is copied.
template <int D>
void write_first_files(const std::filesystem::path& place, const RunSummary& summary, const Mesh<D>& mesh,
                       const std::optional<std::filesystem::path>& initial);

extern template void write_first_files<2>(const std::filesystem::path&, const RunSummary&, const Mesh<2>&,
                                          const std::optional<std::filesystem::path>&);
extern template void write_first_files<3>(const std::filesystem::path&, const RunSummary&, const Mesh<3>&,
                                          const std::optional<std::filesystem::path>&);

}  // namespace talus
