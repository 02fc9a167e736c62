// talus watch: what it says of a run that is at work, and of one that has ended; what its page answers.
#include <gmock/gmock.h>

#include <algorithm>
#include <thread>

#include "app/commands/watch/watch_pages.hpp"
#include "app/observers/results.hpp"
#include "io/output/progress_json.hpp"
#include "io/output/vtk.hpp"
#include "tests/app/program.hpp"

namespace talus::follow_test {

namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

class Follow : public Program {
 protected:
  void SetUp() override
  {
    write("page.html", "<html>\n<!--TALUS-RUN-->\n</html>\n");
    write("block.yaml", block_scene("time: {end: 0.02}\nloads: [{type: gravity, acceleration: [0, -10]}]\n"
                                    "outputs: {particles: {every: 0.01}, history: {every: 0.01}}\n"));
    ASSERT_EQ(talus("run block.yaml --quiet --out out").code, 0);
  }
  /// As if the run had not ended.
  void open_again() const
  {
    std::string summary = read("out/summary.json");
    const std::string done = R"("status": "done",)";
    summary.replace(summary.find(done), done.size(), R"("status": "failed", "message": "the run did not end",)");
    write("out/summary.json", summary);
    write_progress(folder_ / "out/progress.json",
                   {.done = 0.01, .total = 0.02, .done_before = 0, .time = 0.01, .dt = 1e-4, .step = 123, .stage = "run", .elapsed = 60});
  }
};

TEST_F(Follow, ARunThatHasEndedIsToldWithWhatItReturned)
{
  const Outcome done = talus("watch out");
  EXPECT_EQ(done.code, 0) << done.err;
  EXPECT_THAT(done.out, ContainsRegex("^Block\ndone +t = 0.02 s\n"));
  EXPECT_THAT(done.out, ContainsRegex("\nenergy \\[J\\] +kinetic [0-9.]+, .*gravity_work [0-9.]+.*; defect [0-9.e-]+ of the largest\n"));
  EXPECT_THAT(done.out, ContainsRegex("\nframes +[34], the last particles_000[23].vtp at t = 0.02 s\n"));
  EXPECT_THAT(done.out, Not(HasSubstr("\033"))) << "no terminal, no cursor";

  const Outcome stopped = talus("run block.yaml --quiet --out stopped --until 2");
  ASSERT_EQ(stopped.code, 4);
  EXPECT_EQ(talus("watch stopped").code, 4);
  ASSERT_EQ(talus("run block.yaml --quiet --out failed --set watch.speed=1e-6").code, 1);
  const Outcome failed = talus("watch failed --once");
  EXPECT_EQ(failed.code, 1);
  EXPECT_THAT(failed.out, ContainsRegex("\nfailed .*\n +step [0-9]+, t = .* beyond watch.speed"));
  EXPECT_EQ(talus("watch nowhere").code, 2);
  EXPECT_EQ(talus("watch nowhere").err, "error: nowhere holds no results of a run (no summary.json)\n");
}

TEST_F(Follow, WhatCannotBeReadIsLeftOutAndNamed)
{
  const auto frames = read_pvd(folder_ / "out/particles.pvd");
  const std::string last = frames.back().second.filename().string();
  std::string text = read("out/" + last);
  const auto damage = [&](const std::string& word, const std::string& other) {
    std::string damaged = text;
    ASSERT_NE(damaged.find(word), std::string::npos) << word;
    write("out/" + last, damaged.replace(damaged.find(word), word.size(), other));
  };
  damage("NumberOfPoints=\"", "NumberOfPoints=\"-");
  EXPECT_THAT(talus("report out --page page.html").out, HasSubstr("is left out: cannot read out/" + last + ": it is damaged"));
  damage("NumberOfComponents=\"3\"", "NumberOfComponents=\"2147483648\"");
  const Outcome report = talus("report out --page page.html");
  EXPECT_EQ(report.code, 0) << report.err;
  EXPECT_THAT(report.out, HasSubstr("is left out: cannot read out/" + last));
  write("out/mesh.vtu", "no mesh");
  write("out/particles.pvd", read("out/particles.pvd").substr(0, 150));
  const Outcome without = talus("report out --page page.html");
  EXPECT_EQ(without.code, 0) << without.err;
  EXPECT_THAT(without.out, HasSubstr("mesh: it is left out: cannot read out/mesh.vtu"));
  EXPECT_THAT(without.out, HasSubstr("all particles are left out: out/particles.pvd"));
  EXPECT_THAT(talus("watch out --once").out, HasSubstr("\nleft out           out/particles.pvd"));
}

TEST_F(Follow, PicturesLeaveOutFramesThatCannotBeReadAndNameThem)
{
  const auto frames = read_pvd(folder_ / "out/particles.pvd");
  const auto damage = [&](std::size_t frame) {
    std::string text = read("out/" + frames[frame].second.filename().string());
    const std::string word = "NumberOfPoints=\"";
    write("out/" + frames[frame].second.filename().string(), text.insert(text.find(word) + word.size(), "-"));
  };
  damage(0);
  const Outcome all = talus("render out --frames all --range whole --size 320x240");
  EXPECT_EQ(all.code, 0) << all.err;
  EXPECT_EQ(std::count(all.out.begin(), all.out.end(), '\n'), std::ssize(frames) - 1) << all.out;
  EXPECT_THAT(all.err,
              ContainsRegex("^warning: the frame at t = 0 s is left out: cannot read out/particles_0000.vtp: it is damaged[^\n]*\n$"));
  for (std::size_t frame = 1; frame < frames.size(); ++frame)
    damage(frame);
  const Outcome none = talus("render out");
  EXPECT_EQ(none.code, 3);
  EXPECT_THAT(none.err, HasSubstr("particles_000"));
  EXPECT_THAT(none.err, Not(HasSubstr("OpenGL")));
}

TEST_F(Follow, ARunAtWorkSaysHowFarItIs)
{
  open_again();
  EXPECT_THAT(talus("watch out --once").out, HasSubstr("\nkilled")) << "nobody has the folder";
  EXPECT_EQ(talus("watch out --once").code, 1);
  const FolderLock lock(folder_ / "out");
  const Outcome outcome = talus("watch out --once");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(
      outcome.out,
      ContainsRegex("\nat work +\\[####################                    \\] 50 %  t = 0.01 s, 0.01 of 0.02 s done, 1:00 left\n"));
  EXPECT_THAT(outcome.out, ContainsRegex("\n +step 123, dt = 0.0001 s, .* stage \"run\", at it for 1:00\n"));
}

TEST_F(Follow, EndsWhenTheRunDoes)
{
  const std::string end = read("out/summary.json");
  open_again();
  std::optional<FolderLock> lock(folder_ / "out");
  std::thread run([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(600));
    write("out/summary.json", end);
    lock.reset();
  });
  const Outcome outcome = talus("watch out --interval 0.1 --page page.html");
  run.join();
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(
      outcome.out,
      ContainsRegex("^page: http://127.0.0.1:[0-9]+/\nat work   50 %  t = 0.01 s  step 123 .*  1:00 left  [34] frames\nBlock\ndone "))
      << "one line as long as nothing changes, then all of it";
}

TEST_F(Follow, ARunIsFollowedInTheTerminalWhereThePageWasNotBuilt)
{
  const std::string end = read("out/summary.json");
  open_again();
  std::filesystem::copy_file(TALUS_BINARY, folder_ / "bare");  // no report.html beside it
  std::optional<FolderLock> lock(folder_ / "out");
  std::thread run([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(600));
    write("out/summary.json", end);
    lock.reset();
  });
  const Outcome outcome = talus("", "sh -c './bare watch out --interval 0.1'");
  run.join();
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("note: no page for the browser: the page was left out when this program was built"));
  EXPECT_THAT(outcome.out, HasSubstr("\ndone "));
}

TEST_F(Follow, ThePageAnswersForTheRunAndNothingElseOfTheDisk)
{
  open_again();
  const FolderLock lock(folder_ / "out");
  std::filesystem::create_directory(folder_ / "out/pictures");
  write("out/pictures/velocity_0001.png", "a picture");
  write("out/secret.png", "a secret");
  std::filesystem::create_symlink(folder_ / "out/secret.png", folder_ / "out/pictures/link.png");
  std::mutex readers;
  WatchPages pages(folder_ / "out", folder_ / "page.html", 2, readers);
  const auto stamp = *pages.answer("/stamp")->body;
  const auto page = pages.answer("/");
  ASSERT_TRUE(page);
  EXPECT_EQ(page->type, "text/html; charset=utf-8");
  EXPECT_THAT(*page->body, HasSubstr(R"("live":{"interval":2.0})"));
  EXPECT_THAT(*page->body, HasSubstr(R"("summary":null)"));
  EXPECT_EQ(*pages.answer("/stamp")->body, stamp);
  EXPECT_EQ(pages.answer("/")->body, page->body) << "not made again";
  EXPECT_EQ(*pages.answer("/pictures/velocity_0001.png")->body, "a picture");
  for (const char* path :
       {"/pictures/link.png", "/pictures/../secret.png", "/pictures/..%2fsecret.png", "/pictures/none.png", "/pictures/.png", "/pictures/",
        "/summary.json", "/pictures/velocity_0001.png/", "//", "/pictures//velocity_0001.png"})
    EXPECT_FALSE(pages.answer(path)) << path;
}

}  // namespace

}  // namespace talus::follow_test
