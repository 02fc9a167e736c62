// The contract of laws that compute several particles at once: each as if it were alone.
#include "tests/materials/law_contract.hpp"

namespace talus::law_contract_test {
namespace {

template <class L>
constexpr auto kinds_of()
{
  if constexpr (requires { typename L::Kinds; })
    return typename L::Kinds{};
  else
    return TypeList<L>{};
}
template <class List>
struct AllKinds;
template <class... L>
struct AllKinds<TypeList<L...>> {
  using Types = typename AsGtest<decltype(joined(kinds_of<L>()...))>::Types;
};
// Without this a change of signature would be noticed by nothing but the time of a run.
template <class... L>
constexpr bool in_lanes(TypeList<L...>)
{
  return (LawInLanes<L> && ...);
}
template <class... L>
constexpr bool all_in_lanes(TypeList<L...>)
{
  return (in_lanes(kinds_of<L>()) && ...);
}
static_assert(all_in_lanes(Laws{}));

/// Laws in all their kinds, for several particles at once.
template <class L>
class LawInLanesContract : public ::testing::Test {
 protected:
  static L law()
  {
    if constexpr (std::is_base_of_v<JohnsonCookMetal, L>)
      return L{static_cast<const JohnsonCookMetal&>(sample<JohnsonCook>())};
    else if constexpr (std::is_base_of_v<ThresholdMetal, L>)
      return L{static_cast<const ThresholdMetal&>(sample<MechanicalThreshold>())};
    else if constexpr (std::is_base_of_v<DruckerPrager, L>)
      return L{sample<DruckerPrager>()};
    else if constexpr (std::is_base_of_v<MohrCoulomb, L>)
      return L{sample<MohrCoulomb>()};
    else if constexpr (std::is_base_of_v<VonMises, L>)
      return L{sample<VonMises>()};
    else
      return sample<L>();
  }
  /// Variants with what sample() leaves out.
  static std::vector<L> laws()
  {
    std::vector<L> all{law()};
    if constexpr (requires { law().reference_rate; }) {
      all.push_back(law());
      all.back().reference_rate = 1;
      all.back().thermal_exponent = 0.8;
    }
    if constexpr (std::is_base_of_v<VonMises, L>) {
      all.push_back(law());
      all.back().residual_stress = 0.2 * all.back().yield_stress;
      all.back().softening_strain = 0.05;
      all.push_back(law());
      all.back().rate = CowperSymonds{.reference_rate = 40, .exponent = 5};
      all.push_back(law());
      all.back().voce.reset();
      all.back().power.reset();
    }
    if constexpr (std::is_base_of_v<SoilStrength, L>) {
      all.push_back(law());
      all.back().tension_cutoff.reset();
      all.back().softening_strain.reset();
      all.back().residual_cohesion.reset();
      all.back().residual_friction_angle.reset();
      all.push_back(all.back());
      all.back().friction_angle = all.back().dilation_angle = 0;
    }
    if constexpr (std::is_same_v<L, CohesiveCamClay>) {
      all.push_back(law());  // falls apart soon
      all.back().preconsolidation_pressure = 1e4;
      all.push_back(testing::as_cohesive(sample<ModifiedCamClay>()));
      all.push_back(all.back());
      all.back().cohesion_ratio = 0.3;
    }
    if constexpr (std::is_same_v<L, ModifiedCamClay>) {
      all.push_back(law());  // first yield is near zero pressure, on the dry side it opens
      all.back().preconsolidation_pressure = 1e3;
    }
    if constexpr (std::is_same_v<L, ElasticHerschelBulkley>) {
      for (const Real flow_index : {0.5, 1.0, 1.7, 2.0}) {
        all.push_back(law());
        all.back().flow_index = flow_index;
      }
      all.push_back(law());
      all.back().consistency = 0;
    }
    return all;
  }
};
TYPED_TEST_SUITE(LawInLanesContract, AllKinds<Laws>::Types);

/// The largest difference of history variables, by what the larger is, or by one, or by the stiffness where it is an energy.
template <class State>
Real difference(const State& a, const State& b)
{
  Real worst = 0;
  for_each_field<State>([&]<class Owner, class Value>(const History<Owner, Value>& field) {
    const Real least = field.unit == "J/m^3" ? testing::sample_stiffness : 1;
    const auto compare = [&](Real x, Real y) {
      if (x != y && !(std::isnan(x) && std::isnan(y)))
        worst = std::max(worst, std::isfinite(x - y) ? std::abs(x - y) / std::max({least, std::abs(x), std::abs(y)}) : HUGE_VAL);
    };
    if constexpr (std::is_same_v<Value, Real>)
      compare(a.*field.member, b.*field.member);
    else
      for (int k = 0; k < 6; ++k)
        compare((a.*field.member)[k], (b.*field.member)[k]);
  });
  return worst;
}

/// What several particles are told and answer at once, and what each is told and answers alone from the same state.
template <class L>
class Neighbours {
 public:
  explicit Neighbours(const L& law) : law_(law)
  {
    together_.fill(at_rest());
    F_.fill(Mat3::Identity());
    stress_.fill(Mat3::Zero());
  }
  /// Particles deform by f; those from `count` on are not told.
  void step(const std::array<Mat3, pack_size>& f, int count, bool elastic, Real viscous)
  {
    constexpr Real dt = 1e-3;
    Mat3Of<SimdReal> F, rate, before;
    SimdReal pressure = 0;
    std::array<Real, std::max(1, numbers_of_state<State>) * pack_size> history;
    StateLanes<State> states{history.data(), pack_size, count};
    for (int lane = 0; lane < pack_size; ++lane) {
      const int from = std::min(lane, count - 1);
      const auto i = static_cast<std::size_t>(from);
      states.set(lane, together_[i]);
      const Mat3 end = f[i] * F_[i], velocity = (f[i] - Mat3::Identity()) / dt;
      for (Index k = 0; k < 9; ++k) {
        F(k).set(lane, end(k));
        rate(k).set(lane, velocity(k));
        before(k).set(lane, stress_[i](k));
      }
      pressure.set(lane, viscous * (1 + from));
    }
    auto alone = together_;
    const Mat3Of<SimdReal> answers = law_.update(IncrementOf<SimdReal>{F, rate, before, dt, pressure, elastic}, states);
    const SimdReal speeds = law_.wave_speed(F, states);
    for (int lane = 0; lane < count; ++lane) {
      const auto i = static_cast<std::size_t>(lane);
      together_[i] = states.of(lane);
      const Mat3 end = lane_of(F, lane), velocity = lane_of(rate, lane);
      const Mat3 expected = law_.update(Increment{end, velocity, stress_[i], dt, pressure[lane], elastic}, row_of(alone[i]));
      const Mat3 answer = lane_of(answers, lane);
      ASSERT_EQ(answer.allFinite(), expected.allFinite()) << "lane " << lane << " of " << count;
      const Real size = std::max(testing::sample_stiffness, expected.norm());
      if (expected.allFinite()) {
        ASSERT_LE((answer - expected).norm(), allowed * size) << "lane " << lane << " of " << count;
        const Real speed = law_.wave_speed(end, row_of(alone[i]));
        ASSERT_NEAR(speeds[lane], speed, allowed * speed);
      }
      ASSERT_LE(difference(together_[i], alone[i]), allowed) << "lane " << lane << " of " << count;
      F_[i] = end;
      stress_[i] = answer;
    }
  }
  void begin_again(std::size_t i)
  {
    F_[i] = Mat3::Identity();
    stress_[i] = Mat3::Zero();
    together_[i] = at_rest();
  }
  const auto& history(std::size_t i) const { return together_[i]; }

 private:
  // Twenty roundings of numbers of order one, and what the root finder leaves, 1e-12 of plastic strains up to one.
  static constexpr Real allowed = 4e-12;
  using State = typename L::State;

  State at_rest() const
  {
    State state{};
    law_.initial_history(row_of(state));
    return state;
  }
  static Real* row_of(State& state) { return reinterpret_cast<Real*>(&state); }

  ConstitutiveLawOf<L> law_;
  std::array<State, pack_size> together_;
  std::array<Mat3, pack_size> F_, stress_;
};

TYPED_TEST(LawInLanesContract, EveryLaneAnswersAsItWouldAlone)
{
  Dice dice(10);
  const auto laws = this->laws();
  for (int path = 0; path < 120 && !this->HasFatalFailure(); ++path) {
    Neighbours<TypeParam> neighbours(laws[static_cast<std::size_t>(path) % laws.size()]);
    for (int n = 0; n < 40 && !this->HasFatalFailure(); ++n) {
      std::array<Mat3, pack_size> f;
      for (Mat3& each : f)  // some stay elastic, some flow, some leave the series of the logarithm
        each = Mat3::Identity() + dice.matrix(std::pow(10.0, dice.real(-6, n % 8 == 7 ? -0.7 : -1.5)));
      neighbours.step(f, 1 + (path + n) % pack_size, n % 10 == 3, n % 3 * 1e3);
    }
  }
}

TYPED_TEST(LawInLanesContract, OneLaneStaysElasticWhereItsNeighboursFlow)
{
  Dice dice(11);
  for (int still = 0; still < pack_size; ++still) {
    Neighbours<TypeParam> neighbours(this->law());
    for (int n = 0; n < 40 && !this->HasFatalFailure(); ++n) {
      std::array<Mat3, pack_size> f;
      for (int lane = 0; lane < pack_size; ++lane) {
        const auto i = static_cast<std::size_t>(lane);
        const Real grown = 1 + 0.02 * std::sin(0.7 * n + lane);  // opens and closes
        f[i] = lane == still ? Mat3(-1e-5 * Mat3::Identity()) : Mat3(dice.matrix(0.01) + (grown - 1) * Mat3::Identity());
        f[i] += Mat3::Identity();
      }
      neighbours.step(f, pack_size, false, 0);
    }
  }
}

TYPED_TEST(LawInLanesContract, OnlyTheLaneWithoutAnAnswerAnswersNaN)
{
  Dice dice(12);
  for (int path = 0; path < 10; ++path) {
    for (std::size_t bad = 0; bad < pack_size && !this->HasFatalFailure(); ++bad) {
      Neighbours<TypeParam> neighbours(this->law());
      for (int n = 0; n < 6 && !this->HasFatalFailure(); ++n) {
        std::array<Mat3, pack_size> f;
        for (Mat3& each : f)
          each = Mat3::Identity() + dice.matrix(0.02);
        if (n % 3 == 2)
          f[bad] = Vec3(1, 1, n == 2 ? -1 : 0).asDiagonal();
        neighbours.step(f, pack_size, false, 0);
        if (n % 3 == 2)
          neighbours.begin_again(bad);
      }
    }
  }
}

}  // namespace
}  // namespace talus::law_contract_test
