#pragma once
// One picture: particles in their colours, lines of the mesh, a colour bar, and words, drawn off screen and saved as PNG.
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "io/pictures/render_camera.hpp"
#include "io/pictures/render_colours.hpp"
#include "io/pictures/render_data.hpp"
#include "mesh/geometry/spacing.hpp"
#include "mesh/rigid_ground.hpp"

class vtkRenderer;

namespace talus::render {

struct Picture {
  std::array<int, 2> size;  ///< pixels
  Camera camera;
  int dimension{};
  Real radius{};  ///< m, of a particle as drawn
  Spread spread;  ///< of the particles in 2-D
  Scale scale;
  Lines mesh;                         ///< behind the particles, or around them
  MeshLines mesh_lines{};             ///< what those are: edges lie over the particles in 2-D
  Lines start;                        ///< over the particles
  std::optional<RigidGround> ground;  ///< of a mesh of terrain
  Vec3 upwards = Vec3::UnitZ();       ///< of the ground
  std::optional<Plane> clip;          ///< by which particles were cut, and the ground is
  std::string title;
  std::vector<std::string> notes;  ///< what else must be known, such as where it was cut
  Real time{};                     ///< s
};

struct Pen {
  Colour colour;
  float width;   ///< pixels of the picture
  Real opacity;  ///< one hides what is behind
};
void add_lines(vtkRenderer* renderer, const Picture& picture, const Lines& lines, const Pen& pen);

/// Draws and writes.  Needs a display (X11); the caller has looked for one.  EnvironmentError if the file cannot be written.
void draw(const Picture& picture, const Cloud& cloud, const std::filesystem::path& png);

}  // namespace talus::render
