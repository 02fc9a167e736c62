// talus-render as `talus render` starts it.  The program stands beside this test program; xvfb must be installed.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <optional>

#include "core/error.hpp"
#include "io/launch_render.hpp"
#include "io/vtk.hpp"
#include "io/whole_file.hpp"
#include "tests/io/scratch_folder.hpp"

namespace talus::render_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

fs::path program() { return fs::read_symlink("/proc/self/exe").parent_path() / "talus-render"; }

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

/// Two frames of a 20 x 10 sheet of particles that slides by 5 m.
void write_run(const fs::path& folder)
{
  PvdSeries series(folder / "particles.pvd");
  for (int frame = 0; frame < 2; ++frame) {
    std::vector<Real> x;
    std::vector<std::int64_t> id;
    Column velocity{"velocity", 3, {}, "m/s"};
    for (int i = 0; i < 200; ++i) {
      id.push_back(i);
      for (const Real value : {i % 20 + 5.0 * frame, i / 20 + 0.0, 0.0})
        x.push_back(value);
      for (const float value : {static_cast<float>(i % 20), 0.0F, 0.0F})
        velocity.values.push_back(value);
    }
    const fs::path file = folder / "particles" / fmt::format("{}.vtp", frame);
    write_particles(file, frame, x, id, std::vector<Column>{velocity});
    series.append(frame, file);
  }
}

/// Width and height in the header of a PNG (ISO/IEC 15948, 11.2.2).
std::array<unsigned, 2> png_size(const std::string& bytes)
{
  std::array<unsigned, 2> size{};
  if (bytes.substr(0, 8) == "\x89PNG\r\n\x1a\n" && bytes.substr(12, 4) == "IHDR")
    for (std::size_t i = 0; i < 8; ++i)
      size[i / 4] = size[i / 4] * 256 + static_cast<unsigned char>(bytes[16 + i]);
  return size;
}

template <class Kind>
std::string message_of(const fs::path& talus_render, const std::vector<std::string>& arguments)
{
  try {
    launch_render(talus_render, arguments);
  } catch (const Kind& error) {
    return error.what();
  }
  return "no error";
}

fs::path script(const ScratchFolder& folder, const std::string& body)
{
  const fs::path path = folder / "program";
  std::ofstream(path) << "#!/bin/sh\n" << body << '\n';
  fs::permissions(path, fs::perms::owner_all);
  return path;
}

TEST(Render, DrawsEveryFrameWithoutADisplay)
{
  ASSERT_TRUE(fs::exists(program())) << "build the target talus-render";
  const ScratchFolder folder;
  const Variable none("DISPLAY", std::nullopt);
  write_run(folder.path());
  const auto pictures = launch_render(program(), {folder.path().string(), "--frames", "all", "--size", "400x240", "--title", "Sliding"});
  ASSERT_EQ(pictures.size(), 2u);
  EXPECT_EQ(pictures[1], folder.path() / "pictures/velocity_0001.png");
  const std::string first = read_whole(pictures[0]), last = read_whole(pictures[1]);
  EXPECT_THAT(png_size(first), testing::ElementsAre(400u, 240u));
  EXPECT_NE(first, last);  // the camera stands still, the sheet has moved
}

TEST(Render, ColoursFollowTheRangeAndTheFieldAskedFor)
{
  ASSERT_TRUE(fs::exists(program())) << "build the target talus-render";
  const ScratchFolder folder;
  const Variable none("DISPLAY", std::nullopt);
  write_run(folder.path());
  const auto draw = [&](const std::string& name, const std::string& field, const std::string& high) {
    const std::string file = (folder / name).string();
    launch_render(program(), {folder.path().string(), "--out", file, "--field", field, "--range", "0", high, "--size", "400x240"});
    return read_whole(file);
  };
  const std::string once = draw("a.png", "velocity", "19");
  EXPECT_EQ(once, draw("b.png", "velocity", "19"));
  EXPECT_NE(once, draw("c.png", "velocity", "40"));
  EXPECT_NE(once, draw("d.png", "velocity:y", "19"));
}

TEST(Render, ChartShowsACurveAndLevels)
{
  ASSERT_TRUE(fs::exists(program())) << "build the target talus-render";
  const ScratchFolder folder;
  const Variable none("DISPLAY", std::nullopt);
  const std::string table = (folder / "table.csv").string();
  std::ofstream(table) << "strain [-],stress [Pa]\n0,0\n0.1,2000\n0.2,1500\n";
  const auto chart = [&](const std::string& name, const std::string& y, const std::vector<std::string>& rest) {
    std::vector<std::string> words{"chart", table, "--x", "strain [-]", "--y", y, "--out", (folder / name).string()};
    words.insert(words.end(), rest.begin(), rest.end());
    return words;
  };
  launch_render(program(), chart("bare.png", "stress [Pa]", {}));
  launch_render(program(), chart("level.png", "stress [Pa]", {"--level", "formula", "1800"}));
  EXPECT_THAT(png_size(read_whole(folder / "bare.png")), testing::ElementsAre(960u, 600u));
  EXPECT_NE(read_whole(folder / "bare.png"), read_whole(folder / "level.png"));
  EXPECT_THAT(message_of<Error>(program(), chart("none.png", "stres [Pa]", {})), HasSubstr("did you mean \"stress [Pa]\"?"));
  EXPECT_FALSE(fs::exists(folder / "none.png"));
}

TEST(Render, UnknownFieldIsRefusedWithTheNearestName)
{
  ASSERT_TRUE(fs::exists(program())) << "build the target talus-render";
  const ScratchFolder folder;
  const Variable none("DISPLAY", std::nullopt);
  write_run(folder.path());
  EXPECT_THAT(message_of<Error>(program(), {folder.path().string(), "--field", "velocty"}), HasSubstr("did you mean \"velocity\"?"));
}

TEST(Render, ProgramStartedWithoutADisplaySaysSoInsteadOfAborting)
{
  ASSERT_TRUE(fs::exists(program())) << "build the target talus-render";
  const ScratchFolder folder;
  write_run(folder.path());
  const int status = std::system(
      fmt::format("env -u DISPLAY '{}' '{}' 2>'{}'", program().string(), folder.path().string(), (folder / "said").string()).c_str());
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 3);
  EXPECT_THAT(read_whole(folder / "said"), HasSubstr("there is no display"));
}

TEST(LaunchRender, SaysWhatToInstallWhenXvfbIsMissing)
{
  const ScratchFolder folder;
  const Variable none("DISPLAY", std::nullopt), empty("PATH", folder.path().string());
  EXPECT_THAT(message_of<EnvironmentError>(script(folder, "exit 0"), {}), HasSubstr("apt-get install xvfb xauth"));
}

TEST(LaunchRender, ProgramThatIsNotThereIsNamed)
{
  const ScratchFolder folder;
  EXPECT_THAT(message_of<EnvironmentError>(folder / "nothing", {}), HasSubstr((folder / "nothing").string()));
}

TEST(LaunchRender, AbortedProgramIsAnEnvironmentErrorWithItsMessages)
{
  const ScratchFolder folder;
  const Variable some("DISPLAY", ":nowhere");
  const std::string message = message_of<EnvironmentError>(script(folder, "echo bad X server >&2; kill -ABRT $$"), {});
  EXPECT_THAT(message, HasSubstr("signal 6"));
  EXPECT_THAT(message, HasSubstr("bad X server"));
}

TEST(LaunchRender, PictureThatIsNotThereIsAnError)
{
  const ScratchFolder folder;
  const Variable some("DISPLAY", ":nowhere");
  EXPECT_THAT(message_of<EnvironmentError>(script(folder, "echo picture: /nowhere.png"), {}),
              HasSubstr("/nowhere.png, which is not there"));
  EXPECT_THAT(message_of<EnvironmentError>(script(folder, "exit 0"), {}), HasSubstr("wrote no picture"));
}

TEST(LaunchRender, ArgumentsArriveAsTheyWereGiven)
{
  const ScratchFolder folder;
  const Variable some("DISPLAY", ":nowhere");
  EXPECT_THAT(message_of<Error>(script(folder, "printf '%s|' \"$@\"; exit 2"), {"a b", "$HOME", ""}), testing::StrEq("a b|$HOME||"));
}

}  // namespace
}  // namespace talus::render_test
