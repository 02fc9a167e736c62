// One rank alone: every call is the identity, and MPI is never started.  Several ranks: tests/ranks.
#include "core/parallel/communicator.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <stdexcept>

#include "core/error.hpp"

namespace talus::exchange_test {
namespace {

std::vector<std::byte> bytes_of(std::string_view text)
{
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

TEST(ExchangeAlone, IsOneRank)
{
  const Communicator exchange;
  EXPECT_EQ(exchange.rank(), 0);
  EXPECT_EQ(exchange.size(), 1);
  EXPECT_TRUE(exchange.alone());
  EXPECT_TRUE(exchange.is_root());
}

TEST(ExchangeAlone, ChangesNothing)
{
  Communicator exchange;
  std::vector<std::int64_t> numbers{1, -2};
  exchange.sum(numbers);
  EXPECT_THAT(numbers, testing::ElementsAre(1, -2));
  ExactSums<Real> mass;
  ExactSums<Vec<2>> push;
  mass.add(3);
  push.add({4, 5});
  exchange.sum(mass, push);
  EXPECT_EQ(mass.value(), 3);
  EXPECT_EQ(push.value(), Vec<2>(4, 5));

  EXPECT_EQ(exchange.min(2.5), 2.5);
  EXPECT_EQ(exchange.max(2.5), 2.5);
  EXPECT_EQ(exchange.min(std::int64_t{7}), 7);
  EXPECT_EQ(exchange.max(std::int64_t{7}), 7);
  std::vector<Real> least{1, -0.0};
  std::int64_t word = -7;
  exchange.least(least, word);
  EXPECT_EQ(word, -7);
  EXPECT_THAT(least, testing::ElementsAre(1, 0));
  EXPECT_TRUE(std::signbit(least[1]));

  std::string text = "what it was";
  exchange.broadcast(text, 0);
  EXPECT_EQ(text, "what it was");
  std::vector<std::byte> bytes = bytes_of("bytes");
  exchange.broadcast(bytes, 0);
  EXPECT_EQ(bytes, bytes_of("bytes"));
  EXPECT_THAT(exchange.gather(bytes), testing::ElementsAre(bytes));
  EXPECT_THAT(exchange.all_to_all({bytes}), testing::ElementsAre(bytes));
  exchange.barrier();
  EXPECT_EQ(exchange.traffic().messages, 0);
  EXPECT_EQ(exchange.traffic().bytes, 0);
}

TEST(ExchangeAlone, SendsToItself)
{
  Communicator exchange;
  std::vector<std::byte> sent = bytes_of("to myself"), got(sent.size());
  const Message out{0, sent}, in{0, got}, elsewhere{1, sent};
  PendingMessages talk;
  exchange.start({&out, 1}, {&in, 1}, 3, talk);
  talk.wait();
  EXPECT_EQ(got, sent);
  exchange.start({}, {}, 3, talk);
  talk.wait();
  EXPECT_THROW(exchange.start({&elsewhere, 1}, {&in, 1}, 3, talk), EnvironmentError);
  EXPECT_THROW(exchange.start({&out, 1}, {}, 3, talk), EnvironmentError);

  const std::array self{0}, other{1};
  EXPECT_THAT(exchange.neighbours(self, {sent}, 4), testing::ElementsAre(sent));
  EXPECT_THAT(exchange.neighbours({}, {}, 4), testing::IsEmpty());
  EXPECT_THROW(exchange.neighbours(other, {sent}, 4), EnvironmentError);
}

TEST(ExchangeAlone, LetsErrorsPass)
{
  Communicator exchange;
  EXPECT_NO_THROW(exchange.agree(nullptr));
  EXPECT_THROW(exchange.together([] { throw RunError("no"); }), RunError);
  EXPECT_THROW(exchange.agree(Communicator::caught([] { throw std::out_of_range("no"); })), std::out_of_range);
  int times = 0;
  exchange.together([&] { ++times; });
  EXPECT_EQ(times, 1);
}

TEST(ExchangeAloneDeathTest, AbortEndsTheProcess) { EXPECT_EXIT(Communicator().abort(3), testing::ExitedWithCode(3), ""); }

TEST(LaunchedAsRanks, LooksForALauncher)
{
  const std::array names{"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMI_RANK", "PMIX_RANK"};
  for (const char* name : names)
    if (std::getenv(name) != nullptr)
      GTEST_SKIP() << "this test was itself launched as ranks";
  setenv("SLURM_NTASKS", "4", 1);  // a job alone is no launcher
  EXPECT_FALSE(launched_as_ranks());
  unsetenv("SLURM_NTASKS");
  for (const char* name : names) {
    setenv(name, "0", 1);
    EXPECT_TRUE(launched_as_ranks()) << name;
    unsetenv(name);
  }
}

TEST(RanksAlone, AreNoneWithoutALauncher)
{
  if (launched_as_ranks())
    GTEST_SKIP() << "this test was itself launched as ranks";
  Ranks ranks;
  EXPECT_TRUE(world().alone());
  EXPECT_EQ(ranks.end(4), 4);
}

}  // namespace
}  // namespace talus::exchange_test
