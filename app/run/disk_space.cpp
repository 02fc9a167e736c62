#include "app/run/disk_space.hpp"

#include <fmt/format.h>

#include "app/observers/field_columns.hpp"
#include "app/observers/history.hpp"
#include "app/run/new_results.hpp"
#include "app/setup/setup.hpp"
#include "core/error.hpp"
#include "core/finite_count.hpp"
#include "core/print.hpp"

namespace talus {

namespace {

/// Bytes per item in a VTK file besides its fields: a position, an id, a cell of one corner.
constexpr Real place_bytes = 3 * sizeof(double), id_bytes = sizeof(std::int64_t), vertex_bytes = 2 * sizeof(int);
/// Bytes of names and units of columns, balances, and the scene, measured with few particles.
constexpr Real vtk_header = 3e3, checkpoint_header = 7e4;
constexpr Real history_number = 20;  // characters per number

template <class ColumnOf>
Real bytes_of_fields(const std::vector<std::string>& names, ColumnOf&& column_of)
{
  std::size_t bytes = 0;
  for (const std::string& name : names)
    bytes += static_cast<std::size_t>(column_of(name).components) * sizeof(float);
  return static_cast<Real>(bytes);
}

/// The number of outputs, including those at the beginning and the end.
std::int64_t times(Real time, Real every) { return counted_sum(counted(time / every), 2); }

std::string megabytes(Real bytes) { return fmt::format("{:.3g} MB", bytes / 1e6); }

}  // namespace

template <int D>
FileSizes file_sizes(const RunView<D>& view, const OutputSpec& outputs)
{
  FileSizes sizes;
  const auto particles = static_cast<Real>(view.problem.ranks->sum(static_cast<std::int64_t>(view.state.particles.size())));
  const Index n_nodes = view.problem.subdomain.alone() ? view.problem.mesh.n_nodes() : view.problem.subdomain.whole_nodes;
  const Index n_cells = view.problem.subdomain.alone() ? view.problem.mesh.n_cells() : view.problem.subdomain.whole_cells;
  if (outputs.particles) {
    const Real fields =
        bytes_of_fields(particle_fields_of(outputs), [&](const auto& name) { return particle_column(view.problem, view.state, {}, name); });
    sizes.particles = vtk_header + particles * (place_bytes + id_bytes + vertex_bytes + fields);
  }
  if (outputs.mesh) {
    const Real fields = bytes_of_fields(outputs.mesh->fields_wanted, [&](const auto& name) { return node_column(view, name); });
    const Real corners = (D + 2) * sizeof(int) + 1;  // with the end of each cell, and its type
    sizes.mesh = vtk_header + n_nodes * (place_bytes + fields) + n_cells * corners;
  }
  if (outputs.history)
    sizes.history_row = history_number * static_cast<Real>(HistoryWriter<D>::columns(*outputs.history, view).size());
  sizes.checkpoint = checkpoint_header + particles * bytes_per_particle(view);
  return sizes;
}

DiskUse disk_use(const FileSizes& one, const OutputSpec& outputs, Real time)
{
  const auto times_of = [&](const auto& output) { return output ? times(time, output->every) : 0; };
  DiskUse use;
  use.particle_files = times_of(outputs.particles);
  use.mesh_files = times_of(outputs.mesh);
  use.history_rows = times_of(outputs.history);
  use.checkpoints = outputs.checkpoint.keep + 1;  // one more while it is written
  const auto bytes = [](std::int64_t number, Real each) { return static_cast<Real>(number) * each; };
  use.bytes = bytes(use.particle_files, one.particles) + bytes(use.mesh_files, one.mesh) + bytes(use.history_rows, one.history_row) +
              bytes(use.checkpoints, one.checkpoint);
  return use;
}

namespace {

/// The free space in bytes; the largest number if the system does not report it.
Real free_space(std::filesystem::path folder)
{
  std::error_code unknown;
  for (folder = std::filesystem::absolute(folder, unknown); !std::filesystem::exists(folder, unknown) && folder.has_relative_path();)
    folder = folder.parent_path();
  return static_cast<Real>(std::filesystem::space(folder, unknown).available);
}

void compare_with_free_space(const std::filesystem::path& folder, const FileSizes& one, const OutputSpec& outputs, Real time_left,
                             bool replaces)
{
  const Real free = free_space(folder) + (replaces ? static_cast<Real>(bytes_replaced(folder)) : 0);
  const Real least = one.particles + one.mesh + one.history_row + one.checkpoint;
  if (free < least)
    throw EnvironmentError(fmt::format("the disk of {} has {} left; one checkpoint and one file of each kind take about {}",
                                       folder.string(), megabytes(free), megabytes(least)));
  const Real all = disk_use(one, outputs, time_left).bytes;
  if (free < all)
    say(stderr, "warning: the disk of {} has {} left; all outputs of the run may take about {}\n", folder.string(), megabytes(free),
        megabytes(all));
}

}  // namespace

template <int D>
void check_disk_space(const std::filesystem::path& folder, const RunView<D>& view, const OutputSpec& outputs, Real time_left)
{
  const FileSizes one = file_sizes(view, outputs);
  const bool begins = view.state.clock.step == 0;  // a new run replaces the existing results, whose space counts as free
  view.problem.ranks->together([&] { compare_with_free_space(folder, one, outputs, time_left, begins); });
}

template FileSizes file_sizes<2>(const RunView<2>&, const OutputSpec&);
template FileSizes file_sizes<3>(const RunView<3>&, const OutputSpec&);
template void check_disk_space<2>(const std::filesystem::path&, const RunView<2>&, const OutputSpec&, Real);
template void check_disk_space<3>(const std::filesystem::path&, const RunView<3>&, const OutputSpec&, Real);

}  // namespace talus
