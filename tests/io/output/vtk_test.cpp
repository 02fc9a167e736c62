// Files as VTK's own readers see them.
#include "io/output/vtk.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <fstream>
#include <limits>
#include <numeric>
#include <random>

#include "core/error.hpp"
#include "io/files/atomic_file.hpp"
#include "tests/io/full_disk.hpp"
#include "tests/io/scratch_folder.hpp"

namespace talus::vtk_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

struct Cloud {
  std::vector<Real> positions;
  std::vector<std::int64_t> ids;
  std::vector<Column> columns;
};

/// Noise: LZ4 cannot shrink it, so the sizes of files are known from below.
Cloud random_cloud(std::size_t n)
{
  std::mt19937 generator(7);
  std::normal_distribution<Real> normal;
  Cloud cloud{{}, {}, {{"velocity", 3, {}, "m/s"}, {"stress", 6, {}, "Pa"}, {"volume", 1, {}, "m^3"}}};
  for (std::size_t p = 0; p < n; ++p) {
    cloud.ids.push_back(static_cast<std::int64_t>(p) + (std::int64_t{1} << 40));
    for (int d = 0; d < 3; ++d)
      cloud.positions.push_back(1e6 + normal(generator));  // as map coordinates are
    for (Column& column : cloud.columns)
      for (int c = 0; c < column.components; ++c)
        column.values.push_back(static_cast<float>(normal(generator)));
  }
  return cloud;
}

template <class Reader>
void read(Reader& reader, const std::filesystem::path& file)
{
  reader.SetFileName(file.c_str());
  reader.Update();
  ASSERT_EQ(reader.GetErrorCode(), 0ul);
}

template <int D>
Mesh<D> two_cells()
{
  MeshData<D> data;
  for (int n = 0; n < D + 2; ++n) {
    Vec<D> x = Vec<D>::Zero();
    if (n > 0 && n <= D)
      x[n - 1] = 1;
    if (n == D + 1)
      x.setOnes();
    data.nodes.push_back(x);
  }
  std::array<Index, D + 1> first, second;
  for (int a = 0; a <= D; ++a) {
    first[static_cast<std::size_t>(a)] = a;
    second[static_cast<std::size_t>(a)] = a + 1;
  }
  data.cells = {first, second};
  return Mesh<D>(data);
}

TEST(Vtk, ParticlesReadBackAsWritten)
{
  const ScratchFolder folder;
  const Cloud cloud = random_cloud(20000);
  write_particles(folder / "a.vtp", 1.25, cloud.positions, cloud.ids, cloud.columns);
  vtkNew<vtkXMLPolyDataReader> reader;
  read(*reader, folder / "a.vtp");
  vtkPolyData* data = reader->GetOutput();
  ASSERT_EQ(data->GetNumberOfPoints(), 20000);
  ASSERT_EQ(data->GetNumberOfVerts(), 20000);
  EXPECT_EQ(data->GetFieldData()->GetArray("TimeValue")->GetTuple1(0), 1.25);
  vtkDataArray* id = data->GetPointData()->GetArray("id");
  ASSERT_NE(id, nullptr);
  for (vtkIdType p = 0; p < 20000; p += 997) {
    const auto q = static_cast<std::size_t>(p);
    for (int d = 0; d < 3; ++d)
      EXPECT_EQ(data->GetPoint(p)[d], cloud.positions[3 * q + static_cast<std::size_t>(d)]);
    EXPECT_EQ(static_cast<std::int64_t>(id->GetTuple1(p)), cloud.ids[q]);
    vtkIdType points = 0;
    const vtkIdType* vertex = nullptr;
    data->GetVerts()->GetCellAtId(p, points, vertex);
    EXPECT_EQ(points, 1);
    EXPECT_EQ(vertex[0], p);
  }
  for (const Column& column : cloud.columns) {
    vtkDataArray* array = data->GetPointData()->GetArray(column.name.c_str());
    ASSERT_NE(array, nullptr) << column.name;
    ASSERT_EQ(array->GetNumberOfComponents(), column.components);
    EXPECT_STREQ(array->GetInformation()->Get(vtkDataArray::UNITS_LABEL()), column.unit.c_str());
    for (std::size_t i = 0; i < column.values.size(); ++i)
      ASSERT_EQ(array->GetComponent(static_cast<vtkIdType>(i) / column.components, static_cast<int>(i) % column.components),
                column.values[i]);
  }
}

TEST(Vtk, EmptyCloudIsALegalFile)
{
  const ScratchFolder folder;
  const std::vector<Column> columns{{"velocity", 3, {}}};
  write_particles(folder / "empty.vtp", 0, {}, {}, columns);
  vtkNew<vtkXMLPolyDataReader> reader;
  read(*reader, folder / "empty.vtp");
  EXPECT_EQ(reader->GetOutput()->GetNumberOfPoints(), 0);
  EXPECT_EQ(reader->GetNumberOfPointArrays(), 2);
}

TEST(Vtk, ValuesThatAreNotFiniteAreWrittenAsTheyAre)
{
  const ScratchFolder folder;
  const std::vector<Column> columns{{"a", 1, {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}}};
  write_particles(folder / "nan.vtp", 0, std::vector<Real>(6, 0.0), std::vector<std::int64_t>{0, 1}, columns);
  vtkNew<vtkXMLPolyDataReader> reader;
  read(*reader, folder / "nan.vtp");
  vtkDataArray* array = reader->GetOutput()->GetPointData()->GetArray("a");
  EXPECT_TRUE(std::isnan(array->GetTuple1(0)));
  EXPECT_TRUE(std::isinf(array->GetTuple1(1)));
}

template <int D>
void expect_mesh_reads_back()
{
  const ScratchFolder folder;
  const Mesh<D> mesh = two_cells<D>();
  std::vector<float> numbers(static_cast<std::size_t>(mesh.n_nodes()));
  std::iota(numbers.begin(), numbers.end(), 0.f);
  const std::vector<Column> node_columns{{"mass", 1, numbers}}, cell_columns{{"quality", 1, {0.5f, 0.75f}}};
  write_mesh<D>(folder / "mesh.vtu", 0.5, mesh, node_columns, cell_columns);
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  read(*reader, folder / "mesh.vtu");
  vtkUnstructuredGrid* grid = reader->GetOutput();
  ASSERT_EQ(grid->GetNumberOfPoints(), mesh.n_nodes());
  ASSERT_EQ(grid->GetNumberOfCells(), 2);
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    for (int d = 0; d < 3; ++d)
      EXPECT_EQ(grid->GetPoint(n)[d], d < D ? mesh.node(n)[std::min(d, D - 1)] : 0.0);
    EXPECT_EQ(grid->GetPointData()->GetArray("mass")->GetTuple1(n), static_cast<double>(n));
  }
  for (Index c = 0; c < 2; ++c) {
    EXPECT_EQ(grid->GetCellType(c), D == 2 ? VTK_TRIANGLE : VTK_TETRA);
    for (int a = 0; a <= D; ++a)
      EXPECT_EQ(grid->GetCell(c)->GetPointId(a), mesh.cell(c)[static_cast<std::size_t>(a)]);
  }
  EXPECT_EQ(grid->GetCellData()->GetArray("quality")->GetTuple1(1), 0.75);
}

TEST(Vtk, TrianglesReadBackAsWritten) { expect_mesh_reads_back<2>(); }
TEST(Vtk, TetrahedraReadBackAsWritten) { expect_mesh_reads_back<3>(); }

TEST(Vtk, ColumnOfTheWrongLengthIsRefusedByName)
{
  const ScratchFolder folder;
  const std::vector<Column> columns{{"velocity", 3, {1, 2}}};
  try {
    write_particles(folder / "a.vtp", 0, std::vector<Real>(3, 0.0), std::vector<std::int64_t>{0}, columns);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("\"velocity\" has 2 values"));
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "a.vtp"));
}

TEST(Vtk, FullDiskIsAnEnvironmentErrorAndKeepsTheOldFile)
{
  const ScratchFolder folder;
  const Cloud cloud = random_cloud(20000);
  write_particles(folder / "a.vtp", 0, {}, {}, {});
  const std::string before = read_whole(folder / "a.vtp");
  {
    const FullDisk full(200'000);  // less than the 20000 positions alone
    try {
      write_particles(folder / "a.vtp", 0, cloud.positions, cloud.ids, cloud.columns);
      ADD_FAILURE() << "wrote more than the disk holds";
    } catch (const EnvironmentError& error) {
      EXPECT_THAT(error.what(), HasSubstr((folder / "a.vtp").string()));
    }
  }
  EXPECT_EQ(read_whole(folder / "a.vtp"), before);
}

TEST(Vtk, FolderThatCannotBeMadeIsAnEnvironmentError)
{
  const ScratchFolder folder;
  std::ofstream(folder / "file") << "not a folder";
  EXPECT_THROW(write_particles(folder / "file/a.vtp", 0, {}, {}, {}), EnvironmentError);
}

TEST(Pvd, ListsTimesAndPathsThatOpen)
{
  const ScratchFolder folder;
  PvdSeries series(folder / "particles.pvd", "talus 1.2; -D 'a=\"b\"'");
  for (const Real t : {0.0, 0.1, 1.0 / 3})
    series.append(t, folder.path() / "particles" / fmt::format("a&b_{}.vtp", t));
  const auto read = read_pvd(folder / "particles.pvd");
  ASSERT_EQ(read.size(), 3u);
  EXPECT_EQ(read[2].first, 1.0 / 3);
  EXPECT_EQ(read[1].second, folder.path() / "particles/a&b_0.1.vtp");
  EXPECT_THAT(read_whole(folder / "particles.pvd"), HasSubstr("MadeBy=\"talus 1.2; -D 'a=&quot;b&quot;'\">"));
  EXPECT_THAT(read_whole(folder / "particles.pvd"), HasSubstr("file=\"particles/a&amp;b_0.1.vtp\""));
}

TEST(Pvd, ResumedSeriesHasNoDoubledAndNoMissingStep)
{
  const ScratchFolder folder;
  PvdSeries first(folder / "a.pvd");
  for (const Real t : {0.0, 0.1, 0.2, 0.3})
    first.append(t, folder / fmt::format("{}.vtp", t));
  PvdSeries second(folder / "a.pvd");
  second.resume(0.25);
  second.append(0.3, folder / "new.vtp");
  EXPECT_THAT(read_pvd(folder / "a.pvd"), ElementsAre(Pair(0.0, folder / "0.vtp"), Pair(0.1, folder / "0.1.vtp"),
                                                      Pair(0.2, folder / "0.2.vtp"), Pair(0.3, folder / "new.vtp")));
}

TEST(Pvd, FileThatIsNoListIsNamed)
{
  const ScratchFolder folder;
  std::ofstream(folder / "a.pvd") << "<VTKFile/>";
  EXPECT_THROW(read_pvd(folder / "a.pvd"), EnvironmentError);
  const std::string begin = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\"><!-- by hand -->\n<Collection>\n",
                    end = "</Collection></VTKFile>";
  const auto refused = [&](const std::string& text) {
    write_whole(folder / "a.pvd", text);
    try {
      read_pvd(folder / "a.pvd");
    } catch (const EnvironmentError& wrong) {
      return std::string(wrong.what()).find("a.pvd") != std::string::npos;
    }
    return false;
  };
  const std::string good = "<DataSet timestep='1' file='a.vtp'/>";
  EXPECT_FALSE(refused(begin + good + end));
  for (const std::string& damaged :
       {good.substr(0, 20), std::string("<DataSet timestep=\"1\"/>"), std::string("<DataSet timestep=\"x\" file=\"a\"/>"),
        std::string("<DataSet timestep=\"nan\" file=\"a\"/>"), std::string("<DataSet timestep=\"1\" file=\"\"/>"), std::string("< a/>"),
        std::string("<!DOCTYPE a [<!ENTITY x SYSTEM \"file:///etc/passwd\">]>"), std::string("<!-- ")})
    EXPECT_TRUE(refused(begin + damaged + end)) << damaged;
  EXPECT_TRUE(refused(begin + good)) << "it has been cut short";
  EXPECT_THROW(read_pvd(folder / "none.pvd"), EnvironmentError);
}

}  // namespace
}  // namespace talus::vtk_test
