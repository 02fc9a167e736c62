// The list of what Talus wrote: what it proves, and what it does not.
#include "io/files/manifest.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "core/error.hpp"
#include "io/files/atomic_file.hpp"
#include "io/files/result_files.hpp"
#include "io/output/csv.hpp"
#include "tests/io/full_disk.hpp"
#include "tests/io/scratch_folder.hpp"

namespace talus::manifest_test {
namespace {

namespace fs = std::filesystem;

class List : public testing::Test {
 protected:
  void SetUp() override { begin_manifest(folder_.path()); }
  bool proves(const std::string& name) const { return Manifest::of(folder_.path())->proves(name); }
  void user_writes(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }
  /// Another time of modification, as a copy or an edit has.
  void touch(const std::string& name) const
  {
    fs::last_write_time(folder_ / name, fs::file_time_type::clock::now() - std::chrono::hours(1));
  }
  ScratchFolder folder_;
};

TEST_F(List, ProvesWhatWasWrittenAndNothingElse)
{
  write_whole(folder_ / "summary.json", "one");
  write_whole(folder_ / "notes.txt", "of another program of the user");
  write_whole(folder_ / "pictures/a.png", "drawn");
  user_writes("mesh.msh", "mine");
  EXPECT_TRUE(proves("summary.json"));
  EXPECT_TRUE(proves("pictures/a.png"));
  EXPECT_FALSE(proves("notes.txt")) << "no result has this name";
  EXPECT_FALSE(proves("mesh.msh"));
  EXPECT_FALSE(proves("history.csv")) << "it is not there";
  EXPECT_THAT(Manifest::of(folder_.path())->names(), testing::ElementsAre("pictures/a.png", "summary.json"));
}

TEST_F(List, KnowsACopyByItsBytesAndAnEditByThem)
{
  write_whole(folder_ / "summary.json", "0123456789");
  touch("summary.json");
  EXPECT_TRUE(proves("summary.json"));
  user_writes("summary.json", "0123456780");
  touch("summary.json");
  EXPECT_FALSE(proves("summary.json")) << "of the same length";
  write_whole(folder_ / "mesh.vtu", std::string(200'000, 'x'));
  std::string other(200'000, 'x');
  other[131'072] = 'y';
  user_writes("mesh.vtu", other);
  touch("mesh.vtu");
  EXPECT_FALSE(proves("mesh.vtu"));
}

TEST_F(List, ALinkOrAFolderIsNeverProved)
{
  write_whole(folder_ / "summary.json", "0123456789");
  fs::rename(folder_ / "summary.json", folder_ / "elsewhere");
  fs::create_symlink("elsewhere", folder_ / "summary.json");
  EXPECT_FALSE(proves("summary.json"));
  fs::remove(folder_ / "summary.json");
  fs::create_directory(folder_ / "summary.json");
  EXPECT_FALSE(proves("summary.json"));
}

/// A run that is killed between the line and the file, or before the next version is there, leaves nothing unknown.
TEST_F(List, EveryVersionThatWasNotedIsProved)
{
  write_whole(folder_ / "summary.json", "first");
  user_writes("next", "second");
  note_result(folder_ / "summary.json", folder_ / "next");
  touch("summary.json");
  EXPECT_TRUE(proves("summary.json")) << "the file is still the first";
  fs::rename(folder_ / "next", folder_ / "summary.json");
  EXPECT_TRUE(proves("summary.json"));
}

TEST_F(List, ATableMayGrowByRowsOfNumbersUntilItIsDone)
{
  HistoryFile history(folder_ / "history.csv", {{"time", "s"}, {"a"}});
  history.append(std::array{0.0, -1.5e-300});
  history.append(std::array{0.1, std::numeric_limits<Real>::infinity()});
  EXPECT_TRUE(proves("history.csv")) << "as after a kill";
  std::ofstream(folder_ / "history.csv", std::ios::app) << "0.2,note\n";
  EXPECT_FALSE(proves("history.csv"));
  const HistoryFile again = HistoryFile::resume(folder_ / "rows.csv", {{"time", "s"}}, 0);  // no result: nothing is noted
  EXPECT_FALSE(proves("rows.csv"));
  user_writes("history.csv", "time [s],a\n0,1\n");
  EXPECT_TRUE(proves("history.csv"));
  note_result(folder_ / "history.csv", folder_ / "history.csv");
  std::ofstream(folder_ / "history.csv", std::ios::app) << "9,9\n";
  EXPECT_FALSE(proves("history.csv")) << "it grows no more";
}

TEST_F(List, LinesThatAreCutShortOrMakeNoSenseProveNothing)
{
  write_whole(folder_ / "summary.json", "x");
  write_whole(folder_ / "mesh.vtu", "y");
  const fs::path list = folder_ / ".talus/files.txt";
  const std::string text = read_whole(list);
  std::ofstream(list) << "w\nw 12 \nz 0 0 0 summary.json\nw zz 1 1 summary.json\nw 1 -1 1 summary.json\nw 1 1 1 ../x\n"
                      << text.substr(0, text.size() - 4);
  EXPECT_TRUE(proves("summary.json"));
  EXPECT_FALSE(proves("mesh.vtu"));
  write_whole(folder_ / "mesh.msh", "z");
  EXPECT_TRUE(proves("mesh.msh")) << "behind a line that was cut short";
}

TEST_F(List, WhatTalusDidNotWriteIsSetAside)
{
  user_writes("summary.json", "mine");
  write_whole(folder_ / "summary.json", "theirs");
  user_writes("summary.json", "mine again");
  write_whole(folder_ / "summary.json", "theirs");
  EXPECT_EQ(read_whole(folder_ / "summary.json.aside"), "mine");
  EXPECT_EQ(read_whole(folder_ / "summary.json.aside.2"), "mine again");
  write_whole(folder_ / "summary.json", "theirs at last");
  EXPECT_FALSE(fs::exists(folder_ / "summary.json.aside.3"));
  user_writes("notes.txt", "mine");
  write_whole(folder_ / "notes.txt", "told to");
  EXPECT_FALSE(fs::exists(folder_ / "notes.txt.aside")) << "no result has this name";
}

TEST_F(List, ThatCannotBeWrittenNamesTheFileAndLeavesTheOldOne)
{
  write_whole(folder_ / "summary.json", "old");
  const std::string before = read_whole(folder_ / ".talus/files.txt");
  {
    const FullDisk full(before.size() + 10);
    try {
      write_whole(folder_ / "summary.json", "new");
      FAIL();
    } catch (const EnvironmentError& e) {
      EXPECT_THAT(e.what(), testing::HasSubstr((folder_ / "summary.json").string()));
    }
  }
  EXPECT_EQ(read_whole(folder_ / "summary.json"), "old");
  write_whole(folder_ / "summary.json", "new");
  EXPECT_TRUE(proves("summary.json"));
}

TEST(ResultFiles, NamesOfRunsAndOfResults)
{
  for (const char* name : {"history.csv", "particles_0001.vtp", "mesh_12.vtu", "checkpoints/step_000000001.h5", "maps/speed_max.tif",
                           "maps/thickness_0001.tif", "sections/axis.csv"})
    EXPECT_TRUE(is_written_by_runs(name)) << name;
  for (const char* name : {"history_backup.csv", "particles_a.vtp", "checkpoints/mine.h5", "maps/x.tif", "pictures/a.png", "report.html",
                           "sections/notes.txt", "checkpoints", "a/history.csv"})
    EXPECT_FALSE(is_written_by_runs(name)) << name;
  for (const char* name : {"report.html", "progress.json", "pictures/a.png", "history.csv"})
    EXPECT_TRUE(is_result(name)) << name;
  for (const char* name : {"pictures", "notes.txt", "a/report.html", "../history.csv"})
    EXPECT_FALSE(is_result(name)) << name;
}

}  // namespace
}  // namespace talus::manifest_test
