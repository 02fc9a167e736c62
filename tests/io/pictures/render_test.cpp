// talus-render as `talus render` and `talus surface` start it, and movies by ffmpeg.  The program stands beside this test program; xvfb must be installed.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>

#include "core/error.hpp"
#include "io/files/atomic_file.hpp"
#include "io/output/vtk.hpp"
#include "io/pictures/settings/launch_render.hpp"
#include "io/system/movie.hpp"
#include "mesh/generate/generate.hpp"
#include "tests/io/pictures/drawn.hpp"

namespace talus::render_test {
namespace {

using testing::HasSubstr;

/// Triangles of a binary STL: 80 bytes, their number, and 50 bytes each, of which the first twelve floats are the normal and three corners.
std::vector<std::array<std::array<float, 3>, 3>> triangles_of(const fs::path& stl)
{
  const std::string bytes = read_whole(stl);
  std::uint32_t n = 0;
  std::memcpy(&n, bytes.data() + 80, sizeof n);
  EXPECT_EQ(bytes.size(), 84 + 50 * std::size_t{n});
  std::vector<std::array<std::array<float, 3>, 3>> triangles(n);
  for (std::size_t t = 0; t < n; ++t)
    std::memcpy(&triangles[t], bytes.data() + 84 + 50 * t + 12, 36);
  return triangles;
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
  EXPECT_EQ(pictures[1].path, folder.path() / "pictures/velocity_0001.png");
  const std::string first = read_whole(pictures[0].path), last = read_whole(pictures[1].path);
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

TEST(Render, ClipLeavesOutWhatLiesBeyondThePlane)
{
  const ScratchFolder folder;
  const Variable none("DISPLAY", std::nullopt);
  write_run(folder.path());
  const auto coloured = [](const Pixel& p) { return p.is_coloured(); };
  const Pixels whole = drawn(folder, {"--frames", "first"}), cut = drawn(folder, {"--frames", "first", "--clip", "x", "9.5"});
  EXPECT_NEAR(static_cast<Real>(cut.count(coloured)), 0.5 * static_cast<Real>(whole.count(coloured)),
              0.05 * static_cast<Real>(whole.count(coloured)));
  EXPECT_GT(whole.count(coloured, 160), 1000);
  EXPECT_EQ(cut.count(coloured, 160), 0);  // x = 9.5 m of 24 m is 10.7 / 26.6 of 348 pixels
}

TEST(Render, WindowShowsThePartAskedForAndZoomWhatIsLookedAt)
{
  const ScratchFolder folder;
  const Variable none("DISPLAY", std::nullopt);
  write_run(folder.path());
  const auto yellow = [](const Pixel& p) { return p.is_yellow(); };
  const auto coloured = [](const Pixel& p) { return p.is_coloured(); };
  const std::vector<std::string> same{"--frames", "first", "--range", "0", "19"};
  const auto with = [&](std::vector<std::string> words) {
    words.insert(words.end(), same.begin(), same.end());
    return drawn(folder, words);
  };
  const Pixels all = with({});
  EXPECT_GT(all.count(yellow), 100);
  EXPECT_EQ(with({"--window", "0", "0", "9", "9"}).count(yellow), 0);
  EXPECT_GT(with({"--window", "16", "0", "19", "9"}).count(yellow), all.count(yellow));
  const Pixels near_left = with({"--look-at", "4", "5", "--zoom", "3"});
  EXPECT_EQ(near_left.count(yellow), 0);
  EXPECT_GT(near_left.count(coloured), all.count(coloured));
}

TEST(Render, OutlineAtTheStartIsDrawnOverWhatHasMoved)
{
  const ScratchFolder folder;
  const Variable none("DISPLAY", std::nullopt);
  write_run(folder.path());
  const auto dark = [](const Pixel& p) { return p.is_dark(); };
  const Pixels bare = drawn(folder, {"--range", "-20", "20"}), outlined = drawn(folder, {"--range", "-20", "20", "--outline", "start"});
  EXPECT_GT(outlined.count(dark), bare.count(dark) + 500);                    // about two thirds of 348 pixels long, twice
  EXPECT_GT(outlined.count(dark, 20, 60), bare.count(dark, 20, 60) + 50);     // where nothing is any more
  EXPECT_LT(outlined.count(dark, 290, 340), bare.count(dark, 290, 340) + 5);  // where nothing was
}

TEST(Render, MeshIsItsOutlineOrAllItsEdgesOrNothing)
{
  const ScratchFolder folder;
  const Variable none("DISPLAY", std::nullopt);
  write_run(folder.path());
  write_square_mesh(folder / "mesh.vtu");
  const auto grey = [](const Pixel& p) { return p.is_grey(); };
  const auto count = [&](const char* lines) { return drawn(folder, {"--frames", "first", "--mesh", lines}).count(grey, 285); };
  const auto nothing = count("none"), outline = count("outline"), edges = count("edges");
  EXPECT_EQ(nothing, 0);
  EXPECT_GT(outline, 50);
  EXPECT_GT(edges, 2 * outline);
}

TEST(Render, RangeOfTheWholeSeriesIsThatOfAllFrames)
{
  const ScratchFolder folder;
  const Variable none("DISPLAY", std::nullopt);
  write_run(folder.path());
  const auto bytes = [&](const std::vector<std::string>& words) {
    drawn(folder, words);
    return read_whole(folder / "picture.png");
  };
  const std::string whole = bytes({"--range", "whole"});
  EXPECT_EQ(whole, bytes({"--range", "0", "19"}));
  EXPECT_NE(whole, bytes({"--range", "last"}));
  EXPECT_NE(whole, bytes({"--range", "whole", "--map", "cividis"}));
  EXPECT_NE(bytes({"--range", "1", "19", "--log"}), bytes({"--range", "1", "19"}));
}

TEST(Render, NamedViewsAreDirectionsAsUpSays)
{
  const ScratchFolder folder;
  const Variable none("DISPLAY", std::nullopt);
  write_run(folder.path(), 2);
  const auto view = [&](const std::vector<std::string>& words) {
    const auto coloured = drawn(folder, words).count([](const Pixel& p) { return p.is_coloured(); });
    return std::pair(read_whole(folder / "picture.png"), coloured);
  };
  EXPECT_EQ(view({"--view", "front", "--up", "0", "1", "0"}).first, view({"--view", "0", "0", "1", "--up", "0", "1", "0"}).first);
  const auto front = view({"--view", "front"}), parallel = view({"--view", "front", "--orthographic"}), top = view({"--view", "top"});
  EXPECT_NE(front.first, parallel.first);
  EXPECT_GT(top.second, 3 * front.second);  // 20 x 10 beside 20 x 2
}

TEST(Surface, OfABlockIsClosedLooksOutwardsAndEnclosesIt)
{
  const ScratchFolder folder;
  write_run(folder.path(), 12);
  const fs::path stl = folder / "block.stl";
  const auto files =
      launch_render(program(), {"surface", folder.path().string(), "--out", stl.string(), "--body", "0", "block"}, Display::not_needed);
  ASSERT_EQ(files.size(), 1u);
  ASSERT_EQ(files[0].said.size(), 1u);
  EXPECT_THAT(files[0].said[0], testing::AllOf(HasSubstr("block: "), HasSubstr("its 2400 particles have 2400 m^3")));
  using Corner = std::array<float, 3>;
  std::map<std::pair<Corner, Corner>, int> edges;
  Real volume = 0, lowest = 1e9, highest = -1e9;
  for (const auto& [a, b, c] : triangles_of(stl)) {
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
      ++edges[{from, to}];
      --edges[{to, from}];
      lowest = std::min<Real>(lowest, from[0]);
      highest = std::max<Real>(highest, from[0]);
    }
    volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6.0;
  }
  EXPECT_TRUE(std::all_of(edges.begin(), edges.end(), [](const auto& edge) { return edge.second == 0; })) << "an edge has one side only";
  EXPECT_NEAR(volume, 2400, 0.04 * 2400);  // edges and corners are round
  EXPECT_NEAR(lowest, 5 - 0.5, 0.1);       // half a particle beyond the outermost centres
  EXPECT_NEAR(highest, 24 + 0.5, 0.1);
}

TEST(Surface, OfASheetIsALineAndOfSeveralFramesSeveralFiles)
{
  const ScratchFolder folder;
  write_run(folder.path());
  const auto surface = [&](const std::string& file, std::vector<std::string> words) {
    words.insert(words.begin(), {"surface", folder.path().string(), "--out", (folder / file).string()});
    return words;
  };
  EXPECT_THAT(message_of<Error>(program(), surface("sheet.ply", {})), HasSubstr("the run is 2-D, its surface is a line"));
  const auto files = launch_render(program(), surface("sheet.obj", {"--frame", "all"}), Display::not_needed);
  ASSERT_EQ(files.size(), 2u);
  EXPECT_EQ(files[1].path, folder / "sheet_0001.obj");
  EXPECT_THAT(read_whole(files[1].path), HasSubstr("\nl "));
  EXPECT_THAT(message_of<Error>(program(), surface("sheet.obj", {"--spacing", "1e-6"})),
              testing::AllOf(HasSubstr("--spacing: 1e-06 m makes a grid of"), HasSubstr("would do")));
  EXPECT_FALSE(fs::exists(folder / "sheet.obj"));
}

TEST(Surface, VerticesOfAPlyHaveTheColoursOfAField)
{
  const ScratchFolder folder;
  write_run(folder.path(), 4);
  const fs::path ply = folder / "block.ply";
  launch_render(program(), {"surface", folder.path().string(), "--out", ply.string(), "--field", "velocity:x"}, Display::not_needed);
  const std::string bytes = read_whole(ply);
  EXPECT_THAT(bytes.substr(0, 300),
              testing::AllOf(testing::StartsWith("ply\nformat binary_little_endian"), HasSubstr("property uchar red")));
}

TEST(Movie, HasAllPicturesAndIsThereAsAWholeOrNotAtAll)
{
  const ScratchFolder folder;
  const Variable none("DISPLAY", std::nullopt);
  write_run(folder.path());
  std::vector<fs::path> pictures;
  for (const RenderedFile& file : launch_render(program(), {folder.path().string(), "--frames", "all", "--size", "401x241"}))
    pictures.push_back(file.path);
  const std::vector<fs::path> three{pictures[0], pictures[1], pictures[0]};
  make_movie(three, 5, folder / "a 100%.mp4");
  make_movie(three, 5, folder / "slide.gif");
  EXPECT_EQ(read_whole(folder / "a 100%.mp4").substr(4, 4), "ftyp");
  EXPECT_EQ(read_whole(folder / "slide.gif").substr(0, 6), "GIF89a");
  for (const char* name : {"a 100%.mp4", "slide.gif"}) {
    const std::string command =
        fmt::format("ffprobe -v error -count_frames -show_entries stream=nb_read_frames,width,height -of csv=p=0 '{}' >'{}'",
                    (folder / name).string(), (folder / "said").string());
    EXPECT_EQ(std::system(command.c_str()), 0);
    EXPECT_THAT(read_whole(folder / "said"), testing::StartsWith(name[0] == 'a' ? "402,242,3" : "401,241,3"));
  }
  std::ofstream(folder / "no.png") << "no picture";
  EXPECT_THROW(make_movie({folder / "no.png"}, 5, folder / "no.mp4"), EnvironmentError);
  EXPECT_FALSE(fs::exists(folder / "no.mp4"));
  EXPECT_FALSE(fs::exists(folder / "no.mp4.tmp"));
  EXPECT_FALSE(fs::exists(folder / "no.mp4.tmp.series"));
  const Variable empty("PATH", folder.path().string());
  EXPECT_THROW(make_movie(three, 5, folder / "b.gif"), EnvironmentError);
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
  EXPECT_THAT(message_of<EnvironmentError>(script(folder, "echo file: /nowhere.png"), {}), HasSubstr("/nowhere.png, which is not there"));
  EXPECT_THAT(message_of<EnvironmentError>(script(folder, "exit 0"), {}), HasSubstr("wrote nothing"));
}

TEST(LaunchRender, ArgumentsArriveAsTheyWereGiven)
{
  const ScratchFolder folder;
  const Variable some("DISPLAY", ":nowhere");
  EXPECT_THAT(message_of<Error>(script(folder, "printf '%s|' \"$@\"; exit 2"), {"a b", "$HOME", ""}), testing::StrEq("a b|$HOME||"));
}

}  // namespace
}  // namespace talus::render_test
