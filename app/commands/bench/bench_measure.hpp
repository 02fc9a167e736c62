#pragma once
// Time of whole steps: some steps to warm up, then repeats of equally many.
#include <chrono>
#include <ctime>
#include <utility>

#include "app/commands/bench/bench_block.hpp"

namespace talus {

struct BenchPlan {
  Index particles{};  ///< about as many
  int warm_up{}, repeats{}, steps{};
  int all_steps() const noexcept { return warm_up + repeats * steps; }
};

/// Median, least and most of some values.
Measured measured(std::vector<Real> values);

/// Times between marks -> medians of the repeats.
class Laps {
 public:
  using Totals = std::vector<std::pair<std::string_view, Real>>;  ///< seconds of each phase so far
  explicit Laps(const BenchPlan& plan) : plan_(plan) {}
  /// To be called after every step.
  void step_done(Real particle_steps, const Totals& phases);
  /// Times of the result and of its phases, whose last one is the rest.
  void fill(BenchResult& result) const;

 private:
  using Clock = std::chrono::steady_clock;
  struct Mark {
    Clock::time_point time;
    std::clock_t cpu;  ///< of all threads
    Real particle_steps;
    Totals phases;
  };
  BenchPlan plan_;
  int steps_ = 0;
  std::vector<Mark> marks_;
};

/// The phases of a step, in order: the only place of the bench that names them.
Laps::Totals phases_of(const Timings& timings);

/// Runs one setting.  RunError if it does not stay sound.
BenchResult measure(const BenchSetting& setting, const BenchPlan& plan);

/// What memory has to bring and take for a step at least, per particle [B]: each column in use and the history once in, all that a step
/// changes once out, sums and motion of the nodes once in and once out.
template <int D>
Real bytes_moved(const RunView<D>& view);

}  // namespace talus
