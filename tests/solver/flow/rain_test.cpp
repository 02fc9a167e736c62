// Rain on bodies, and the weight of open water.
#include "tests/solver/flow/saturated_soil.hpp"

namespace talus::rain_test {
namespace {

using namespace saturated_soil;

constexpr Real rate = 1e-5, dt = 0.1;
constexpr int steps = 10;

/// A bank that cannot move, 1 m wide (and deep), under rain: with a surface of this slope that cuts the cells, or follows them where it is
/// level, and with this pressure everywhere, or that of water that stands to a height of 1 m.
template <int D>
FlowLedger rained_on(Real slope, std::optional<Real> pressure, Real pace)
{
  FlowOfBody soil = pores(1e-3, 1e8);
  soil.retention = {1e3, 2, 0};
  auto m = saturated<D>(unit_box<D>(D == 2 ? 16 : 8, slope == 0 ? 0 : 0.2), soil,
                        [=](const Vec<D>& x) { return x[D - 1] < 0.5 + slope * (x[0] - 0.5); });
  hold_everything(m);
  m.problem.loads.gravity = {-9.81 * Vec<D>::Unit(D - 1), {}};
  m.problem.flow.surface_drains = true;
  m.problem.flow.rain = Table{{{0, rate}}};
  m.problem.flow.pace = Table{{{0, pace}}};
  begin<D>(
      m, [&](const Vec<D>& x) { return pressure.value_or(weight * (1 - x[D - 1])); },
      pressure ? Vec<D>(Vec<D>::Zero()) : Vec<D>(-weight * Vec<D>::Unit(D - 1)));
  make_steps(m, steps, dt);
  const FlowLedger& flow = m.state.flow;
  EXPECT_NEAR(flow.defect(), 0, 1e-5 * (flow.inflow + std::abs(flow.drained) + std::abs(flow.stored)));
  return flow;
}

TEST(Rain, FallsOnTheHorizontalAreaOfASurfaceThatCutsCells)
{
  const Real fallen = rate * dt * steps;
  EXPECT_NEAR(rained_on<2>(0.3, -5e3, 1).inflow, fallen, 0.05 * fallen);
  EXPECT_NEAR(rained_on<2>(0.3, -5e3, 3).inflow, 3 * fallen, 0.15 * fallen);
  EXPECT_NEAR(rained_on<3>(0.3, -5e3, 1).inflow, fallen, 0.05 * fallen);
}

TEST(Rain, RunsOffWherePoresAreFull)
{
  const FlowLedger full = rained_on<2>(0, {}, 1);
  EXPECT_LT(full.inflow, 0.3 * rate * dt * steps);  // a pressure of zero less rounding errors takes rain up for one step
  EXPECT_GT(full.drained, 0);
}

TEST(OpenWater, PressesWithTheDepthBelowItsLevel)
{
  MeshTraction<2> load;
  load.unit_weight = weight, load.level = Table{{{0, 2}, {1, 1}}}, load.height = {0.5, 1.5};
  EXPECT_DOUBLE_EQ(load.pressure_at(0, 0), 1.5 * weight);
  EXPECT_DOUBLE_EQ(load.pressure_at(1, 0), 0.5 * weight);
  EXPECT_DOUBLE_EQ(load.pressure_at(1, 1), 0);
}

}  // namespace
}  // namespace talus::rain_test
