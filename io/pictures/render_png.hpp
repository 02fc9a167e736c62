#pragma once
// Windows that are drawn off screen and saved: drawn at twice the size and averaged, which smooths particles, lines and letters alike.
#include <array>
#include <filesystem>

class vtkRenderWindow;

namespace talus::render {

inline constexpr int oversampling = 2;

/// Makes a window that never shows, `size` pixels of the picture wide and high.
void prepare(vtkRenderWindow* window, const std::array<int, 2>& size);

/// What the window shows as a picture, whole or not at all.  EnvironmentError if the file cannot be written.
void save(vtkRenderWindow* window, const std::filesystem::path& png);

}  // namespace talus::render
