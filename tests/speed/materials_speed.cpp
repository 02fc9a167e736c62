// Nanoseconds per stress update of every law: small steps around a strained state, for soil elastic and flowing.
#include <benchmark/benchmark.h>

#include "tests/materials/samples.hpp"

namespace {

using namespace talus;
using namespace talus::testing;

enum class Regime { elastic, flowing, large_strain };

template <class L>
void update(benchmark::State& timer, Regime regime)
{
  constexpr int n = 1024;
  Dice dice(1);
  const Real size = regime == Regime::elastic ? 1e-6 : regime == Regime::flowing ? 1e-2 : 0.3;
  L law = sample<L>();
  if constexpr (requires { law.cohesion; })
    if (regime == Regime::large_strain)
      law.cohesion = 1e8, law.tension_cutoff.reset(), law.softening_strain.reset();
  AnyBatch any = make_batch(law, 0, n, "body");
  auto& batch = std::get<Batch<L>>(any);
  std::vector<Mat3> gradient, F, stress;
  for (int i = 0; i < n; ++i) {
    gradient.push_back(dice.matrix(size));
    F.push_back(Mat3::Identity() + gradient.back());
    stress.push_back(-1e5 * Mat3::Identity());
    prestress(batch, i, stress.back());
  }
  const auto start = batch.history;
  for (auto _ : timer) {
    batch.history = start;
    for (Index i = 0; i < n; ++i) {
      const auto p = static_cast<std::size_t>(i);
      stress[p] = batch.update(i, {F[p], gradient[p], stress[p], 1.0, 0, false});
    }
    benchmark::DoNotOptimize(stress.data());
  }
  timer.SetItemsProcessed(timer.iterations() * n);
}

const bool registered = [] {
  for_each_type(Laws{}, []<class L>() {
    const std::string name(L::name);
    benchmark::RegisterBenchmark(("update/" + name + "/elastic").c_str(), update<L>, Regime::elastic);
    benchmark::RegisterBenchmark(("update/" + name + "/flowing").c_str(), update<L>, Regime::flowing);
    benchmark::RegisterBenchmark(("update/" + name + "/large_strain").c_str(), update<L>, Regime::large_strain);
  });
  return true;
}();

}  // namespace
