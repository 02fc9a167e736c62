// Earthquakes: waves that come up through a base and leave again, layers against closed forms, and sides beside which the ground goes on.
#include <gmock/gmock.h>

#include <cmath>
#include <complex>
#include <functional>
#include <numbers>

#include "mesh/conditions/soil_column.hpp"
#include "tests/app/program.hpp"

namespace talus::earthquake_test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Ground of the scenes below: E = 2.0e8 Pa, nu = 0.3.
constexpr Real density = 2000, shear = 2.0e8 / 2.6, confined = 2.0e8 * 0.7 / (1.3 * 0.4);
const Real s_wave = std::sqrt(shear / density), p_wave = std::sqrt(confined / density);

/// A wavelet of one frequency [Hz] and height 1 about t = 1.6 / frequency.
Real ricker(Real t, Real frequency)
{
  const Real a = std::pow(std::numbers::pi * frequency * t - 1.6 * std::numbers::pi, 2);
  return (1 - 2 * a) * std::exp(-a);
}

std::string samples(Real end, Real step, const std::function<Real(Real)>& value)
{
  std::string text = "time [s], velocity [m/s]\n";
  for (int k = 0; k * step <= end; ++k)
    text += fmt::format("{}, {}\n", k * step, value(k * step));
  return text;
}

/// Amplification of a layer on a halfspace of its impedance over `impedance_ratio`, to a wave of unit height that comes up in that [Kramer 1996,
/// section 7.2.1]: twice one over (cos kH + i r sin kH).
Real amplification(Real frequency, Real speed, Real height, Real impedance_ratio)
{
  const Real kH = 2 * std::numbers::pi * frequency * height / speed;
  return 2 / std::abs(std::complex<Real>(std::cos(kH), impedance_ratio * std::sin(kH)));
}

struct Ground {
  std::string grid, body, base, sides;
  Real end;
  std::string at_rest = "  - {type: geostatic, duration: 20, damping: 0.7, residual: 1.0e-3, initial_stress: {k0: 0.428571}}\n";

  std::string scene() const
  {
    return "title: Ground\ndimension: 2\nkernel: linear\nmesh: {grid: {low: [0, 0], " + grid +
           "}}\nmaterials: [{name: soil, law: linear_elastic, density: 2000, youngs_modulus: 2.0e8, poisson_ratio: 0.3}]\n"
           "bodies: [{name: ground, material: soil, shape: {type: box, low: [0, 0], high: " +
           body + "}, particles_per_cell: 3}]\nloads: [{type: gravity, acceleration: [0, -9.81]}]\nboundaries:\n  - {" + base + "}\n" +
           sides + "stages:\n" + at_rest + fmt::format("  - {{type: run, duration: {}}}\n", end) +
           "outputs: {history: {every: 0.004, points: [{name: top, at: [0.5, 100]}, {name: middle, at: [10, 100]}]}}\n";
  }
};

const std::string rollers = "  - {type: roller, on: x_min}\n  - {type: roller, on: x_max}\n";
const std::string free_fields = "  - {type: free_field, on: x_min}\n  - {type: free_field, on: x_max}\n";

/// A column 40 m high between rollers, in which P waves go up and down, on a halfspace that is `times` as stiff against them.
Ground column(Real times, const std::string& wave, Real end)
{
  return {"high: [1, 41], cells: [1, 41]", "[1, 40]",
          fmt::format("type: compliant_base, on: y_min, density: {}, s_wave: {}, p_wave: {}{}", density * times, s_wave, p_wave, wave),
          rollers, end};
}

class Earthquake : public Program {
 protected:
  struct Curve {
    std::vector<Real> time, value;  // time since the shaking began
  };
  /// What it says.
  std::string run(const Ground& ground, const std::string& out = "out") const
  {
    write("scene.yaml", ground.scene());
    const Outcome outcome = talus("run scene.yaml --threads 1 --out " + out);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return outcome.out;
  }
  Curve curve(const std::string& name, const std::string& out = "out") const
  {
    const HistoryTable table = history(out);
    const auto time = *table["time"], stage = *table["stage"], values = *table[name];
    Curve found;
    Real begin = 0;
    for (std::size_t k = 0; k < table.rows(); ++k)
      if (stage[k] < 1)
        begin = time[k];
      else
        found.time.push_back(time[k] - begin), found.value.push_back(values[k]);
    return found;
  }
  static Real largest(const Curve& curve, Real from = 0)
  {
    Real most = 0;
    for (std::size_t k = 0; k < curve.time.size(); ++k)
      most = std::max(most, curve.time[k] >= from ? std::abs(curve.value[k]) : 0);
    return most;
  }
  template <class F>
  static Real farthest(const Curve& curve, F&& reference)
  {
    Real most = 0;
    for (std::size_t k = 0; k < curve.time.size(); ++k)
      most = std::max(most, std::abs(curve.value[k] - reference(curve.time[k])));
    return most;
  }
};

TEST_F(Earthquake, SurfaceMovesTwiceAsFastAsTheWaveThatComesUpAndNothingComesBack)
{
  write("wave.csv", samples(0.8, 0.002, [](Real t) { return ricker(t, 4); }));
  const std::string said = run(column(1, ", velocity: [0, 0.1], record: {file: wave.csv, unit: m/s}", 1.6));
  EXPECT_THAT(said, HasSubstr("wave.csv: 401 samples over 0.8 s"));
  EXPECT_THAT(said, HasSubstr("audit: "));
  EXPECT_THAT(said, Not(HasSubstr("DOES NOT CLOSE")));
  const Curve top = curve("top_vy");
  EXPECT_LT(farthest(top, [](Real t) { return 0.2 * ricker(t - 40 / p_wave, 4); }), 0.01 * 0.2);  // measured: 0.5 %
  EXPECT_LT(largest(top, 1.2), 1e-4 * 0.2);
  EXPECT_LT(largest(curve("top_uy"), 1.5), 1e-6);
}

TEST_F(Earthquake, ARunDoesNotGoOnWithAnotherRecord)
{
  const auto wave = [](Real height) { return samples(0.4, 0.01, [height](Real t) { return height * ricker(t, 5); }); };
  write("wave.csv", wave(1));
  write("scene.yaml", column(1, ", velocity: [0, 0.01], record: {file: wave.csv, unit: m/s}", 0.4).scene());
  ASSERT_EQ(talus("run scene.yaml --quiet --out out --until 5").code, 4);
  write("wave.csv", wave(1.01));
  const Outcome refused = talus("run --resume out --quiet");
  EXPECT_EQ(refused.code, 3);
  EXPECT_THAT(refused.err, HasSubstr("a record or the water table of"));
  write("wave.csv", wave(1));
  EXPECT_EQ(talus("run --resume out --quiet").code, 0);
}

TEST_F(Earthquake, RigidBaseSendsTheWaveBackForEver)
{
  write("wave.csv", samples(0.8, 0.002, [](Real t) { return ricker(t, 4); }));
  Ground ground = column(1, "", 1.6);
  ground.base = "type: velocity, on: y_min, velocity: [0, 0.1], record: {file: wave.csv, unit: m/s}";
  run(ground);
  EXPECT_GT(largest(curve("top_vy"), 1.2), 0.1);
}

TEST_F(Earthquake, LayerOnStifferGroundAnswersAsItsTransferFunctionSays)
{
  constexpr Real stiffer = 4;
  for (const Real frequency : {p_wave / 160, p_wave / 80}) {  // of the first resonance, and of the first minimum behind it
    write("wave.csv",
          samples(3, 0.002, [&](Real t) { return std::min(t * frequency / 2, 1.0) * std::sin(2 * std::numbers::pi * frequency * t); }));
    run(column(stiffer, ", velocity: [0, 0.01], record: {file: wave.csv, unit: m/s}", 2.8));
    const Real exact = 0.01 * amplification(frequency, p_wave, 40, 1 / stiffer);
    EXPECT_NEAR(largest(curve("top_vy"), 2.8 - 1 / frequency), exact, 0.03 * exact) << frequency;
  }
}

TEST_F(Earthquake, BaseDoesNotCreepUnderItsWeight)
{
  run(column(1, "", 2));
  EXPECT_LT(largest(curve("top_vy")), 1e-6);
  EXPECT_LT(largest(curve("top_uy")), 1e-6);
}

/// Level ground 20 m high and wide that a shear wave shakes, on rock.
Ground level(const std::string& sides)
{
  return {
      "high: [20, 21], cells: [20, 21]", "[20, 20]",
      "type: compliant_base, on: y_min, density: 2200, s_wave: 600, p_wave: 1100, velocity: [0.1, 0], record: {file: wave.csv, unit: m/s}",
      sides, 0.9};
}

TEST_F(Earthquake, FreeFieldsLetLevelGroundMoveAsAColumnDoes)
{
  write("wave.csv", samples(0.8, 0.002, [](Real t) { return ricker(t, 4); }));
  const Halfspace rock{2200, 600, 1100};
  const Real back = (density * s_wave - rock.density * rock.s_wave) / (density * s_wave + rock.density * rock.s_wave);
  // the wave that came through, once from each passage up and down: the base turns it round with the coefficient `back`
  const auto exact = [&](Real t) {
    Real v = 0, height = 2 * 0.1 * 2 / (1 + density * s_wave / (rock.density * rock.s_wave));
    for (Real arrival = 20 / s_wave; arrival < 2; arrival += 40 / s_wave, height *= back)
      v += height * ricker(t - arrival, 4);
    return v;
  };
  run(level(free_fields));
  EXPECT_LT(farthest(curve("middle_vx"), exact), 0.03 * 0.3);
  EXPECT_LT(farthest(curve("top_vx"), exact), 0.03 * 0.3);
  EXPECT_LT(largest(curve("middle_vy")), 0.01 * 0.3);
  run(level(rollers), "closed");
  EXPECT_GT(farthest(curve("middle_vx", "closed"), exact), 0.3 * 0.3);
}

/// A column alone, which the model's own steps do not touch.
SoilColumn<2> soil(std::size_t layers, const Halfspace& ground)
{
  SoilColumn<2> column;
  for (std::size_t l = 0; l <= layers; ++l)
    column.level.push_back(static_cast<Real>(l) * 40 / static_cast<Real>(layers));
  column.layer.assign(layers, {ground, 1});
  return column;
}

TEST(SoilColumn, OnGroundLikeItselfItsSurfaceMovesTwiceAsFastAsTheWave)
{
  const Halfspace ground{density, s_wave, p_wave};
  const SoilColumn<2> column = soil(80, ground);
  ColumnMotion motion = column.at_rest();
  Real off = 0;
  const Real dt = 2e-4;
  for (Real t = 0; t < 1.4; t += dt) {
    advance(column, ColumnBase<2>{Vec<2>(0.1 * ricker(t + dt, 4), 0.05 * ricker(t + dt, 4)), ground}, dt, motion);
    const Vec<2> top = column.velocity_at(40, motion);
    off = std::max(off, std::abs(top[0] - 0.2 * ricker(t + dt - 40 / s_wave, 4)));
    off = std::max(off, std::abs(top[1] - 0.1 * ricker(t + dt - 40 / p_wave, 4)));
  }
  EXPECT_LT(off, 0.01 * 0.2);
  for (const Real v : motion.velocity)
    EXPECT_LT(std::abs(v), 1e-4);  // nothing came back
}

TEST(SoilColumn, TakesAsManyPartsOfAStepAsAreStable)
{
  const SoilColumn<2> column = soil(40, {density, s_wave, p_wave});
  ColumnMotion motion = column.at_rest();
  for (int step = 0; step < 200; ++step)
    advance(column, ColumnBase<2>{Vec<2>(0.1 * ricker(0.02 * step, 1), 0), std::nullopt}, 0.02, motion);
  for (const Real v : motion.velocity)
    EXPECT_LT(std::abs(v), 1);
}

TEST(SoilColumn, PushesASideByTheStressOfItsWaves)
{
  const SoilColumn<2> column = soil(1, {density, s_wave, p_wave});
  ColumnMotion motion = column.at_rest();
  motion.traction = {30, 50};  // shear and axial stress on a horizontal plane
  const Real lambda = confined - 2 * shear;
  const Vec<2> force = column.force_on({2, 0}, 0, motion);
  EXPECT_NEAR(force[0], 2 * 50 * lambda / confined, 1e-10);
  EXPECT_NEAR(force[1], 2 * 30, 1e-10);
}

using BadRecord = Earthquake;

TEST_F(BadRecord, IsToldByFileLineAndColumn)
{
  write("wave.csv", "# station 7\ntime; a\n0.00; 0.1\n0.01; 0.2\n0.01; 0.3\n0.02; much\n0.03\n0.04; nan\n0.05; +1.5e-1\n");
  write("scene.yaml", column(1, ", velocity: [0, 1], record: {file: wave.csv, unit: g}", 1).scene());
  const Outcome outcome = talus("check scene.yaml");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("wave.csv:5:1: error: the time 0.01 s does not come after that of the sample before, 0.01 s"));
  EXPECT_THAT(outcome.err, HasSubstr("wave.csv:6:7: error: the value \"much\" is not a finite number"));
  EXPECT_THAT(outcome.err, HasSubstr("wave.csv:7:1: error: a sample has two values, its time [s] and its value [g]; here is 1"));
  EXPECT_THAT(outcome.err, HasSubstr("wave.csv:8:7: error: the value \"nan\" is not a finite number"));
  EXPECT_THAT(outcome.err, HasSubstr("4 errors, nothing was run"));
}

TEST_F(BadRecord, OfNoSamplesOrNowhereIsToldAtItsKey)
{
  write("scene.yaml", column(1, ", velocity: [0, 1], record: {file: wave.csv, unit: g}", 1).scene());
  Outcome outcome = talus("check scene.yaml");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("record.file: "));
  EXPECT_THAT(outcome.err, HasSubstr("there is no such file"));
  write("wave.csv", "time, a\n");
  outcome = talus("check scene.yaml");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("a record needs two samples or more"));
}

TEST_F(BadRecord, ThatGoesOnMovingIsWarnedOfUnlessABaselineIsTakenOff)
{
  write("wave.csv", "0 0\n0.5 1\n1.5 1\n");
  const auto check = [&](const std::string& baseline) {
    write("scene.yaml", column(1, ", velocity: [0, 1], record: {file: wave.csv, unit: cm/s^2, scale: 2" + baseline + "}", 1).scene());
    return talus("check scene.yaml");
  };
  const Outcome drifts = check("");
  EXPECT_THAT(drifts.err, HasSubstr("\"wave.csv\" ends with 0.025 m/s, and its velocity stays so after its end"));
  EXPECT_THAT(drifts.out, HasSubstr("wave.csv: 3 samples over 1.5 s, peaks 0.025 m/s and 0.02 m/s^2; ends with 0.025 m/s"));
  EXPECT_EQ(check(", baseline: velocity").err, "");
  EXPECT_EQ(check(", baseline: displacement").err, "");
}

TEST_F(Earthquake, SideWhoseFootNothingHoldsIsAnError)
{
  Ground ground = level(free_fields);
  ground.base = "type: roller, on: y_min";
  write("scene.yaml", ground.scene());
  const Outcome outcome = talus("check scene.yaml");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("no boundary of type fixed, velocity or compliant_base holds the foot of \"x_min\""));
}

}  // namespace
}  // namespace talus::earthquake_test
