// Memory that is there, as the files of a system tell it, and what is refused for want of it.
#include "io/system/memory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <fstream>

#include "tests/io/scratch_folder.hpp"

namespace talus::memory_test {
namespace {

class Memory : public testing::Test {
 protected:
  ScratchFolder root_;

  void write(const std::string& name, const std::string& text) const
  {
    std::filesystem::create_directories((root_ / name).parent_path());
    std::ofstream(root_ / name) << text;
  }
  Real available() const { return available_memory(root_.path()); }
};

constexpr auto meminfo = "MemTotal:       16000000 kB\nMemFree:         1000000 kB\nMemAvailable:    8000000 kB\n";

TEST_F(Memory, IsWithoutEndWhereNobodyTells) { EXPECT_EQ(available(), std::numeric_limits<Real>::infinity()); }

TEST_F(Memory, IsWhatTheMachineCanSpare)
{
  write("proc/meminfo", meminfo);
  EXPECT_EQ(available(), 8e6 * 1024);
}

TEST_F(Memory, IsWhatTheNarrowestGroupAllows)
{
  write("proc/meminfo", meminfo);
  write("proc/self/cgroup", "0::/batch/job\n");
  write("sys/fs/cgroup/batch/job/memory.max", "max\n");
  EXPECT_EQ(available(), 8e6 * 1024) << "no limit";
  write("sys/fs/cgroup/batch/memory.max", "3000000000\n");
  write("sys/fs/cgroup/batch/memory.current", "2000000000\n");
  EXPECT_EQ(available(), 1e9);
  write("sys/fs/cgroup/batch/memory.stat", "anon 1500000000\ninactive_file 500000000\n");
  EXPECT_EQ(available(), 1.5e9) << "files that are only remembered";
  write("sys/fs/cgroup/batch/job/memory.max", "100000000\n");
  EXPECT_EQ(available(), 1e8);
  write("sys/fs/cgroup/batch/job/memory.current", "200000000\n");
  EXPECT_EQ(available(), 0) << "more than allowed";
}

TEST_F(Memory, KnowsGroupsOfTheFirstVersion)
{
  write("proc/self/cgroup", "5:devices:/job\n4:memory:/job\n0::/\n");
  write("sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n");
  write("sys/fs/cgroup/memory/job/memory.limit_in_bytes", "5000\n");
  write("sys/fs/cgroup/memory/job/memory.usage_in_bytes", "3000\n");
  EXPECT_EQ(available(), 2000);
}

TEST_F(Memory, IsWhatTheLimitOfAddressesLeaves)
{
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_AS, &before), 0);
  rlimit narrow = before;
  narrow.rlim_cur = std::min<rlim_t>(before.rlim_max, rlim_t{1} << 50);
  ASSERT_EQ(::setrlimit(RLIMIT_AS, &narrow), 0);
  write("proc/self/statm", "1000 1 1 1 0 1 0\n");
  const Real left = available();
  ASSERT_EQ(::setrlimit(RLIMIT_AS, &before), 0);
  EXPECT_EQ(left, static_cast<Real>(narrow.rlim_cur) - 1000.0 * static_cast<Real>(::sysconf(_SC_PAGESIZE)));
}

TEST(TooMany, NamesWhatIsNeededAndWhatIsThere)
{
  EXPECT_EQ(too_many(1000, "cells", 100), "");
  EXPECT_THAT(too_many(1e15, "cells", 100),
              testing::MatchesRegex("asks for 1e\\+15 cells, which need at least 1e\\+08 GB of memory; .* GB are there"));
}

}  // namespace
}  // namespace talus::memory_test
