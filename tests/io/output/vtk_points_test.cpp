// VTK's files of other programs, in every encoding.
#include "io/output/vtk_points.hpp"

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "io/files/atomic_file.hpp"
#include "io/output/vtk.hpp"
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
  std::string end;
  std::string corners = "0 1 2 0 2 3";
  std::string text() const
  {
    return "<?xml version=\"1.0\"?>\n<VTKFile " + file +
           "><UnstructuredGrid>\n<Piece NumberOfPoints=\"4\" NumberOfCells=\"2\">\n"
           "<PointData Scalars=\"p\"><DataArray type=\"Float32\" Name=\"p\" format=\"ascii\">1 2 3 4e0</DataArray></PointData>\n"
           "<CellData><DataArray type=\"Float32\" Name=\"sigma\" NumberOfComponents=\"4\" " +
           stress + "<Array type=\"String\" Name=\"word\" format=\"ascii\">65 0 66 0</Array></CellData>\n" +
           "<Points><DataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\" " + points + "</Points>\n" +
           "<Cells><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">" + corners +
           "</DataArray><DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">3 6</DataArray>"
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
  EXPECT_THAT(refusal({.corners = "0 1 2 0 2 4"}), HasSubstr("cell 2 has the corner 4, of 4 points"));
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
