// What every kernel and transfer must keep: mass, momentum, the same bits for any number of threads, and no allocation in a step.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "tests/solver/blocks_of_particles.hpp"

namespace {
std::atomic<long> allocations{0};
}  // namespace

void* operator new(std::size_t size)
{
  ++allocations;
  if (void* block = std::malloc(size))
    return block;
  throw std::bad_alloc();
}
void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }

namespace talus::testing::conservation_test {
namespace {

template <int D_, class K_, Scheme scheme_, bool musl_>
struct Case {
  static constexpr int D = D_;
  using K = K_;
  static constexpr Scheme scheme = scheme_;
  static constexpr bool musl = musl_;
};

template <class C>
class EveryKernelAndTransfer : public ::testing::Test {};

using Cases = ::testing::Types<
    Case<2, Linear<2>, Scheme::flip, true>, Case<2, Linear<2>, Scheme::flip, false>, Case<2, Linear<2>, Scheme::apic, false>,
    Case<2, Linear<2>, Scheme::tpic, false>, Case<2, Umls<2>, Scheme::flip, true>, Case<2, Umls<2>, Scheme::flip, false>,
    Case<2, Umls<2>, Scheme::apic, false>, Case<2, Umls<2>, Scheme::tpic, false>, Case<2, Umls<2>, Scheme::tpic, true>,
    Case<3, Linear<3>, Scheme::flip, true>, Case<3, Linear<3>, Scheme::tpic, false>, Case<3, Umls<3>, Scheme::flip, true>,
    Case<3, Umls<3>, Scheme::apic, false>, Case<3, Umls<3>, Scheme::tpic, false>, Case<2, Umls<2>, Scheme::aflip, true>,
    Case<2, Projected<2>, Scheme::flip, true>, Case<2, Projected<2>, Scheme::flip, false>, Case<2, Projected<2>, Scheme::tpic, false>,
    Case<2, Projected<2>, Scheme::aflip, true>, Case<2, Projected<2>, Scheme::aflip, false>, Case<3, Projected<3>, Scheme::flip, true>,
    Case<3, Projected<3>, Scheme::tpic, true>, Case<3, Projected<3>, Scheme::aflip, true>, Case<2, Projected<2>, Scheme::saflip, true>,
    Case<3, Projected<3>, Scheme::saflip, true>>;
TYPED_TEST_SUITE(EveryKernelAndTransfer, Cases);

/// Hats have no bound on force over mass at a node that a particle has only just come to see: without MUSL they live a short time.
template <class C>
constexpr bool stable = C::musl || !std::is_same_v<typename C::K, Linear<C::D>>;

/// A rubber block that flies, spins and swings in the middle of a jittered box; nothing touches it.
template <class C>
Model<C::D> flying_block()
{
  constexpr int D = C::D;
  auto m = make_model<typename C::K>(unit_box<D>(D == 2 ? 12 : 7, 0.2));
  m.problem.transfer = {.scheme = C::scheme, .musl = C::musl, .pic_damping_time = {}, .pic_damping_crossings = {}};
  if (C::scheme == Scheme::aflip)
    m.problem.transfer.pic_damping_crossings = 25;
  const auto inside = [](const Vec<D>& x) { return (x.array() > 0.3).all() && (x.array() < 0.7).all(); };
  add_body<D>(m, "block", rubber(1e4, 0.3, 1000), D == 2 ? 3 : 4, inside);
  make_ready(m);
  Mat<D> A = Mat<D>::Zero();
  A(0, 1) = -0.6;
  A(1, 0) = 0.4;
  A(0, 0) = 0.15;
  set_velocity<D>(m, A, Vec<D>::Constant(-0.1));
  return m;
}

TYPED_TEST(EveryKernelAndTransfer, KeepMassAndMomentumOfAFreeBlock)
{
  auto m = flying_block<TypeParam>();
  const auto before = totals(m);
  run_until(m, stable<TypeParam> ? 0.2 : 0.05);
  const auto after = totals(m);
  EXPECT_NEAR(before.mass, after.mass, 1e-14 * before.mass) << "rows are sorted anew, so the sum may round differently";
  const Real scale = 0.2 * before.mass;  // speeds are of this order
  EXPECT_LT((after.momentum - before.momentum).norm(), 1e-12 * scale);
  EXPECT_GT(m.state.clock.step, 8);
  EXPECT_GT(m.state.particles.stress[0].norm(), 1) << "the block must have been strained for this to mean anything";
}

/// Where their hosts lie on a line, nodes of small mass hand their forces on to other places: a small moment.
TYPED_TEST(EveryKernelAndTransfer, InternalForcesExertNoMoment)
{
  auto m = flying_block<TypeParam>();
  run_until(m, stable<TypeParam> ? 0.2 : 0.05);
  const Real scale = 0.04 * totals(m).mass;  // of what moves at 0.2 m/s at a distance of 0.2 m
  EXPECT_LT(m.state.momentum.on_nodes.norm(), (m.work.fields[0].small_mass_nodes.size() > 0 ? 5e-3 : 1e-13) * scale);
  EXPECT_GT(m.state.particles.stress[0].norm(), 1);
}

TYPED_TEST(EveryKernelAndTransfer, GiveTheSameBitsForAnyNumberOfThreads)
{
  const auto hash = [](int threads) {
    set_threads(threads);
    auto m = flying_block<TypeParam>();
    run_until(m, 0.06);
    set_threads(1);
    std::uint64_t h = 14695981039346656037ull;
    const auto mix = [&](const auto& column) {
      std::vector<std::byte> bytes(row_bytes<std::decay_t<decltype(column)>>);
      for (std::size_t row = 0; row < column.size(); ++row) {
        save_row(column, row, bytes.data());
        for (const std::byte byte : bytes)
          h = (h ^ std::to_integer<std::uint64_t>(byte)) * 1099511628211ull;
      }
    };
    m.state.particles.for_each_column([&](std::string_view, std::string_view, const auto& column) { mix(column); });
    return h;
  };
  const auto one = hash(1);
  EXPECT_EQ(one, hash(2));
  EXPECT_EQ(one, hash(3));
  EXPECT_EQ(one, hash(4));
}

TYPED_TEST(EveryKernelAndTransfer, AllocateOnlyWhereStripsGrow)
{
  set_threads(2);
  auto m = flying_block<TypeParam>();
  const Real dt = 0.3 * shortest_crossing(m.problem.mesh, m.state.materials, m.state.particles);
  for (int step = 0; step < 30; ++step)
    make_step(m, dt);
  const long before = allocations;
  for (int step = 0; step < 30; ++step)
    make_step(m, dt);
  // Blocks of cells that no particle has been in, and strips that get more particles than ever before, need memory.
  EXPECT_LE(allocations - before, 60);
  set_threads(1);
}

TYPED_TEST(EveryKernelAndTransfer, AllocateNothingWhileParticlesKeepTheirCells)
{
  set_threads(2);
  auto m = flying_block<TypeParam>();
  const Real dt = 1e-6 * shortest_crossing(m.problem.mesh, m.state.materials, m.state.particles);
  for (int step = 0; step < 5; ++step)
    make_step(m, dt);
  // Buffers of a thread grow with the largest block or strip that it has had, and threads take these in any order:
  // a thread may get its first one late. After that, and that is tested, no step allocates.
  long made = 1;
  for (int attempt = 0; attempt < 20 && made > 0; ++attempt) {
    const long before = allocations;
    for (int step = 0; step < 30; ++step)
      make_step(m, dt);
    made = allocations - before;
  }
  EXPECT_EQ(made, 0);
  set_threads(1);
}

TYPED_TEST(EveryKernelAndTransfer, CloseTheEnergyBalanceWhileStable)
{
  if (!stable<TypeParam>)
    return;
  auto m = flying_block<TypeParam>();
  m.state.energy = {.kinetic_start = totals(m).kinetic};
  const Real start = m.state.energy.kinetic_start;
  const Real dt = 0.05 * shortest_crossing(m.problem.mesh, m.state.materials, m.state.particles);  // the balance is first order in the step
  Real strained = 0;
  while (m.state.clock.time < 0.2) {
    advance(m, dt);
    strained = std::max(strained, std::abs(m.state.energy.internal));
  }
  const Real kinetic = totals(m).kinetic;
  EXPECT_GT(strained, 1e-3 * start) << "at some time of the swing, or there is no balance to close";
  EXPECT_LT(std::abs(m.state.energy.at_velocities().defect(kinetic)), 0.01 * start);
}

}  // namespace
}  // namespace talus::testing::conservation_test
