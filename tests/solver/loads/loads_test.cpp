// Loads on particles and on facets of the mesh, by the formulas of each force, its moment and its work.
#include "solver/loads/loads.hpp"

#include <gtest/gtest.h>

#include "tests/solver/blocks_of_particles.hpp"

namespace talus::testing::loads_test {
namespace {

constexpr Real rounding = 1e-12;

Table growing()
{
  Table table;
  table.points = {{0, 0}, {10, 10}};
  return table;
}

/// The unit square, two by two, full of particles.
Model<2> square(int per_cell = 3)
{
  auto m = make_model<Linear<2>>(Mesh<2>(box<2>(Vec<2>::Zero(), Vec<2>::Ones(), {2, 2})));
  add_body<2>(m, "square", rubber(1e5, 0.3, 1000), per_cell, [](const Vec<2>&) { return true; });
  return m;
}

/// The forces of loads on all particles at a time, into their column; the sum.
ForceAndMoment<2> find_all_forces(Model<2>& m, Real time, Real ramp)
{
  begin_sweeps(m);
  ParticleLoadSums<2> total;
  for_each_strip(*m.work.strips, [&](const StripColumns<2>& all, std::size_t n) {
    find_forces(m.problem.loads, time, ramp, m.work.carriers, all, n);
    total.add_forces(all, n);
  });
  end_sweeps(m);
  return total.force;
}

void expect_near(const Vec<2>& a, const Vec<2>& b) { EXPECT_LT((a - b).norm(), rounding) << a.transpose() << " is not " << b.transpose(); }

Real turning(const Vec<2>& x, const Vec<2>& f) { return x[0] * f[1] - x[1] * f[0]; }

TEST(Loads, GravityIsScaledByItsTableAndTheRamp)
{
  const Gravity<2> gravity{{3, -8}, growing()};
  EXPECT_EQ(gravity(4, 0.25), (Vec<2>(3, -8)));
  EXPECT_EQ(gravity(8, 0.25), (Vec<2>(6, -16)));
}

TEST(Loads, AreOnParticlesIfTheyAreOfPlaceOrCarried)
{
  Loads<2> loads;
  EXPECT_FALSE(loads.any_on_particles());
  loads.on_mesh.emplace_back();
  EXPECT_FALSE(loads.any_on_particles());
  loads.on_particles.emplace_back();
  EXPECT_TRUE(loads.any_on_particles());
  loads.of_place.emplace_back();
  EXPECT_TRUE(loads.any_on_particles());
  loads.on_particles.clear();
  EXPECT_TRUE(loads.any_on_particles());
}

/// Areas go to the particles behind each facet alike; a traction acts per initial area, a pressure on the surface as it is by Nanson's formula.
TEST(Loads, CarriedTractionsFollowTheDeformationOfTheirParticles)
{
  auto m = square();
  ParticleTraction<2> carried = carried_by_particles(m.problem.mesh, *m.problem.mesh.facet_set("y_max"), m.state.particles);
  ASSERT_EQ(carried.id.size(), 6u) << "three in each of the two cells below";
  for (const Vec<2>& area : carried.area)
    expect_near(area, {0, 0.5 / 3});
  carried.traction = {7, 5}, carried.pressure = 11, carried.table = growing();
  m.problem.loads.on_particles.push_back(carried);
  make_ready(m);
  Mat3 F = Mat3::Identity();
  F.topLeftCorner<2, 2>() << 1.5, 0.25, 0.5, 2;
  set_each(m.state.particles.F, [&](std::size_t) { return F; });
  const ForceAndMoment<2> sum = find_all_forces(m, 4.0, 0.5);

  const Vec<2> surface(-0.5 * 0.5 / 3, 1.5 * 0.5 / 3);  // across (1.5, 0.5), what a tangent becomes
  const Vec<2> force = 0.5 * 4 * (0.5 / 3 * Vec<2>(7, 5) - 11 * surface);
  Vec<2> linear = Vec<2>::Zero();
  Real angular = 0, sizes = 0;
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p) {
    const bool carries = std::find(carried.id.begin(), carried.id.end(), m.state.particles.id[p]) != carried.id.end();
    const Vec<2> here = carries ? force : Vec<2>(0, 0);
    expect_near(m.state.particles.applied[p], here);
    linear += here, angular += turning(m.state.particles.x[p], here), sizes += here.norm();
  }
  expect_near(sum.linear, linear);
  EXPECT_NEAR(sum.angular[2], angular, rounding);
  EXPECT_NEAR(sum.size, sizes, rounding);

  // what is moved works, against where it was
  const Vec<2> way(0.01, -0.03);
  begin_sweeps(m);
  ParticleLoadSums<2> sums;
  for_each_strip(*m.work.strips, [&](const StripColumns<2>& all, std::size_t n) {
    find_forces(m.problem.loads, 4.0, 0.5, m.work.carriers, all, n);
    for (std::size_t i = 0; i < n; ++i)
      all.before.set(i, all.x.of(i)), all.x.set(i, all.x.of(i) + way);
    sums.add_work(all, n);
  });
  EXPECT_NEAR(sums.work, 6 * force.dot(way), rounding);
}

TEST(Loads, TwoTractionsOfOneParticleAddUp)
{
  auto m = square();
  for (int times = 0; times < 2; ++times) {
    m.problem.loads.on_particles.push_back(carried_by_particles(m.problem.mesh, *m.problem.mesh.facet_set("y_max"), m.state.particles));
    m.problem.loads.on_particles.back().traction = {0, times + 1.0};
  }
  make_ready(m);
  expect_near(find_all_forces(m, 0.0, 1.0).linear, {0, 3});
}

/// At places that are not those of the start.
TEST(Loads, ForcesOfPlaceAreTheMassTimesTheAccelerationThere)
{
  for (const bool at_start : {false, true}) {
    auto m = make_model<Linear<2>>(unit_box<2>(10, 0));
    add_body<2>(m, "square", rubber(1e5, 0.3, 1000), 3, [](const Vec<2>&) { return true; });
    const auto acceleration = [](const Vec<2>& x, Real time) { return Vec<2>(x[1] * time, 2 - x[0]); };
    BodyForce<2> of_place;
    of_place.at_start = at_start;
    of_place.acceleration = [&](std::span<const Vec<2>> places, Real time, std::span<Vec<2>> accelerations) {
      EXPECT_LE(places.size(), 64u);
      for (std::size_t i = 0; i < places.size(); ++i)
        accelerations[i] = acceleration(places[i], time);
    };
    m.problem.loads.of_place = {of_place, of_place};
    if (at_start)
      m.state.particles.x0 = m.state.particles.x;
    make_ready(m);
    const std::vector<Vec<2>> start = m.state.particles.x.values();
    ASSERT_EQ(start.size(), 600u);
    for (std::size_t p = 0; p < m.state.particles.x.size(); ++p)
      m.state.particles.x.set(p, m.state.particles.x[p] + Vec<2>(0.01, 0.02));
    const Vec<2> total = find_all_forces(m, 3.0, 0.5).linear;
    Vec<2> sum = Vec<2>::Zero();
    for (std::size_t p = 0; p < start.size(); ++p) {
      const Vec<2> place = at_start ? start[p] : Vec<2>(m.state.particles.x[p]);
      const Vec<2> force = 2 * 0.5 * m.state.particles.mass[p] * acceleration(place, 3);  // of two such loads
      expect_near(m.state.particles.applied[p], force);
      sum += force;
    }
    EXPECT_LT((total - sum).norm(), 1e-9);
  }
}

TEST(Loads, TractionsOfTheMeshPushNodesThatHaveMassAndWorkAtTheirMeanVelocity)
{
  const Mesh<2> mesh(box<2>(Vec<2>::Zero(), Vec<2>::Ones(), {2, 2}));
  Loads<2> loads;
  loads.on_mesh.push_back(carried_by_mesh(mesh, *mesh.facet_set("y_max")));
  MeshTraction<2>& load = loads.on_mesh.front();
  ASSERT_EQ(load.node.size(), 3u);
  EXPECT_TRUE(std::is_sorted(load.node.begin(), load.node.end()));
  for (std::size_t k = 0; k < 3; ++k) {
    const Real x = mesh.node(load.node[k])[0], share = x > 0 && x < 1 ? 0.5 : 0.25;
    expect_near(load.area[k], {0, share});
    EXPECT_NEAR(load.measure[k], share, rounding);
  }
  load.traction = {7, 5}, load.pressure = 11, load.table = growing();
  const auto force = [&](std::size_t k) { return Vec<2>(0.5 * 4 * (load.measure[k] * Vec<2>(7, 5) - 11 * load.area[k])); };

  const OwnNodes own = all_nodes(mesh);
  Nodes<2> nodes;
  nodes.sum.resize(static_cast<std::size_t>(mesh.n_nodes()));
  nodes.motion.resize(nodes.sum.size());
  nodes.kick = 0.25;
  ForceAndMoment<2> expected;
  Real work = 0;
  for (std::size_t k = 0; k < 2; ++k) {  // the last one has no mass
    const auto n = static_cast<std::size_t>(load.node[k]);
    nodes.sum[n].mass = 3;
    nodes.sum[n].force = {100, 200};
    nodes.motion[n] = {Vec<2>(2, 3 + static_cast<Real>(k)), Vec<2>(1, -4)};
    expected += ForceAndMoment<2>::at(mesh.node(load.node[k]), force(k));
    work += 0.25 * force(k).dot(Vec<2>(1.5, 5 + static_cast<Real>(k)));  // between (1, 7 + k) and (2, 3 + k)
  }
  ExactSums<ForceAndMoment<2>> total;
  apply(loads, 4.0, 0.5, mesh, own, std::span(nodes.sum), total);
  for (std::size_t k = 0; k < 3; ++k)
    expect_near(nodes.sum[static_cast<std::size_t>(load.node[k])].force, k < 2 ? Vec<2>(Vec<2>(100, 200) + force(k)) : Vec<2>(0, 0));
  expect_near(total.value().linear, expected.linear);
  EXPECT_NEAR(total.value().angular[2], expected.angular[2], rounding);

  ExactSums<Real> done;
  add_work(loads, 4.0, 0.5, own, nodes, done);
  EXPECT_NEAR(done.value(), work, rounding);

  // nodes of another rank are pushed here too, and counted there
  OwnNodes others = own;
  others.owned.assign(others.owned.size(), 0);
  ExactSums<ForceAndMoment<2>> nothing;
  ExactSums<Real> no_work;
  const Vec<2> before = nodes.sum[static_cast<std::size_t>(load.node[0])].force;
  apply(loads, 4.0, 0.5, mesh, others, std::span(nodes.sum), nothing);
  add_work(loads, 4.0, 0.5, others, nodes, no_work);
  expect_near(nodes.sum[static_cast<std::size_t>(load.node[0])].force, before + force(0));
  EXPECT_EQ(nothing.value().size, 0);
  EXPECT_EQ(no_work.value(), 0);
}

}  // namespace
}  // namespace talus::testing::loads_test
