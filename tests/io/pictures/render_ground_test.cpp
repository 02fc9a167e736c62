// What pictures show beside the particles: the ground of a run in terrain, no holes, nothing behind the words, nothing cut.
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <set>

#include "io/mesh/gmsh_write.hpp"
#include "tests/io/pictures/drawn.hpp"

namespace talus::render_test {
namespace {

/// Pixels of a picture of that width that are not white, within so many pixels of its edges.
int ink_at_the_edges(const Pixels& picture, int width, int height, int rim)
{
  int n = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (x < rim || y < rim || x >= width - rim || y >= height - rim)
        n += picture.rows.at(static_cast<std::size_t>(y * width + x)).largest() < 250 ? 1 : 0;
  return n;
}

TEST(Render, ChartIsNotCutAtItsEdges)
{
  const ScratchFolder folder;
  const Variable none("DISPLAY", std::nullopt);
  const std::string table = (folder / "table.csv").string(), png = (folder / "chart.png").string();
  std::ofstream(table) << "factor,displacement [m]\n1,0.01\n1.2,0.02\n1.35,0.3\n1.5,20\n";
  launch_render(program(),
                {"chart", table, "--title", "Agjpqy", "--x", "factor", "--y", "displacement [m]", "--level", "limit", "10", "--out", png});
  EXPECT_EQ(ink_at_the_edges(Pixels(png), 960, 600, 3), 0) << "title, last number";
}

TEST(Render, ParticlesAtRestHaveNoWhiteHoles)
{
  const ScratchFolder folder;
  const Variable none("DISPLAY", std::nullopt);
  PvdSeries series(folder / "particles.pvd");
  std::vector<Real> x;
  std::vector<std::int64_t> id;
  Column velocity{"velocity", 3, {}, "m/s"};
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 8; ++j)
      for (const auto& [dx, dy] : {std::pair{0.3, 0.0}, {0.0, 0.3}, {-0.3, 0.0}, {0.0, -0.3}}) {  // in clumps: their neighbours are near
        x.insert(x.end(), {2.0 * i + dx, 2.0 * j + dy, 0});
        id.push_back(static_cast<std::int64_t>(id.size()));
        velocity.values.insert(velocity.values.end(), {static_cast<float>(i), 0, 0});
      }
  write_particles(folder / "one.vtp", 0, x, id, std::vector<Column>{velocity});
  series.append(0, folder / "one.vtp");
  const auto white_inside = [&](const std::vector<std::string>& words) {
    const Pixels picture = drawn(folder, words);
    int white = 0;
    for (int y = 80; y < 160; ++y)
      for (int px = 100; px < 240; ++px) {
        const Pixel& p = picture.rows.at(static_cast<std::size_t>(y * 400 + px));
        white += std::min({p.r, p.g, p.b}) > 250 ? 1 : 0;
      }
    return white;
  };
  EXPECT_GT(white_inside({"--radius", "0.2"}), 3000) << "wide gaps stay";
  EXPECT_EQ(white_inside({}), 0) << "1.22 m from the middle of a gap to the next particle";
  EXPECT_EQ(white_inside({"--radius", "0.75"}), 0) << "disks of two clumps overlap";
  EXPECT_EQ(white_inside({"--radius", "0.69"}), 0) << "they do not: gaps of 2 cm join the holes to the outside";
}

/// A mesh of terrain whose rigid base falls along x, with particles on it.
void write_valley(const fs::path& folder)
{
  MeshData<3> data = box<3>({0, 0, 0}, {24, 10, 4}, {12, 5, 2});
  std::set<std::array<Index, 3>> base;
  for (const auto& cell : data.cells)
    for (std::size_t left_out = 0; left_out < 4; ++left_out) {
      std::array<Index, 3> facet{};
      for (std::size_t a = 0, k = 0; a < 4; ++a)
        if (a != left_out)
          facet[k++] = cell[a];
      std::sort(facet.begin(), facet.end());
      if (std::all_of(facet.begin(), facet.end(), [&](Index n) { return data.nodes[static_cast<std::size_t>(n)][2] == 0; }))
        base.insert(facet);
    }
  data.facet_sets["base"] = data.facet_sets["terrain"] = {base.begin(), base.end()};
  for (Vec<3>& node : data.nodes)
    node[2] += 6 - 0.25 * node[0];
  write_msh(folder / "mesh.msh", Mesh<3>(data));
}

TEST(Render, GroundOfTerrainIsDrawnCutAndLeftOutOnDemand)
{
  const ScratchFolder folder;
  const Variable none("DISPLAY", std::nullopt);
  write_run(folder.path(), 2);
  const auto stone = [](const Pixel& p) { return !p.is_coloured() && p.largest() < 250 && p.r >= p.g && p.g >= p.b && p.r > p.b + 2; };
  // Particles all of the darkest colour, which is blue: mixed with white at their rims it is none of the stone.
  const std::vector<std::string> above{"--view", "0", "-1", "2", "--frames", "first", "--range", "0", "1000"};
  const auto count = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = above;
    words.insert(words.end(), more.begin(), more.end());
    return drawn(folder, words).count(stone);
  };
  EXPECT_EQ(count({}), 0) << "no mesh of terrain";
  write_valley(folder.path());
  const auto whole = count({});
  EXPECT_GT(whole, 3000);
  const auto cut = count({"--clip", "x", "12"});
  EXPECT_LT(cut, 0.8 * static_cast<Real>(whole));
  EXPECT_GT(cut, 0);
  EXPECT_EQ(count({"--no-ground"}), 0);
  std::ofstream(folder / "mesh.msh")
      << "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 1 \"terrain\"\n$EndPhysicalNames\n$Nodes\nx";
  EXPECT_EQ(count({}), 0) << "a damaged mesh leaves the particles, with a warning";
}

TEST(Render, NothingPassesBehindTheTitle)
{
  const ScratchFolder folder;
  const Variable none("DISPLAY", std::nullopt);
  write_run(folder.path());
  write_mesh<2>(folder / "mesh.vtu", 0, Mesh<2>(box<2>(Vec<2>(-40, -40), Vec<2>(60, 60), {100, 100})), {}, {});
  const Pixels picture = drawn(folder, {"--mesh", "edges"});
  int marked = 0;
  for (int y = 0; y < 18; ++y)
    for (int px = 0; px < 300; ++px)
      marked += picture.rows.at(static_cast<std::size_t>(y * 400 + px)).largest() < 250 ? 1 : 0;
  EXPECT_EQ(marked, 0) << "no title was given: its line is white";
}

}  // namespace
}  // namespace talus::render_test
