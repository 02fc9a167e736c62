#pragma once
// A check that the disk has room for the output of a run, before the first step.
#include <filesystem>

#include "io/scene/scene_output.hpp"
#include "solver/run_view.hpp"

namespace talus {

/// The sizes of the files of a run in bytes, without compression; 0 for files that it does not write.
struct FileSizes {
  Real particles{}, mesh{}, history_row{}, checkpoint{};
};
template <int D>
FileSizes file_sizes(const RunView<D>& view, const OutputSpec& outputs);

/// The output of a run in `time` [s], without its mesh and summary: the number of files of each kind, and bytes of all of them without
/// compression.
struct DiskUse {
  std::int64_t particle_files{}, mesh_files{}, history_rows{}, checkpoints{};
  Real bytes{};
};
DiskUse disk_use(const FileSizes& one, const OutputSpec& outputs, Real time);

/// Throws EnvironmentError if the disk of `folder` has no room for a checkpoint and one file of each kind.  Prints a warning on standard
/// error if it has no room for all output in `time_left` [s].
template <int D>
void check_disk_space(const std::filesystem::path& folder, const RunView<D>& view, const OutputSpec& outputs, Real time_left);

}  // namespace talus
