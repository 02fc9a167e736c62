// What passes between ranks, for any number of them.  A test that leaves early on one rank makes the others wait: EXPECT, not ASSERT.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <new>
#include <random>
#include <stdexcept>
#include <typeinfo>

#include "core/error.hpp"
#include "core/parallel/communicator.hpp"

namespace talus::exchange_ranks_test {
namespace {

/// Bytes that tell who has sent them, to whom and how many.
std::vector<std::byte> letter(int from, int to, std::size_t length)
{
  std::vector<std::byte> bytes(length);
  for (std::size_t i = 0; i < length; ++i)
    bytes[i] = static_cast<std::byte>(from * 31 + to * 7 + static_cast<int>(i));
  return bytes;
}
std::size_t length_of(int from, int to) { return static_cast<std::size_t>(from == to ? 0 : 8 * (10 * from + to)); }

class World : public testing::Test {
 protected:
  void SetUp() override { exchange.barrier(); }
  void TearDown() override { exchange.cut_messages(std::size_t{1} << 30); }
  Communicator& exchange = world();
  const int rank = exchange.rank(), size = exchange.size();
};

TEST_F(World, IsWhatTheLauncherStarted)
{
  if (const char* launched = std::getenv("OMPI_COMM_WORLD_SIZE")) {
    EXPECT_EQ(size, std::atoi(launched));
    EXPECT_EQ(rank, std::atoi(std::getenv("OMPI_COMM_WORLD_RANK")));
  }
  EXPECT_EQ(exchange.alone(), size == 1);
  EXPECT_EQ(exchange.is_root(), rank == 0);
}

TEST_F(World, SumsIntegers)
{
  for (const std::size_t piece : {std::size_t{1} << 30, std::size_t{24}}) {
    exchange.cut_messages(piece);
    std::vector<std::int64_t> numbers{1, rank, -5, std::int64_t{1} << 60, 0, 3, 4};
    exchange.sum(numbers);
    EXPECT_THAT(numbers,
                testing::ElementsAre(size, size * (size - 1) / 2, -5 * size, size * (std::int64_t{1} << 60), 0, 3 * size, 4 * size));
  }
}

struct Sums {
  Real mass = 0;
  Vec<2> push = Vec<2>::Zero();
};

TEST_F(World, SumsExactly)
{
  std::mt19937_64 random(1);  // the same on every rank
  ExactSums<Sums> all, mine;
  ExactSums<Real> count;
  for (int i = 0; i < 10000; ++i) {
    const auto number = [&] { return std::ldexp(static_cast<Real>(random()) - 9e18, static_cast<int>(random() % 400) - 200); };
    const Sums one{number(), {number(), number()}};
    all.add(one);
    if (static_cast<int>(random() % static_cast<unsigned>(size)) == rank) {
      mine.add(one);
      count.add(1);
    }
  }
  exchange.sum(mine, count);
  EXPECT_EQ(mine.value().mass, all.value().mass);
  EXPECT_EQ(mine.value().push, all.value().push);
  EXPECT_EQ(count.value(), 10000);
  mine.add({rank == 0 ? std::numeric_limits<Real>::infinity() : 0, {0, 0}});
  exchange.sum(mine);
  EXPECT_TRUE(std::isinf(mine.value().mass));
}

/// Again and again, each time with numbers of another size: small, large, none, beyond all that was there before.
TEST_F(World, SumsExactlyWhatDigitsAreInUse)
{
  Digits digits;
  for (const int exponent : {0, 0, 1, -40, -40, 300, 0, -1000, 0}) {
    std::mt19937_64 random(2);  // the same on every rank
    std::vector<ExactSums<Real>> all(3), mine(3);
    ExactSums<Vec<2>> none;
    for (int i = 0; i < 300; ++i) {
      const Real size_of_one = std::ldexp(1.0, exponent - 63 + static_cast<int>(random() % 30));
      const Real number = size_of_one * (static_cast<Real>(random()) - 9e18);
      const std::size_t k = random() % 3;
      all[k].add(number);
      if (i % size == rank)
        mine[k].add(number);
    }
    const std::int64_t before = exchange.traffic().bytes_to_all;
    exchange.sum(digits, std::span(mine), none);
    const std::int64_t sent = exchange.traffic().bytes_to_all - before;
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(mine[k].value(), all[k].value()) << exponent;
    EXPECT_EQ(none.value(), Vec<2>::Zero());
    if (exponent == 1 && size > 1) {
      EXPECT_LT(sent, 200) << "of 5 sums of 560 bytes";
    }
  }
  ExactSums<Real> endless;
  endless.add(rank == size - 1 ? std::numeric_limits<Real>::infinity() : 1);
  Digits other;
  for (int again = 0; again < 2; ++again) {
    ExactSums<Real> sum = endless;
    exchange.sum(other, sum);
    EXPECT_TRUE(std::isinf(sum.value()));
  }
}

TEST_F(World, FindsTheLeast)
{
  EXPECT_EQ(exchange.min(static_cast<Real>(rank) - 1), -1);
  EXPECT_EQ(exchange.max(static_cast<Real>(rank) - 1), size - 2);
  EXPECT_EQ(exchange.min(std::int64_t{5} - rank), 6 - size);
  EXPECT_EQ(exchange.max(std::int64_t{5} - rank), 5);
  const bool last = rank == size - 1;
  constexpr Real infinity = std::numeric_limits<Real>::infinity();
  std::vector<Real> numbers{last ? -0.0 : 0.0, last ? std::nan("") : -infinity, last ? infinity : 3.0, 1e-310 * (rank + 1)};
  std::int64_t word = 3 - rank;
  exchange.least(numbers, word);
  EXPECT_EQ(word, 4 - size);
  EXPECT_TRUE(std::signbit(numbers[0]));
  EXPECT_TRUE(std::isnan(numbers[1]));
  EXPECT_EQ(numbers[2], size == 1 ? infinity : 3.0);
  EXPECT_EQ(numbers[3], 1e-310);
}

TEST_F(World, Broadcasts)
{
  for (const std::size_t piece : {std::size_t{1} << 30, std::size_t{10}})
    for (int from = 0; from < size; ++from) {
      exchange.cut_messages(piece);
      std::string text = rank == from ? "a text of rank " + std::to_string(from) : "something longer that goes away";
      exchange.broadcast(text, from);
      EXPECT_EQ(text, "a text of rank " + std::to_string(from));
      std::vector<std::byte> bytes = rank == from ? letter(from, 1, 20) : letter(1, 1, 3);
      exchange.broadcast(bytes, from);
      EXPECT_EQ(bytes, letter(from, 1, 20));
      text = rank == from ? "" : "old";
      exchange.broadcast(text, from);
      EXPECT_EQ(text, "");
    }
  if (size > 1) {
    std::string text;
    EXPECT_THROW(exchange.broadcast(text, size), EnvironmentError);
  }
}

TEST_F(World, GathersOnTheRoot)
{
  for (const std::size_t piece : {std::size_t{1} << 30, std::size_t{16}}) {
    exchange.cut_messages(piece);
    const auto all = exchange.gather(letter(rank, 0, length_of(rank, 5)));
    EXPECT_EQ(all.size(), rank == 0 ? static_cast<std::size_t>(size) : 0);
    for (int r = 0; r < static_cast<int>(all.size()); ++r)
      EXPECT_EQ(all[static_cast<std::size_t>(r)], letter(r, 0, length_of(r, 5)));
  }
}

TEST_F(World, GivesEveryRankItsOwn)
{
  for (const std::size_t piece : {std::size_t{1} << 30, std::size_t{16}}) {
    exchange.cut_messages(piece);
    std::vector<std::vector<std::byte>> out;
    for (int r = 0; r < size; ++r)
      out.push_back(letter(rank, r, length_of(rank, r)));
    const auto in = exchange.all_to_all(out);
    EXPECT_EQ(in.size(), static_cast<std::size_t>(size));
    for (int r = 0; r < static_cast<int>(in.size()); ++r)
      EXPECT_EQ(in[static_cast<std::size_t>(r)], letter(r, rank, length_of(r, rank)));
  }
}

/// Messages to and from every other rank.
struct Post {
  Post(int rank, int size, int kind)
  {
    for (int r = 0; r < size; ++r)
      if (r != rank) {
        others.push_back(r);
        sent.push_back(letter(rank + kind, r, length_of(rank, r)));
        got.emplace_back(length_of(r, rank));
        wanted.push_back(letter(r + kind, rank, length_of(r, rank)));
      }
    for (std::size_t i = 0; i < others.size(); ++i) {
      out.push_back({others[i], sent[i]});
      in.push_back({others[i], got[i]});
    }
  }
  std::vector<int> others;
  std::vector<std::vector<std::byte>> sent, got, wanted;
  std::vector<Message> out, in;
};

TEST_F(World, KindsOfMessagesDoNotMix)
{
  PendingMessages first_talk, second_talk;
  for (const std::size_t piece : {std::size_t{1} << 30, std::size_t{16}}) {
    exchange.cut_messages(piece);
    for (int step = 0; step < 50; ++step) {
      Post first(rank, size, 2 * step), second(rank, size, 2 * step + 1);
      Post third(rank, size, 99);
      const auto start_first = [&] { exchange.start(first.out, first.in, 1, first_talk); };
      const auto start_second = [&] { exchange.start(second.out, second.in, 2, second_talk); };
      if ((rank + step) % 2 == 0) {
        start_first();
        start_second();
      } else {
        start_second();
        start_first();
      }
      EXPECT_EQ(exchange.neighbours(third.others, third.sent, 3), third.wanted);
      EXPECT_EQ(exchange.min(std::int64_t{rank}), 0);
      second_talk.wait();
      EXPECT_EQ(second.got, second.wanted);
      first_talk.wait();
      first_talk.wait();
      EXPECT_EQ(first.got, first.wanted);
    }
  }
}

TEST_F(World, LongMessagesArriveWhole)
{
  if (size == 1)
    return;
  const int right = (rank + 1) % size, left = (rank + size - 1) % size;
  std::vector<std::byte> sent = letter(rank, right, 1000000), got(sent.size());
  const Message out{right, sent}, in{left, got};
  PendingMessages talk;
  exchange.start({&out, 1}, {&in, 1}, 0, talk);
  PendingMessages moved = std::move(talk);
  moved.wait();
  EXPECT_EQ(got, letter(left, rank, 1000000));
}

TEST_F(World, AWrongLengthIsTold)
{
  if (size == 1)
    return;
  std::vector<std::byte> sent(12), got(16);
  const int other = rank ^ 1;
  if (other < size) {
    const Message out{other, sent}, in{other, got};
    PendingMessages talk;
    exchange.start({&out, 1}, {&in, 1}, 0, talk);
    try {
      talk.wait();
      ADD_FAILURE() << "nothing was thrown";
    } catch (const EnvironmentError& e) {
      EXPECT_EQ(e.what(), "a message from rank " + std::to_string(other) + " has 12 bytes where 16 were expected");
    }
  }
}

TEST_F(World, CountsWhatItSends)
{
  const Traffic before = exchange.traffic();
  Post post(rank, size, 0);
  PendingMessages talk;
  exchange.start(post.out, post.in, 0, talk);
  talk.wait();
  std::vector<std::int64_t> numbers(5);
  exchange.sum(numbers);
  std::int64_t bytes = 0, messages = 0;
  for (const Message& parcel : post.out) {
    bytes += static_cast<std::int64_t>(parcel.bytes.size());
    messages += parcel.bytes.empty() ? 0 : 1;
  }
  EXPECT_EQ(exchange.traffic().bytes - before.bytes, bytes);
  EXPECT_EQ(exchange.traffic().messages - before.messages, messages);
  EXPECT_EQ(exchange.traffic().calls - before.calls, size > 1 ? 1 : 0);
  EXPECT_EQ(exchange.traffic().bytes_to_all - before.bytes_to_all, size > 1 ? 40 : 0);
}

/// The message of the exception, of just that type, that comes out of agree() when the ranks from `first` on have one.
template <class E>
std::string agreed(Communicator& exchange, int first, const E& error)
{
  try {
    exchange.agree(Communicator::caught([&] {
      if (exchange.rank() >= first)
        throw error;
    }));
  } catch (const std::exception& e) {
    return typeid(e) == typeid(E) ? e.what() : "another type: " + std::string(e.what());
  }
  return "nothing";
}

TEST_F(World, AgreesOnTheErrorOfTheLowestRank)
{
  for (int first = 0; first < size; ++first) {
    const std::string text = "of rank " + std::to_string(std::max(rank, first)), wanted = "of rank " + std::to_string(first);
    EXPECT_EQ(agreed(exchange, first, RunError(text)), wanted);
    EXPECT_EQ(agreed(exchange, first, Stopped(text)), wanted);
    EXPECT_EQ(agreed(exchange, first, EnvironmentError(text)), wanted);
    EXPECT_EQ(agreed(exchange, first, Error(text)), wanted);
    EXPECT_EQ(agreed(exchange, first, std::runtime_error(text)), wanted);
    EXPECT_EQ(agreed(exchange, first, std::bad_alloc()), std::bad_alloc().what());
    const auto wrong = [](const std::string& what) {
      return SceneErrors({{{"b.yaml", 3, 4, "a.b"}, what, "a: {b: 1}\n"}, {{"a.yaml", 0, 0, ""}, "12 34", ""}});
    };
    EXPECT_EQ(agreed(exchange, first, wrong(text)), wrong(wanted).what());
  }
  EXPECT_EQ(agreed(exchange, size, RunError("never")), "nothing");
}

TEST_F(World, ActsTogetherOnTheRoot)
{
  int times = 0;
  exchange.together([&] { ++times; });
  EXPECT_EQ(times, rank == 0 ? 1 : 0);
  EXPECT_THROW(exchange.together([] { throw Stopped("here"); }), Stopped);
  if (rank == 0)
    EXPECT_THROW(exchange.together([] { throw 3; }), int);
  else
    EXPECT_THROW(exchange.together([] {}), std::runtime_error);
}

}  // namespace
}  // namespace talus::exchange_ranks_test
