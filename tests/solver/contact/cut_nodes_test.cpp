// A block that a cut parts: what its sides exchange, and what they do not.
#include <gtest/gtest.h>

#include <limits>

#include "tests/mesh/cut_box.hpp"
#include "tests/solver/contact_kinds.hpp"

namespace talus::testing::cut_nodes_test {
namespace {

template <class S>
class CutIn : public ::testing::Test {};
TYPED_TEST_SUITE(CutIn, ContactKinds);
template <class S>
class TiedIn : public ::testing::Test {};
using OfLinear = ::testing::Types<Kind<2, Linear>, Kind<3, Linear>>;
TYPED_TEST_SUITE(TiedIn, OfLinear);

constexpr Real always = std::numeric_limits<Real>::infinity();

/// A block in the middle of a unit box from side to side, whose lower and upper halves move with velocities of their own.  A cut with this law
/// parts them from x = 0 to `end`, unless there is none.
template <class S>
Model<S::D> box_in_two(const Vec<S::D>& v_low, const Vec<S::D>& v_high, const CutLaw* law, Real end = 1)
{
  constexpr int D = S::D;
  const MeshData<D> data = cut_box<D>(D == 2 ? 8 : 6, end, 0.2);
  auto m = make_model<typename S::Kernel>(law != nullptr ? cut_along(data) : Mesh<D>(data));
  m.problem.transfer = {.scheme = Scheme::flip, .musl = true, .pic_damping_time = {}, .pic_damping_crossings = {}};
  add_body<D>(
      m, "block", rubber(1e4, 0.3, 1000), 4, [](const Vec<D>& x) { return std::abs(x[D - 1] - 0.5) < 0.3; },
      [&](const Vec<D>& x) { return x[D - 1] < 0.5 ? v_low : v_high; });
  if (law != nullptr)
    m.problem.cuts = {*law};
  make_ready(m);
  return m;
}

/// Nodes of small mass move with their hosts and have no contact of their own.
template <int D>
bool both_move(const Model<D>& m, const CutNode<D>& at)
{
  const auto& active = m.work.fields.front().nodes.active;
  return active[static_cast<std::size_t>(at.first)] != 0 && active[static_cast<std::size_t>(at.second)] != 0;
}

TYPED_TEST(TiedIn, ATiedCutIsNone)
{
  constexpr int D = TypeParam::D;
  const Vec<D> down = along<D>(D - 1, -0.2) + along<D>(0, 0.3), up = along<D>(D - 1, 0.1);
  const CutLaw tied{.group = "cut", .tied_until = always};
  auto cut = box_in_two<TypeParam>(down, up, &tied, 0.5), uncut = box_in_two<TypeParam>(down, up, nullptr, 0.5);
  for (int step = 0; step < 100; ++step)
    advance(cut, 1e-3), advance(uncut, 1e-3);
  Real most = 0, speed = 0;
  for (std::size_t p = 0; p < uncut.state.particles.id.size(); ++p) {
    ASSERT_EQ(cut.state.particles.id[p], uncut.state.particles.id[p]);
    most = std::max(most, (cut.state.particles.v[p] - uncut.state.particles.v[p]).norm());
    speed = std::max(speed, uncut.state.particles.v[p].norm());
    EXPECT_LT((cut.state.particles.x[p] - uncut.state.particles.x[p]).norm(), 1e-11);
  }
  EXPECT_LT(most, 1e-10 * speed);
  EXPECT_GT(speed, 0.05);
  EXPECT_GT(cut.state.contacts[0].impulse.norm(), 0);
}

TYPED_TEST(CutIn, TiedSidesMoveAsOneUntilTheirTime)
{
  constexpr int D = TypeParam::D;
  const CutLaw law{.group = "cut", .tied_until = 2.5e-4};
  auto m = box_in_two<TypeParam>(along<D>(D - 1, -1), along<D>(D - 1, 1), &law);
  for (int step = 0; step < 3; ++step) {
    make_step(m, 1e-4);
    const Nodes<D>& nodes = m.work.fields.front().nodes;
    for (const CutNode<D>& at : m.work.cuts.nodes()) {
      EXPECT_TRUE(at.tied);
      if (!both_move(m, at))
        continue;
      EXPECT_LT((nodes.motion[static_cast<std::size_t>(at.first)].v - nodes.motion[static_cast<std::size_t>(at.second)].v).norm(), 1e-12);
    }
  }
  make_step(m, 1e-4);
  const Nodes<D>& nodes = m.work.fields.front().nodes;
  for (const CutNode<D>& at : m.work.cuts.nodes()) {
    EXPECT_FALSE(at.tied);
    EXPECT_GT((nodes.motion[static_cast<std::size_t>(at.second)].v - nodes.motion[static_cast<std::size_t>(at.first)].v)[D - 1], 0);
  }
  end_sweeps(m);
}

TYPED_TEST(CutIn, SidesThatPartDoNotAttractEachOther)
{
  constexpr int D = TypeParam::D;
  const CutLaw law{.group = "cut", .friction = 0.5, .cohesion = 1e3};
  auto m = box_in_two<TypeParam>(along<D>(D - 1, -1), along<D>(D - 1, 1), &law);
  for (int step = 0; step < 20; ++step)
    advance(m, 1e-3);
  EXPECT_EQ(m.state.contacts[0].impulse, (Vec<D>(Vec<D>::Zero())));
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p)
    EXPECT_NEAR(m.state.particles.v[p][D - 1], m.state.particles.x[p][D - 1] < 0.5 ? -1 : 1, 1e-9);
}

TYPED_TEST(CutIn, SidesThatMeetExchangeOppositeImpulses)
{
  constexpr int D = TypeParam::D;
  const CutLaw law{.group = "cut"};
  auto m = box_in_two<TypeParam>(along<D>(D - 1, 1), along<D>(D - 1, -1), &law);
  const Vec<D> before = totals(m).momentum;
  for (int step = 0; step < 20; ++step)
    advance(m, 1e-4);
  EXPECT_LT((totals(m).momentum - before).norm(), 1e-12 * totals(m).mass);
  EXPECT_LT(m.state.contacts[0].impulse[D - 1], 0);
  EXPECT_NEAR(m.state.contacts[0].impulse[0], 0, 1e-12 * std::abs(m.state.contacts[0].impulse[D - 1]));
  EXPECT_LT(m.state.contacts[0].pressure, 0);
  EXPECT_EQ(m.state.contacts[0].friction, 0);
}

TYPED_TEST(CutIn, FrictionIsItsCoefficientTimesThePressure)
{
  constexpr int D = TypeParam::D;
  const CutLaw law{.group = "cut", .friction = 0.25};
  auto m = box_in_two<TypeParam>(along<D>(D - 1, 0.1) + along<D>(0, 1), along<D>(D - 1, -0.1), &law);
  make_step(m, 1e-6);
  int sliding = 0, moving = 0;
  for (const CutNode<D>& at : m.work.cuts.nodes()) {
    if (!both_move(m, at))
      continue;
    ++moving;
    EXPECT_TRUE(at.touches);
    EXPECT_NEAR(at.normal[D - 1], 1, 1e-12);
    EXPECT_NEAR(at.rubbed.norm(), 0.25 * at.pressed.norm(), 1e-12 * at.pressed.norm());
    sliding += at.rubbed[0] < 0 ? 1 : 0;
  }
  EXPECT_EQ(sliding, moving);
  EXPECT_GT(moving, 0.8 * static_cast<double>(m.work.cuts.nodes().size()));
  end_sweeps(m);
  EXPECT_LT(m.state.contacts[0].friction, 0);
}

TYPED_TEST(CutIn, CohesionActsOnTheAreaOfTheCut)
{
  constexpr int D = TypeParam::D;
  constexpr Real cohesion = 10, dt = 1e-6;
  const CutLaw law{.group = "cut", .cohesion = cohesion};
  auto m = box_in_two<TypeParam>(along<D>(D - 1, 0.1) + along<D>(0, 1), along<D>(D - 1, -0.1), &law);
  make_step(m, dt);
  Real area = 0, all = 0;
  for (const CutNode<D>& at : m.work.cuts.nodes()) {
    all += at.area;
    if (!both_move(m, at))
      continue;
    EXPECT_NEAR(at.rubbed.norm(), cohesion * at.area * dt / 2, 1e-12 * cohesion * dt);  // the first step kicks by half of its length
    area += at.area;
  }
  EXPECT_NEAR(all, 1, 1e-12);
  EXPECT_GT(area, 0.9);
  end_sweeps(m);
}

TYPED_TEST(CutIn, AnOpenCrackClosesBeforeItsSidesFeelEachOther)
{
  constexpr int D = TypeParam::D;
  const CutLaw law{.group = "cut"};
  auto m = box_in_two<TypeParam>(along<D>(D - 1, -1), along<D>(D - 1, 1), &law);
  const int opens = 30;
  for (int step = 0; step < opens; ++step)
    advance(m, 1e-3);
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p)
    m.state.particles.v.set(p, -m.state.particles.v[p]);
  int free = 0;
  while (m.state.contacts[0].impulse.isZero(0) && free < 2 * opens)
    advance(m, 1e-3), ++free;
  EXPECT_GE(free, opens / 2);  // the sides touch early by a part of a cell: half the width of particles
  EXPECT_LE(free, opens + 5);
}

}  // namespace
}  // namespace talus::testing::cut_nodes_test
