#pragma once
// Whether the disk has room for what a run will write, asked before anything is computed.
#include <filesystem>

#include "io/scene/scene_output.hpp"
#include "solver/run_view.hpp"

namespace talus {

/// Bytes of the files of a run as if nothing were compressed; 0 for what it does not write.
struct FileSizes {
  Real particles{}, mesh{}, history_row{}, checkpoint{};
};
template <int D>
FileSizes file_sizes(const RunView<D>& view, const OutputSpec& outputs);

/// What a run writes in `time` [s], besides its mesh and its summary: how often each kind, and bytes of all of it as if nothing were
/// compressed.
struct DiskUse {
  std::int64_t particle_files{}, mesh_files{}, history_rows{}, checkpoints{};
  Real bytes{};
};
DiskUse disk_use(const FileSizes& one, const OutputSpec& outputs, Real time);

/// EnvironmentError: the disk of `folder` has no room for a checkpoint and one file of each kind.  A warning on standard error: it has none
/// for all that will be written in `time_left` [s].
template <int D>
void check_disk_space(const std::filesystem::path& folder, const RunView<D>& view, const OutputSpec& outputs, Real time_left);

extern template FileSizes file_sizes<2>(const RunView<2>&, const OutputSpec&);
extern template FileSizes file_sizes<3>(const RunView<3>&, const OutputSpec&);
extern template void check_disk_space<2>(const std::filesystem::path&, const RunView<2>&, const OutputSpec&, Real);
extern template void check_disk_space<3>(const std::filesystem::path&, const RunView<3>&, const OutputSpec&, Real);

}  // namespace talus
