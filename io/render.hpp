#pragma once
// Pictures of a run: settings from the command line of talus-render, PNG files from result files.
#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/types.hpp"

namespace talus::render {

enum class Which : std::uint8_t { first, last, all };

struct Settings {
  std::filesystem::path folder;                           ///< holds particles.pvd, and mesh.vtu or mesh.pvd for the outline
  std::optional<std::string> field;                       ///< see read_cloud
  std::optional<std::array<Real, 2>> range;               ///< of the colours [SI]; default: of the last frame
  std::variant<Which, std::size_t> frames = Which::last;  ///< or the number of one, from zero
  std::optional<std::array<int, 2>> size;                 ///< pixels; default 1280 wide, as high as the particles need
  Vec3 view{0.4, -1.0, 0.5}, up{0, 0, 1};                 ///< 3-D: direction from the particles to the camera, and up in the picture
  std::optional<std::filesystem::path> out;               ///< a .png, or a folder; default: pictures/ in `folder`
  std::string title;
  std::optional<Real> radius;  ///< of a particle as drawn [m]; default from their spacing
  bool mesh = true;            ///< draw the outline
};

std::string usage();
/// Error, saying what is wrong, for words that are no settings.
Settings parse(std::span<const std::string> arguments);

/// Draws and calls `written` with every picture once it is on the disk.  Needs a display: EnvironmentError without DISPLAY, since
/// VTK would abort.  Error if a frame or field does not exist; EnvironmentError if files cannot be read or written.
void make_pictures(const Settings& settings, const std::function<void(const std::filesystem::path&)>& written);

}  // namespace talus::render
