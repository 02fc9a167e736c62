#include "io/system/child_process.hpp"

#include <gtest/gtest.h>

#include <csignal>

namespace talus::child_process_test {

namespace {

TEST(ChildProcess, LeavesItsCodeAndWhatItSaid)
{
  const Ending ending = run_to_its_end({"sh", "-c", "echo one; echo two >&2; exit 7"});
  EXPECT_EQ(ending.code, 7);
  EXPECT_EQ(ending.output, "one\ntwo\n");
}

TEST(ChildProcess, TellsSignalsAndProgramsThatAreNotThere)
{
  EXPECT_EQ(run_to_its_end({"sh", "-c", "kill -KILL $$"}).code, Ending::of_signal + SIGKILL);
  EXPECT_EQ(run_to_its_end({"no_such_program_anywhere"}).code, Ending::not_started);
}

}  // namespace

}  // namespace talus::child_process_test
