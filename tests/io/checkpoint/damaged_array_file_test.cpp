// A damaged file of arrays is refused, or reads as the sound one.
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

template <class T>
void append(std::string& to, const std::vector<T>& values)
{
  to.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

/// All that can be read from it, as bytes.
std::string content(const std::filesystem::path& file)
{
  const ArrayReader reader(file);
  std::string all = reader.text("scene");
  for (const char* group : {"", "many", "soil"})
    for (const std::string& name : reader.names(group))
      all += name + ' ';
  append(all, reader.read<double>("soil/x", 3));
  append(all, reader.read<std::int32_t>("soil/cell"));
  append(all, reader.read<std::int64_t>("soil/id"));
  append(all, reader.read<float>("soil/old"));
  append(all, reader.read<std::uint8_t>("soil/on"));
  append(all, reader.read<double>("soil/none", 3));
  for (int i = 0; i < 9; ++i)
    append(all, reader.read<double>("many/" + std::to_string(i)));
  for (const char* path : {"soil/x", "soil/old", "soil/id"})
    all += reader.unit(path) + std::to_string(reader.rows(path)) + ' ';
  all += reader.has("soil/x") && reader.has("many/8") && !reader.has("many/9") ? "there" : "not there";
  return all;
}

/// How often a damaged file was refused; one that reads otherwise than the sound one fails the test.
struct Damage {
  explicit Damage(const ScratchFolder& folder) : file(folder / "damaged.h5")
  {
    write_small(folder / "sound.h5");
    bytes = bytes_of(folder / "sound.h5");
    sound = content(folder / "sound.h5");
  }
  void check(const std::string& damaged, const std::string& how)
  {
    std::filesystem::remove(file);  // a file that is written over waits for the disk
    write(file, damaged);
    try {
      ASSERT_EQ(content(file), sound) << how;
      ++same;
    } catch (const EnvironmentError& error) {
      EXPECT_THAT(error.what(), HasSubstr(file.string())) << how;
      ++refused;
    }
  }
  std::filesystem::path file;
  std::string bytes, sound;
  int same = 0, refused = 0;
};

void flip_every_byte(const std::function<std::vector<int>(std::size_t)>& masks_of)
{
  const ScratchFolder folder;
  Damage damage(folder);
  for (std::size_t i = 0; i < damage.bytes.size(); ++i) {
    for (const int mask : masks_of(i)) {
      std::string damaged = damage.bytes;
      damaged[i] = static_cast<char>(static_cast<unsigned char>(damaged[i]) ^ mask);
      damage.check(damaged, "byte " + std::to_string(i) + " flipped with " + std::to_string(mask));
    }
  }
  EXPECT_GT(damage.refused, damage.same);  // bytes between the arrays are nobody's
}

TEST(DamagedArrayFile, NoFlippedByteChangesAValue)
{
  flip_every_byte([](std::size_t i) { return std::vector<int>{1 << (i % 8)}; });
}

TEST(DamagedArrayFile, NoFlippedByteChangesAValueNightly)
{
  flip_every_byte([](std::size_t) { return std::vector<int>{0x01, 0x02, 0x04, 0x08, 0x10, 0x20, 0x40, 0x80, 0xff}; });
}

TEST(DamagedArrayFile, FileCutAnywhereIsRefused)
{
  const ScratchFolder folder;
  Damage damage(folder);
  for (std::size_t size = 0; size < damage.bytes.size(); size += 7)
    damage.check(damage.bytes.substr(0, size), "cut to " + std::to_string(size));
  damage.check(damage.bytes.substr(0, damage.bytes.size() - 1), "cut by one");
  EXPECT_EQ(damage.same, 0);
}

TEST(DamagedArrayFile, LostAndErasedBlocksChangeNoValue)
{
  const ScratchFolder folder;
  Damage damage(folder);
  for (const char fill : {'\0', '\xff'})
    for (std::size_t length = 16; length <= 512; length *= 2)
      for (std::size_t i = 0; i < damage.bytes.size(); i += length) {
        std::string damaged = damage.bytes;
        const std::size_t n = std::min(length, damaged.size() - i);
        damaged.replace(i, n, n, fill);
        damage.check(damaged, std::to_string(n) + " bytes lost at " + std::to_string(i));
      }
  EXPECT_GT(damage.refused, 0);
}

TEST(DamagedArrayFile, ZerosInPlaceOfMinusOnesAreNoticed)
{
  const ScratchFolder folder;
  const std::vector<std::int32_t> cells{5, 6, -1, -1, -1, -1, 7};  // the checksum of HDF5 is the same with zeros for -1
  ArrayWriter writer(folder / "a.h5");
  writer.write<std::int32_t>("cells", cells);
  writer.close();
  std::string bytes = bytes_of(folder / "a.h5");
  const auto at = bytes.find(std::string(16, '\xff') + std::string("\7\0\0\0", 4));
  ASSERT_NE(at, std::string::npos);
  bytes.replace(at, 16, 16, '\0');
  write(folder / "a.h5", bytes);
  EXPECT_THAT(message_of([&] { ArrayReader(folder / "a.h5").read<std::int32_t>("cells"); }),
              AllOf(HasSubstr("cells is damaged"), HasSubstr("digest")));
}

}  // namespace
}  // namespace talus::array_file_test
