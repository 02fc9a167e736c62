// Blocks that fall onto walls with gaps: when they feel them, and where.
#include <gtest/gtest.h>

#include "solver/strips/particles_in_cell.hpp"
#include "tests/solver/contact_kinds.hpp"

namespace talus::testing::wall_gaps_test {
namespace {

template <class S>
class WallGapsIn : public ::testing::Test {};
TYPED_TEST_SUITE(WallGapsIn, ContactKinds);

constexpr Real stiffness = 1e5, speed = 0.5, dt = 1e-3;

/// A box with a floor, and blocks that fall with `speed`: one that ends 1.75 cells above the floor, and if there are two fields another one
/// beside it that ends one cell higher.
template <class S>
Model<S::D> blocks_over_floor(bool gap, Index n_fields = 1)
{
  constexpr int D = S::D;
  constexpr Index n = D == 2 ? 16 : 8;
  auto m = make_model<typename S::Kernel>(unit_box<D>(n, 0.2));
  m.problem.transfer = {.scheme = Scheme::flip, .musl = true, .pic_damping_time = {}, .pic_damping_crossings = {}};
  const Real low = 1.75 / n;
  const auto falls = [](const Vec<D>&) { return along<D>(D - 1, -speed); };
  const auto within = [](Real from, const Vec<D>& x) {
    return x[D - 1] > from && x[D - 1] < from + 0.4 && (x.template head<D - 1>().array() - 0.5).abs().maxCoeff() < 0.35;
  };
  const auto law = rubber(stiffness, 0.3, 1000);
  add_body<D>(
      m, "left", law, 4, [&](const Vec<D>& x) { return within(low, x) && (n_fields == 1 || x[0] < 0.4); }, falls);
  if (n_fields == 2) {
    add_body<D>(
        m, "right", law, 4, [&](const Vec<D>& x) { return within(low + 1.0 / n, x) && x[0] > 0.6; }, falls);
    m.problem.contacts = {.field_of_body = {0, 1},
                          .n_fields = 2,
                          .laws = {{.first = 0, .second = 1, .friction = 0, .first_body = "left", .second_body = "right"}}};
  }
  const Mesh<D>& mesh = m.problem.mesh;
  m.state.boundary.add({.name = "floor", .kind = Friction<D>{0.3, gap}}, mesh,
                       std::span<const Facet>(*mesh.facet_set(D == 2 ? "y_min" : "z_min")));
  make_ready(m);
  return m;
}

/// The lowest point of the particles of a body, each with its half width [m].
template <int D>
Real lowest(const Model<D>& m, std::size_t body)
{
  Real low = 1;
  const auto& p = m.state.particles;
  for (Index i = m.state.bodies[body].begin; i < m.state.bodies[body].end; ++i) {
    const auto k = static_cast<std::size_t>(i);
    low = std::min(low, p.x[k][D - 1] - half_width<D>(p.F[k], p.volume0[k], along<D>(D - 1, 1)));
  }
  return low;
}

/// Steps until the floor has pushed; then how high the lowest point of the first body was [cells].
template <class S>
Real height_of_touch(bool gap)
{
  constexpr int D = S::D;
  auto m = blocks_over_floor<S>(gap);
  for (int step = 0; step < 400; ++step) {
    const Real height = lowest(m, 0);
    advance(m, dt);
    if (m.state.boundary.conditions()[0].impulse[D - 1] > 0)
      return height * (D == 2 ? 16 : 8);
  }
  ADD_FAILURE() << "it never touched";
  return 0;
}

TYPED_TEST(WallGapsIn, ABlockFeelsTheFloorWhereItTouchesIt)
{
  EXPECT_NEAR(height_of_touch<TypeParam>(true), 0, 0.02) << "cells";
  EXPECT_GT(height_of_touch<TypeParam>(false), 0.3) << "cells, at nodes with mass";
}

TYPED_TEST(WallGapsIn, ItIsHeldThereAndLosesItsVelocity)
{
  constexpr int D = TypeParam::D;
  auto m = blocks_over_floor<TypeParam>(true);
  const Real mass = totals(m).mass, size = 1.0 / (D == 2 ? 16 : 8);
  Real lowest_ever = 1;
  for (int step = 0; step < 400; ++step) {
    advance(m, dt);
    lowest_ever = std::min(lowest_ever, lowest(m, 0));
  }
  EXPECT_GT(lowest_ever, -0.2 * size);
  EXPECT_NEAR(m.state.boundary.conditions()[0].impulse[D - 1], totals(m).momentum[D - 1] + mass * speed, 1e-9 * mass);
  EXPECT_GT(totals(m).momentum[D - 1], -0.1 * mass * speed) << "it rests or rebounds";
}

TYPED_TEST(WallGapsIn, OneFieldMayTouchWhereAnotherDoesNot)
{
  constexpr int D = TypeParam::D;
  auto m = blocks_over_floor<TypeParam>(true, 2);
  for (int step = 0; step < 400 && lowest(m, 0) > 0; ++step)
    advance(m, dt);
  advance(m, dt), advance(m, dt);
  std::array<int, 2> touched{};
  for (const auto& plane : m.state.boundary.gap_planes())
    for (std::size_t f = 0; f < 2; ++f)
      touched[f] += m.work.fields[f].nodes.of_field(plane.node).open == 0 ? 1 : 0;
  EXPECT_GT(touched[0], 0);
  EXPECT_EQ(touched[1], 0);
  Real fastest = 0;
  const Body& right = m.state.bodies[1];
  for (Index i = right.begin; i < right.end; ++i)
    fastest = std::max(fastest, (m.state.particles.v[static_cast<std::size_t>(i)] - along<D>(D - 1, -speed)).norm());
  EXPECT_LT(fastest, 1e-12) << "it still falls";
}

}  // namespace
}  // namespace talus::testing::wall_gaps_test
