// What every boundary condition promises, typed over the list of conditions: momentum closes, the sign of its work, corners with every other
// condition, ranks, restart.
#include <gtest/gtest.h>

#include "tests/solver/boundary/nodes_in_a_square.hpp"

namespace talus::testing::condition_contract_test {
namespace {

constexpr Real rounding = 1e-12;  // of velocities and masses of the order of one

/// Parameters under which a condition shows all it has.  One that has parameters needs a sample of its own.
template <class C>
C sample(Index)
{
  static_assert(std::is_empty_v<C>, "a condition with parameters needs a sample here");
  return {};
}
template <>
PrescribedVelocity<2> sample<PrescribedVelocity<2>>(Index)
{
  return {{{0.4, -0.3}, {.points = {{0, 1}, {10, 3}}}}};
}
template <>
Friction<2> sample<Friction<2>>(Index)
{
  return {0.3};
}
template <>
CompliantBase<2> sample<CompliantBase<2>>(Index)
{
  return {{2, 3, 5}, {{0.4, -0.3}, {.points = {{0, 1}, {10, 3}}}}};
}
template <>
FreeField<2> sample<FreeField<2>>(Index base)
{
  SoilColumn<2> column;
  column.level = {0, 1, 2};
  column.layer = {{{2, 3, 5}, 1}, {{1.5, 2, 4}, 0.5}};
  return {column, base};
}

template <class List>
struct AsGtest;
template <class... C>
struct AsGtest<TypeList<C...>> {
  using Types = ::testing::Types<C...>;
};
template <class C>
class ConditionContract : public ::testing::Test {};
TYPED_TEST_SUITE(ConditionContract, AsGtest<Conditions<2>>::Types);

/// Nodes of a square mesh, 2 m wide, all with a mass of their own.
struct MovingNodes {
  static constexpr Real dt = 0.25;
  Mesh<2> mesh{box<2>({0, 0}, {2, 2}, {16, 16})};
  BoundaryConditions<2> conditions;
  Nodes<2> nodes;
  ExactSums<BoundaryWork> work;
  Real time = 0;

  MovingNodes()
  {
    nodes.sum.resize(static_cast<std::size_t>(mesh.n_nodes()));
    nodes.motion.resize(nodes.sum.size());
    nodes.active.assign(nodes.sum.size(), 1);
    nodes.kick = dt;
    for (std::size_t n = 0; n < nodes.sum.size(); ++n)
      nodes.sum[n].mass = 1 + 0.1 * static_cast<Real>(n % 7), nodes.sum[n].lightest = 1;
  }
  /// A sample on one side, on a fixed base if it needs one.
  template <class C>
  static MovingNodes with()
  {
    MovingNodes all;
    if constexpr (MovesOnBase<C>)
      add_on<2>(all.conditions, all.mesh, "y_min", Fixed<2>{});
    add_on<2>(all.conditions, all.mesh, "x_min", sample<C>(0));
    return all;
  }
  MovingNodes& begin(bool dynamic)
  {
    conditions.finalize();
    conditions.begin_stage(!dynamic, 0);
    return *this;
  }
  /// Every node moves towards x_min and y_min, by different speeds.
  void move(const Vec<2>& change = Vec<2>::Zero())
  {
    for (std::size_t n = 0; n < nodes.motion.size(); ++n)
      nodes.motion[n] = {{-1 - 0.1 * static_cast<Real>(n % 3), -0.5 - 0.1 * static_cast<Real>(n % 5)}, change};
  }
  void stop() { std::fill(nodes.motion.begin(), nodes.motion.end(), NodeMotion<2>{}); }
  void step()
  {
    conditions.apply_dashpots(time + dt / 2, dt, one_rank(), nodes);
    conditions.apply({time - dt / 2, time + dt / 2}, nodes, work);
    conditions.keep_impulses();
    time += dt;
  }
  template <class F>
  auto sum(F&& f) const
  {
    auto total = f(std::size_t{0});
    for (std::size_t n = 1; n < nodes.motion.size(); ++n)
      total += f(n);
    return total;
  }
  Vec3 momentum() const  // and its moment about the origin
  {
    return sum([&](std::size_t n) {
      const Vec<2> p = nodes.sum[n].mass * nodes.motion[n].v, x = mesh.node(static_cast<Index>(n));
      return Vec3(p[0], p[1], x[0] * p[1] - x[1] * p[0]);
    });
  }
  Real kinetic_energy() const
  {
    return sum([&](std::size_t n) { return 0.5 * nodes.sum[n].mass * nodes.motion[n].v.squaredNorm(); });
  }
  Vec3 impulse() const
  {
    Vec3 total = Vec3::Zero();
    for (const BoundaryCondition<2>& condition : conditions.conditions())
      total += Vec3(condition.impulse[0], condition.impulse[1], condition.angular[2]);
    return total;
  }
};

TYPED_TEST(ConditionContract, IsAConditionWithADistinctName)
{
  using Options = typename TypeParam::Options;
  static_assert(std::is_base_of_v<BoundaryCommon, Options> && HasFields<Options>);
  static_assert(HoldsNodes<TypeParam> || ActsOnPlanes<TypeParam> || HasDashpots<TypeParam>);
  static_assert(!MovesOnBase<TypeParam> || HasFields<TypeParam>, "what moves by itself is saved for a restart");
  int same = 0;
  for_each_type(Conditions<2>{}, [&]<class Other>() { same += Other::Options::name == Options::name; });
  EXPECT_EQ(same, 1);
}

TYPED_TEST(ConditionContract, ItsImpulseIsTheChangeOfMomentum)
{
  for (const bool dynamic : {false, true}) {
    auto all = MovingNodes::with<TypeParam>().begin(dynamic);
    all.move();
    const Vec3 before = all.momentum();
    all.step();
    EXPECT_LT((all.momentum() - before - all.impulse()).norm(), rounding * before.norm());
    EXPECT_NEAR(all.work.value().turned[2], all.impulse()[2], rounding * before.norm());
    EXPECT_GT(all.conditions.conditions().back().impulse.norm(), 0.1) << "it pushes nothing";
  }
}

TYPED_TEST(ConditionContract, ItsWorkIsTheChangeOfKineticEnergyAndHasItsSign)
{
  for (const bool dynamic : {false, true}) {
    auto all = MovingNodes::with<TypeParam>().begin(dynamic);
    all.move();
    const Real before = all.kinetic_energy();
    all.step();
    const BoundaryWork work = all.work.value();
    EXPECT_NEAR(work.friction + work.moved + work.arrival, all.kinetic_energy() - before, rounding * before);
    EXPECT_LE(work.friction, 0);
    EXPECT_GE(work.waves, 0);
    const bool moves = all.conditions.conditions().back().peak_speed() > 0;
    if (!moves) {
      EXPECT_LT(all.kinetic_energy(), before) << "what stays where it is gives no energy";
    }

    auto at_rest = MovingNodes::with<TypeParam>().begin(dynamic);
    at_rest.step();
    if (moves && (dynamic || !HasDashpots<TypeParam>)) {
      EXPECT_GT(at_rest.work.value().moved, 0);
    } else {
      EXPECT_EQ(at_rest.kinetic_energy(), 0);
    }
  }
}

/// Whatever meets in an edge, momentum closes there, both conditions hold, and the order in which they were given does not matter.
TYPED_TEST(ConditionContract, MeetsEveryOtherInACorner)
{
  for_each_type(Conditions<2>{}, [&]<class Other>() {
    for (const bool dynamic : {false, true}) {
      SCOPED_TRACE(std::string(Other::Options::name) + (dynamic ? ", dynamic" : ", geostatic"));
      std::vector<Vec<2>> velocity;
      for (const bool first : {false, true}) {
        MovingNodes all;
        const auto add_this = [&] { add_on<2>(all.conditions, all.mesh, "x_min", sample<TypeParam>(first ? 1 : 0)); };
        if (first)
          add_this();
        add_on<2>(all.conditions, all.mesh, "y_min", sample<Other>(first ? 0 : 1));
        if (!first)
          add_this();
        all.begin(dynamic);
        all.move();
        const Vec3 before = all.momentum();
        all.step();
        EXPECT_LT((all.momentum() - before - all.impulse()).norm(), rounding * before.norm());
        for (Index n = 0; n < all.mesh.n_nodes(); ++n) {
          const Vec<2> v = all.nodes.motion[static_cast<std::size_t>(n)].v;
          EXPECT_LT((all.conditions.held({n}, MovingNodes::dt / 2, v) - v).norm(), rounding);
          if (all.mesh.node(n).norm() == 0)
            velocity.push_back(v);
        }
      }
      ASSERT_EQ(velocity.size(), 2U);
      EXPECT_LT((velocity[0] - velocity[1]).norm(), rounding);
    }
  });
}

/// Each rank has the conditions of its part of the mesh, and together they push as one does.
TYPED_TEST(ConditionContract, RanksTogetherPushAsOneDoes)
{
  for (const bool dynamic : {false, true}) {
    auto whole = MovingNodes::with<TypeParam>().begin(dynamic);
    whole.move();
    std::vector<int> rank_of_block;
    for (Index b = 0; b < blocks_of(whole.mesh.n_cells()); ++b)
      rank_of_block.push_back(b % 2);
    ASSERT_GT(rank_of_block.size(), 3U);
    Vec3 impulse = Vec3::Zero();
    std::vector<std::vector<Vec<2>>> velocity(2);
    std::vector<Part<2>> parts;
    for (int rank = 0; rank < 2; ++rank) {
      const Part<2>& part = parts.emplace_back(cut<2>(whole.mesh, rank_of_block, rank, 2));
      auto mine = MovingNodes::with<TypeParam>();
      mine.conditions.restrict_to(part.subdomain);
      mine.begin(dynamic);
      mine.nodes.sum.clear(), mine.nodes.motion.clear();
      for (const Index n : part.subdomain.node) {
        mine.nodes.sum.push_back(whole.nodes.sum[static_cast<std::size_t>(n)]);
        mine.nodes.motion.push_back(whole.nodes.motion[static_cast<std::size_t>(n)]);
      }
      mine.nodes.active.assign(mine.nodes.sum.size(), 1);
      mine.step();
      impulse += mine.impulse();
      for (const NodeMotion<2>& motion : mine.nodes.motion)
        velocity[static_cast<std::size_t>(rank)].push_back(motion.v);
    }
    whole.step();
    EXPECT_LT((impulse - whole.impulse()).norm(), rounding * whole.impulse().norm());
    for (std::size_t rank = 0; rank < 2; ++rank)
      for (std::size_t n = 0; n < velocity[rank].size(); ++n)
        EXPECT_EQ(velocity[rank][n], whole.nodes.motion[static_cast<std::size_t>(parts[rank].subdomain.node[n])].v);
  }
}

/// What fields() list is all that a step needs of those before.
TYPED_TEST(ConditionContract, GoesOnAfterARestartBitByBit)
{
  for (const bool dynamic : {false, true}) {
    auto through = MovingNodes::with<TypeParam>().begin(dynamic), again = MovingNodes::with<TypeParam>().begin(dynamic);
    for (int step = 0; step < 3; ++step) {
      through.move({0.1, -0.2});
      through.step();
    }
    again.conditions.continue_from(through.conditions);
    EXPECT_TRUE(again.conditions.fits());
    again.time = through.time;
    for (MovingNodes* run : {&through, &again}) {
      run->move();
      run->step();
    }
    for (std::size_t n = 0; n < through.nodes.motion.size(); ++n)
      ASSERT_EQ(through.nodes.motion[n].v, again.nodes.motion[n].v);
    EXPECT_EQ(through.impulse(), again.impulse());
  }
}

}  // namespace
}  // namespace talus::testing::condition_contract_test
