// Fields of result files, as `talus diff` reads them.
#include <gmock/gmock.h>

#include <limits>

#include "core/error.hpp"
#include "core/parallel/communicator.hpp"
#include "io/files/atomic_file.hpp"
#include "io/output/vtk.hpp"
#include "tests/io/scratch_folder.hpp"

namespace talus::vtk_read_test {

namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::int64_t large_id = (std::int64_t{1} << 53) + 1;  // no double has this value

std::string message_of(const std::filesystem::path& file)
{
  try {
    read_particles(file);
  } catch (const EnvironmentError& e) {
    return e.what();
  }
  return "";
}

TEST(VtkRead, ParticlesAreReadWithEveryBit)
{
  const ScratchFolder folder;
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const std::vector<Real> positions{0.1, 1.0 / 3, 0, -1e300, 5e-324, 0};
  const std::vector<std::int64_t> ids{3, large_id};
  write_particles(folder / "a.vtp", 0.5, positions, ids,
                  std::vector<Column>{{"heat", 1, {0.1f, infinity}, "J"}, {"velocity", 3, {1, 2, 3, 4, 5, 6}, "m/s"}, {"none", 1, {0, 0}}},
                  "talus 1.2; scene 17");
  const StoredParticles read = read_particles(folder / "a.vtp");
  EXPECT_EQ(read.ids, ids);
  EXPECT_EQ(read.made_by, "talus 1.2; scene 17");
  ASSERT_EQ(read.fields.size(), 4u);
  EXPECT_EQ(read.fields[0].name, "position");
  EXPECT_EQ(read.fields[0].unit, "m");
  EXPECT_EQ(read.fields[0].values, positions);
  EXPECT_EQ(read.fields[1].name, "heat");
  EXPECT_EQ(read.fields[1].unit, "J");
  EXPECT_THAT(read.fields[1].values, ElementsAre(Real{0.1f}, Real{infinity}));
  EXPECT_EQ(read.fields[2].components, 3);
  EXPECT_THAT(read.fields[2].values, ElementsAre(1, 2, 3, 4, 5, 6));
  EXPECT_EQ(read.fields[3].unit, "");
}

TEST(VtkRead, NoParticlesAreNoError)
{
  const ScratchFolder folder;
  write_particles(folder / "a.vtp", 0, {}, {}, std::vector<Column>{{"heat", 1, {}, "J"}});
  const StoredParticles read = read_particles(folder / "a.vtp");
  EXPECT_TRUE(read.ids.empty());
  for (const StoredField& field : read.fields)
    EXPECT_TRUE(field.values.empty()) << field.name;
}

TEST(VtkRead, AnyShortenedFileIsAnErrorThatNamesIt)
{
  const ScratchFolder folder;
  std::vector<Real> positions;
  std::vector<std::int64_t> ids;
  Column heat{"heat", 1, {}, "J"};
  for (int p = 0; p < 1000; ++p) {
    ids.push_back(p);
    heat.values.push_back(std::sin(static_cast<float>(p)));
    for (int d = 0; d < 3; ++d)
      positions.push_back(std::sin(3 * p + d));
  }
  write_particles(folder / "a.vtp", 0, positions, ids, std::vector<Column>{heat});
  const std::string whole = read_whole(folder / "a.vtp");
  // From nothing to the middle of the last block of numbers; what follows it is the end of the XML, which is not needed to read it.
  for (std::size_t length = 0; length < whole.size() - 1000; length += whole.size() / 50) {
    write_whole(folder / "short.vtp", whole.substr(0, length));
    testing::internal::CaptureStderr();
    const std::string message = message_of(folder / "short.vtp");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "VTK says nothing itself";
    EXPECT_THAT(message, HasSubstr("cannot read " + (folder / "short.vtp").string() + ": it is damaged")) << length;
    EXPECT_THAT(message, testing::Not(HasSubstr("0x"))) << message;
  }
  EXPECT_EQ(message_of(folder / "a.vtp"), "");
  EXPECT_THAT(message_of(folder / "none.vtp"), HasSubstr("there is no such file"));
}

TEST(VtkRead, WordsAndLengthsThatAreWrongAreErrors)
{
  const ScratchFolder folder;
  write_particles(folder / "a.vtp", 0, std::vector<Real>{1, 2, 3}, std::vector<std::int64_t>{1}, std::vector<Column>{{"heat", 1, {1}}});
  const std::string whole = read_whole(folder / "a.vtp");
  const auto spoilt = [&](const std::string& word, const std::string& other) {
    std::string text = whole;
    const auto at = text.find(word);
    EXPECT_NE(at, std::string::npos) << word;
    write_whole(folder / "b.vtp", text.replace(at, other.size(), other));
    return message_of(folder / "b.vtp");
  };
  // Without the order of its bytes VTK would read the numbers backwards, and divide by lengths that are 0 then.
  for (const auto& [word, other] : {std::pair{"byte_order", "bite"}, {"UInt64", "UInt32"}, {"LZ4", "ZL4"}, {"AppendedData", "appended"}})
    EXPECT_THAT(spoilt(word, other), HasSubstr("b.vtp: it is damaged, or not written by talus")) << word;
  EXPECT_THAT(spoilt("NumberOfPoints=\"1", "NumberOfPoints=\"9"), HasSubstr("b.vtp: it is damaged"));
  EXPECT_THAT(spoilt("Name=\"id\"", "Name=\"di\""), HasSubstr("its particles have no field \"id\""));
  // The first array is the time: a number of blocks (1), their size, and the size of the last that is not whole.
  const std::string blocks = whole.substr(whole.find('_', whole.find("AppendedData")) + 1, 8);
  ASSERT_EQ(blocks, std::string("\1\0\0\0\0\0\0\0", 8));
  EXPECT_THAT(spoilt("_" + blocks, "_" + std::string(8, '\xff')), HasSubstr("b.vtp: it is damaged"));
  EXPECT_THAT(spoilt("_" + blocks, "_" + blocks + std::string(8, '\0')), HasSubstr("b.vtp: it is damaged"));
}

/// Every number and some words of the head, one at a time, replaced by values that crashed VTK's own readers or made them loop without end.
TEST(VtkRead, NothingInADamagedHeadIsBelieved)
{
  const ScratchFolder folder;
  write_particles(folder / "a.vtp", 0.5, std::vector<Real>{1, 2, 3, 4, 5, 6}, std::vector<std::int64_t>{1, 2},
                  std::vector<Column>{{"velocity", 3, {1, 2, 3, 4, 5, 6}, "m/s"}}, "talus");
  const std::string whole = read_whole(folder / "a.vtp");
  const std::size_t data = whole.find("<AppendedData");
  std::size_t tried = 0, refused = 0;
  for (std::size_t at = whole.find("=\""); at < data; at = whole.find("=\"", at + 1)) {
    const std::size_t begin = at + 2, end = whole.find('"', begin);
    if (whole.find_first_not_of("0123456789 ", begin) < end)
      continue;
    for (const char* other :
         {"-5", "0", "3", "99999999999", "-9223372036854775808", "18446744073709551615", "2147483648", "", "x", "1e308"}) {
      std::string text = whole;
      write_whole(folder / "b.vtp", text.replace(begin, end - begin, other));
      ++tried;
      try {
        EXPECT_EQ(read_particles(folder / "b.vtp").ids.size(), 2u);
        stored_particle_fields(folder / "b.vtp");
      } catch (const EnvironmentError& wrong) {
        ++refused;
        EXPECT_THAT(wrong.what(), HasSubstr("b.vtp"));
      }
    }
  }
  EXPECT_GT(tried, 150u);
  EXPECT_GT(refused, tried / 2);
  for (const auto& [word, other] : {std::pair{"NumberOfPoints=\"2\"", "NumberOfPoints=\"-5\""},
                                    {"NumberOfTuples=\"1\"", "NumberOfTuples=\"-5\""},
                                    {"NumberOfComponents=\"3\"", "NumberOfComponents=\"2147483648\""},
                                    {"type=\"Float32\"", "type=\"Float64\""},
                                    {"type=\"Int64\"", "type=\"String\""}}) {
    std::string text = whole;
    ASSERT_NE(text.find(word), std::string::npos) << word;
    write_whole(folder / "b.vtp", text.replace(text.find(word), std::string_view(word).size(), other));
    EXPECT_THAT(message_of(folder / "b.vtp"), HasSubstr("b.vtp: it is damaged")) << word;
  }
}

TEST(VtkRead, PackedBytesThatAreDamagedAreAnError)
{
  const ScratchFolder folder;
  write_particles(folder / "a.vtp", 0.5, std::vector<Real>(3000, 0.25), std::vector<std::int64_t>(1000, 7), {});
  const std::string whole = read_whole(folder / "a.vtp");
  const std::size_t data = whole.find('_', whole.find("<AppendedData")) + 1;
  std::size_t refused = 0;
  for (std::size_t at = data; at < whole.size(); at += whole.size() / 60) {
    std::string text = whole;
    text[at] = static_cast<char>(~static_cast<unsigned char>(text[at]));
    write_whole(folder / "b.vtp", text);
    testing::internal::CaptureStderr();
    refused += message_of(folder / "b.vtp").empty() ? 0 : 1;
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "VTK says nothing itself";
  }
  EXPECT_GT(refused, 0u) << "most bytes are only other numbers";
}

TEST(VtkRead, AFileWithPlacesThatAreNoneIsDamaged)
{
  const ScratchFolder folder;
  write_particles(folder / "a.vtp", 0, std::vector<Real>{1, 2, std::nan("")}, std::vector<std::int64_t>{1}, {});
  EXPECT_THAT(message_of(folder / "a.vtp"), HasSubstr("a.vtp: it is damaged: position 0 is not finite"));
}

TEST(VtkRead, CornersOfCellsAreNodesOfTheMesh)
{
  const ScratchFolder folder;
  const auto write = [&](const std::vector<Index>& corners, int dimension) {
    write_mesh(one_rank(), folder / "a.vtu", 0, {dimension, {0, 4}, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 1}, corners}, {}, {});
  };
  write({0, 1, 3}, 2);
  const StoredMesh mesh = read_mesh(folder / "a.vtu");
  EXPECT_EQ(mesh.dimension, 2);
  EXPECT_THAT(mesh.corners, ElementsAre(0, 1, 3));
  write({0, 1, 2, 3}, 3);
  EXPECT_EQ(read_mesh(folder / "a.vtu").dimension, 3);
  for (const Index wrong : {4, -1}) {
    write({0, 1, wrong}, 2);
    EXPECT_THROW(read_mesh(folder / "a.vtu"), EnvironmentError) << wrong;
  }
}

TEST(VtkRead, FieldsOfAMeshAreReadByNodeAndByCell)
{
  const ScratchFolder folder;
  MeshData<2> data;
  data.nodes = {{0, 0}, {1, 0}, {0, 1}};
  data.cells = {{0, 1, 2}};
  write_mesh<2>(folder / "a.vtu", 0, Mesh<2>(data), std::vector<Column>{{"mass", 1, {1, 2, 3}, "kg"}},
                std::vector<Column>{{"size", 1, {0.5f}, "m^2"}});
  const StoredMeshFields read = read_mesh_fields(folder / "a.vtu");
  ASSERT_EQ(read.nodes.size(), 2u);
  EXPECT_THAT(read.nodes[0].values, ElementsAre(0, 0, 0, 1, 0, 0, 0, 1, 0));
  EXPECT_EQ(read.nodes[1].name, "mass");
  EXPECT_THAT(read.nodes[1].values, ElementsAre(1, 2, 3));
  ASSERT_EQ(read.cells.size(), 1u);
  EXPECT_EQ(read.cells[0].unit, "m^2");
  EXPECT_THAT(read.cells[0].values, ElementsAre(0.5));
}

}  // namespace

}  // namespace talus::vtk_read_test
