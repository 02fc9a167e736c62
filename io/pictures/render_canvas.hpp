#pragma once
// One picture: coloured particles, lines of the mesh, colour bar and texts, drawn off screen and saved as PNG.
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "io/output/vtk.hpp"
#include "io/pictures/render_camera.hpp"
#include "io/pictures/render_colours.hpp"
#include "io/pictures/render_data.hpp"
#include "mesh/geometry/spacing.hpp"
#include "mesh/rigid_ground.hpp"

class vtkRenderer;

namespace talus::render {

struct Picture {
  std::array<int, 2> size;  ///< in pixels
  Camera camera;
  int dimension{};
  Real radius{};  ///< radius of a drawn particle [m]
  Spread spread;  ///< spacing of the particles in 2-D
  Scale scale;
  Lines mesh;                         ///< lines behind the particles, or around them
  MeshLines mesh_lines{};             ///< kind of these lines: edges are drawn over the particles in 2-D
  Lines start;                        ///< outline drawn over the particles
  std::optional<RigidGround> ground;  ///< the ground of a mesh made from terrain
  std::optional<StoredMesh> rigid;    ///< surfaces of rigid bodies at the time of the frame
  Vec3 upwards = Vec3::UnitZ();       ///< vertical axis
  std::optional<Plane> clip;          ///< plane by which particles and ground are cut
  std::string title;
  std::vector<std::string> notes;  ///< further information, such as the cut
  Real time{};                     ///< time of the frame [s]
};

struct Pen {
  Colour colour;
  float width;   ///< width of lines in pixels of the picture
  Real opacity;  ///< 1 is opaque
};
void add_lines(vtkRenderer* renderer, const Picture& picture, const Lines& lines, const Pen& pen);

/// Draws and writes the picture.  Needs a display (X11), which the caller has checked.  Throws EnvironmentError if the file cannot be
/// written.
void draw(const Picture& picture, const Cloud& cloud, const std::filesystem::path& png);

}  // namespace talus::render
