// Arrays come back as the same bits or not at all: damaged anywhere, cut anywhere, asked for as something else, a full disk.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <functional>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "core/error.hpp"
#include "core/parallel/communicator.hpp"
#include "io/checkpoint/array_file.hpp"
#include "io/checkpoint/kept_arrays.hpp"
#include "io/files/atomic_file.hpp"
#include "tests/io/bytes.hpp"
#include "tests/io/checkpoint/small_array_file.hpp"
#include "tests/io/full_disk.hpp"
#include "tests/io/scratch_folder.hpp"

namespace talus::array_file_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string message_of(const std::function<void()>& action)
{
  try {
    action();
  } catch (const EnvironmentError& error) {
    return error.what();
  }
  return "accepted";
}

template <class T>
void expect_same_bits(const ScratchFolder& folder, const std::vector<T>& values)
{
  ArrayWriter writer(folder / "a.h5");
  writer.write<T>("values", values);
  writer.close();
  const ArrayReader reader(folder / "a.h5");
  const std::vector<T> read = reader.read<T>("values");
  ASSERT_EQ(read.size(), values.size());
  EXPECT_EQ(std::memcmp(read.data(), values.data(), values.size() * sizeof(T)), 0);
  std::vector<T> into(values.size(), T(7));
  reader.read_into<T>("values", into);
  EXPECT_EQ(std::memcmp(into.data(), values.data(), values.size() * sizeof(T)), 0);
}

TEST(ArrayFile, EveryTypeComesBackAsTheSameBits)
{
  const ScratchFolder folder;
  using D = std::numeric_limits<double>;
  using F = std::numeric_limits<float>;
  const auto nan_with = [](std::uint64_t payload) { return std::bit_cast<double>(0x7ff0000000000000U | payload); };
  expect_same_bits<double>(folder, {0.1, -0.0, 0.0, D::infinity(), -D::infinity(), D::denorm_min(), D::max(), D::quiet_NaN(),
                                    -D::quiet_NaN(), nan_with(1), nan_with(0x8000000012345U)});
  expect_same_bits<float>(
      folder, {0.1F, -0.0F, F::infinity(), F::denorm_min(), std::bit_cast<float>(0x7f800001U), std::bit_cast<float>(0xffc12345U)});
  expect_same_bits<std::int32_t>(folder, {0, -1, std::numeric_limits<std::int32_t>::min(), std::numeric_limits<std::int32_t>::max()});
  expect_same_bits<std::int64_t>(folder, {0, -1, std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max()});
  expect_same_bits<std::uint8_t>(folder, {0, 1, 127, 128, 255});
}

TEST(ArrayFile, ArraysOfManyPiecesComeBack)
{
  const ScratchFolder folder;
  std::vector<double> values(3 * 150'001);  // 3.6 MB, the last piece is not full
  std::iota(values.begin(), values.end(), 0.5);
  ArrayWriter writer(folder / "a.h5");
  writer.write<double>("x", values, 3, "m");
  writer.close();
  const ArrayReader reader(folder / "a.h5");
  EXPECT_EQ(reader.rows("x"), 150'001U);
  EXPECT_EQ(reader.read<double>("x", 3), values);
}

/// More digests than HDF5 keeps beside an array, of rows that do not lie one behind the other.
TEST(ArrayFile, AnArrayOfThousandsOfPiecesComesBackInAnyPart)
{
  struct Row {
    std::int32_t other;
    float values[2];
  };
  constexpr std::size_t n = 100'000;
  std::vector<Row> rows(n);
  std::vector<float> values;
  for (std::size_t i = 0; i < n; ++i) {
    rows[i] = {-1, {static_cast<float>(i), 0.5F}};
    values.insert(values.end(), {static_cast<float>(i), 0.5F});
  }
  const ScratchFolder folder;
  const auto write_rows = [&](const std::filesystem::path& file, const void* first, std::size_t stride) {
    const Slice all{0, n, 10, 7};
    const SharedArray array{"x", NumberKind::float32, 2, "m", static_cast<const std::byte*>(first), n, stride, all};
    write_arrays(one_rank(), file, std::span(&array, 1), [](ArrayWriter& rest) { rest.write("text", "words"); });
  };
  write_rows(folder / "a.h5", rows.data()->values, sizeof(Row));
  write_rows(folder / "b.h5", values.data(), 2 * sizeof(float));
  EXPECT_TRUE(bytes_of(folder / "a.h5") == bytes_of(folder / "b.h5"));
  const ArrayReader reader(folder / "a.h5");
  EXPECT_EQ(reader.text("text"), "words");
  EXPECT_EQ(reader.read<float>("x", 2), values);
  for (const std::size_t first : {0U, 2U, 3U, 4U, 13U, 50'000U, 99'999U}) {
    std::vector<float> some(2 * std::min<std::size_t>(25, n - first));
    reader.read_rows<float>("x", first, some, 2);
    EXPECT_TRUE(std::equal(some.begin(), some.end(), values.begin() + static_cast<std::ptrdiff_t>(2 * first))) << first;
  }
}

TEST(ArrayFile, EmptyArraysAndTextsAreThere)
{
  const ScratchFolder folder;
  ArrayWriter writer(folder / "a.h5");
  writer.write<double>("none", {}, 3, "m");
  writer.write<std::int32_t>("one column", {});
  writer.write("text", "");
  writer.close();
  const ArrayReader reader(folder / "a.h5");
  EXPECT_THAT(reader.names(""), ElementsAre("none", "one column", "text"));
  EXPECT_THAT(reader.read<double>("none", 3), IsEmpty());
  EXPECT_THAT(reader.read<std::int32_t>("one column"), IsEmpty());
  reader.read_into<double>("none", {}, 3);
  EXPECT_EQ(reader.rows("none"), 0U);
  EXPECT_EQ(reader.unit("none"), "m");
  EXPECT_EQ(reader.text("text"), "");
  EXPECT_THAT(message_of([&] { reader.read<double>("none", 2); }), HasSubstr("3 columns, not 2"));
}

TEST(ArrayFile, TextsAreAnyBytes)
{
  const ScratchFolder folder;
  std::string all;
  for (int c = 0; c < 256; ++c)
    all += static_cast<char>(c);
  const std::string zeros(5, '\0'), large(3 << 20, 'x');
  ArrayWriter writer(folder / "a.h5");
  writer.write("all", all);
  writer.write("zeros", zeros);
  writer.write("large", large);
  writer.close();
  const ArrayReader reader(folder / "a.h5");
  EXPECT_EQ(reader.text("all"), all);
  EXPECT_EQ(reader.text("zeros"), zeros);
  EXPECT_EQ(reader.text("large"), large);
}

TEST(ArrayFile, GroupsNamesAndUnits)
{
  const ScratchFolder folder;
  const std::vector<double> x{1, 2, 3, 4};
  ArrayWriter writer(folder / "a.h5");
  writer.write<double>("particles/soil/position", x, 2, "m");
  writer.write<double>("particles/soil/mass", x, 1, "kg");
  writer.write<double>("particles/soil/damage", x);
  writer.write("particles/about", "text");
  for (int i = 0; i < 40; ++i)  // HDF5 keeps many names otherwise than few
    writer.write<double>("many/" + std::to_string(i), x);
  writer.close();
  const ArrayReader reader(folder / "a.h5");
  EXPECT_THAT(reader.names(""), ElementsAre("many", "particles"));
  EXPECT_THAT(reader.names("particles"), ElementsAre("about", "soil"));
  EXPECT_THAT(reader.names("particles/soil"), ElementsAre("damage", "mass", "position"));
  const auto many = reader.names("many");
  EXPECT_EQ(many.size(), 40U);
  EXPECT_TRUE(std::is_sorted(many.begin(), many.end()));
  EXPECT_EQ(reader.unit("particles/soil/position"), "m");
  EXPECT_EQ(reader.unit("particles/soil/mass"), "kg");
  EXPECT_EQ(reader.unit("particles/soil/damage"), "");
  EXPECT_EQ(reader.rows("particles/soil/position"), 2U);
  EXPECT_TRUE(reader.has("particles"));
  EXPECT_TRUE(reader.has("particles/soil"));
  EXPECT_TRUE(reader.has("particles/soil/mass"));
  EXPECT_FALSE(reader.has("particles/soil/mass/deeper"));
  EXPECT_FALSE(reader.has("particles/rock/mass"));
  EXPECT_FALSE(reader.has("nothing"));
}

TEST(ArrayFile, WhatIsNotAsAskedForIsNamed)
{
  const ScratchFolder folder;
  const std::vector<double> x{1, 2, 3, 4, 5, 6};
  ArrayWriter writer(folder / "a.h5");
  writer.write<double>("group/x", x, 3);
  writer.write("text", "words");
  writer.close();
  const ArrayReader reader(folder / "a.h5");
  const auto names_it = [&](const std::string& path, const std::string& what) {
    return AllOf(HasSubstr((folder / "a.h5").string()), HasSubstr(path), HasSubstr(what));
  };
  EXPECT_THAT(message_of([&] { reader.read<float>("group/x", 3); }), names_it("group/x", "holds double, not float"));
  EXPECT_THAT(message_of([&] { reader.read<std::int64_t>("group/x", 3); }), names_it("group/x", "holds double, not int64"));
  EXPECT_THAT(message_of([&] { reader.read<double>("group/x", 2); }), names_it("group/x", "has 3 columns, not 2"));
  EXPECT_THAT(message_of([&] { reader.read<double>("group/x"); }), names_it("group/x", "has 3 columns, not 1"));
  EXPECT_THAT(message_of([&] { reader.read<double>("group/y"); }), names_it("group/y", "is not there"));
  EXPECT_THAT(message_of([&] { reader.read<double>("other/y"); }), names_it("other/y", "is not there"));
  EXPECT_THAT(message_of([&] { reader.read<double>("group"); }), names_it("group", "is a group"));
  EXPECT_THAT(message_of([&] { reader.read<std::uint8_t>("text"); }), names_it("text", "holds text, not uint8"));
  EXPECT_THAT(message_of([&] { reader.text("group/x"); }), names_it("group/x", "holds double, not text"));
  EXPECT_THAT(message_of([&] { reader.rows("text"); }), names_it("text", "holds text, not numbers"));
  EXPECT_THAT(message_of([&] { reader.names("text"); }), names_it("text", "is not a group"));
  EXPECT_THAT(message_of([&] { reader.names("other"); }), names_it("other", "is not there"));
  std::vector<double> three_rows(9);
  EXPECT_THAT(message_of([&] { reader.read_into<double>("group/x", three_rows, 3); }), names_it("group/x", "has 2 rows, not 3"));
}

TEST(ArrayFile, MistakesOfTheCallerAreTold)
{
  const ScratchFolder folder;
  const std::vector<double> x{1, 2, 3};
  ArrayWriter writer(folder / "a.h5");
  writer.write<double>("x", x);
  EXPECT_THROW(writer.write<double>("x", x), std::invalid_argument);
  EXPECT_THROW(writer.write("x", "text"), std::invalid_argument);
  EXPECT_THROW(writer.write<double>("y", x, 2), std::invalid_argument);
  EXPECT_THROW(writer.write<double>("y", x, 0), std::invalid_argument);
  for (const char* path : {"", "/y", "y/", "a//y", "./y"})
    EXPECT_THROW(writer.write<double>(path, x), std::invalid_argument) << path;
  writer.close();
  EXPECT_THROW(writer.write<double>("z", x), std::invalid_argument);
  EXPECT_THAT(ArrayReader(folder / "a.h5").names(""), ElementsAre("x"));
}

TEST(ArrayFile, FileThatIsNoneIsRefused)
{
  const ScratchFolder folder;
  const auto message = [&] { return message_of([&] { const ArrayReader reader(folder / "a.h5"); }); };
  EXPECT_THAT(message(), AllOf(HasSubstr((folder / "a.h5").string()), HasSubstr("it does not exist")));
  write(folder / "a.h5", "");
  EXPECT_THAT(message(), HasSubstr("is not an HDF5 file"));
  write(folder / "a.h5", std::string(5000, 'x'));
  EXPECT_THAT(message(), HasSubstr("is not an HDF5 file"));
  EXPECT_THAT(message_of([&] { const ArrayReader reader(folder.path()); }), HasSubstr(folder.path().string()));
  EXPECT_THAT(message_of([&] { const ArrayWriter writer(folder / "no/a.h5"); }),
              AllOf(HasSubstr((folder / "no/a.h5").string()), HasSubstr("No such file")));
}

TEST(ArrayFile, SameCallsMakeTheSameBytes)
{
  const ScratchFolder folder;
  write_small(folder / "a.h5");
  write_small(folder / "b.h5");
  EXPECT_EQ(bytes_of(folder / "a.h5"), bytes_of(folder / "b.h5"));
}

TEST(ArrayFile, ArraysThatWereKeptMakeTheSameBytes)
{
  const ScratchFolder folder;
  write_small(folder / "at_once.h5");
  KeptArrays kept;
  write_small_to(kept);
  for (const char* const name : {"kept.h5", "again.h5"}) {
    ArrayWriter writer(folder / name);
    kept.write_to(writer);
    writer.close();
    EXPECT_TRUE(read_whole(folder / name) == read_whole(folder / "at_once.h5")) << name;
  }
}

TEST(ArrayFile, SeveralFilesAreOpenAtOnce)
{
  const ScratchFolder folder;
  write_small(folder / "a.h5");
  const ArrayReader one(folder / "a.h5"), two(folder / "a.h5");
  write_small(folder / "b.h5");
  EXPECT_EQ(one.text("scene"), two.text("scene"));
}

TEST(ArrayFile, FullDiskIsAnEnvironmentErrorThatNamesTheFile)
{
  const ScratchFolder folder;
  const std::vector<double> large(400'000, 1.5);
  const auto write_all = [&](const std::filesystem::path& file) {
    ArrayWriter writer(file);
    writer.write<double>("large", large);
    writer.write("text", "small");
    writer.close();
  };
  write_all(folder / "a.h5");
  const auto size = static_cast<rlim_t>(std::filesystem::file_size(folder / "a.h5"));
  std::filesystem::remove(folder / "a.h5");
  for (const rlim_t limit : {rlim_t{0}, rlim_t{50}, rlim_t{1000}, size / 2, size - 2000, size - 1}) {
    const FullDisk full(limit);
    EXPECT_THAT(message_of([&] { write_all(folder / "a.h5"); }),
                AllOf(HasSubstr("cannot write " + (folder / "a.h5").string()), HasSubstr("File too large")))
        << limit << " of " << size;
    EXPECT_THAT(message_of([&] { write_whole(folder / "b.h5", write_all); }), HasSubstr("cannot write"));
    EXPECT_FALSE(std::filesystem::exists(folder / "b.h5"));
  }
  write_all(folder / "a.h5");  // what failed before is not in the way
  EXPECT_EQ(ArrayReader(folder / "a.h5").read<double>("large"), large);
}

}  // namespace
}  // namespace talus::array_file_test
