// At which time each quantity of a step stands: a step is a leap-frog, whose loads act at the time of places and stress.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/solver/blocks_of_particles.hpp"

namespace talus::testing::time_levels_test {
namespace {

using Bar = Model<2>;
constexpr Real end = 0.05;     // [s]
constexpr Real w = 4.4 / end;  // of what swells [1/s]; over a whole period the errors of equal steps would cancel

/// A block of rubber, 1/2 m wide and 1/2 m high, in the middle of a square; it keeps what it gets.
Bar floating_block()
{
  Bar m = make_model<Linear<2>>(unit_box<2>(8, 0));
  m.problem.transfer = {.scheme = Scheme::flip, .musl = false, .pic_damping_time = {}, .pic_damping_crossings = {}};
  add_body<2>(m, "block", rubber(1e5, 0.3, 1000), 3, [](const Vec<2>& x) { return (x.array() > 0.25).all() && (x.array() < 0.75).all(); });
  return m;
}

/// 1 + sin(w t) in so many straight lines that its own error is below that of the steps.
Table swelling()
{
  Table table;
  constexpr int lines = 4000;
  for (int k = -lines / 4; k <= 5 * lines / 4; ++k) {
    const Real t = end * k / lines;
    table.points.push_back({t, 1 + std::sin(w * t)});
  }
  return table;
}
Real integral_of_swelling(Real t) { return t + (1 - std::cos(w * t)) / w; }
Real second_integral_of_swelling(Real t) { return t * t / 2 + t / w - std::sin(w * t) / (w * w); }

Vec<2> centre(const Bar& m)
{
  const auto sums = totals(m);
  return sums.centre / sums.mass;
}

/// How far the centre of mass moves along x in equal steps.
template <class SetUp>
Real way(int steps, const SetUp& set_up)
{
  Bar m = floating_block();
  set_up(m);
  make_ready(m);
  const Real from = centre(m)[0];
  for (int k = 0; k < steps; ++k)
    advance(m, end / steps);
  EXPECT_FALSE(m.work.errors.worst());
  return centre(m)[0] - from;
}

struct Case {
  std::string name;
  std::function<void(Bar&)> set_up;
  Real exact;  ///< [m]
};
class TimeLevels : public ::testing::TestWithParam<Case> {};

/// With half the step a quarter of the error is left.  Loads that act one step early, and a first step in which they act as long as
/// in the others, leave a half.
TEST_P(TimeLevels, AreSecondOrderInTheStep)
{
  const Case& one = GetParam();
  const Real coarse = std::abs(way(10, one.set_up) - one.exact), fine = std::abs(way(20, one.set_up) - one.exact);
  EXPECT_LT(coarse, 0.05 * one.exact);
  EXPECT_GT(coarse, 1e-9 * one.exact) << "there must be an error for this to mean anything";
  EXPECT_GT(std::log2(coarse / fine), 1.9) << coarse << " " << fine;
}

constexpr Real pull = 4;  // [m/s^2], of all cases

/// Tractions on a surface of 1/2 m that give 1/4 m^2 of 1000 kg/m^2 this acceleration.
const Vec<2> traction = Vec<2>(pull * 1000 / 2, 0);

void load_particles(Bar& m)  // of the rightmost column of cells
{
  ParticleTraction<2> load;
  load.traction = traction, load.table = swelling();
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p)
    if (m.state.particles.x[p][0] > 0.625)
      load.id.push_back(m.state.particles.id[p]);
  load.area.assign(load.id.size(), Vec<2>(0.5 / static_cast<Real>(load.id.size()), 0));
  m.problem.loads.on_particles.push_back(load);
}

void load_mesh(Bar& m)
{
  MeshTraction<2> load;
  load.traction = traction, load.table = swelling();
  for (Index n = 0; n < m.problem.mesh.n_nodes(); ++n)
    if (std::abs(m.problem.mesh.node(n)[0] - 0.625) < 1e-9 && std::abs(m.problem.mesh.node(n)[1] - 0.5) < 0.2)
      load.node.push_back(n);
  load.area.assign(load.node.size(), Vec<2>::Zero());
  load.measure.assign(load.node.size(), 0.5 / static_cast<Real>(load.node.size()));
  m.problem.loads.on_mesh.push_back(load);
}

void move_all(Bar& m)
{
  std::vector<Index> all(static_cast<std::size_t>(m.problem.mesh.n_nodes()));
  std::iota(all.begin(), all.end(), Index{0});
  m.state.boundary.add({.name = "all", .kind = PrescribedVelocity<2>{{Vec<2>(pull * end, 0), swelling()}}}, m.problem.mesh, all);
}

std::vector<Case> cases()
{
  const Real accelerated = pull * second_integral_of_swelling(end), moved = pull * end * integral_of_swelling(end);
  const auto place = [](std::span<const Vec<2>>, Real t, std::span<Vec<2>> accelerations) {
    std::ranges::fill(accelerations, Vec<2>(pull * (1 + std::sin(w * t)), 0));
  };
  return {{"gravity",
           [](Bar& m) {
             m.problem.loads.gravity = {Vec<2>(pull, 0), swelling()};
           },
           accelerated},
          {"forces_of_place", [place](Bar& m) { m.problem.loads.of_place.push_back({place}); }, accelerated},
          {"tractions_on_particles", load_particles, accelerated},
          {"tractions_on_the_mesh", load_mesh, accelerated},
          {"moving_walls", move_all, moved}};
}

std::string name_of(const ::testing::TestParamInfo<Case>& one) { return one.param.name; }

INSTANTIATE_TEST_SUITE_P(Of, TimeLevels, ::testing::ValuesIn(cases()), name_of);

/// A constant acceleration is integrated exactly, whatever steps are made: the first kick is half a step, each later one the mean of
/// the steps before and after it.
TEST(TimeLevelsOfAStep, ABlockFallsAsItShouldInStepsOfAnyLength)
{
  Bar m = floating_block();
  m.problem.loads.gravity.acceleration = Vec<2>(0, -9.81);
  make_ready(m);
  set_velocity<2>(m, Mat<2>::Zero(), Vec<2>(0.3, 0.2));
  const Vec<2> from = centre(m);
  for (const Real dt : {0.002, 0.001, 0.004, 0.004, 0.0005, 0.003}) {
    advance(m, dt);
    const Real t = m.state.clock.time, then = t - m.state.clock.lag;
    EXPECT_NEAR(centre(m)[0] - from[0], 0.3 * t, 1e-15);
    EXPECT_NEAR(centre(m)[1] - from[1], 0.2 * t - 9.81 / 2 * t * t, 1e-15);
    EXPECT_NEAR(m.state.particles.v[0][1], 0.2 - 9.81 * then, 1e-14) << "velocities are of the middle of the step";
    EXPECT_EQ(m.state.clock.lag, dt / 2);
  }
}

/// In the first step of bodies without stress all work becomes kinetic energy of the nodes, to round-off: of loads, gravity and walls,
/// each with the mean of old and new velocity.
TEST(TimeLevelsOfAStep, WorkOfAStepIsTheKineticEnergyThatComesOfIt)
{
  const auto unaccounted = [](Real EnergyLedger::*term, const std::function<void(Bar&)>& set_up) {
    Bar m = floating_block();
    set_up(m);
    make_ready(m);
    set_velocity<2>(m, Mat<2>::Zero(), Vec<2>(-0.02, 0.01));
    begin_stage(m, test_stage(1), 0);
    advance(m, 0.01);
    EXPECT_GT(std::abs(m.state.energy.*term), 1e-6);
    return std::abs(m.state.energy.*term / m.state.energy.nodes - 1);
  };
  EXPECT_LT(unaccounted(&EnergyLedger::gravity, [](Bar& m) { m.problem.loads.gravity.acceleration = Vec<2>(pull, 1); }), 1e-12);
  EXPECT_LT(unaccounted(&EnergyLedger::loads,
                        [](Bar& m) {
                          MeshTraction<2> load;
                          load.traction = Vec<2>(pull * 1000, 500);
                          for (Index n = 0; n < m.problem.mesh.n_nodes(); ++n)
                            if (std::abs(m.problem.mesh.node(n)[0] - 0.625) < 1e-9)
                              load.node.push_back(n);
                          load.area.assign(load.node.size(), Vec<2>::Zero());
                          load.measure.assign(load.node.size(), 0.1);
                          m.problem.loads.on_mesh.push_back(load);
                        }),
            1e-12);
  EXPECT_LT(unaccounted(&EnergyLedger::walls,
                        [](Bar& m) {
                          std::vector<Index> some;
                          for (Index n = 0; n < m.problem.mesh.n_nodes(); ++n)
                            if (std::abs(m.problem.mesh.node(n)[0] - 0.375) < 1e-9 && std::abs(m.problem.mesh.node(n)[1] - 0.5) < 0.2)
                              some.push_back(n);
                          m.state.boundary.add({.name = "some", .kind = PrescribedVelocity<2>{{Vec<2>(0.5, 0.1)}}}, m.problem.mesh, some);
                        }),
            1e-12);
}

}  // namespace
}  // namespace talus::testing::time_levels_test
