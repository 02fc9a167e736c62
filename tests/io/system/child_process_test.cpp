#include "io/system/child_process.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <optional>
#include <thread>

#include "io/files/atomic_file.hpp"
#include "tests/io/scratch_folder.hpp"

namespace talus::child_process_test {

namespace {

class Child : public testing::Test {
 protected:
  ScratchFolder folder_;
  int log_ = ::open((folder_ / "log").c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
  ~Child() override { ::close(log_); }
  ChildProcess shell(const std::string& script) const { return ChildProcess({"sh", "-c", script}, log_); }
};

TEST_F(Child, LeavesItsCodeAndWhatItSaid)
{
  ChildProcess child = shell("echo one; echo two >&2; exit 7");
  EXPECT_EQ(child.wait(), 7);
  EXPECT_EQ(child.wait(), 7) << "as often as one asks";
  EXPECT_EQ(read_whole(folder_ / "log"), "one\ntwo\n");
}

TEST_F(Child, RunsBesideThisProgramUntilItIsToldToEnd)
{
  ChildProcess child = shell("trap 'exit 4' TERM; echo ready; while :; do sleep 0.01; done");
  EXPECT_FALSE(child.ended());
  while (read_whole(folder_ / "log").empty())
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  child.ask_to_end();
  EXPECT_EQ(child.wait(), 4);
}

TEST_F(Child, TellsSignalsAndProgramsThatAreNotThere)
{
  EXPECT_EQ(shell("kill -KILL $$").wait(), ChildProcess::of_signal + SIGKILL);
  EXPECT_EQ(ChildProcess({"no_such_program_anywhere"}, log_).wait(), ChildProcess::not_started);
}

TEST_F(Child, IsToldToEndByWhoLetsGoOfIt)
{
  const auto begun = std::chrono::steady_clock::now();
  {
    std::optional<ChildProcess> saved;
    saved = shell("sleep 100");
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(50));
}

}  // namespace

}  // namespace talus::child_process_test
