// VTK's files of other programs, in every encoding.
#include "io/output/vtk_points.hpp"

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "io/files/atomic_file.hpp"
#include "io/output/vtk.hpp"
#include "io/output/vtk_arrays.hpp"
#include "tests/io/scratch_folder.hpp"

namespace talus::vtk_points_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A square of 2 m in two triangles, with the stress of each and the pressure of each corner.
struct Parts {
  std::string file = R"(type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt32")";
  std::string points = R"(format="ascii">0 0 0  2 0 0  2 2 0  0 2 0</DataArray>)";
  std::string stress = R"(format="ascii">-1 -2 -3 0.5 -5 -6 -7 0.25</DataArray>)";
  std::string end{};
  std::string corners = R"(format="ascii">0 1 2 0 2 3</DataArray>)";
  std::string offsets = "3 6";
  std::string keys{};  // of the pressure
  std::string text() const
  {
    return "<?xml version=\"1.0\"?>\n<VTKFile " + file +
           "><UnstructuredGrid>\n<Piece NumberOfPoints=\"4\" NumberOfCells=\"2\">\n"
           "<PointData Scalars=\"p\"><DataArray type=\"Float32\" Name=\"p\" format=\"ascii\">1 2 3 4e0" +
           keys +
           "</DataArray></PointData>\n"
           "<CellData><DataArray type=\"Float32\" Name=\"sigma\" NumberOfComponents=\"4\" " +
           stress + "<Array type=\"String\" Name=\"word\" format=\"ascii\">65 0 66 0</Array></CellData>\n" +
           "<Points><DataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\" " + points + "</Points>\n" +
           "<Cells><DataArray type=\"Int32\" Name=\"connectivity\" " + corners +
           "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">" + offsets +
           "</DataArray>"
           "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">5 5</DataArray></Cells>\n</Piece></UnstructuredGrid>" +
           end + "</VTKFile>\n";
  }
};

VtkPoints read(const Parts& parts)
{
  const ScratchFolder folder;
  write_whole(folder / "a.vtu", parts.text());
  return read_vtk_points(folder / "a.vtu");
}
std::string refusal(const Parts& parts)
{
  try {
    read(parts);
  } catch (const EnvironmentError& wrong) {
    return wrong.what();
  }
  return "";
}

void expect_square(const VtkPoints& all)
{
  EXPECT_THAT(all.points, ElementsAre(0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0));
  EXPECT_THAT(all.cells, ElementsAre(4. / 3, 2. / 3, 0, 2. / 3, 4. / 3, 0));
  ASSERT_EQ(all.of_points.size(), 1U);
  EXPECT_THAT(all.of_points[0].values, ElementsAre(1, 2, 3, 4));
  ASSERT_EQ(all.of_cells.size(), 1U);
  EXPECT_EQ(all.of_cells[0].name, "sigma");
  EXPECT_EQ(all.of_cells[0].components, 4);
  EXPECT_THAT(all.of_cells[0].values, ElementsAre(-1, -2, -3, 0.5, -5, -6, -7, 0.25));
}

const std::string points64 =
    "YAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAABAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAABAAAAAAAAAAEAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAEAAAAAAAAAAAA"
    "==";
const std::string stress64 = "AQAAAAAAAAAgAAAAAAAAAAAAAAAAAAAAIgAAAAAAAAA=eJxjYGjYz8DAcICBwQGIGewZGBYA6QNA/ACIG+wAe/AIfQ==";

TEST(VtkPoints, TextAndBase64AreRead)
{
  expect_square(read({}));
  expect_square(read({.points = "format=\"binary\">\n  " + points64 + "\n</DataArray>"}));
}

TEST(VtkPoints, CompressedBlocksAndAppendedDataAreRead)
{
  const std::string packed = R"(type="UnstructuredGrid" byte_order="LittleEndian" header_type="UInt64" compressor="vtkZLibDataCompressor")";
  expect_square(read({.file = packed, .stress = "format=\"binary\">" + stress64 + "</DataArray>"}));
  expect_square(read({.file = packed,
                      .stress = "format=\"appended\" offset=\"4\"/>",
                      .end = "<AppendedData encoding=\"base64\">\n _AAAA" + stress64 + "\n</AppendedData>"}));
  std::string raw("_xy\0\0\0", 6);
  raw[3] = 32;
  raw += '\0';
  const float values[] = {-1, -2, -3, 0.5F, -5, -6, -7, 0.25F};
  raw.append(reinterpret_cast<const char*>(values), sizeof values);
  raw[3] = 32, raw[4] = 0, raw[5] = 0, raw[6] = 0;
  expect_square(read(
      {.stress = "format=\"appended\" offset=\"2\"></DataArray>", .end = "<AppendedData encoding=\"raw\">" + raw + "</AppendedData>"}));
}

/// ParaView writes the range of an array into it, and what a unit is.
TEST(VtkPoints, KeysInsideOfArraysHideNoArrayBehindThem)
{
  const std::string range =
      "<InformationKey name=\"L2_NORM_RANGE\" location=\"vtkDataArray\" length=\"2\">\n<Value index=\"0\">1</Value>\n"
      "<Value index=\"1\">4</Value></InformationKey>";
  const VtkPoints all =
      read({.keys = range + "<InformationKey name=\"UNITS_LABEL\" location=\"vtkDataArray\">kPa</InformationKey></DataArray>" +
                    "<DataArray type=\"Float32\" Name=\"q\" format=\"ascii\">5 6 7 8" + range});
  ASSERT_EQ(all.of_points.size(), 2U);
  EXPECT_EQ(all.of_points[0].unit, "kPa");
  EXPECT_EQ(all.of_points[1].name, "q");
  EXPECT_THAT(all.of_points[1].values, ElementsAre(5, 6, 7, 8));
  EXPECT_EQ(all.of_cells.size(), 1U);
}

std::string in_base64(const std::string& bytes)
{
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8U | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : letters[bits >> (18 - 6 * k) & 63U];
  }
  return text;
}
std::string header_of(const std::vector<std::uint64_t>& numbers)
{
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(std::uint64_t)};
}
const std::string packed_file =
    R"(type="UnstructuredGrid" byte_order="LittleEndian" header_type="UInt64" compressor="vtkZLibDataCompressor")";

/// VTK writes blocks of 32768 bytes, of which a short array has a part of one.
TEST(VtkPoints, ABlockMayBeShorterThanBlocksAre)
{
  const std::string begin = in_base64(header_of({1, 32768, 32, 34})), block = stress64.substr(stress64.find('=') + 1);
  expect_square(read({.file = packed_file, .stress = "format=\"binary\">" + begin + block + "</DataArray>"}));
}

/// The sizes are such that their sums and products of 64 bits are those of an array that fits.
TEST(VtkPoints, SizesOfDamagedFilesDoNotOverflow)
{
  constexpr std::uint64_t half = std::uint64_t{1} << 63U;
  const auto array = [](const std::vector<std::uint64_t>& numbers) {
    return "format=\"binary\">" + in_base64(header_of(numbers)) + "</DataArray>";
  };
  const std::string blocks = "blocks of 9223372036854775840 bytes, and its numbers are 32 bytes";
  EXPECT_THAT(refusal({.file = packed_file, .stress = array({2, half + 32, half, 1, 1, 0, 0})}), HasSubstr("array \"sigma\": it has 2 "));
  EXPECT_THAT(refusal({.file = packed_file, .stress = array({2, half + 16, half + 16, 1, 1, 0, 0})}),
              HasSubstr("array \"sigma\": it has 2 "));
  EXPECT_THAT(refusal({.file = packed_file, .stress = array({2, half + 32, 0, 1, 1, 0, 0})}), HasSubstr(blocks));
  EXPECT_THAT(refusal({.file = packed_file, .corners = array({4, half / 2 + 6, 0, 1, 1, 1, 1, 0, 0})}),
              HasSubstr("array \"connectivity\": it has more bytes than its blocks can hold"));
  EXPECT_THAT(refusal({.file = packed_file, .stress = array({half / 4, 8, 0, 1})}),
              HasSubstr("array \"sigma\": it ends before its numbers"));
  EXPECT_THAT(refusal({.file = packed_file, .stress = array({2, 16, 0, ~std::uint64_t{0}, 2})}),
              HasSubstr("array \"sigma\": it ends before its numbers"));
}

TEST(VtkPoints, EndsOfCellsThatAreNoWholeNumbersAreRefused)
{
  for (const auto* offsets : {"nan 6", "1e300 6", "-3 6", "0.5 6", "3 3", "3 7", "6 3"})
    EXPECT_THAT(refusal({.offsets = offsets}), HasSubstr("has no corners")) << offsets;
}

/// Otherwise a file of many arrays takes a time that grows with their square.
TEST(VtkArrays, OfArraysInOneTextOnlyTheFirstIsDecoded)
{
  const std::string plain = in_base64(header_of({16, 1, 2})), packed = in_base64(header_of({2, 8, 0, 8, 8})) + in_base64(header_of({1, 2}));
  const std::string behind = in_base64(std::string(3000, 'x'));
  EXPECT_EQ(array_in_base64(plain + behind, {.long_headers = true, .compressor = ""}), header_of({16, 1, 2}));
  EXPECT_EQ(array_in_base64(packed + behind, {.long_headers = true, .compressor = "any"}), header_of({2, 8, 0, 8, 8, 1, 2}));
  EXPECT_EQ(vtk_count_in_base64(packed + behind, {.long_headers = true, .compressor = "any"}, "Float64"), 2U);
  EXPECT_EQ(decoded_base64(plain, 5).size(), 5U);
}

TEST(VtkPoints, FilesOfTalusAreReadWithTheirUnits)
{
  const ScratchFolder folder;
  const std::vector<Column> of_particles{{"stress", 6, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}, "Pa"}};
  write_particles(folder / "a.vtp", 0.5, std::vector<Real>{0.1, 0.2, 0, 0.3, 0.4, 0}, std::vector<std::int64_t>{3, 9}, of_particles);
  const VtkPoints particles = read_vtk_points(folder / "a.vtp");
  EXPECT_THAT(particles.points, ElementsAre(0.1, 0.2, 0, 0.3, 0.4, 0));
  ASSERT_EQ(particles.of_points.size(), 2U);
  EXPECT_EQ(particles.of_points[1].unit, "Pa");
  EXPECT_THAT(particles.of_points[1].values, ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12));
}

TEST(VtkPoints, WhatCannotBeReadIsNamed)
{
  const auto with = [](const std::string& file) { return Parts{.file = file}; };
  EXPECT_THAT(refusal(with(R"(type="PUnstructuredGrid" byte_order="LittleEndian")")), HasSubstr("a.vtu: it is a list of pieces"));
  EXPECT_THAT(refusal(with(R"(type="ImageData" byte_order="LittleEndian")")), HasSubstr("its type is \"ImageData\""));
  EXPECT_THAT(refusal(with(R"(type="UnstructuredGrid" byte_order="BigEndian")")), HasSubstr("its byte order is \"BigEndian\""));
  EXPECT_THAT(refusal({.stress = "format=\"ascii\">1 2 3</DataArray>"}), HasSubstr("array \"sigma\": it has 3 numbers, not 8"));
  EXPECT_THAT(refusal({.stress = "format=\"ascii\">1 2 3 4 5 6 7 x</DataArray>"}), HasSubstr("array \"sigma\": number 8 is \"x\""));
  EXPECT_THAT(refusal({.stress = "format=\"own\">1</DataArray>"}), HasSubstr("its format is \"own\""));
  EXPECT_THAT(refusal({.stress = "format=\"appended\" offset=\"0\"/>"}), HasSubstr("its numbers are not in the file"));
  EXPECT_THAT(refusal({.points = "format=\"binary\">YAAAAAAA</DataArray>"}), HasSubstr("array \"Points\": it ends before its numbers"));
  EXPECT_THAT(refusal({.corners = "format=\"ascii\">0 1 2 0 2 4</DataArray>"}), HasSubstr("cell 2 has the corner 4, of 4 points"));
  const std::string packed = R"(type="UnstructuredGrid" byte_order="LittleEndian" header_type="UInt64" compressor=")";
  EXPECT_THAT(
      refusal({.file = packed + "vtkZLibDataCompressor\"", .stress = "format=\"binary\">" + stress64.substr(0, 60) + "</DataArray>"}),
      HasSubstr("array \"sigma\": it ends before its numbers"));
  EXPECT_THAT(refusal({.file = packed + "own\"", .stress = "format=\"binary\">" + stress64 + "</DataArray>"}),
              HasSubstr("compressor \"own\" is not one of VTK's LZ4, ZLib and LZMA"));
  std::string damaged = stress64;
  damaged[70] = damaged[70] == 'A' ? 'B' : 'A';
  EXPECT_THAT(refusal({.file = packed + "vtkZLibDataCompressor\"", .stress = "format=\"binary\">" + damaged + "</DataArray>"}),
              HasSubstr("block 1 cannot be unpacked"));
}

}  // namespace
}  // namespace talus::vtk_points_test
