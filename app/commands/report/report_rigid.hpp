#pragma once
// The rigid bodies of a run in a page.
#include <filesystem>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "io/page/page.hpp"
#include "io/scene/scene_rigid.hpp"

namespace talus {

struct StoredMesh;

/// Places, one a column [m].
using RigidCorners = Eigen::Matrix<Real, 3, Eigen::Dynamic>;

/// The files of rigid.pvd: surfaces that move without deforming, so the page has each once, and its motion in each frame.
class RigidFrames {
 public:
  RigidFrames() = default;
  /// Adds the surfaces of the first file to the page.  Nothing is added without such files, and a note if they cannot be read.
  RigidFrames(const std::filesystem::path& folder, std::span<const RigidSpec> bodies, Page& page);

  /// Whether the page has rigid bodies.
  bool any() const noexcept { return !bodies_.empty(); }
  /// Adds how the bodies have moved until a time [s]: a block as PageFrame has it.  Nothing if there is no readable file of that time.
  std::optional<BlockId> add(Real time, Page& page) const;

 private:
  struct Body {
    Index first;            ///< number of its first corner in the files
    RigidCorners at_start;  ///< from their centre, in the first file
    Vec3 centre, middle;    ///< mean of the corners there [m]; middle of their box from it
  };
  void add_surfaces(const std::filesystem::path& folder, std::span<const RigidSpec> bodies, Page& page);
  void add_surface(std::string name, const StoredMesh& mesh, Index first, Index last, Page& page);

  std::vector<std::pair<Real, std::filesystem::path>> files_;
  std::size_t nodes_ = 0;      ///< coordinates of the corners of all bodies in a file
  std::size_t triangles_ = 0;  ///< in the page
  std::vector<Body> bodies_;
};

/// Notes the frames in which the rigid bodies are missing.
void note_frames_without_rigid(Page& page);

}  // namespace talus
