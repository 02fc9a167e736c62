#pragma once
// Runs to be drawn by talus-render, and the pixels of what it drew.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "io/files/atomic_file.hpp"
#include "io/output/vtk.hpp"
#include "io/pictures/settings/launch_render.hpp"
#include "mesh/generate/generate.hpp"
#include "tests/io/scratch_folder.hpp"

namespace talus::render_test {

namespace fs = std::filesystem;

inline fs::path program() { return fs::read_symlink("/proc/self/exe").parent_path() / "talus-render"; }

/// Sets or removes a variable for the life of a test.
class Variable {
 public:
  Variable(std::string name, std::optional<std::string> value) : name_(std::move(name))
  {
    if (const char* old = std::getenv(name_.c_str()))
      old_ = old;
    put(value);
  }
  ~Variable() { put(old_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  void put(const std::optional<std::string>& value) const
  {
    if (value)
      ::setenv(name_.c_str(), value->c_str(), 1);
    else
      ::unsetenv(name_.c_str());
  }
  std::string name_;
  std::optional<std::string> old_;
};

/// Two frames of 20 x 10 x layers particles, 1 m apart, that slide by 5 m and slow down to half their velocity, which is largest on the right.
inline void write_run(const fs::path& folder, int layers = 1)
{
  PvdSeries series(folder / "particles.pvd");
  for (int frame = 0; frame < 2; ++frame) {
    std::vector<Real> x;
    std::vector<std::int64_t> id;
    Column velocity{"velocity", 3, {}, "m/s"}, volume{"volume", 1, {}, "m^3"}, body{"body", 1, {}};
    for (int i = 0; i < 200 * layers; ++i) {
      id.push_back(i);
      for (const Real value : {i % 20 + 5.0 * frame, i / 20 % 10 + 0.0, i / 200 + 0.0})
        x.push_back(value);
      for (const float value : {static_cast<float>(i % 20) / static_cast<float>(frame + 1), 0.0F, 0.0F})
        velocity.values.push_back(value);
      volume.values.push_back(1);
      body.values.push_back(0);
    }
    const fs::path file = folder / "particles" / fmt::format("{}.vtp", frame);
    write_particles(file, frame, x, id, std::vector<Column>{velocity, volume, body});
    series.append(frame, file);
  }
}

/// A mesh of 24 x 10 m in squares of 2 m, each of two triangles.
inline void write_square_mesh(const fs::path& file)
{
  write_mesh<2>(file, 0, Mesh<2>(box<2>(Vec<2>(0, 0), Vec<2>(24, 10), {12, 5})), {}, {});
}

struct Pixel {
  unsigned char r, g, b;
  int largest() const { return std::max({r, g, b}); }
  bool is_coloured() const { return largest() - std::min({r, g, b}) > 40; }
  bool is_yellow() const { return r > 200 && g > 200 && b < 90; }
  bool is_dark() const { return largest() < 70; }
  bool is_grey() const { return !is_coloured() && largest() < 235; }
};

/// A picture of 400 x 240 pixels, decoded by ffmpeg, which must be installed.
struct Pixels {
  std::vector<Pixel> rows;  ///< from above
  explicit Pixels(const fs::path& png)
  {
    const fs::path raw = png.string() + ".raw";
    const std::string command =
        fmt::format("ffmpeg -nostdin -v error -y -i '{}' -f rawvideo -pix_fmt rgb24 '{}'", png.string(), raw.string());
    EXPECT_EQ(std::system(command.c_str()), 0);
    const std::string bytes = read_whole(raw);
    for (std::size_t i = 0; i + 2 < bytes.size(); i += 3)
      rows.push_back(
          {static_cast<unsigned char>(bytes[i]), static_cast<unsigned char>(bytes[i + 1]), static_cast<unsigned char>(bytes[i + 2])});
  }
  /// How many there are among the particles: left of the colour bar, below the title, above the scale.
  template <class F>
  std::ptrdiff_t count(F&& is, int from = 0, int to = 345) const
  {
    std::ptrdiff_t n = 0;
    for (int y = 25; y < 215; ++y)
      for (int x = from; x < to; ++x)
        n += is(rows.at(static_cast<std::size_t>(y * 400 + x))) ? 1 : 0;
    return n;
  }
};

inline Pixels drawn(const ScratchFolder& folder, const std::vector<std::string>& words)
{
  const fs::path file = folder / "picture.png";
  std::vector<std::string> arguments{folder.path().string(), "--out", file.string(), "--size", "400x240", "--field", "velocity"};
  arguments.insert(arguments.end(), words.begin(), words.end());
  launch_render(program(), arguments);
  return Pixels(file);
}

}  // namespace talus::render_test
