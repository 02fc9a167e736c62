// Water that flows through pores: closed forms of consolidation and seepage, what must be kept, and water that is nearly incompressible.
#include <numbers>

#include "solver/model/seepage.hpp"
#include "solver/run_view.hpp"
#include "tests/solver/flow/saturated_soil.hpp"

namespace talus::pore_pressure_test {
namespace {

using namespace saturated_soil;
using std::numbers::pi;
using testing::close_off;

/// Water of a first mode that drains to one side of soil that cannot move.
template <int D>
Real error_of_draining(Index cells, Real jitter)
{
  const FlowOfBody soil = pores(1e-3, 1e6);
  const Real diffusivity = soil.permeability / weight * soil.bulk_modulus / soil.porosity, end = 0.2 / diffusivity;
  auto m = saturated<D>(unit_box<D>(cells, jitter), soil, everywhere<D>);
  hold_everything(m);
  m.problem.flow.heads.push_back({"x_min", nodes_on(m.problem.mesh, "x_min"), true, {}});
  const auto mode = [&](Real t) {
    return [=](const Vec<D>& x) { return 1000 * std::sin(pi / 2 * x[0]) * std::exp(-pi * pi / 4 * diffusivity * t); };
  };
  begin<D>(m, mode(0), Vec<D>::Zero());
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p)
    m.state.particles.water_gradient.set(p, 1000 * pi / 2 * std::cos(pi / 2 * m.state.particles.x[p][0]) * Vec<D>::Unit(0));
  const int steps = D == 2 ? static_cast<int>(cells * cells) * 3 : 50;
  make_steps(m, steps, end / steps);
  return rms(m, mode(end)) / 1000;
}

TEST(PorePressure, DrainsAsTheClosedFormSaysWithSecondOrder)
{
  for (const Real jitter : {0.0, 0.2}) {
    const Real coarse = error_of_draining<2>(4, jitter), fine = error_of_draining<2>(8, jitter);
    EXPECT_LT(fine, 5e-3) << jitter;
    EXPECT_GT(std::log2(coarse / fine), 1.6) << jitter;
  }
  EXPECT_LT(error_of_draining<3>(3, 0.2), 0.03);
}

template <int D>
void rests_below_its_level()
{
  auto m = saturated<D>(unit_box<D>(D == 2 ? 8 : 4, 0.2), pores(1e-2, 1e8), everywhere<D>);
  hold_everything(m);
  m.problem.loads.gravity = {-9.81 * Vec<D>::Unit(D - 1), {}};
  m.problem.flow.heads.push_back({"x_min", nodes_on(m.problem.mesh, "x_min"), false, {{{0, 1.5}}}});
  const auto at_rest = [](const Vec<D>& x) { return weight * (1.5 - x[D - 1]); };
  begin<D>(m, at_rest, -weight * Vec<D>::Unit(D - 1));
  make_steps(m, 20, 1e-3);
  EXPECT_LT(rms(m, at_rest), 1e-8 * weight);
  EXPECT_NEAR(m.state.flow.drained, 0, 1e-14);
  EXPECT_NEAR(m.state.flow.seepage, 0, 1e-9);
}

TEST(PorePressure, OfWaterAtRestStays)
{
  rests_below_its_level<2>();
  rests_below_its_level<3>();
}

TEST(PorePressure, FeelsForcesOfPlaceAsGravity)
{
  auto m = saturated<2>(unit_box<2>(8, 0.2), pores(1e-2, 1e8), everywhere<2>);
  hold_everything(m);
  m.problem.loads.of_place.push_back({.acceleration = [](std::span<const Vec<2>> places, Real, std::span<Vec<2>> accelerations) {
    for (std::size_t k = 0; k < places.size(); ++k)
      accelerations[k] = {0, -9.81};
  }});
  m.problem.flow.heads.push_back({"y_max", nodes_on(m.problem.mesh, "y_max"), true, {}});
  const auto at_rest = [](const Vec<2>& x) { return weight * (1 - x[1]); };
  begin<2>(m, at_rest, -weight * Vec<2>::Unit(1));
  make_steps(m, 20, 1e-3);
  EXPECT_LT(rms(m, at_rest), 1e-8 * weight);
  EXPECT_NEAR(m.state.flow.drained, 0, 1e-14);
  EXPECT_NEAR(m.state.flow.seepage, 0, 1e-9);
  EXPECT_LT(seepage_velocity(m.problem, m.state, 5).norm(), 1e-10);
}

TEST(PorePressure, FallsAlongTheFlowAsDarcySays)
{
  constexpr Real rate = 1e-4;
  const FlowOfBody soil = pores(1e-3, 1e6);
  auto m = saturated<2>(unit_box<2>(8, 0.2), soil, everywhere<2>);
  hold_everything(m);
  const auto in = nodes_on(m.problem.mesh, "x_max");
  const auto shares = carried_by_mesh<2>(m.problem.mesh, *m.problem.mesh.facet_set("x_max"));
  m.problem.flow.inflows.push_back({"x_max", shares.node, shares.measure, {{{0, rate}}}});
  m.problem.flow.heads.push_back({"x_min", nodes_on(m.problem.mesh, "x_min"), true, {}});
  begin<2>(
      m, [](const Vec<2>&) { return 0; }, Vec<2>::Zero());
  make_steps(m, 200, 1);
  const Real slope = rate * weight / soil.permeability, before = m.state.flow.drained;
  EXPECT_LT(rms(m, [&](const Vec<2>& x) { return slope * x[0]; }), 1e-6 * slope);
  EXPECT_NEAR(m.state.flow.inflow, 200 * rate, 1e-12);
  EXPECT_NEAR(m.state.flow.defect(), 0, 1e-8 * m.state.flow.inflow);
  make_step(m, 1);
  end_sweeps(m);
  EXPECT_NEAR(m.state.flow.drained - before, rate, 1e-8 * rate);
}

TEST(PorePressure, OfRainThatSinksMakesPoresConductWhatFalls)
{
  constexpr Real rate = 2e-4;
  FlowOfBody soil = pores(1e-3, 1e8);
  soil.retention = {.entry = 2e3, .exponent = 2, .residual = 0.1};
  auto m = saturated<2>(unit_box<2>(5, 0.2), soil, everywhere<2>);
  hold_everything(m);
  m.problem.loads.gravity = {Vec<2>(0, -9.81), {}};
  const auto shares = carried_by_mesh<2>(m.problem.mesh, *m.problem.mesh.facet_set("y_max"));
  m.problem.flow.inflows.push_back({"y_max", shares.node, shares.measure, {{{0, rate}}}});
  // k_r(p) = rate / k: gravity alone drives the water
  Real low = -2e4, high = 0;
  for (int i = 0; i < 60; ++i) {
    const Real p = (low + high) / 2;
    (soil.retention.conductance(p) < rate / soil.permeability ? low : high) = p;
  }
  m.problem.flow.heads.push_back({"y_min", nodes_on(m.problem.mesh, "y_min"), true, {}});
  begin<2>(
      m, [&](const Vec<2>&) { return low; }, Vec<2>::Zero());
  constexpr Real dt = 20;
  make_steps(m, 300, dt);
  Real sum = 0, count = 0;
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p)
    if (m.state.particles.x[p][1] > 0.8)
      sum += m.state.particles.water[p], ++count;
  EXPECT_NEAR(sum / count, low, 0.03 * std::abs(low));
  EXPECT_NEAR(m.state.flow.inflow, 300 * dt * rate, 1e-9);
  const Real drained = m.state.flow.drained;
  make_steps(m, 100, dt);
  EXPECT_NEAR(m.state.flow.drained - drained, 100 * dt * rate, 0.02 * 100 * dt * rate);
}

TEST(PorePressure, LetsNoWaterInThroughADrySurface)
{
  FlowOfBody soil = pores(1e-2, 1e8);
  soil.retention = {.entry = 5e3, .exponent = 3, .residual = 0};
  auto m = saturated<2>(unit_box<2>(8, 0.2), soil, [](const Vec<2>& x) { return x[1] < 0.75; });
  hold_everything(m);
  m.problem.flow.surface_drains = true;
  m.problem.loads.gravity = {Vec<2>(0, -9.81), {}};
  begin<2>(
      m, [](const Vec<2>& x) { return weight * (0.3 - x[1]); }, Vec<2>(0, -weight));
  make_steps(m, 100, 1);
  EXPECT_LT(rms(m, [](const Vec<2>& x) { return weight * (0.3 - x[1]); }), 1e-6 * weight);
  EXPECT_NEAR(m.state.flow.drained, 0, 1e-12);
}

/// Full pores without pressure, whose foot is opened: storage begins with zero, and all the same no water may vanish.
template <int D>
void loses_what_leaves(Real jitter)
{
  FlowOfBody soil = pores(1e-2, 1e9);
  soil.retention = {2e3, 2, 0.2};
  auto m = saturated<D>(unit_box<D>(D == 2 ? 8 : 4, jitter), soil, everywhere<D>);
  hold_everything(m);
  m.problem.loads.gravity = {-9.81 * Vec<D>::Unit(D - 1), {}};
  const std::string foot = D == 2 ? "y_min" : "z_min";
  m.problem.flow.heads.push_back({foot, nodes_on(m.problem.mesh, foot), true, {}});
  begin<D>(
      m, [](const Vec<D>&) { return 0; }, Vec<D>::Zero());
  make_steps(m, 40, 0.05);
  Real lost = 0;
  const auto& particles = m.state.particles;
  for (std::size_t p = 0; p < particles.id.size(); ++p)
    lost += soil.porosity * particles.volume[p] * (1 - soil.retention.saturation(particles.water[p]));
  EXPECT_GT(lost, 0.01);
  EXPECT_NEAR(m.state.flow.drained, lost, 1e-4 * lost);
  EXPECT_NEAR(m.state.flow.stored, -lost, 1e-4 * lost);
  EXPECT_NEAR(m.state.flow.defect(), 0, 1e-6 * lost);
  EXPECT_EQ(m.state.flow.unsettled, 0);
  EXPECT_LT(m.state.flow.total_iterations, 40 * 50);
}

TEST(PorePressure, LosesNoWaterWherePoresBeginToDrain)
{
  loses_what_leaves<2>(0);
  loses_what_leaves<2>(0.2);
  loses_what_leaves<3>(0.2);
}

TEST(Retention, IsVanGenuchtens)
{
  const Retention curve{.entry = 1e4, .exponent = 2, .residual = 0.1};
  EXPECT_EQ(curve.saturation(0), 1);
  EXPECT_EQ(curve.conductance(5), 1);
  EXPECT_NEAR(curve.saturation(-1e4), 0.1 + 0.9 * std::sqrt(0.5), 1e-12);
  const Real p = -1.3e4, h = 1;
  EXPECT_NEAR(curve.capacity(p), (curve.saturation(p + h) - curve.saturation(p - h)) / (2 * h), 1e-10);
  const Real e = curve.effective(p);
  EXPECT_NEAR(curve.conductance(p), std::sqrt(e) * std::pow(1 - std::sqrt(1 - e * e), 2), 1e-12);
}

/// One step of soil that is squeezed evenly: what its pores lose, the water in them takes up.
template <int D, class K>
void is_squeezed()
{
  constexpr Real rate = 0.1, dt = 1e-4, bulk_modulus = 1e5;
  const auto velocity = [](const Vec<D>& x) { return Vec<D>(-rate * x[0] * Vec<D>::Unit(0)); };
  auto m = saturated<D, K>(unit_box<D>(4, 0), pores(1e-3, bulk_modulus), everywhere<D>, velocity);
  m.problem.transfer = {.scheme = Scheme::tpic, .musl = false, .pic_damping_time = {}, .pic_damping_crossings = {}};
  close_off<D>(m, "x_min", Roller<D>{});
  close_off<D>(m, "x_max", PrescribedVelocity<D>{{Vec<D>(-rate * Vec<D>::Unit(0))}});
  for (int d = 1; d < D; ++d)
    for (const char* end : {"_min", "_max"})
      close_off<D>(m, std::string(1, "xyz"[d]) + end, Roller<D>{});
  begin<D>(
      m, [](const Vec<D>&) { return 0; }, Vec<D>::Zero());
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p)
    m.state.particles.L.set(p, -rate * Vec<D>::Unit(0) * Vec<D>::Unit(0).transpose());
  make_step(m, dt);
  end_sweeps(m);
  EXPECT_LT(rms(m, [&](const Vec<D>&) { return bulk_modulus / 0.4 * rate * dt; }), 1e-6 * bulk_modulus * rate * dt);
  EXPECT_NEAR(m.state.flow.squeezed, -rate * dt, 1e-9 * rate * dt);
  // The first kick is half a step; the walls hold what the pressure pushes.
  const Real push = bulk_modulus / 0.4 * rate * dt * dt / 2;
  EXPECT_NEAR(m.state.boundary.conditions()[0].impulse[0], push, 1e-6 * push);
  EXPECT_NEAR(m.state.boundary.conditions()[1].impulse[0], -push, 1e-6 * push);
  EXPECT_NEAR(m.state.flow.defect(), 0, 1e-9 * rate * dt);
}

TEST(PorePressure, GrowsByWhatPoresLose)
{
  is_squeezed<2, Linear<2>>();
  is_squeezed<2, Projected<2>>();
  is_squeezed<3, Projected<3>>();
}

/// Waves in the water of this soil are a thousand times as fast as those that limit its steps.
template <int D, class K>
void swings_undrained(Real permeability, bool surface_drains)
{
  const Index cells = D == 2 ? 8 : 5;
  const auto inside = [](const Vec<D>& x) { return (x - Vec<D>::Constant(0.5)).norm() < 0.35; };
  const auto velocity = [](const Vec<D>& x) { return Vec<D>(2 * (x[0] - 0.5) * Vec<D>::Unit(0) - 0.5 * (x[1] - 0.5) * Vec<D>::Unit(1)); };
  auto m = saturated<D, K>(unit_box<D>(cells, 0.2), pores(permeability, 1e12), inside, velocity);
  m.problem.flow.surface_drains = surface_drains;
  begin<D>(
      m, [](const Vec<D>&) { return 0; }, Vec<D>::Zero());
  const Totals<D> before = totals(m);
  const Real speed = std::sqrt(1.2e6 / 2000), dt = 0.3 / static_cast<Real>(cells) / speed;
  make_steps(m, 80, dt);
  const Totals<D> after = totals(m);
  EXPECT_LT(after.kinetic, before.kinetic);
  EXPECT_LT((after.momentum - before.momentum).norm(), 1e-10 * before.mass);
  const FlowLedger& flow = m.state.flow;
  EXPECT_NEAR(flow.defect(), 0, 1e-8 * (std::abs(flow.squeezed) + std::abs(flow.drained)) + 1e-12);
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p)
    ASSERT_NEAR(m.state.particles.F[p].determinant(), 1, surface_drains ? 0.2 : 0.1);
}

TEST(PorePressure, OfStiffWaterDoesNotLimitTheStep)
{
  for (const Real permeability : {1e-12, 1e-3, 1.0})
    for (const bool surface_drains : {true, false}) {
      swings_undrained<2, Projected<2>>(permeability, surface_drains);
      swings_undrained<2, Umls<2>>(permeability, surface_drains);
      swings_undrained<2, Linear<2>>(permeability, surface_drains);
    }
  swings_undrained<3, Projected<3>>(1e-4, true);
}

/// A box with a linear pressure, too small to move anything, that flies through cells: each particle keeps its pressure.
template <int D>
void flies_with_its_pressure()
{
  const auto inside = [](const Vec<D>& x) { return (x - Vec<D>::Constant(0.3)).cwiseAbs().maxCoeff() < 0.2; };
  const Vec<D> speed = 0.4 * Vec<D>::Ones(), slope = 1e-3 * Vec<D>::Unit(0) - 2e-3 * Vec<D>::Unit(1);
  auto m = saturated<D>(unit_box<D>(D == 2 ? 10 : 6, 0.2), pores(1e-12, 1e3), inside, [&](const Vec<D>&) { return speed; });
  begin<D>(
      m, [&](const Vec<D>& x) { return slope.dot(x); }, slope);
  const int steps = 200;
  make_steps(m, steps, 1.0 / steps);
  EXPECT_LT(rms(m, [&](const Vec<D>& x) { return slope.dot(x - speed); }), 5e-3 * slope.norm());  // the box gives way a little
}

TEST(PorePressure, MovesWithTheMaterial)
{
  flies_with_its_pressure<2>();
  flies_with_its_pressure<3>();
}

/// What conditions held at a stage before must not hold in the next one.
TEST(PorePressure, ForgetsConditionsThatHaveGone)
{
  constexpr Real dt = 1e-4;
  const auto pressures = [](bool was_held) {
    auto m = saturated<2>(unit_box<2>(4, 0.2), pores(1e-3, 1e9), everywhere<2>);
    if (was_held)
      hold_everything(m);
    begin<2>(
        m, [](const Vec<2>&) { return 0; }, Vec<2>::Zero());
    make_steps(m, 1, dt);
    m.state.boundary = {};
    bind_boundary_conditions(m);
    for (std::size_t p = 0; p < m.state.particles.id.size(); ++p)
      m.state.particles.v.set(p, -0.1 * m.state.particles.x[p]);
    make_steps(m, 1, dt);
    return m.state.particles.water.values();
  };
  EXPECT_EQ(pressures(true), pressures(false));
}

/// A part of the upper side is loaded, and no water leaves: pressures must not alternate from node to node far below.
TEST(PorePressure, OfSealedSoilIsSmooth)
{
  auto m = saturated<2>(unit_box<2>(10, 0.2), pores(1e-12, 2e9), everywhere<2>);
  m.problem.transfer = {.scheme = Scheme::tpic, .musl = false, .pic_damping_time = {}, .pic_damping_crossings = {}};
  for (const char* side : {"x_min", "x_max", "y_min"})
    close_off<2>(m, side, Roller<2>{});
  std::vector<Facet> loaded;
  const std::vector<Facet> top = m.problem.mesh.facet_set("y_max").value();
  for (const Facet facet : top)
    if (m.problem.mesh.node(m.problem.mesh.nodes_of(facet)[0])[0] < 0.45)
      loaded.push_back(facet);
  m.problem.loads.on_mesh.push_back(carried_by_mesh<2>(m.problem.mesh, loaded));
  m.problem.loads.on_mesh.back().pressure = 1000;
  begin<2>(
      m, [](const Vec<2>&) { return 0; }, Vec<2>::Zero());
  make_steps(m, 300, 0.3 * 0.1 / std::sqrt(1.2e6 / 2000));
  Real sum = 0, count = 0;
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p)
    if (m.state.particles.x[p][1] < 0.5)
      sum += m.state.particles.water_gradient[p].squaredNorm(), ++count;
  EXPECT_LT(std::sqrt(sum / count), 800) << "Pa/m";  // 462; 3901 without the projection
}

TEST(FlowOfBody, HasPoresThatFollowTheVolume)
{
  FlowOfBody soil = pores(1e-3, 1e9);
  EXPECT_NEAR(soil.porosity_at(1.2), 0.5, 1e-15);
  EXPECT_EQ(soil.permeability_at(0.5), 1e-3);
  soil.follows_pores = true;
  EXPECT_NEAR(soil.permeability_at(soil.porosity), 1e-3, 1e-18);
  EXPECT_NEAR(soil.permeability_at(0.5), 1e-3 * (0.125 / 0.25) / (0.064 / 0.36), 1e-15);
}

}  // namespace
}  // namespace talus::pore_pressure_test
