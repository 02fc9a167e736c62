// Reading .msh files: four formats, groups, what is written comes back, and damage done at random.
#include "io/mesh/gmsh_read.hpp"

#include <gmock/gmock.h>
#include <gmsh.h>
#include <gtest/gtest.h>

#include <random>

#include "io/load_mesh.hpp"
#include "io/mesh/gmsh_write.hpp"
#include "mesh/generate/generate.hpp"
#include "tests/io/bytes.hpp"
#include "tests/io/scratch_folder.hpp"

namespace talus::gmsh_read_test {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;
using ::testing::SizeIs;

struct Format {
  double version;
  int binary;
};
constexpr std::array<Format, 4> formats{{{2.2, 0}, {2.2, 1}, {4.1, 0}, {4.1, 1}}};

/// A unit box of two materials, meshed by gmsh and written in the four formats; groups of every dimension, one without a name, and a
/// group "all" that shares its cells with others.
std::array<std::filesystem::path, 4> files_of_gmsh(const ScratchFolder& folder, int dimension, double size)
{
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::option::setNumber("Mesh.MeshSizeMax", size);
  namespace occ = gmsh::model::occ;
  gmsh::vectorpair all;
  if (dimension == 2)
    all = {{2, occ::addRectangle(0, 0, 0, 0.5, 1)}, {2, occ::addRectangle(0.5, 0, 0, 0.5, 1)}};
  else
    all = {{3, occ::addBox(0, 0, 0, 0.5, 1, 1)}, {3, occ::addBox(0.5, 0, 0, 0.5, 1, 1)}};
  gmsh::vectorpair out;
  std::vector<gmsh::vectorpair> map;
  occ::fragment({all[0]}, {all[1]}, out, map);
  occ::synchronize();
  const auto group = [](int d, const std::vector<int>& entities, const std::string& name) {
    const int tag = gmsh::model::addPhysicalGroup(d, entities);
    if (!name.empty())
      gmsh::model::setPhysicalName(d, tag, name);
  };
  group(dimension, {map[0][0].second}, "left half");
  group(dimension, {map[1][0].second}, "");
  group(dimension, {map[0][0].second, map[1][0].second}, "all");
  gmsh::vectorpair sides;
  gmsh::model::getEntitiesInBoundingBox(-1e-3, -1e-3, -1e-3, 1e-3, 1.001, 1.001, sides, dimension - 1);
  group(dimension - 1, {sides.at(0).second}, "wall");
  gmsh::vectorpair points;
  gmsh::model::getEntities(points, 0);
  group(0, {points[0].second}, "corner");
  gmsh::model::mesh::generate(dimension);
  std::array<std::filesystem::path, 4> files;
  for (std::size_t i = 0; i < 4; ++i) {
    gmsh::option::setNumber("Mesh.MshFileVersion", formats[i].version);
    gmsh::option::setNumber("Mesh.Binary", formats[i].binary);
    files[i] = folder / ("mesh" + std::to_string(i) + ".msh");
    gmsh::write(files[i].string());
  }
  gmsh::finalize();
  return files;
}

/// Cells or facets as sorted lists of sorted corners: what a set is, however it is numbered.
template <int D, class Nodes>
auto places(const MeshData<D>& data, const std::vector<Nodes>& items)
{
  using Corner = std::array<Real, D>;
  std::vector<std::array<Corner, std::tuple_size_v<Nodes>>> result;
  for (const Nodes& nodes : items) {
    auto& corners = result.emplace_back();
    for (std::size_t a = 0; a < nodes.size(); ++a)
      for (int d = 0; d < D; ++d)
        corners[a][d] = std::round(data.nodes[nodes[a]][d] * 1e12);  // text of gmsh has 16 digits, one too few to be exact
    std::sort(corners.begin(), corners.end());
  }
  std::sort(result.begin(), result.end());
  return result;
}
template <int D>
auto places_of_cells(const MeshData<D>& data, const std::vector<Index>& numbers)
{
  std::vector<std::array<Index, D + 1>> cells;
  for (const Index c : numbers)
    cells.push_back(data.cells[c]);
  return places(data, cells);
}

template <int D>
void expect_same(const MeshData<D>& a, const MeshData<D>& b)
{
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  EXPECT_EQ(places(a, a.cells), places(b, b.cells));
  ASSERT_EQ(a.cell_sets.size(), b.cell_sets.size());
  for (const auto& [name, cells] : a.cell_sets)
    EXPECT_EQ(places_of_cells(a, cells), places_of_cells(b, b.cell_sets.at(name))) << name;
  ASSERT_EQ(a.facet_sets.size(), b.facet_sets.size());
  for (const auto& [name, facets] : a.facet_sets)
    EXPECT_EQ(places(a, facets), places(b, b.facet_sets.at(name))) << name;
  ASSERT_EQ(a.node_sets.size(), b.node_sets.size());
  for (const auto& [name, nodes] : a.node_sets)
    EXPECT_EQ(nodes.size(), b.node_sets.at(name).size()) << name;
}

template <int D>
void four_formats(double size)
{
  const ScratchFolder folder;
  const auto files = files_of_gmsh(folder, D, size);
  const MeshData<D> first = read_msh<D>(files[0], {});
  EXPECT_THAT(first.cell_sets, ElementsAre(Pair("all", SizeIs(first.cells.size())), Pair("left half", SizeIs(::testing::Gt(1U))),
                                           Pair("physical_" + std::to_string(D) + "_2", SizeIs(::testing::Gt(1U)))));
  EXPECT_EQ(first.cell_sets.at("left half").size() + first.cell_sets.at("physical_" + std::to_string(D) + "_2").size(), first.cells.size());
  EXPECT_THAT(first.facet_sets, ElementsAre(Pair("wall", SizeIs(::testing::Gt(1U)))));
  for (const auto& facet : first.facet_sets.at("wall"))
    for (const Index n : facet)
      EXPECT_EQ(first.nodes[n][0], 0);
  EXPECT_THAT(first.node_sets, ElementsAre(Pair("corner", SizeIs(1))));
  for (std::size_t i = 1; i < 4; ++i) {
    SCOPED_TRACE(i);
    expect_same(first, read_msh<D>(files[i], {}));
  }
}
TEST(GmshRead, FourFormatsGiveTheSamePlaneMesh) { four_formats<2>(0.2); }
TEST(GmshRead, FourFormatsGiveTheSameSolidMesh) { four_formats<3>(0.3); }

template <int D>
void comes_back(MshKind kind)
{
  const ScratchFolder folder;
  std::array<Index, D> counts;
  counts.fill(3);
  MeshData<D> data = jittered<D>(box<D>(Vec<D>::Constant(-0.1), Vec<D>::Constant(1.3), counts), 0.2, 7);
  data.cell_sets["some"] = {0, 3, 4};
  data.node_sets["two nodes"] = {2, 5};
  const Mesh<D> mesh(data);
  write_msh(folder / "a.msh", mesh, kind);
  const MeshData<D> read = read_msh<D>(folder / "a.msh", {});
  ASSERT_EQ(read.nodes.size(), static_cast<std::size_t>(mesh.n_nodes()));
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    EXPECT_EQ(read.nodes[n], mesh.node(n));  // bits: the shortest text that is read back exactly
  expect_same(read, data);
}
TEST(GmshWrite, PlaneMeshAndItsGroupsComeBackFromText) { comes_back<2>(MshKind::ascii); }
TEST(GmshWrite, PlaneMeshAndItsGroupsComeBackFromBytes) { comes_back<2>(MshKind::binary); }
TEST(GmshWrite, SolidMeshAndItsGroupsComeBackFromText) { comes_back<3>(MshKind::ascii); }
TEST(GmshWrite, SolidMeshAndItsGroupsComeBackFromBytes) { comes_back<3>(MshKind::binary); }

TEST(GmshWrite, GmshReadsWhatIsWritten)
{
  const ScratchFolder folder;
  const Mesh<3> mesh(jittered<3>(box<3>({0, 0, 0}, {1, 2, 3}, {2, 2, 2}), 0.2, 7));
  for (const MshKind kind : {MshKind::ascii, MshKind::binary}) {
    write_msh(folder / "a.msh", mesh, kind);
    gmsh::initialize(0, nullptr, false);
    gmsh::option::setNumber("General.Terminal", 0);
    gmsh::open((folder / "a.msh").string());
    std::vector<std::size_t> tags, nodes;
    gmsh::model::mesh::getElementsByType(4, tags, nodes);
    std::vector<std::size_t> node_tags;
    std::vector<double> coordinates, parameters;
    gmsh::model::mesh::getNodes(node_tags, coordinates, parameters);
    gmsh::vectorpair groups;
    gmsh::model::getPhysicalGroups(groups);
    std::vector<std::string> names;
    for (const auto& [dimension, tag] : groups) {
      names.emplace_back();
      gmsh::model::getPhysicalName(dimension, tag, names.back());
    }
    gmsh::finalize();
    ASSERT_EQ(tags.size(), 48U);
    ASSERT_EQ(nodes.size(), 4 * tags.size());
    ASSERT_EQ(node_tags.size(), static_cast<std::size_t>(mesh.n_nodes()));
    ASSERT_EQ(coordinates.size(), 3 * node_tags.size());
    for (std::size_t i = 0; i < node_tags.size(); ++i)
      for (int d = 0; d < 3; ++d)
        EXPECT_EQ(coordinates[3 * i + static_cast<std::size_t>(d)], mesh.node(static_cast<Index>(node_tags[i] - 1))[d]);
    for (std::size_t i = 0; i < tags.size(); ++i) {
      const auto cell = mesh.cell(static_cast<Index>(tags[i] - tags.front()));
      for (std::size_t k = 0; k < 4; ++k)
        EXPECT_EQ(nodes[4 * i + k], static_cast<std::size_t>(cell[k]) + 1);
    }
    EXPECT_EQ(groups.size(), 7U);  // six sides and all
    EXPECT_THAT(names, ::testing::UnorderedElementsAre("all", "x_min", "x_max", "y_min", "y_max", "z_min", "z_max"));
  }
}

/// One random injury.
std::string mutant(std::string bytes, std::mt19937& random)
{
  const auto below = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  const std::size_t at = below(bytes.size()), length = 1 + below(std::min<std::size_t>(40, bytes.size() - at));
  constexpr std::array<std::int64_t, 8> values{
      -1, 0, 1, 2, 0x7fffffff, std::int64_t{1} << 40, std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::min()};
  switch (below(7)) {
    case 0: bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8))); break;
    case 1: bytes[at] = static_cast<char>(below(256)); break;
    case 2: bytes.resize(at); break;
    case 3: bytes.erase(at, length); break;
    case 4: bytes.insert(below(bytes.size()), bytes.substr(at, length)); break;
    case 5: bytes[at] = static_cast<char>('0' + below(10)); break;
    default:
      for (std::size_t i = 0; i < 8 && at + i < bytes.size(); ++i)
        bytes[at + i] = reinterpret_cast<const char*>(&values[below(values.size())])[i];
  }
  return bytes;
}

/// Thousands of damaged files: each ends in a mesh or in a located complaint.
template <int D>
void survives_mutants(int count)
{
  const ScratchFolder folder;
  const auto files = files_of_gmsh(folder, D, 1);
  std::mt19937 random(12345);
  int good = 0, bad = 0;
  MeshSpec spec;
  spec.file = "mutant.msh";
  for (const auto& file : files) {
    const std::string bytes = bytes_of(file);
    for (int i = 0; i < count; ++i) {
      write(folder / spec.file, mutant(bytes, random));
      try {
        const Mesh<D> mesh = load_mesh<D>(spec, folder.path());
        EXPECT_LE(static_cast<std::size_t>(mesh.n_cells()), bytes.size());
        ++good;
      } catch (const SceneErrors& errors) {
        EXPECT_EQ(errors.problems().size(), 1U);
        ++bad;
      }
    }
  }
  EXPECT_GT(good, count / 20);  // a changed digit of a coordinate leaves a mesh
  EXPECT_GT(bad, count);
}
TEST(GmshRead, MutantsOfPlaneMeshesEndInAMeshOrAComplaint) { survives_mutants<2>(300); }
TEST(GmshRead, MutantsOfSolidMeshesEndInAMeshOrAComplaint) { survives_mutants<3>(300); }
TEST(GmshRead, NightlyManyMutantsEndInAMeshOrAComplaint)
{
  survives_mutants<2>(50'000);
  survives_mutants<3>(50'000);
}

}  // namespace
}  // namespace talus::gmsh_read_test
