// A very long run: memory, energy, momentum and files stay what they were.
#include <algorithm>
#include <numeric>

#include "tests/app/program.hpp"
#include "tests/app/same_state.hpp"

namespace talus::soak_test {
namespace {

using Soak = Program;

std::vector<int> numbers_in(const std::string& text)
{
  std::istringstream lines(text);
  return {std::istream_iterator<int>(lines), {}};
}

/// A free bar that swings lengthwise for ever.  Its ends never leave their cells and its motion is small, so the step is a linear map, the
/// leapfrog of an undamped spring: its energy swings about its mean by about a hundredth and drifts by round-off alone.
TEST_F(Soak, AMillionStepsChangeNothingNightly)
{
  write("scene.yaml", R"yaml(title: Soak
dimension: 2
kernel: linear
transfer: {scheme: tpic}
mesh: {grid: {low: [0, 0], high: [12, 1], cells: [12, 1]}}
time: {end: 20000, max_step: 0.02}
materials: [{name: rubber, law: linear_first_piola, density: 1, youngs_modulus: 100, poisson_ratio: 0}]
bodies:
  - {name: bar, material: rubber, shape: {type: box, low: [1.5, 0], high: [10.5, 1]}, particles_per_cell: 3,
     velocity: ["1.0e-3 * cos(pi * (x - 1.5) / 9)", "0"]}
boundaries: [{type: roller, on: y_min}, {type: roller, on: y_max}]
outputs:
  checkpoint: {steps: 10000, keep: 3}
  particles: {every: 200}
  mesh: {every: 1000}
  history: {every: 2}
)yaml");
  const Outcome outcome = talus("info >info.txt; '" TALUS_BINARY
                                "' run scene.yaml --quiet --out out --threads 2 & child=$!; "
                                "while kill -0 $child 2>no.txt; do sed -n 's/VmRSS: *//p' /proc/$child/status | tr -d kB; sleep 0.5; done "
                                ">memory.txt; wait $child");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const HistoryTable table = history("out");
  EXPECT_EQ(last(table, "step"), 1e6);

  // Resident [kB], twice a second.
  const std::vector<int> memory = numbers_in(read("memory.txt"));
  const std::size_t tenth = memory.size() / 10;
  ASSERT_GE(tenth, 1U) << "too fast to be watched";
  constexpr int allowed = 2000;  // [kB]; names of files are remembered, 6 kB each while a checkpoint is written
  EXPECT_LT(memory[memory.size() - 2], memory[tenth] + allowed);

  const auto kinetic = *table["kinetic"], strain = *table["strain"], momentum = *table["momentum_x"], centre = *table["centre_x"];
  std::vector<Real> energy(table.rows());
  std::transform(kinetic.begin(), kinetic.end(), strain.begin(), energy.begin(), std::plus<>());
  const auto mean = [&](std::size_t begin, std::size_t end) {
    return std::accumulate(energy.begin() + static_cast<std::ptrdiff_t>(begin), energy.begin() + static_cast<std::ptrdiff_t>(end), 0.0) /
           static_cast<Real>(end - begin);
  };
  const std::size_t rows = energy.size(), part = rows / 10;
  const Real before = mean(0, part), after = mean(rows - part, rows);
  // A thousand samples of the swing, wherever in it they fall.
  EXPECT_NEAR(after, before, 1e-3 * before);
  for (const Real e : energy)
    ASSERT_NEAR(e, before, 0.02 * before);
  // m |v| of the start is 5.7e-3 kg m/s; a sum of a million round-offs of it.
  for (std::size_t r = 0; r < rows; ++r) {
    ASSERT_LT(std::abs(momentum[r]), 1e-13);
    ASSERT_NEAR(centre[r], 6, 1e-11);
  }
  EXPECT_EQ(files_in(folder_ / "out/checkpoints", ".h5").size(), 3U);
  std::printf(
      "memory %d kB after a tenth, %d kB at the end; mean energy %.3g -> %.3g J, %+.1e; momentum %.1e kg m/s, centre %.1e m at most\n",
      memory[tenth], memory[memory.size() - 2], before, after, after / before - 1, *std::max_element(momentum.begin(), momentum.end()),
      *std::max_element(centre.begin(), centre.end()) - 6);
}

}  // namespace
}  // namespace talus::soak_test
