// Nanoseconds per particle of a stress update of every law, one particle after the other and four at once: elastic, flowing, far from rest.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "materials/interface/constitutive_law_of.hpp"
#include "tests/materials/samples.hpp"

namespace {

using namespace talus;
using namespace talus::testing;

/// flowing: a large step of material that has not flown; flowing_on: a small step after it.
enum class Regime { elastic, flowing, flowing_on, large_strain };

/// Particles of one law on their way into a regime.
template <class L>
struct Body {
  static constexpr int n = 1024;
  ConstitutiveLawOf<L> law;
  std::vector<typename L::State> history;
  std::vector<Mat3> gradient, F, stress;

  explicit Body(Regime regime) : law(law_in(regime)), history(n)
  {
    Dice dice(1);
    const Real size = regime == Regime::elastic ? 1e-6 : regime == Regime::large_strain ? 0.3 : 1e-2;
    for (int i = 0; i < n; ++i) {
      gradient.push_back(dice.matrix(size));
      F.push_back(Mat3::Identity() + gradient.back());
      stress.push_back(-1e5 * Mat3::Identity());
      law.initial_history(row(static_cast<std::size_t>(i)));
      law.prestress(stress.back(), row(static_cast<std::size_t>(i)));
    }
    if (regime == Regime::flowing_on)
      for (int i = 0; i < n; ++i) {
        const auto p = static_cast<std::size_t>(i);
        stress[p] = law.update(Increment{F[p], gradient[p], stress[p], 1.0, 0, false}, row(p));
        gradient[p] *= 0.01;
        F[p] += gradient[p] * F[p];
      }
  }
  Real* row(std::size_t p) { return reinterpret_cast<Real*>(&history[p]); }
  static L law_in(Regime regime)
  {
    L law = sample<L>();
    if constexpr (requires { law.cohesion; })
      if (regime == Regime::large_strain)
        law.cohesion = 1e8, law.tension_cutoff.reset(), law.softening_strain.reset();
    return law;
  }
};

template <class L>
void update(benchmark::State& timer, Regime regime)
{
  Body<L> body(regime);
  const auto start = body.history;
  for (auto _ : timer) {
    body.history = start;
    for (Index i = 0; i < body.n; ++i) {
      const auto p = static_cast<std::size_t>(i);
      body.stress[p] = body.law.update(Increment{body.F[p], body.gradient[p], body.stress[p], 1.0, 0, false}, body.row(p));
    }
    benchmark::DoNotOptimize(body.stress.data());
  }
  timer.SetItemsProcessed(timer.iterations() * body.n);
}

/// Four particles at once; their tensors are packed already, as after gathering from nodes.
template <class L>
void update_in_lanes(benchmark::State& timer, Regime regime)
{
  Body<L> body(regime);
  const auto packed = [&](const std::vector<Mat3>& all) {
    std::vector<Mat3Of<SimdReal>> packs(all.size() / pack_size);
    for (std::size_t p = 0; p < packs.size(); ++p)
      for (Index k = 0; k < 9; ++k)
        packs[p](k) = in_each_lane([&](int lane) { return all[p * pack_size + static_cast<std::size_t>(lane)](k); });
    return packs;
  };
  const auto gradient = packed(body.gradient), F = packed(body.F);
  auto stress = packed(body.stress);
  std::vector<Real> start(body.history.size() * std::max<std::size_t>(1, numbers_of_state<typename L::State>));
  const auto lanes_at = [&](Real* numbers, Index i) { return StateLanes<typename L::State>{numbers + i, body.history.size(), pack_size}; };
  for (Index i = 0; i < body.n; ++i)
    lanes_at(start.data(), i).set(0, body.history[static_cast<std::size_t>(i)]);
  std::vector<Real> history;
  for (auto _ : timer) {
    history = start;
    for (Index i = 0; i < body.n; i += pack_size) {
      const auto p = static_cast<std::size_t>(i / pack_size);
      auto states = lanes_at(history.data(), i);
      stress[p] = body.law.update(IncrementOf<SimdReal>{F[p], gradient[p], stress[p], 1.0, 0, false}, states);
    }
    benchmark::DoNotOptimize(stress.data());
  }
  timer.SetItemsProcessed(timer.iterations() * body.n);
}

const bool registered = [] {
  for_each_type(Laws{}, []<class L>() {
    constexpr std::pair<std::string_view, Regime> regimes[] = {{"elastic", Regime::elastic},
                                                               {"flowing", Regime::flowing},
                                                               {"flowing_on", Regime::flowing_on},
                                                               {"large_strain", Regime::large_strain}};
    for (const auto& [name, regime] : regimes) {
      benchmark::RegisterBenchmark(fmt::format("update/{}/{}", L::name, name).c_str(), update<L>, regime);
      benchmark::RegisterBenchmark(fmt::format("update_in_lanes/{}/{}", L::name, name).c_str(), update_in_lanes<L>, regime);
    }
  });
  return true;
}();

}  // namespace
