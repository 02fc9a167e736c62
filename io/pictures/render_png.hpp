#pragma once
// Off-screen windows that are saved as pictures: drawn at twice the size and averaged, which smooths particles, lines and letters.
#include <array>
#include <filesystem>

class vtkRenderWindow;

namespace talus::render {

inline constexpr int oversampling = 2;

/// Makes an off-screen window of `size` pixels of the picture.
void prepare(vtkRenderWindow* window, const std::array<int, 2>& size);

/// Writes the contents of the window as a picture, atomically.  Throws EnvironmentError if the file cannot be written.
void save(vtkRenderWindow* window, const std::filesystem::path& png);

}  // namespace talus::render
