// Small .msh files by hand: good ones, odd ones, and some that are broken in every way that came to mind.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "io/mesh/gmsh_read.hpp"
#include "io/mesh/gmsh_write.hpp"
#include "mesh/generate/generate.hpp"
#include "tests/io/bytes.hpp"
#include "tests/io/scratch_folder.hpp"

namespace talus::gmsh_broken_test {
namespace {

using ::testing::HasSubstr;

const std::string good_2 = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
0 3 "corner"
1 1 "floor"
2 2 "soil"
$EndPhysicalNames
$Nodes
4
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
$EndNodes
$Elements
4
1 15 2 3 1 1
2 1 2 1 1 1 2
3 2 2 2 1 1 2 3
4 2 2 2 1 1 3 4
$EndElements
)";

const std::string good_4 = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
3
0 3 "corner"
1 1 "floor"
2 2 "soil"
$EndPhysicalNames
$Entities
1 1 1 0
1 0 0 0 1 3
1 0 0 0 1 0 0 1 1 0
1 0 0 0 1 1 0 1 2 1 1
$EndEntities
$Nodes
1 4 1 4
2 1 0 4
1
2
3
4
0 0 0
1 0 0
1 1 0
0 1 0
$EndNodes
$Elements
3 4 1 4
0 1 15 1
1 1
1 1 1 1
2 1 2
2 1 2 2
3 1 2 3
4 1 3 4
$EndElements
)";

std::string replaced(std::string text, const std::string& from, const std::string& to)
{
  const std::size_t at = text.find(from);
  if (at == std::string::npos)
    throw std::logic_error("nothing to replace: " + from);
  return text.replace(at, from.size(), to);
}

/// What read_msh says of a file with these bytes, called a.msh and asked for by scene.yaml:3:10.
template <int D>
std::string complaint(const std::string& bytes)
{
  const ScratchFolder folder;
  write(folder / "a.msh", bytes);
  try {
    read_msh<D>(folder / "a.msh", SourceLocation{"scene.yaml", 3, 10, "mesh.file"});
  } catch (const SceneErrors& errors) {
    std::string text = errors.what();
    const std::string path = folder.path().string() + "/";
    for (std::size_t at = text.find(path); at != std::string::npos; at = text.find(path))
      text.erase(at, path.size());
    return text;
  }
  return "no complaint";
}

TEST(GmshRead, SmallGoodFilesAreGood)
{
  EXPECT_EQ(complaint<2>(good_2), "no complaint");
  EXPECT_EQ(complaint<2>(good_4), "no complaint");
}

TEST(GmshRead, ComplaintNamesLineColumnAndScene)
{
  EXPECT_EQ(complaint<2>(replaced(good_2, "3 1 1 0\n4", "3 1 one 0\n4")),
            "a.msh:14:5: error: expected the y coordinate of a node, found \"one\" (mesh of scene.yaml:3:10)\n"
            "   14 | 3 1 one 0\n"
            "      |     ^\n"
            "1 error, nothing was run.");
}

/// A good file with a word replaced, and what is said of it.
struct Broken {
  const char* name;
  const std::string& base;
  const char *from, *to, *message;
};
void PrintTo(const Broken& broken, std::ostream* out) { *out << '"' << broken.from << "\" -> \"" << broken.to << '"'; }

class GmshReadBroken : public ::testing::TestWithParam<Broken> {};

TEST_P(GmshReadBroken, IsRefusedWithItsPlace)
{
  const Broken& broken = GetParam();
  EXPECT_THAT(complaint<2>(replaced(broken.base, broken.from, broken.to)), HasSubstr(broken.message));
}

INSTANTIATE_TEST_SUITE_P(
    Files, GmshReadBroken,
    ::testing::Values(
        Broken{"NoMeshFile", good_2, "$MeshFormat\n2.2", "solid part\n2.2", "a.msh:1:1: error: expected the opening word of a section"},
        Broken{"NoFormat", good_2, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n", "",
               "a.msh:1:1: error: the file does not begin with $MeshFormat"},
        Broken{"OldVersion", good_2, "2.2 0 8", "1 0 8", "a.msh:2:1: error: format 1 is not supported, only 2.2 and 4.1"},
        Broken{"Version40", good_4, "4.1 0 8", "4 0 8", "a.msh:2:1: error: format 4 is not supported"},
        Broken{"FileType", good_4, "4.1 0 8", "4.1 2 8", "a.msh:2:5: error: the file type is 2"},
        Broken{"NumberSize", good_4, "4.1 0 8", "4.1 0 4", "a.msh:2:7: error: numbers of 4 bytes"},
        Broken{"FormatTwice", good_2, "$PhysicalNames", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames", "a second $MeshFormat"},
        Broken{"NodesTwice", good_2, "$Elements", "$Nodes\n0\n$EndNodes\n$Elements", "a.msh:17:1: error: a second $Nodes section"},
        Broken{"MissingName", good_2, "1 1 \"floor\"", "1 1", "a.msh:7:4: error: expected the name of a group in quotes"},
        Broken{"OpenQuote", good_2, "\"floor\"", "\"floor", "a.msh:7:5: error: expected the name of a group in quotes"},
        Broken{"NameTwice", good_2, "3\n0 3 \"corner\"", "4\n1 7 \"floor\"\n0 3 \"corner\"",
               "two groups of dimension 1 have the name \"floor\""},
        Broken{"TwoNames", good_2, "3\n0 3 \"corner\"", "4\n1 1 \"bed\"\n0 3 \"corner\"", "group 1 of dimension 1 has two names"},
        Broken{"TooManyNames", good_2, "3\n0 3", "900\n0 3", "a.msh:5:1: error: the number of names is 900, but only"},
        Broken{"TooFewNames", good_2, "3\n0 3", "2\n0 3", "a.msh:8:1: error: expected $EndPhysicalNames, found \"2\""},
        Broken{"NameDimension", good_2, "0 3 \"corner\"", "4 3 \"corner\"", "a group of dimension 4"},
        Broken{"NegativeCount", good_2, "$Nodes\n4", "$Nodes\n-4", "a.msh:11:1: error: the number of nodes is -4"},
        Broken{"HugeCount", good_2, "$Nodes\n4", "$Nodes\n4000000000", "the number of nodes is 4000000000, more than can be numbered"},
        Broken{"BigCount", good_2, "$Nodes\n4", "$Nodes\n1000", "the number of nodes is 1000, but only"},
        Broken{"OneNodeMore", good_2, "$Nodes\n4", "$Nodes\n5", "a.msh:16:1: error: expected the tag of a node, found \"$EndNodes\""},
        Broken{"OneNodeLess", good_2, "$Nodes\n4", "$Nodes\n3", "a.msh:15:1: error: expected $EndNodes, found \"4\""},
        Broken{"NotANumber", good_2, "3 1 1 0\n4", "3 nan 1 0\n4", "a.msh:14:3: error: the x coordinate of a node is nan"},
        Broken{"Infinite", good_4, "1 1 0\n0 1 0", "1 -inf 0\n0 1 0", "the y coordinate of a node is -inf"},
        Broken{"Overflow", good_2, "3 1 1 0\n4", "3 1 1e999 0\n4", "expected the y coordinate of a node, found \"1e999\""},
        Broken{"NodeTwice", good_2, "\n4 0 1 0", "\n3 0 1 0", "a.msh:15:7: error: node 3 occurs twice"},
        Broken{"NoSuchNode", good_2, "1 1 3 4", "1 1 3 9", "a.msh:22:15: error: element 4 names node 9, which does not exist"},
        Broken{"NodeTwiceInCell", good_2, "1 1 3 4", "1 1 3 3", "element 4 names node 3 twice"},
        Broken{"Flat", good_2, "4 0 1 0", "4 0.5 0.5 0", "a.msh:22:15: error: element 4 at (0.5, 0.5) has no volume"},
        Broken{"NotPlane", good_2, "4 0 1 0", "4 0 1 0.1", "the mesh is not in a plane of constant z: z = 0.1 at node 4, 0 elsewhere"},
        Broken{"Quadrilateral", good_2, "4 2 2 2 1 1 3 4", "4 3 2 2 1 1 2 3 4",
               "a.msh:22:3: error: quadrilaterals are not supported: mesh with triangles"},
        Broken{"SecondOrder", good_4, "2 1 2 2", "2 1 9 2",
               "a.msh:34:5: error: elements of type 9 (second order or higher) are not supported"},
        Broken{"NoSuchType", good_2, "4 2 2 2 1 1 3 4", "4 777 2 2 1 1 3 4", "there is no element type 777"},
        Broken{"Tetrahedron", good_2, "4 2 2 2 1 1 3 4", "4 4 2 2 1 1 2 3 4", "tetrahedra in a scene of dimension 2"},
        Broken{"ElementTwice", good_2, "4 2 2 2 1 1 3 4", "3 2 2 2 1 1 3 4", "element 3 occurs twice"},
        Broken{
            "NoCells", good_2, "$Elements\n4\n1 15 2 3 1 1\n2 1 2 1 1 1 2\n3 2 2 2 1 1 2 3\n4 2 2 2 1 1 3 4", "$Elements\n1\n1 15 2 3 1 1",
            "a.msh: error: the mesh has no triangles, which are the cells of a scene of dimension 2; its elements are of lower dimension"},
        Broken{"NoElements", good_2, "$Elements", "$Other", "a.msh:17:1: error: section $Other is never closed"},
        Broken{"ElementsFirst", good_2, "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n", "", "$Elements stands before $Nodes"},
        Broken{"NoClosingWord", good_2, "$EndElements\n", "", "a.msh:23:1: error: the file ends where $EndElements should stand"},
        Broken{"TagCount", good_2, "3 2 2 2 1 1 2 3", "3 2 99999 2 1 1 2 3", "the number of tags of an element is 99999"},
        Broken{"Partitioned", good_4, "$Entities", "$PartitionedEntities", "the mesh is partitioned"},
        Broken{"EntityTwice", good_4, "1 1 1 0\n", "2 1 1 0\n1 0 0 0 0\n", "a.msh:13:1: error: entity 1 of dimension 0 occurs twice"},
        Broken{"NoSuchEntity", good_4, "2 1 2 2\n", "2 6 2 2\n", "$Entities has no entity 6 of dimension 2"},
        Broken{"EntityDimension", good_4, "2 1 2 2\n", "1 1 2 2\n", "elements of dimension 2 on an entity of dimension 1"},
        Broken{"EntityCount", good_4, "1 1 1 0\n1 0", "1 1 999 0\n1 0", "a.msh:11:5: error: the number of entities is 999, but only"},
        Broken{"TagOutOfRange", good_4, "1 4 1 4\n2 1 0 4\n1\n2", "1 4 1 4\n2 1 0 4\n1\n7", "the tag of a node is 7, outside [1, 4]"},
        Broken{"RangeUpsideDown", good_4, "1 4 1 4\n2 1 0 4", "1 4 4 1\n2 1 0 4", "the highest tag is 1, outside [4,"},
        Broken{"TotalTooSmall", good_4, "1 4 1 4\n2 1 0 4", "1 3 1 4\n2 1 0 4", "3 nodes announced, 4 found"},
        Broken{"TotalTooLarge", good_4, "3 4 1 4\n", "3 5 1 5\n", "5 elements announced, 4 found"},
        Broken{"Parametric", good_4, "2 1 0 4", "2 1 5 4", "the parametric flag is 5"},
        Broken{"BlockCount", good_4, "3 4 1 4\n", "4 4 1 4\n", "expected the dimension of an entity, found \"$EndElements\""}),
    [](const auto& test) { return test.param.name; });

TEST(GmshRead, FacetAwayFromTheCellsIsRefused)
{
  const std::string file = replaced(replaced(good_2, "$Nodes\n4\n", "$Nodes\n5\n9 2 2 0\n"), "1 1 1 2\n", "1 1 1 9\n");
  EXPECT_EQ(complaint<2>(file),
            "a.msh: error: a facet of group \"floor\" touches node 9, which belongs to no cell: the group must lie on cells (mesh of "
            "scene.yaml:3:10)\n1 error, nothing was run.");
}

TEST(GmshRead, PlaneMeshInSolidSceneIsRefused)
{
  EXPECT_THAT(complaint<3>(good_4), HasSubstr("a.msh: error: the mesh has no tetrahedra, which are the cells of a scene of dimension 3"));
}

TEST(GmshRead, MissingEmptyAndFolderAreErrorsOfTheScene)
{
  const ScratchFolder folder;
  const SourceLocation asked{"scene.yaml", 3, 10, "mesh.file"};
  const auto said = [&](const std::string& name) -> std::string {
    try {
      read_msh<2>(folder / name, asked);
    } catch (const SceneErrors& errors) {
      EXPECT_EQ(to_string(errors.problems().at(0).where), "scene.yaml:3:10");
      return errors.problems().at(0).message;
    }
    return "no complaint";
  };
  write(folder / "empty.msh", "");
  std::filesystem::create_directory(folder / "folder.msh");
  EXPECT_THAT(said("none.msh"), HasSubstr("none.msh\" does not exist"));
  EXPECT_THAT(said("empty.msh"), HasSubstr("empty.msh\" is empty"));
  EXPECT_THAT(said("folder.msh"), HasSubstr("folder.msh\" is a folder"));
}

TEST(GmshRead, WhatIsOddButSaneIsAccepted)
{
  EXPECT_EQ(complaint<2>("$Comments\nby hand\n$EndComments\n" + good_2), "no complaint");
  EXPECT_EQ(complaint<2>(good_2 + "$NodeData\n1\n\"u\"\n$EndNodeData\n"), "no complaint");
  EXPECT_EQ(complaint<2>(replaced(good_2, "$Nodes\n4\n", "$Nodes\n5\n70 3 3 3\n")), "no complaint") << "a node no cell uses";
  EXPECT_EQ(complaint<2>(replaced(good_2, "2 1 0 0", "2 1 1e-400 0")), "no complaint") << "smaller than any double";
  EXPECT_EQ(complaint<2>(replaced(good_2, "3 2 2 2 1", "3 2 2 0 1")), "no complaint") << "a cell in no group";
  std::string windows;
  for (const char c : good_4)
    windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(complaint<2>(windows), "no complaint");
}

TEST(GmshRead, PlaneAtAnyHeightIsAPlane)
{
  const ScratchFolder folder;
  std::string raised = good_2;
  for (const char* node : {"1 0 0 0\n2", "2 1 0 0\n3", "3 1 1 0\n4", "4 0 1 0\n$"}) {
    std::string higher = node;
    higher[6] = '7';
    raised = replaced(raised, node, higher);
  }
  write(folder / "a.msh", raised);
  EXPECT_EQ(read_msh<2>(folder / "a.msh", {}).nodes.size(), 4U);
}

template <class T>
std::string overwritten(std::string bytes, std::size_t at, T value)
{
  std::memcpy(&bytes.at(at), &value, sizeof(value));
  return bytes;
}

/// Two triangles in binary 4.1.
std::string good_binary()
{
  const ScratchFolder folder;
  write_msh(folder / "a.msh", Mesh<2>(box<2>({0, 0}, {1, 1}, {1, 1})), MshKind::binary);
  return bytes_of(folder / "a.msh");
}

TEST(GmshRead, BrokenBinaryFilesAreRefusedWithTheByte)
{
  const std::string good = good_binary();
  ASSERT_EQ(complaint<2>(good), "no complaint");
  const std::size_t nodes = good.find("$Nodes\n") + 7, elements = good.find("$Elements\n") + 10;
  const std::size_t tags = nodes + 32 + 20, places = tags + 4 * 8;
  const auto at = [](std::size_t byte, const std::string& text) {
    return HasSubstr("a.msh: error: byte " + std::to_string(byte) + ": " + text);
  };
  EXPECT_THAT(complaint<2>(overwritten(good, good.find("4.1 1 8\n") + 8, 7)), HasSubstr("the byte order cannot be told"));
  EXPECT_THAT(complaint<2>(overwritten(good, nodes + 8, std::uint64_t{1} << 40)),
              at(nodes + 8, "the number of nodes is 1099511627776, more than"));
  EXPECT_THAT(complaint<2>(overwritten(good, nodes + 8, std::uint64_t{1} << 63)),
              at(nodes + 8, "the number of nodes is -9223372036854775808"));
  EXPECT_THAT(complaint<2>(overwritten(good, nodes + 8, std::uint64_t{100000})), at(nodes + 8, "the number of nodes is 100000, but only"));
  EXPECT_THAT(complaint<2>(overwritten(good, nodes + 32, 9)), at(nodes + 32, "an entity of dimension 9"));
  EXPECT_THAT(complaint<2>(overwritten(good, tags, std::uint64_t{99})), at(tags, "the tag of a node is 99, outside [1, 4]"));
  EXPECT_THAT(complaint<2>(overwritten(good, tags, std::uint64_t{2})), HasSubstr("node 2 occurs twice"));
  EXPECT_THAT(complaint<2>(overwritten(good, places + 8, std::nan(""))), at(places + 8, "the y coordinate of a node is nan"));
  EXPECT_THAT(complaint<2>(overwritten(good, elements + 32 + 8, 5)), at(elements + 32 + 8, "hexahedra are not supported"));
  EXPECT_THAT(complaint<2>(overwritten(good, elements + 32 + 4, 77)), at(elements + 32 + 4, "$Entities has no entity 77"));
  EXPECT_THAT(complaint<2>(good.substr(0, places + 20)), HasSubstr("the number of nodes is 4, but only"));
  EXPECT_THAT(complaint<2>(good.substr(0, elements + 60)), HasSubstr("byte "));
  EXPECT_THAT(complaint<2>(good.substr(0, good.size() - 8)), HasSubstr("expected $EndElements, found"));
}

/// Every scalar of a binary file that this machine did not write comes with its bytes reversed.
TEST(GmshRead, ReversedBytesAreTurned)
{
  const std::string head = "$MeshFormat\n2.2 1 8\n", middle = "\n$EndMeshFormat\n$Nodes\n3\n";
  std::string file = head;
  const auto put = [&]<class T>(T value) {
    std::string bytes(sizeof(T), '\0');
    std::memcpy(bytes.data(), &value, sizeof(T));
    std::reverse(bytes.begin(), bytes.end());
    file += bytes;
  };
  put(std::int32_t{1});
  file += middle;
  for (const auto& [tag, x, y] : {std::tuple{1, 0.0, 0.0}, {2, 2.5, 0.0}, {3, 0.0, 1.0}}) {
    put(std::int32_t{tag});
    for (const double coordinate : {x, y, 0.0})
      put(coordinate);
  }
  file += "\n$EndNodes\n$Elements\n1\n";
  for (const std::int32_t value : {2, 1, 2, 1, 0, 1, 1, 2, 3})
    put(value);
  file += "\n$EndElements\n";
  const ScratchFolder folder;
  write(folder / "a.msh", file);
  const MeshData<2> data = read_msh<2>(folder / "a.msh", {});
  ASSERT_EQ(data.nodes.size(), 3U);
  EXPECT_EQ(data.nodes[1], Vec<2>(2.5, 0));
}

}  // namespace
}  // namespace talus::gmsh_broken_test
