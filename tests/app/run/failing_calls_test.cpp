// A call of the system that fails, at any place of a run: it ends with a message, every file is whole, and the resumed run is bitwise identical.
#include <gmock/gmock.h>

#include "tests/app/program.hpp"
#include "tests/app/same_state.hpp"

namespace talus::failing_calls_test {

namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class FailingCalls : public Program {
 protected:
  void SetUp() override
  {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "the sanitizer wants to be the first library";
#endif
    write("scene.yaml", block_scene("loads: [{type: gravity, acceleration: [0, -9.81]}]\nboundaries: [{type: fixed, on: y_min}]\n"
                                    "time: {end: 0.02, max_step: 2.0e-3}\n"
                                    "outputs: {particles: {every: 0.01}, mesh: {every: 0.01}, history: {every: 0.005}, "
                                    "checkpoint: {steps: 4, at_end: true}}\n"));
    ASSERT_EQ(talus(command("whole")).code, 0) << read("err.txt");
  }
  static std::string command(const std::string& out) { return "run scene.yaml --quiet --threads 1 --out " + out; }
  /// With the n-th call of that kind failing.
  Outcome failing(const std::string& kind, long at, const std::string& words, const std::string& how = "") const
  {
    return talus(
        words, fmt::format("FAILING_KIND={} FAILING_AT={} FAILING_COUNT=count.txt {} LD_PRELOAD='{}'", kind, at, how, TALUS_FAILING_CALLS));
  }
  long count(const std::string& kind) const
  {
    fs::remove_all(folder_ / "counted");
    EXPECT_EQ(failing(kind, -1, command("counted")).code, 0) << read("err.txt");
    return std::stol(read("count.txt"));
  }
  /// All files there are as those of the whole run, or a beginning of them.
  void expect_whole(const fs::path& folder) const
  {
    for (const auto& entry : fs::directory_iterator(folder)) {
      const fs::path name = entry.path().filename();
      // A library that ends the program leaves what is of the moment, and what was being written.
      if (!entry.is_regular_file() || name == "summary.json" || name == "progress.json" || name.extension() == ".tmp")
        continue;
      const std::string here = read_whole(entry.path()), all = read("whole/" + name.string());
      if (name == "history.csv" || name.extension() == ".pvd")
        EXPECT_TRUE(all.starts_with(here) || name.extension() == ".pvd") << name;
      else
        EXPECT_TRUE(here == all) << name << " is not whole";
    }
  }
  /// It goes on, or begins anew where there is no checkpoint yet, and comes to the same.
  void expect_goes_on() const
  {
    const bool resumes = exists("out/checkpoints") && !files_in(folder_ / "out/checkpoints", ".h5").empty();
    const Outcome on = talus(resumes ? "run --resume out --quiet --threads 1" : command("out"));
    ASSERT_EQ(on.code, 0) << on.err;
    expect_same_results(folder_ / "whole", folder_ / "out");
  }
  /// Of a run into a folder with finished results.  Returns whether the failure mattered.
  bool try_one(const std::string& kind, long at, const std::string& how = "")
  {
    SCOPED_TRACE(fmt::format("{} {} {}", kind, at, how));
    fs::remove_all(folder_ / "out");
    const Outcome outcome = failing(kind, at, command("out"), how);
    if (outcome.code == 0) {
      expect_same_results(folder_ / "whole", folder_ / "out");
      return false;
    }
    EXPECT_EQ(outcome.code, 3) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("error: "));
    if (kind != "malloc") {
      EXPECT_THAT(outcome.err, testing::ContainsRegex("out|standard output"));
    }
    if (exists("out"))
      expect_whole(folder_ / "out");
    expect_goes_on();
    return true;
  }
  /// `tries` of all calls of a kind, evenly spread.
  void try_some(const std::string& kind, long tries, const std::string& how = "")
  {
    const long all = count(kind);
    ASSERT_GT(all, 3) << kind;
    long mattered = 0;
    for (long k = 0; k < std::min(tries, all) && !HasFatalFailure(); ++k)
      mattered += try_one(kind, all <= tries ? k : k * (all - 1) / (tries - 1), how) ? 1 : 0;
    EXPECT_GT(mattered, 0) << "none of the failures was noticed";
    std::printf("%s: %ld calls, %ld of %ld failures ended the run\n", kind.c_str(), all, mattered, std::min(tries, all));
  }
};

TEST_F(FailingCalls, OfTheDiskEndWithWordsAndTheRunGoesOn)
{
  for (const char* kind : {"write", "fsync", "rename"})
    try_some(kind, 2);
}

TEST_F(FailingCalls, OfTheMemoryEndWithWordsAndTheRunGoesOn) { try_some("malloc", 5); }

TEST_F(FailingCalls, OfTheDiskAtEveryPlaceNightly)
{
  for (const char* kind : {"write", "fsync", "rename"})
    for (const char* how : {"", "FAILING_ON=1"})
      try_some(kind, 1'000, how);
}

TEST_F(FailingCalls, OfTheMemoryAtManyPlacesNightly)
{
  for (const char* how : {"", "FAILING_ON=1"})
    try_some("malloc", 400, how);
}

/// Earlier results and files of the user, and a scene that lies among them: a run that is killed at a call that changes the folder loses none.
class KilledWhileReplacing : public FailingCalls {
 protected:
  void try_some_kills(long tries)
  {
    ASSERT_EQ(talus(command("before")).code, 0);
    for (const char* name : {"before/notes.txt", "before/pictures/holiday.png"}) {
      fs::create_directories((folder_ / name).parent_path());
      write(name, "mine");
    }
    const std::string scene = read("scene.yaml") + "# mine\n";
    write("before/scene.yaml", scene);
    const std::string again = "run out/scene.yaml --quiet --threads 1 --out out --force";
    const auto begin = [&] {
      fs::remove_all(folder_ / "out");
      fs::copy(folder_ / "before", folder_ / "out", fs::copy_options::recursive);
    };
    begin();
    ASSERT_EQ(failing("io", -1, again).code, 0) << read("err.txt");
    const long all = std::stol(read("count.txt"));
    for (long k = 0; k < std::min(tries, all) && !HasFailure(); ++k) {
      const long at = all <= tries ? k : k * (all - 1) / (tries - 1);
      SCOPED_TRACE(at);
      begin();
      EXPECT_NE(failing("io", at, again, "FAILING_KILL=1").code, 0);
      EXPECT_EQ(read("out/notes.txt"), "mine");
      EXPECT_EQ(read("out/pictures/holiday.png"), "mine");
      ASSERT_EQ(read("out/scene.yaml"), scene);
      ASSERT_EQ(talus(again).code, 0) << read("err.txt");
      EXPECT_EQ(read("out/scene.yaml"), scene);
      for (const char* name : {"history.csv", "mesh.msh"})
        EXPECT_TRUE(read("out/" + std::string(name)) == read("whole/" + std::string(name))) << name;
      EXPECT_TRUE(files_in(folder_ / "out", ".tmp").empty());
    }
  }
};

TEST_F(KilledWhileReplacing, LosesNoFileOfTheUser) { try_some_kills(5); }
TEST_F(KilledWhileReplacing, LosesNoFileOfTheUserAtAnyPlaceNightly) { try_some_kills(10'000); }

}  // namespace
}  // namespace talus::failing_calls_test
