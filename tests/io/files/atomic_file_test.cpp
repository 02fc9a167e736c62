// A file is there as a whole or as it was before.
#include "io/files/atomic_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "core/error.hpp"
#include "tests/io/full_disk.hpp"
#include "tests/io/scratch_folder.hpp"

namespace talus::whole_file_test {
namespace {

std::vector<std::string> names(const ScratchFolder& folder)
{
  std::vector<std::string> found;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    found.push_back(entry.path().filename().string());
  return found;
}

TEST(WholeFile, ReadsBackEveryByteAndMakesItsFolder)
{
  const ScratchFolder folder;
  const std::string text("a\0b\r\n\xff", 6);
  write_whole(folder / "new/deep/file", text);
  EXPECT_EQ(read_whole(folder / "new/deep/file"), text);
}

TEST(WholeFile, FailureLeavesTheOldFileAndNoTemporary)
{
  const ScratchFolder folder;
  write_whole(folder / "file", "old");
  {
    const FullDisk full(1000);
    EXPECT_THROW(write_whole(folder / "file", std::string(5000, 'x')), EnvironmentError);
  }
  EXPECT_THROW(write_whole(folder / "file",
                           [](const auto& path) {
                             std::ofstream(path) << "half";
                             throw RunError("stop");
                           }),
               RunError);
  EXPECT_EQ(read_whole(folder / "file"), "old");
  EXPECT_THAT(names(folder), testing::ElementsAre("file"));
}

TEST(WholeFile, MissingFileIsNamed)
{
  const ScratchFolder folder;
  try {
    read_whole(folder / "nothing");
    FAIL() << "read a file that is not there";
  } catch (const EnvironmentError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr((folder / "nothing").string()));
  }
}

}  // namespace
}  // namespace talus::whole_file_test
