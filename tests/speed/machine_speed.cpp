// What the memory and the cores of this machine can do at best: the triad of STREAM (McCalpin 1995), and independent chains of multiply-adds.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <memory>

#include "core/parallel/threads.hpp"
#include "core/simd.hpp"

namespace talus {
namespace {

/// Bytes are counted as STREAM does: two arrays read, one written; that a cache may read what it is about to write is not counted.
void triad(benchmark::State& state, int n_threads)
{
  constexpr Index block_size = 1 << 12, blocks = 1 << 12;  // arrays of 134 MB, several times the largest caches
  constexpr std::size_t n = std::size_t{block_size} * blocks;
  set_threads(n_threads);
  const auto array = [] { return std::unique_ptr<Real[]>(new Real[n]); };  // not touched: its pages go to the threads that use them
  const auto a = array(), b = array(), c = array();
  const auto in_blocks = [&](auto&& f) {
    parallel_for(blocks, [&](Index block) {
      const std::size_t first = static_cast<std::size_t>(block) * block_size;
      for (std::size_t i = first; i < first + block_size; ++i)
        f(i);
    });
  };
  Real *const to = a.get(), *const from = b.get(), *const other = c.get();
  in_blocks([=](std::size_t i) { to[i] = 0, from[i] = 1, other[i] = 2; });
  Real factor = 3;
  for (auto _ : state) {
    in_blocks([=](std::size_t i) { to[i] = from[i] + factor * other[i]; });
    factor = to[0] / 2;  // a pass that nobody looked at might be left out
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(3 * sizeof(Real) * n));
}

/// Items are multiply-adds of doubles.
void multiply_adds(benchmark::State& state, int n_threads)
{
  constexpr int chains = 12, rounds = 2'000'000;  // enough chains to hide a latency of 4 or 5 cycles with two units
  set_threads(n_threads);
  std::vector<Real> results(static_cast<std::size_t>(n_threads));
  for (auto _ : state)
    parallel_for(n_threads, [&](Index thread) {
      Pack sums[chains];
      for (int i = 0; i < chains; ++i)
        sums[i] = Pack{1, 2, 3, 4} + static_cast<Real>(i);
      const Pack factor = Pack{0.5, 0.5, 0.5, 0.5} + results[static_cast<std::size_t>(thread)] * 1e-300;
      const Pack summand = 1 - factor;
      for (int round = 0; round < rounds; ++round)
        for (Pack& x : sums)
          x = x * factor + summand;
      Pack total = sums[0];
      for (int i = 1; i < chains; ++i)
        total += sums[i];
      results[static_cast<std::size_t>(thread)] = sum(total);
    });
  state.SetItemsProcessed(state.iterations() * std::int64_t{chains} * rounds * pack_size * n_threads);
}

const bool registered = [] {
  for (const int n_threads : {1, 2}) {
    benchmark::RegisterBenchmark(fmt::format("machine/triad/threads:{}", n_threads).c_str(), triad, n_threads)->UseRealTime();
    benchmark::RegisterBenchmark(fmt::format("machine/multiply_adds/threads:{}", n_threads).c_str(), multiply_adds, n_threads)
        ->UseRealTime();
  }
  return true;
}();

}  // namespace
}  // namespace talus
