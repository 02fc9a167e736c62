// Order by cell, exits, initial stress, loads.
#include <gtest/gtest.h>

#include "tests/solver/blocks_of_particles.hpp"

namespace talus::testing::nodes_test {
namespace {

TEST(CellOrder, SortsByBodyCellAndIdWhateverTheRowsAre)
{
  const std::vector<Index> cell{3, 1, 3, 0, 2, 2, 200, 2};
  const std::vector<std::int64_t> id{7, 6, 5, 4, 3, 2, 1, 0};
  const std::vector<Body> bodies{{"a", 0, 3, {}}, {"b", 3, 8, {}}};
  CellOrder order;
  sort_by_cell(cell, id, bodies, 300, order);
  EXPECT_EQ(order.row, (std::vector<Index>{1, 2, 0, 3, 7, 5, 4, 6}));
  EXPECT_EQ(order.blocks, 3);
  EXPECT_EQ(order.rows(order.key(0, 0)).size(), 3U);
  EXPECT_EQ(order.rows(order.key(1, 0)).size(), 4U);
  EXPECT_EQ(order.rows(order.key(1, 1)).size(), 1U);
  EXPECT_EQ(order.rows(order.key(1, 2)).size(), 0U);
}

/// A block that flies to the right, out of the mesh.
Model<2> leaving(OnExit policy, bool wall)
{
  auto m = make_model<Linear<2>>(unit_box<2>(6, 0.1));
  m.problem.exits.policy = policy;
  add_body<2>(
      m, "block", rubber(100, 0.3, 1000), 3, [](const Vec<2>& x) { return x[0] > 0.6; }, [](const Vec<2>&) { return Vec<2>(2, 0); });
  if (wall)
    close_off(m, "x_max", Roller<2>{});
  make_ready(m);
  return m;
}

TEST(Exits, StopNamesTheParticleTheBodyAndThePlace)
{
  auto m = leaving(OnExit::stop, false);
  try {
    run_until(m, 0.3);
    FAIL() << "the block has left the mesh";
  } catch (const RunError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("of \"block\" at ("), std::string::npos) << text;
    EXPECT_NE(text.find("is outside the mesh"), std::string::npos) << text;
    EXPECT_EQ(text.find("step "), 0U) << text;
  }
}

TEST(Exits, DeleteKeepsAccountOfTheMass)
{
  auto m = leaving(OnExit::remove, false);
  const Index before = m.state.particles.size();
  run_until(m, 0.3);
  EXPECT_GT(m.state.mass.deleted_count, 5);
  EXPECT_EQ(m.state.particles.size() + m.state.mass.deleted_count, before);
  EXPECT_NEAR(totals(m).mass + m.state.mass.deleted, m.state.mass.start, 1e-12 * m.state.mass.start);
}

TEST(Exits, AClosedWallKeepsParticlesIn)
{
  auto m = leaving(OnExit::stop, true);
  m.state.particles.x.set(0, {1 + 1e-4, 0.5});  // as weights off the wall may carry it
  advance(m, 1e-4);
  EXPECT_FALSE(m.work.errors.worst());
  EXPECT_EQ(m.state.mass.held_count, 1);
  EXPECT_NEAR(m.state.mass.largest_set_back, 1e-4, 1e-8);
}

TEST(InitialStress, CarriesTheWeightAbove)
{
  auto m = make_model<Linear<2>>(unit_box<2>(8, 0.2));
  LinearElastic soil;
  soil.density = 2000;
  soil.youngs_modulus = 1e6;
  soil.poisson_ratio = 0.3;
  add_body<2>(m, "soil", soil, 3, [](const Vec<2>&) { return true; });
  make_ready(m);
  set_start_stress<2>(m.problem.mesh, m.problem.subdomain, *m.problem.ranks, {0, -10}, std::vector{StartStress{.k0 = {{{0, 0.5}}}}},
                      m.work.order, m.state.bodies, m.state.materials, m.state.particles);
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p) {
    const Real weight = 2000 * 10 * (1 - m.state.particles.x[p][1]);
    EXPECT_NEAR(m.state.particles.stress[p][1], -weight, 1e-9 * 2e4);
    EXPECT_NEAR(m.state.particles.stress[p][0], -0.5 * weight, 1e-9 * 2e4);
    EXPECT_NEAR(m.state.particles.stress[p][2], -0.5 * weight, 1e-9 * 2e4);
  }
}

/// A column under traction on its top ends with that stress everywhere, whoever carries the load.
template <class Put>
void squeeze(Put&& put)
{
  auto m = make_model<Umls<2>>(Mesh<2>(jittered(box<2>({0, 0}, {1, 2}, {4, 8}), 0.15, 1)));
  add_body<2>(m, "column", rubber(1e5, 0.0, 1000), 3, [](const Vec<2>& x) { return x[1] < 1.5; });
  for (const char* side : {"x_min", "x_max", "y_min"})
    close_off(m, side, Roller<2>{});
  put(m);
  make_ready(m);
  Stage rest = test_stage(10);
  rest.damping = 0.7;
  rest.ramp = 0.2;
  m.state.stage.damping = 0.7;
  run_stage(m, rest, StepLimits{.cfl = 0.5}, [](const auto&, RunEvent) {});
  Real mean = 0, n = 0;
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p)
    if (m.state.particles.x[p][1] < 0.8) {
      mean += m.state.particles.stress[p][1];
      n += 1;
    }
  EXPECT_NEAR(mean / n, -1000, 10);
  EXPECT_GT(m.state.energy.loads, 0);
}

TEST(Loads, PressureOnParticlesIsTheStressBelow)
{
  squeeze([](auto& m) {
    std::vector<Facet> top;  // upper faces of the cells that hold the column's top
    for (Index c = 0; c < m.problem.mesh.n_cells(); ++c)
      for (Index k = 0; k < 3; ++k) {
        const Facet f{c, k};
        const auto nodes = m.problem.mesh.nodes_of(f);
        if (std::abs(m.problem.mesh.node(nodes[0])[1] - 1.5) < 0.06 && std::abs(m.problem.mesh.node(nodes[1])[1] - 1.5) < 0.06 &&
            m.problem.mesh.area_vector(f)[1] > 0)
          top.push_back(f);
      }
    ASSERT_EQ(top.size(), 4U);
    auto load = carried_by_particles<2>(m.problem.mesh, top, m.state.particles);
    load.pressure = 1000;
    m.problem.loads.on_particles.push_back(load);
  });
}

}  // namespace
}  // namespace talus::testing::nodes_test
