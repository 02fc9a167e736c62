// Particles in strips: steps are those of two passes, and bitwise identical however often the particles go back to their columns.
#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <random>
#include <set>

#include "core/parallel/threads.hpp"
#include "materials/law_examples.hpp"
#include "solver/each_particle.hpp"
#include "tests/solver/blocks_of_particles.hpp"

namespace talus::sweep_test {
namespace {

using testing::add_body;
using testing::close_off;
using testing::rubber;
using testing::unit_box;

/// Everything that is stored of a particle, as bytes, by the name of its column.
using Stored = std::map<std::string, std::vector<std::byte>>;
template <int D>
std::map<std::int64_t, Stored> particles_by_id(const Model<D>& m)
{
  std::map<std::int64_t, Stored> all;
  const auto bytes_of_numbers = [](const auto* from, std::size_t n) {
    const auto bytes = std::as_bytes(std::span(from, n));
    return std::vector<std::byte>(bytes.begin(), bytes.end());
  };
  for (std::size_t b = 0; b < m.state.bodies.size(); ++b)
    for (Index row = m.state.bodies[b].begin; row < m.state.bodies[b].end; ++row) {
      const auto p = static_cast<std::size_t>(row);
      Stored& one = all[m.state.particles.id[p]];
      m.state.particles.for_each_column([&](std::string_view name, std::string_view, const auto& column) {
        if (column.size() > 0)
          one[std::string(name)] = bytes_of_numbers(numbers_of(column, p), RowsOf<std::decay_t<decltype(column)>>::components);
      });
      const HistoryRows& history = m.state.materials[b].history;
      one["history"] = bytes_of_numbers(history.row(row - m.state.bodies[b].begin), static_cast<std::size_t>(history.width()));
      one["body"] = bytes_of_numbers(&b, 1);
    }
  return all;
}

/// The columns in which particles differ; "number" if there are not as many.
std::set<std::string> differences(const std::map<std::int64_t, Stored>& a, const std::map<std::int64_t, Stored>& b)
{
  std::set<std::string> names;
  if (a.size() != b.size())
    names.insert("number");
  for (const auto& [id, stored] : a)
    if (const auto other = b.find(id); other != b.end())
      for (const auto& [name, bytes] : stored)
        if (const auto same = other->second.find(name); same == other->second.end() || same->second != bytes)
          names.insert(name);
  return names;
}
const std::set<std::string> none_differ;

/// Two bodies, one with pore water, that swirl in a closed box, fast enough to change cells in each step.
template <int D>
Model<D> swirl(TransferOptions transfer, Index cells = 6, OnExit policy = OnExit::stop)
{
  auto m = make_model<Projected<D>>(unit_box<D>(cells, 0.2));
  const auto turn = [](const Vec<D>& x) {
    Vec<D> v = Vec<D>::Zero();
    v[0] = 25 * (0.5 - x[1]), v[1] = 25 * (x[0] - 0.5);
    return v;
  };
  add_body<D>(
      m, "rubber", rubber(1e6, 0.3, 1000), D + 1, [](const Vec<D>& x) { return x[0] < 0.5; }, turn);
  add_body<D>(
      m, "soil", law_example<DruckerPrager>(), D == 2 ? 6 : 8, [](const Vec<D>& x) { return x[0] > 0.5 && x[1] < 0.8; }, turn);
  m.state.particles.x0 = m.state.particles.x;
  m.state.materials[0].viscosity = BulkViscosity{};
  for (Index n = 0; n < m.problem.mesh.n_nodes(); ++n)
    m.problem.water.table.push_back(0.6 + 0.3 * m.problem.mesh.node(n)[0]);
  m.problem.water.drained = {0, 1}, m.problem.water.unit_weight = 1e4, m.problem.water.suction = 1e3;
  m.problem.transfer = transfer;
  m.problem.exits.policy = policy;
  if (policy == OnExit::stop)
    for (const char* side : {"x_min", "x_max", "y_min", "y_max"})
      close_off<D>(m, side, Roller<D>{});
  make_ready(m);
  return m;
}

constexpr Real dt = 2e-4;

template <int D>
void same_as_two_passes(TransferOptions transfer)
{
  auto one = swirl<D>(transfer), two = swirl<D>(transfer);
  ASSERT_TRUE(may_sweep(one));
  two.problem.columns.applied = true;  // as if there were loads on particles, which need both passes
  ASSERT_FALSE(may_sweep(two));
  for (int step = 0; step < 40; ++step) {
    make_step(one, dt);
    advance(two, dt);
  }
  ASSERT_FALSE(one.work.errors.worst().has_value());
  ASSERT_FALSE(two.work.errors.worst().has_value());
  ASSERT_TRUE(one.work.strips.has_value());
  end_sweeps(one);
  const auto row_of = [](const Model<D>& m) {
    std::map<std::int64_t, std::size_t> rows;
    for (std::size_t p = 0; p < m.state.particles.id.size(); ++p)
      rows[m.state.particles.id[p]] = p;
    return rows;
  };
  const auto a = row_of(one), b = row_of(two);
  ASSERT_EQ(a.size(), b.size());
  Real wettest = 0;
  for (const auto& [id, p] : a) {
    const std::size_t q = b.at(id);
    const Particles<D>&x = one.state.particles, &y = two.state.particles;
    EXPECT_NEAR((x.x[p] - y.x[q]).norm(), 0, 1e-12);
    EXPECT_NEAR((x.v[p] - y.v[q]).norm(), 0, 1e-9);
    EXPECT_NEAR((x.L[p] - y.L[q]).norm(), 0, 1e-7);
    EXPECT_EQ(x.C.empty(), y.C.empty());
    const Real affine = x.C.empty() ? 0 : (x.C[p] - y.C[q]).norm();
    EXPECT_NEAR(affine, 0, 1e-7);
    EXPECT_NEAR((x.F[p] - y.F[q]).norm(), 0, 1e-10);
    EXPECT_NEAR((x.stress[p] - y.stress[q]).norm(), 0, 1e-4);
    EXPECT_NEAR(x.volume[p], y.volume[q], 1e-12);
    EXPECT_EQ(x.mass[p], y.mass[q]);
    EXPECT_EQ((x.x0[p] - y.x0[q]).norm(), 0);
    EXPECT_NEAR(x.pore[p], y.pore[q], 1e-7);
    wettest = std::max(wettest, x.pore[p]);
  }
  EXPECT_GT(wettest, 1e3);
  EXPECT_NEAR(one.state.energy.internal, two.state.energy.internal, 1e-9 * std::abs(two.state.energy.internal));
  EXPECT_NEAR(one.state.energy.remap, two.state.energy.remap, 1e-9 * std::abs(two.state.energy.internal));
  EXPECT_NEAR(one.state.crossing, two.state.crossing, 1e-12);
  EXPECT_NEAR(one.state.monitor.speed, two.state.monitor.speed, 1e-9);
}

std::vector<TransferOptions> all_transfers()
{
  std::vector<TransferOptions> all;
  for (const Scheme scheme : {Scheme::flip, Scheme::apic, Scheme::tpic, Scheme::aflip})
    for (const bool musl : {false, true}) {
      TransferOptions one{.scheme = scheme, .musl = musl};
      all.push_back(one.with_default_damping());
    }
  return all;
}

/// One model makes steps in strips; the other goes back to columns after each.
template <int D>
void identical_from_columns(TransferOptions transfer)
{
  auto kept = swirl<D>(transfer), restarted = swirl<D>(transfer);
  for (int step = 0; step < 25; ++step) {
    make_step(kept, dt);
    if (step % 3 == 0)
      copy_to_columns(kept);  // as an output does
    advance(restarted, dt);
  }
  ASSERT_FALSE(kept.work.errors.worst().has_value());
  EXPECT_FALSE(restarted.work.strips.has_value());
  end_sweeps(kept);
  EXPECT_EQ(differences(particles_by_id(kept), particles_by_id(restarted)), none_differ);
  EXPECT_EQ(kept.state.energy.internal, restarted.state.energy.internal);
  EXPECT_EQ(totals(kept).kinetic, totals(restarted).kinetic);
}

TEST(Sweep, IsTheSameAsTwoPasses)
{
  for (const TransferOptions& transfer : all_transfers()) {
    SCOPED_TRACE(static_cast<int>(transfer.scheme) * 10 + (transfer.uses_musl() ? 1 : 0));
    same_as_two_passes<2>(transfer);
    same_as_two_passes<3>(transfer);
  }
}

TEST(Sweep, IsBitwiseIdenticalFromColumns)
{
  for (const TransferOptions& transfer : all_transfers()) {
    SCOPED_TRACE(static_cast<int>(transfer.scheme) * 10 + (transfer.uses_musl() ? 1 : 0));
    identical_from_columns<2>(transfer);
    identical_from_columns<3>(transfer);
  }
}

TEST(Sweep, IsBitwiseIdenticalOnAnyNumberOfThreads)
{
  const int before = threads();
  std::vector<std::map<std::int64_t, Stored>> runs;
  for (const int n : {1, 2, 3}) {
    set_threads(n);
    auto m = swirl<3>({.scheme = Scheme::aflip});
    for (int step = 0; step < 20; ++step)
      make_step(m, dt);
    end_sweeps(m);
    runs.push_back(particles_by_id(m));
  }
  set_threads(before);
  EXPECT_EQ(differences(runs[0], runs[1]), none_differ);
  EXPECT_EQ(differences(runs[0], runs[2]), none_differ);
}

TEST(Sweep, ParticlesChangeTheirCells)  // or the tests above would show little
{
  auto m = swirl<2>({.scheme = Scheme::aflip});
  std::map<std::int64_t, Index> first;
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p)
    first[m.state.particles.id[p]] = m.state.particles.cell[p];
  for (int step = 0; step < 40; ++step)
    advance(m, dt);
  std::size_t moved = 0;
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p)
    moved += first[m.state.particles.id[p]] != m.state.particles.cell[p] ? 1 : 0;
  EXPECT_GT(moved, first.size() / 4);
}

TEST(Sweep, DeletesWhatLeavesTheMesh)
{
  auto kept = swirl<2>({.scheme = Scheme::aflip}, 6, OnExit::remove), restarted = swirl<2>({.scheme = Scheme::aflip}, 6, OnExit::remove);
  const Index before = n_particles(kept);
  for (int step = 0; step < 60; ++step) {
    make_step(kept, dt);
    advance(restarted, dt);
  }
  EXPECT_LT(n_particles(kept), before);
  EXPECT_NEAR(kept.state.mass.due(), totals(kept).mass, 1e-9 * kept.state.mass.start);
  end_sweeps(kept);
  EXPECT_EQ(kept.state.particles.size(), n_particles(restarted));
  EXPECT_EQ(differences(particles_by_id(kept), particles_by_id(restarted)), none_differ);
  EXPECT_EQ(kept.state.mass.carried_away.linear, restarted.state.mass.carried_away.linear);
}

TEST(Sweep, TellsWhichParticleIsLostAndKeepsTheState)
{
  auto m = swirl<2>({.scheme = Scheme::aflip});
  m.problem.exits.closed.assign(m.problem.exits.closed.size(), 0);
  m.state.particles.x.set(0, Vec<2>(-0.3, 0.5));
  const std::int64_t id = m.state.particles.id[0];
  const Index before = n_particles(m);
  make_step(m, dt);
  const auto finding = m.work.errors.worst();
  ASSERT_TRUE(finding.has_value());
  EXPECT_EQ(finding->id, id);
  EXPECT_EQ(finding->trouble, Trouble::lost);
  EXPECT_EQ(m.state.clock.step, 0);
  EXPECT_EQ(m.state.particles.size(), before);  // in their columns, for the message
}

TEST(Sweep, SetsBackWhatCrossesAWall)
{
  auto kept = swirl<2>({.scheme = Scheme::aflip}), restarted = swirl<2>({.scheme = Scheme::aflip});
  for (Model<2>* const m : {&kept, &restarted})
    for (std::size_t p = 0; p < m->state.particles.id.size(); ++p)
      if (m->state.particles.x[p].x() < 0.1)
        m->state.particles.x.set(p, Vec<2>(m->state.particles.x[p].x() - 0.1, m->state.particles.x[p].y()));
  for (int step = 0; step < 10; ++step) {
    make_step(kept, dt);
    advance(restarted, dt);
  }
  ASSERT_FALSE(kept.work.errors.worst().has_value());
  EXPECT_GT(kept.state.mass.held_count, 0);
  EXPECT_EQ(kept.state.mass.held_count, restarted.state.mass.held_count);
  EXPECT_EQ(kept.state.mass.largest_set_back, restarted.state.mass.largest_set_back);
  end_sweeps(kept);
  EXPECT_EQ(differences(particles_by_id(kept), particles_by_id(restarted)), none_differ);
}

TEST(Sweep, IsForScenesThatNeedNoPassBetween)
{
  auto plain = swirl<2>({.scheme = Scheme::aflip});  // with viscosity and pore water
  EXPECT_TRUE(may_sweep(plain));
  auto averaged = swirl<2>({.scheme = Scheme::aflip});
  averaged.problem.columns.volume_ratio = true;
  EXPECT_FALSE(may_sweep(averaged));
  auto hot = swirl<2>({.scheme = Scheme::aflip});
  hot.work.heat.emplace(hot.problem.mesh);
  EXPECT_FALSE(may_sweep(hot));
  EXPECT_FALSE(may_sweep(make_model<Linear<2>>(unit_box<2>(2, 0.1))));
  EXPECT_FALSE(may_sweep(make_model<Umls<2>>(unit_box<2>(2, 0.1))));
}

/// What observers read of the particles of a view, in the order in which they read them.
template <int D>
std::vector<Real> read_by_observers(const RunView<D>& view)
{
  std::vector<Real> all;
  const auto add = [&](const auto& tensor) { all.insert(all.end(), tensor.data(), tensor.data() + tensor.size()); };
  for (std::size_t key = 0; key < view.order.keys(); ++key) {
    const int width = view.state.materials[key / static_cast<std::size_t>(view.order.blocks)].history.width();
    for_each_particle(view, key, [&](const auto& p) {
      all.insert(all.end(), {static_cast<Real>(p.id()), p.mass(), p.volume0()});
      add(p.x()), add(p.displacement()), add(p.v()), add(p.stress()), add(p.load());
      for (int k = 0; k < width; ++k)
        all.push_back(p.history(k));
    });
  }
  const Totals<D> sums = totals(view);
  all.insert(all.end(), {sums.mass, sums.kinetic, plastic_work(view)});
  return all;
}

TEST(ParticleStrips, AreReadByObserversLikeColumns)
{
  auto m = swirl<3>({.scheme = Scheme::aflip});
  for (int step = 0; step < 10; ++step)
    make_step(m, dt);
  const Stage stage = testing::test_stage(1);
  ASSERT_NE(view_of(m, stage).strips, nullptr);
  const std::vector<Real> of_strips = read_by_observers(view_of(m, stage));
  end_sweeps(m);
  ASSERT_EQ(view_of(m, stage).strips, nullptr);
  EXPECT_EQ(of_strips, read_by_observers(view_of(m, stage)));
  EXPECT_GT(of_strips.back(), 0) << "the soil flows";
}

TEST(ParticleStrips, GiveBackEveryNumber)
{
  auto m = swirl<3>({.scheme = Scheme::aflip});
  std::mt19937 bits(3);
  std::uniform_real_distribution<Real> any(-1, 1);
  m.state.particles.for_each_column([&](std::string_view name, std::string_view, auto& column) {
    if (name != "cell" && name != "id" && name != "position")
      for (std::size_t p = 0; p < column.size(); ++p)
        for (int c = 0; c < RowsOf<std::decay_t<decltype(column)>>::components; ++c) {
          const Real number = any(bits);
          std::memcpy(numbers_of(column, p) + c, &number, sizeof(*numbers_of(column, p)));
        }
  });
  for (Index i = 0; i < m.state.materials[1].size(); ++i)
    for (int k = 0; k < m.state.materials[1].history.width(); ++k)
      m.state.materials[1].history.row(i)[k] = any(bits);
  const auto before = particles_by_id(m);
  begin_sweeps(m);
  EXPECT_EQ(m.state.particles.size(), 0);
  EXPECT_EQ(n_particles(m), static_cast<Index>(before.size()));
  copy_to_columns(m);
  EXPECT_EQ(differences(particles_by_id(m), before), none_differ);
  drop_copy(m);
  EXPECT_EQ(m.state.particles.size(), 0);
  end_sweeps(m);
  EXPECT_EQ(differences(particles_by_id(m), before), none_differ);
}

TEST(ParticleStrips, AStripGrowsWithItsParticles)
{
  // All particles run into one corner of the box.
  auto m = make_model<Projected<2>>(unit_box<2>(8, 0.1));
  add_body<2>(
      m, "dust", rubber(10, 0, 1000), 3, [](const Vec<2>&) { return true; }, [](const Vec<2>& x) { return Vec<2>(-0.4 * x); });
  m.problem.transfer = {.scheme = Scheme::tpic};
  close_off<2>(m, "x_min", Roller<2>{});
  close_off<2>(m, "y_min", Roller<2>{});
  make_ready(m);
  const Index before = n_particles(m);
  const auto most = [&] {
    Index n = 0;
    for (std::size_t key = 0; key < m.work.strips->keys(); ++key)
      for (const Strip& strip : m.work.strips->strips(key))
        n = std::max(n, strip.n);
    return n;
  };
  begin_sweeps(m);
  const Index first = most();
  for (int step = 0; step < 200; ++step)
    make_step(m, 5e-3);
  ASSERT_FALSE(m.work.errors.worst().has_value())
      << m.work.errors.worst()->id << ' ' << static_cast<int>(m.work.errors.worst()->trouble) << ' ' << m.state.clock.step;
  EXPECT_EQ(n_particles(m), before);
  EXPECT_GT(most(), first + first / 2);
}

}  // namespace
}  // namespace talus::sweep_test
