#pragma once
// Copies of what files for ParaView show, apart from the state, which the next steps change.
#include <filesystem>
#include <optional>
#include <vector>

#include "io/output/vtk.hpp"
#include "io/scene/scene_output.hpp"
#include "solver/run_view.hpp"

namespace talus {

/// Copies of what files show at one time, on this rank.
struct Frame {
  struct ParticleFile {
    std::filesystem::path file;
    Slice rows;
    std::vector<Real> positions;
    std::vector<std::int64_t> ids;
    std::vector<Column> columns;
  };
  struct MeshFile {
    std::filesystem::path file;
    MeshSlice mesh;
    std::vector<Column> columns;
  };
  Real time = 0;  ///< [s]
  std::optional<ParticleFile> particles;
  std::optional<MeshFile> mesh;
  std::optional<MeshFile> rigid;  ///< surfaces of rigid bodies, whole on every rank
};

/// The fields of the particles that the scene wants in a file.  Collective.
template <int D>
Frame::ParticleFile particles_of_frame(const RunView<D>& view, const OutputSpec& outputs, std::filesystem::path file);

/// The mesh, and the fields of its nodes that the scene wants in a file.  Collective.
template <int D>
Frame::MeshFile mesh_of_frame(const RunView<D>& view, const OutputSpec& outputs, std::filesystem::path file);

}  // namespace talus
