// The triad of STREAM (McCalpin 1995), and independent chains of multiply-adds.
#include "app/commands/bench/bench_machine.hpp"

#include <chrono>
#include <fstream>
#include <memory>

#include "core/parallel/threads.hpp"
#include "core/simd.hpp"

namespace talus {

namespace {

constexpr int least_passes = 5;
constexpr Real least_seconds = 0.3;                             // a machine that others use as well has good and bad moments
constexpr Index triad_block = 1 << 12, triad_blocks = 1 << 12;  // arrays of 134 MB, several times the largest caches

template <class F>
Real shortest_pass(F&& pass)
{
  Real shortest = std::numeric_limits<Real>::infinity(), all = 0;
  for (int i = 0; i < least_passes || all < least_seconds; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    pass();
    const Real seconds = std::chrono::duration<Real>(std::chrono::steady_clock::now() - begin).count();
    shortest = std::min(shortest, seconds);
    all += seconds;
  }
  return shortest;
}

/// Bytes are counted as STREAM does: two arrays read, one written; that a cache may read what it is about to write is not counted.
Real triad_bandwidth()
{
  constexpr std::size_t n = std::size_t{triad_block} * triad_blocks;
  const auto array = [] { return std::unique_ptr<Real[]>(new Real[n]); };  // not touched: its pages go to the threads that use them
  const auto a = array(), b = array(), c = array();
  const auto in_blocks = [&](auto&& f) {
    parallel_for(triad_blocks, [&](Index block) {
      const std::size_t first = static_cast<std::size_t>(block) * triad_block;
      for (std::size_t i = first; i < first + triad_block; ++i)
        f(i);
    });
  };
  Real *const to = a.get(), *const from = b.get(), *const other = c.get();
  in_blocks([=](std::size_t i) { to[i] = 0, from[i] = 1, other[i] = 2; });
  Real factor = 3;
  const Real seconds = shortest_pass([&] {
    in_blocks([=](std::size_t i) { to[i] = from[i] + factor * other[i]; });
    factor = to[0] / 2;  // a pass that nobody looked at might be left out
  });
  return 3 * sizeof(Real) * static_cast<Real>(n) / seconds;
}

Real fma_rate(int n_threads)
{
  constexpr int chains = 12, rounds = 2'000'000;  // enough chains to hide a latency of 4 or 5 cycles with two units
  std::vector<Real> saved(static_cast<std::size_t>(n_threads));
  const Real seconds = shortest_pass([&] {
    parallel_for(n_threads, [&](Index thread) {
      Pack sums[chains];
      for (int i = 0; i < chains; ++i)
        sums[i] = Pack{1, 2, 3, 4} + static_cast<Real>(i);
      const Pack factor = Pack{0.5, 0.5, 0.5, 0.5} + saved[static_cast<std::size_t>(thread)] * 1e-300;
      const Pack summand = 1 - factor;
      for (int round = 0; round < rounds; ++round)
        for (Pack& x : sums)
          x = x * factor + summand;
      Pack total = sums[0];
      for (int i = 1; i < chains; ++i)
        total += sums[i];
      saved[static_cast<std::size_t>(thread)] = sum(total);
    });
  });
  return Real{chains} * rounds * pack_size * n_threads / seconds;
}

}  // namespace

MachineLimit measure_machine(int n_threads)
{
  const int before = threads();
  set_threads(n_threads);
  const MachineLimit limit{n_threads, triad_bandwidth(), fma_rate(n_threads)};
  set_threads(before);
  return limit;
}

std::string processor_name()
{
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name"))
      if (const auto colon = line.find(": "); colon != std::string::npos)
        return line.substr(colon + 2);
  return "unknown";
}

}  // namespace talus
