#pragma once
// One picture: particles in their colours, lines of the mesh, a colour bar, and words, drawn off screen and saved as PNG.
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "io/render_camera.hpp"
#include "io/render_colours.hpp"
#include "io/render_data.hpp"

namespace talus::render {

struct Picture {
  std::array<int, 2> size;  ///< pixels
  Camera camera;
  int dimension{};
  Real radius{};  ///< m, of a particle as drawn
  Scale scale;
  bool cut_off = false;    ///< nothing is drawn outside the panel; else what is higher or lower passes behind the words
  Lines mesh;              ///< behind the particles, or around them
  MeshLines mesh_lines{};  ///< what those are: edges lie over the particles in 2-D
  Lines start;             ///< over the particles
  std::string title;
  std::vector<std::string> notes;  ///< what else must be known, such as where it was cut
  Real time{};                     ///< s
};

/// Draws and writes.  Needs a display (X11); the caller has looked for one.  EnvironmentError if the file cannot be written.
void draw(const Picture& picture, const Cloud& cloud, const std::filesystem::path& png);

}  // namespace talus::render
