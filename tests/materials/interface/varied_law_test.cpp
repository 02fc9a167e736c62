// Laws whose parameters vary: each particle as if its law had the parameters of the particle, of every law and parameter.
#include "materials/interface/varied_law.hpp"

#include <gmock/gmock.h>

#include "materials/interface/law_variant.hpp"
#include "materials/interface/varied_law_of.hpp"
#include "tests/materials/samples.hpp"

namespace talus::varied_law_test {
namespace {

using ::testing::Contains;
using testing::Dice;
using ::testing::HasSubstr;
using ::testing::Not;

std::vector<std::string> keys_of(const AnyLaw& law)
{
  std::vector<std::string> keys;
  for (const LawNumber& number : numbers_that_vary(law))
    keys.emplace_back(number.key);
  return keys;
}

/// The law with factors for some of its parameters; nullptr if it is not one.
std::shared_ptr<const VariedLaw> with_factors_of(const AnyLaw& law, const std::vector<std::string>& parameters)
{
  std::vector<ParameterVariation> variation;
  for (const std::string& parameter : parameters) {
    variation.emplace_back();
    variation.back().parameter = parameter;
  }
  return std::dynamic_pointer_cast<const VariedLaw>(talus::varied_law(law, variation));
}

/// The law with one parameter multiplied.
template <class L>
L multiplied(L law, const std::string& key, Real factor)
{
  for_each_field<L>([&]<class Field>(const Field& field) {
    auto& member = law.*field.member;
    using Value = std::remove_cvref_t<decltype(member)>;
    if (field.key != key)
      return;
    if constexpr (std::is_same_v<Value, Real>)
      member *= factor;
    else if constexpr (std::is_same_v<Value, std::optional<Real>>)
      *member *= factor;
  });
  return law;
}

std::vector<Real> row_at_rest(const ConstitutiveLaw& law)
{
  std::vector<Real> row(static_cast<std::size_t>(law.description().history_width));
  law.initial_history(row.data());
  return row;
}

/// Both are compiled for themselves, so that products and sums may be rounded otherwise.
constexpr Real compiled_otherwise = 1e-11;
Real difference(const Real* a, const Real* b, std::size_t n)
{
  Real largest = 0;
  for (std::size_t k = 0; k < n; ++k)
    largest = std::max(largest, std::abs(a[k] - b[k]) / std::max(std::abs(a[k]), Real{1e-3}));
  return largest;
}

/// Steps with random deformations; both must answer alike, and remember the same.
void expect_same_path(const ConstitutiveLaw& plain, const ConstitutiveLaw& varied, std::vector<Real> row_varied, const std::string& what)
{
  std::vector<Real> row = row_at_rest(plain);
  Dice dice(5);
  Mat3 F = Mat3::Identity(), stress = Mat3::Zero();
  constexpr Real dt = 1e-3;
  for (int n = 0; n < 12; ++n) {
    const Mat3 change = dice.matrix(n % 4 == 3 ? 0.03 : 1e-3), rate = change / dt;
    F += change * F;
    const Increment step{F, rate, stress, dt, 0, n % 6 == 1};
    EXPECT_NEAR(plain.wave_speed(F, row.data()) / varied.wave_speed(F, row_varied.data()), 1, compiled_otherwise) << what;
    const Mat3 expected = plain.update(step, row.data()), answer = varied.update(step, row_varied.data());
    ASSERT_LE((expected - answer).norm(), compiled_otherwise * (1 + expected.norm())) << what << ", step " << n;
    ASSERT_LE(difference(row.data(), row_varied.data(), row.size()), compiled_otherwise) << what << ", step " << n;
    stress = expected;
    std::ranges::copy(row, row_varied.begin());
  }
  const auto* const of_particle = dynamic_cast<const VariedLaw*>(&varied);
  ASSERT_NE(of_particle, nullptr);
  EXPECT_EQ(plain.shear_modulus(), of_particle->shear_modulus(row_varied.data())) << what;
}

TEST(VariedLaw, AnswersAsTheLawWithTheParametersOfTheParticle)
{
  constexpr Real factor = 1.0625;  // products are exact
  int checked = 0;
  for_each_type(Laws{}, [&]<class L>() {
    const AnyLaw law(testing::sample<L>());
    for (const std::string& key : keys_of(law)) {
      const auto varied = with_factors_of(law, {key});
      const AnyLaw other(multiplied(testing::sample<L>(), key, factor));
      std::vector<Real> row = row_at_rest(*varied);
      EXPECT_EQ(row.back(), 1);
      const std::string what = fmt::format("{}.{}", L::name, key);
      expect_same_path(*law.model(), *varied, row, what + " at rest");
      row.back() = factor;
      expect_same_path(*other.model(), *varied, row, what);
      if (law.description().has_strength)
        expect_same_path(*other.model()->weakened(1.5), *varied->weakened(1.25)->weakened(1.2), row, what + ", weakened");
      if (law.description().starts_from_stress) {
        std::vector<Real> of_other = row_at_rest(*other.model());
        const Mat3 stress = Vec3(-2e4, -3e4, -2.5e4).asDiagonal();
        other.model()->prestress(stress, of_other.data());
        varied->prestress(stress, row.data());
        EXPECT_LE(difference(of_other.data(), row.data(), of_other.size()), compiled_otherwise) << what;
      }
      ++checked;
    }
  });
  EXPECT_GT(checked, 60);
}

/// Lanes have factors of their own; those beyond the last particle are not touched.
TEST(VariedLaw, EveryLaneAnswersAsItWouldAlone)
{
  const AnyLaw law(testing::sample<MohrCoulomb>());
  const auto varied = std::dynamic_pointer_cast<const VariedLawOf<MohrCoulomb>>(with_factors_of(law, {"cohesion", "youngs_modulus"}));
  ASSERT_NE(varied, nullptr);
  const auto width = static_cast<std::size_t>(varied->description().history_width);
  constexpr std::size_t stride = 7;
  for (int count = 1; count <= pack_size; ++count) {
    Dice dice(8);
    std::vector<Real> columns(width * stride, -7);
    std::vector<std::vector<Real>> rows;
    Mat3Of<SimdReal> F, rate, stress = Mat3Of<SimdReal>::Zero();
    for (int lane = 0; lane < pack_size; ++lane) {
      std::vector<Real> row = row_at_rest(*varied);
      row[width - 2] = dice.real(0.3, 2), row[width - 1] = dice.real(0.5, 1.5);
      for (std::size_t k = 0; k < width; ++k)
        columns[k * stride + static_cast<std::size_t>(lane)] = row[k];
      rows.push_back(row);
      const Mat3 change = dice.matrix(0.02);
      for (Index k = 0; k < 9; ++k)
        F(k).set(lane, change(k) + (k % 4 == 0 ? 1 : 0)), rate(k).set(lane, change(k) / 1e-3);
    }
    StateLanes<MohrCoulomb::State> states{columns.data(), stride, count};
    const auto of_particles = varied->of_particles(states);
    const SimdReal speeds = of_particles.wave_speed(F, states);
    const Mat3Of<SimdReal> after = of_particles.update(IncrementOf<SimdReal>{F, rate, stress, 1e-3, 0, false}, states);
    for (int lane = 0; lane < pack_size; ++lane) {
      std::vector<Real>& row = rows[static_cast<std::size_t>(lane)];
      if (lane < count) {
        const Mat3 f = lane_of(F, lane), l = lane_of(rate, lane), zero = Mat3::Zero();
        EXPECT_EQ(speeds[lane], varied->wave_speed(f, row.data()));
        EXPECT_EQ(lane_of(after, lane), varied->update(Increment{f, l, zero, 1e-3, 0, false}, row.data()));
      }
      for (std::size_t k = 0; k < width; ++k)
        EXPECT_EQ(columns[k * stride + static_cast<std::size_t>(lane)], row[k]) << "number " << k << " of lane " << lane;
    }
  }
}

/// The mean strain is one of the whole body, whatever its particles are.
TEST(VariedLaw, CombinesWithASofteningLength)
{
  MohrCoulomb soil = testing::sample<MohrCoulomb>();
  soil.softening_length = 0.3;
  const AnyLaw law(soil);
  const auto varied = with_factors_of(law, {"cohesion"});
  ASSERT_TRUE(varied->strain_averaging().has_value());
  EXPECT_EQ(varied->strain_averaging()->mean, law.model()->strain_averaging()->mean);
  expect_same_path(*law.model(), *varied, row_at_rest(*varied), "mohr_coulomb with a softening length");
  EXPECT_THAT(keys_of(law), Not(Contains("softening_length")));
  EXPECT_THAT(keys_of(law), Not(Contains("softening_strain")));
  EXPECT_THAT(keys_of(AnyLaw(testing::sample<MohrCoulomb>())), Contains("softening_strain"));
}

TEST(VariedLaw, VariesWhatNothingElseOfTheBodyDependsOn)
{
  EXPECT_THAT(keys_of(AnyLaw(testing::sample<MohrCoulomb>())),
              ::testing::AllOf(Contains("cohesion"), Contains("friction_angle"), Contains("youngs_modulus"), Not(Contains("density")),
                               Not(Contains("bulk_modulus"))));
  const auto fluid = keys_of(AnyLaw(testing::sample<HerschelBulkley>()));  // its largest viscosity bounds the step of the whole body
  EXPECT_THAT(fluid, Contains("bulk_modulus"));
  EXPECT_THAT(fluid, Not(Contains("consistency")));
  EXPECT_THAT(keys_of(AnyLaw(testing::sample<JohnsonCook>())), Not(Contains("room_temperature")));  // that of particles at rest
  EXPECT_THAT(keys_of(AnyLaw(testing::sample<Newtonian>())), Not(Contains("viscosity")));
  EXPECT_TRUE(keys_of(AnyLaw(LawBySymbol{})).empty());
}

TEST(VariedLaw, HasItsFactorsBehindTheHistory)
{
  const AnyLaw law(testing::sample<VonMises>());
  const auto varied = with_factors_of(law, {"yield_stress", "youngs_modulus"});
  const auto plain = law.model()->variables(), all = varied->variables();
  ASSERT_EQ(all.size(), plain.size() + 2);
  EXPECT_EQ(all[plain.size()].key, "yield_stress_factor");
  EXPECT_EQ(all[plain.size() + 1].key, "youngs_modulus_factor");
  EXPECT_EQ(all[plain.size()].first, varied->first_factor());
  EXPECT_EQ(varied->description().history_width, law.model()->description().history_width + 2);
  EXPECT_EQ(varied->weakened(2)->description().history_width, varied->description().history_width);
  EXPECT_EQ(&varied->description(), &with_factors_of(law, {"yield_stress", "youngs_modulus"})->description());
  EXPECT_NE(&varied->description(), &with_factors_of(law, {"youngs_modulus", "yield_stress"})->description());
}

TEST(VariedLaw, SaysWhichRuleItsParametersBreak)
{
  MohrCoulomb soil = testing::sample<MohrCoulomb>();
  const auto varied = with_factors_of(AnyLaw(soil), {"friction_angle", "dilation_angle"});
  std::vector<Real> row = row_at_rest(*varied);
  EXPECT_EQ(varied->problem(row.data()), "");
  Real* const factors = row.data() + varied->first_factor();
  factors[0] = 3.5;
  EXPECT_EQ(varied->problem(row.data()), "friction_angle is 105 deg, but must be [0, 90)");
  factors[0] = 1, factors[1] = 4;  // dilation of 32 degrees, more than the friction
  EXPECT_THAT(varied->problem(row.data()), HasSubstr("dilation"));
}

}  // namespace
}  // namespace talus::varied_law_test
