// A disk that is full, a folder that is taken away: the run says so, what it has written is whole, and it goes on to the same bits.
#include <gmock/gmock.h>

#include "io/output/vtk.hpp"
#include "tests/app/program.hpp"
#include "tests/app/same_state.hpp"

namespace talus::full_disk_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::string bouncing(const std::string& end, const std::string& outputs)
{
  return block_scene("time: {end: " + end +
                     "}\nloads: [{type: gravity, acceleration: [0, -9.81]}]\nboundaries: [{type: roller, on: y_min}, {type: roller, on: "
                     "x_min}, {type: roller, on: x_max}]\noutputs: {" +
                     outputs + "}\n");
}

/// Every file can be read, to the last value.
void expect_whole(const fs::path& folder)
{
  for (const fs::path& file : files_in(folder, ".vtp"))
    EXPECT_EQ(read_particles(file).ids.size(), 96U) << file;
  for (const fs::path& file : files_in(folder, ".vtu"))
    EXPECT_FALSE(read_mesh_fields(file).nodes.empty()) << file;
  for (const fs::path& series : files_in(folder, ".pvd"))
    for (const auto& entry : read_pvd(series))
      EXPECT_TRUE(fs::exists(entry.second)) << entry.second;
  if (fs::exists(folder / "checkpoints"))
    for (const fs::path& file : files_in(folder / "checkpoints", ".h5"))
      expect_same_state(file, file);
}

/// What another run has written so far of `whole`: its beginning.
void expect_beginning(const HistoryTable& part, const HistoryTable& whole)
{
  ASSERT_LE(part.rows(), whole.rows());
  for (std::size_t c = 0; c < part.values.size(); ++c)
    EXPECT_TRUE(std::equal(part.values[c].begin(), part.values[c].end(), whole.values[c].begin())) << whole.columns[c].name;
}

class Disk : public Program {
 protected:
  static constexpr auto own_mounts =
      "unshare -rm setpriv --bounding-set=-dac_override,-dac_read_search";  // files that may not be written are not
  void SetUp() override
  {
    // Two checkpoints, so that not every disk is full when the third is due; long rows, so that some end in the midst of one.
    std::string points;
    for (const char* at : {"[0.5, 0]", "[1.5, 0]", "[0.5, 1]", "[1.5, 1]", "[1, 0.5]"})
      points += fmt::format("{}{{name: p{}, at: {}}}", points.empty() ? "" : ", ", points.size(), at);
    write("scene.yaml",
          bouncing("0.4", "checkpoint: {steps: 30}, particles: {every: 0.08}, mesh: {every: 0.1}, history: {every: 1.0e-3, points: [" +
                              points + "]}"));
    fs::create_directory(folder_ / "disk");
    if (shell("mount -t tmpfs none disk") != 0)
      GTEST_SKIP() << "no disk can be mounted here (unshare -rm): " << read("shell.txt");
  }
  /// A script in the scratch folder by one who may mount; its exit code.
  int shell(const std::string& script) const
  {
    write("script.sh", "cd '" + folder_.path().string() + "'\ntalus='" TALUS_BINARY "'\n" + script + "\n");
    const std::string command =
        fmt::format("{} sh '{}/script.sh' >'{}/shell.txt' 2>&1", own_mounts, folder_.path().string(), folder_.path().string());
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  void run_whole() const { ASSERT_EQ(talus("run scene.yaml --quiet --out whole --threads 1").code, 0); }
  /// Runs on a disk of that many pages until there is no more room, then with more room.  Which kind of file it was, empty if there was room.
  std::string fill(int pages) const
  {
    for (const char* folder : {"full", "again"})
      fs::remove_all(folder_ / folder);
    const int code =
        shell(fmt::format("mount -t tmpfs -o size={}k none disk || exit 99\n"
                          "\"$talus\" run scene.yaml --out disk/run --quiet --threads 1 2>said.txt\ncode=$?\n"
                          "cp -r disk/run full\nmount -o remount,size=64m disk || exit 99\n"
                          "\"$talus\" run --resume disk/run --quiet --threads 1 2>said_again.txt\necho $? >code_again.txt\n"
                          "cp -r disk/run again\nexit $code",
                          4 * pages));
    if (code == 0)
      return "";
    const std::string said = read("said.txt");
    EXPECT_EQ(code, 3) << said;
    expect_whole(folder_ / "full");
    EXPECT_TRUE(files_in(folder_ / "full", ".tmp").empty());
    if (exists("full/history.csv"))
      expect_beginning(history("full"), history("whole"));
    if (const auto written = files_in(folder_ / "full", ".vtp"); !written.empty()) {
      EXPECT_THAT(said, HasSubstr("last good output disk/run/particles_")) << pages;
    }
    const auto saved = exists("full/checkpoints") ? files_in(folder_ / "full/checkpoints", ".h5") : std::vector<fs::path>{};
    if (saved.empty()) {
      EXPECT_EQ(read("code_again.txt"), "3\n");
      EXPECT_THAT(read("said_again.txt"), HasSubstr("has no checkpoints"));
    } else {
      EXPECT_THAT(said, HasSubstr("last checkpoint disk/run/checkpoints/" + saved.back().filename().string()));
      EXPECT_EQ(read("code_again.txt"), "0\n") << read("said_again.txt");
      expect_same_results(folder_ / "whole", folder_ / "again");
    }
    const auto begin = said.find("cannot write disk/run/");
    EXPECT_NE(begin, std::string::npos) << said;
    const auto file = fs::path(said.substr(begin, said.find(':', begin) - begin));
    return (file.extension() == ".tmp" ? file.stem() : file).extension().string();
  }
};

TEST_F(Disk, ThatFillsUpEndsTheRunAndNothingIsLost)
{
  run_whole();
  for (const int pages : {75, 105}) {
    EXPECT_NE(fill(pages), "") << pages << " pages are enough";
    EXPECT_THAT(read("said.txt"), HasSubstr("warning: the disk of disk/run has ")) << "nobody was told before";
  }
}

/// One page more each time, until there is room.
TEST_F(Disk, FillsUpAtEveryFileNightly)
{
  run_whole();
  std::set<std::string> met;
  int pages = 40;
  for (bool refused = true; refused; ++pages) {  // what is refused before it begins
    shell(fmt::format("mount -t tmpfs -o size={}k none disk\n\"$talus\" run scene.yaml --out disk/run --quiet 2>said.txt", 4 * pages));
    refused = read("said.txt").find("take about") != std::string::npos && read("said.txt").find("warning") == std::string::npos;
  }
  const int first = pages;
  for (std::string file = fill(pages); !file.empty(); file = fill(++pages)) {
    met.insert(file);
    ASSERT_FALSE(HasFailure()) << pages << " pages";
  }
  std::printf("from %d to %d pages, full while writing", first, pages);
  for (const std::string& file : met)
    std::printf(" %s", file.c_str());
  std::printf("\n");
  EXPECT_THAT(met, testing::IsSupersetOf({".vtp", ".vtu", ".pvd", ".h5", ".csv"}));
}

TEST_F(Disk, WithoutRoomForOneOfEachIsRefusedBeforeTheFirstStep)
{
  EXPECT_EQ(shell("mount -t tmpfs -o size=96k none disk\n\"$talus\" run scene.yaml --out disk/run --quiet 2>said.txt\ncode=$?\n"
                  "ls -A disk >left.txt\nexit $code"),
            3);
  EXPECT_THAT(read("said.txt"), HasSubstr("error: the disk of disk/run has "));
  EXPECT_THAT(read("said.txt"), HasSubstr("one checkpoint and one file of each kind take about "));
  EXPECT_EQ(read("left.txt"), "") << "nothing is begun";
}

/// Whether there is room is known, and the first files of the new run are written, before anything of the earlier one goes.
TEST_F(Disk, ThatIsTooFullForARunKeepsTheResultsOfTheRunBefore)
{
  run_whole();
  for (const int left : {0, 4, 8, 16}) {
    EXPECT_EQ(shell(fmt::format(
                  "mount -t tmpfs -o size=4m none disk\n\"$talus\" run scene.yaml --out disk/run --quiet --threads 1 || exit 90\n"
                  "cp -a disk/run before; mkdir disk/run/mine; cp scene.yaml disk/run/mine/\n"
                  "free=$(df -k --output=avail disk | tail -1); fallocate -l $((free-{}))k disk/fill || exit 91\n"
                  "\"$talus\" run scene.yaml --out disk/run --quiet --threads 1 --set outputs.checkpoint.keep=3 2>said.txt; code=$?\n"
                  "cmp scene.yaml disk/run/mine/scene.yaml || exit 92; rm -r disk/run/mine\n"
                  "diff -r before disk/run >differ.txt || exit 93\nrm -r before\nexit $code",
                  left)),
              3)
        << left << read("shell.txt");
    EXPECT_THAT(read("said.txt"), HasSubstr("error: cannot ")) << left;
  }
}

/// Something happens to the folder of a run while the run stands still in the midst of it.
class TakenAway : public Disk {
 protected:
  void SetUp() override
  {
    Disk::SetUp();
    write("scene.yaml", bouncing("1", "checkpoint: {steps: 20}, particles: {every: 0.05}, mesh: {every: 0.2}, history: {every: 0.01}"));
  }
  /// Runs `script` then; the exit code of the run.
  int during(const std::string& script) const
  {
    return shell(
        "\"$talus\" run scene.yaml --out out --quiet --threads 1 2>said.txt & child=$!\n"
        "for i in $(seq 3000); do [ -e out/particles_0004.vtp ] && break; sleep 0.002; done; kill -STOP $child\n" +
        script + "\nkill -CONT $child; wait $child");
  }
};

TEST_F(TakenAway, AFolderThatMayNotBeWrittenAnyMoreEndsTheRunAndItGoesOn)
{
  run_whole();
  EXPECT_EQ(during("chmod a-w out out/checkpoints"), 3);
  EXPECT_THAT(read("said.txt"), testing::AllOf(HasSubstr("cannot write out/"), HasSubstr("; last good output out/particles_"),
                                               HasSubstr("; last checkpoint out/checkpoints/step_")));
  expect_whole(folder_ / "out");
  ASSERT_EQ(shell("chmod u+w out out/checkpoints; \"$talus\" run --resume out --quiet --threads 1"), 0) << read("shell.txt");
  expect_same_results(folder_ / "whole", folder_ / "out");
}

TEST_F(TakenAway, AFolderThatIsMovedEndsTheRunAndItGoesOnThere)
{
  run_whole();
  EXPECT_EQ(during("mv out moved"), 3);
  EXPECT_THAT(read("said.txt"), testing::ContainsRegex("out has gone while the run went on|cannot write out/"));
  EXPECT_FALSE(exists("out/summary.json")) << "made anew";
  expect_whole(folder_ / "moved");
  ASSERT_EQ(talus("run --resume moved --quiet --threads 1").code, 0) << read("err.txt");
  expect_same_results(folder_ / "whole", folder_ / "moved");
}

TEST_F(TakenAway, AFolderThatIsRemovedEndsTheRun)
{
  EXPECT_EQ(during("rm -r out"), 3);
  EXPECT_THAT(read("said.txt"), testing::ContainsRegex("out has gone while the run went on|cannot write out/"));
  EXPECT_FALSE(exists("out/summary.json")) << "made anew";
}

}  // namespace
}  // namespace talus::full_disk_test
