// Threads: how many a run takes, and that they do not spin for long.
#include "app/run/thread_choice.hpp"

#include <algorithm>

#include "core/parallel/threads.hpp"
#include "tests/app/program.hpp"

namespace talus::threads_test {
namespace {

TEST(Threads, OneMorePaysForEverySoManyParticles)
{
  EXPECT_EQ(threads_that_pay(0, 8), 1);
  EXPECT_EQ(threads_that_pay(2 * particles_of_a_thread - 1, 8), 1);
  EXPECT_EQ(threads_that_pay(2 * particles_of_a_thread, 8), 2);
  EXPECT_EQ(threads_that_pay(5 * particles_of_a_thread, 8), 5);
}

TEST(Threads, NeverMoreThanThereAre)
{
  EXPECT_EQ(threads_that_pay(1'000'000'000, 8), 8);
  EXPECT_EQ(threads_that_pay(1'000'000'000, 1), 1);
  EXPECT_EQ(threads_that_pay(1'000'000'000, 0), 1);
}

/// The numbers that a choice has after each of so many steps, which take as long as f(threads) says.
template <class F>
std::vector<int> kept_by(ThreadChoice choice, int steps, F&& f)
{
  std::vector<int> chosen;
  for (int step = 0; step < steps; ++step) {
    choice.took(f(choice.next(), step));
    chosen.push_back(choice.chosen());
  }
  return chosen;
}

TEST(ThreadChoice, KeepsTheNumberWithWhichStepsTakeTheLeastTime)
{
  const auto sooner_with_more = [](int threads, int) { return 1.0 / threads; };
  const auto sooner_with_fewer = [](int threads, int) { return 1.0 * threads; };
  EXPECT_EQ(kept_by(ThreadChoice(1, 1, 8), 1000, sooner_with_more).back(), 8);
  EXPECT_EQ(kept_by(ThreadChoice(8, 1, 8), 1000, sooner_with_fewer).back(), 1);
  EXPECT_EQ(kept_by(ThreadChoice(3, 1, 8), 1000, [](int threads, int) { return threads == 3 ? 0.95 : 1; }).back(), 3);
  EXPECT_EQ(kept_by(ThreadChoice(3, 3, 3), 1000, sooner_with_more).back(), 3);
}

TEST(ThreadChoice, FollowsWhatElseTheMachineDoes)
{
  const auto chosen = kept_by(ThreadChoice(1, 1, 2), 1500, [](int threads, int step) {
    return (step < 700) == (threads == 2) ? 1 : 1.5;  // free cores at first, busy ones later
  });
  EXPECT_EQ(chosen[600], 2);
  EXPECT_EQ(chosen[1400], 1);
}

TEST(ThreadChoice, TriesOthersOnlyNowAndThen)
{
  ThreadChoice choice(1, 1, 2);
  int others = 0;
  for (int step = 0; step < 10'000; ++step) {
    others += choice.next() == 2 ? 1 : 0;
    choice.took(choice.next());
  }
  EXPECT_GT(others, 0);
  EXPECT_LT(others, 200);
}

TEST(ThreadChoice, OneStepThatTakesLongDecidesNothing)
{
  const auto chosen = kept_by(ThreadChoice(1, 1, 2), 1000, [](int threads, int step) { return step % 7 == 0 ? 100.0 : threads; });
  EXPECT_EQ(*std::max_element(chosen.begin(), chosen.end()), 1);
}

class ThreadsOfRuns : public Program {
 protected:
  /// What OpenMP's library says of each time that it was loaded: "300000", "1000".
  std::vector<std::string> spins(const std::string& variables) const
  {
    const Outcome outcome = talus("info", "env -u OMP_WAIT_POLICY -u GOMP_SPINCOUNT OMP_DISPLAY_ENV=verbose " + variables);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const std::string name = "GOMP_SPINCOUNT = '";
    std::vector<std::string> found;
    for (std::size_t at = outcome.err.find(name); at != std::string::npos; at = outcome.err.find(name, at + 1))
      found.push_back(outcome.err.substr(at + name.size(), outcome.err.find('\'', at + name.size()) - at - name.size()));
    return found;
  }

  /// "3 threads" in the first line of a run, of which only one step is made.
  std::string threads_of(const std::string& cells, const std::string& rest = "", const std::string& words = "",
                         const std::string& variables = "-u OMP_NUM_THREADS") const
  {
    write("scene.yaml",
          "title: Block\ndimension: 2\nmesh: {grid: {low: [0, 0], high: [1, 1], cells: " + cells +
              "}}\ntime: {end: 1.0e-9}\n"
              "materials: [{name: rubber, law: neo_hookean, density: 1000, youngs_modulus: 1.0e5, poisson_ratio: 0.3}]\n"
              "bodies: [{name: block, material: rubber, shape: {type: box, low: [0, 0], high: [1, 1]}, particles_per_cell: 1}]\n" +
              rest);
    const Outcome outcome = talus("run scene.yaml --out run " + words, "env " + variables);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const std::string line = outcome.out.substr(0, outcome.out.find('\n'));
    return line.substr(line.rfind(", ") + 2);
  }
};

TEST_F(ThreadsOfRuns, WaitingOnesSleepSoon)
{
  const std::vector<std::string> found = spins("OMP_NUM_THREADS=2");
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found.back(), "1000");
}

TEST_F(ThreadsOfRuns, WaitAsTheUserSays)
{
  EXPECT_EQ(spins("OMP_NUM_THREADS=2 GOMP_SPINCOUNT=7"), std::vector<std::string>{"7"});
  const std::vector<std::string> active = spins("OMP_NUM_THREADS=2 OMP_WAIT_POLICY=active");
  ASSERT_EQ(active.size(), 1U);
  EXPECT_NE(active.front(), "0");
}

TEST_F(ThreadsOfRuns, SmallScenesTakeOneAndLargerOnesMore)
{
  EXPECT_EQ(threads_of("[4, 4]"), "1 thread");
  const int n = threads_that_pay(2 * 64 * 64, threads());
  EXPECT_EQ(threads_of("[64, 64]"), n == 1 ? "1 thread" : std::to_string(n) + " threads");
}

TEST_F(ThreadsOfRuns, NamedNumbersStay)
{
  EXPECT_EQ(threads_of("[4, 4]", "", "--threads 3"), "3 threads");
  EXPECT_EQ(threads_of("[4, 4]", "threads: 2\n"), "2 threads");
  EXPECT_EQ(threads_of("[4, 4]", "", "", "OMP_NUM_THREADS=2"), "2 threads");
}

}  // namespace
}  // namespace talus::threads_test
