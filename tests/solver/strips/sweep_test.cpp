// Steps in strips are bitwise identical however often the particles go back to their columns.
#include <gtest/gtest.h>

#include "core/parallel/threads.hpp"
#include "tests/solver/strips/swirl.hpp"

namespace talus::testing::sweep_test {
namespace {

constexpr Real dt = swirl_dt;

std::vector<TransferOptions> all_transfers()
{
  std::vector<TransferOptions> all;
  for (const Scheme scheme : {Scheme::flip, Scheme::apic, Scheme::tpic, Scheme::aflip})
    for (const bool musl : {false, true}) {
      TransferOptions one{.scheme = scheme, .musl = musl};
      all.push_back(one.with_damping(0, false));
    }
  return all;
}

/// One model makes steps in strips; the other goes back to columns after each.
template <int D, class K>
void identical_from_columns(TransferOptions transfer)
{
  auto kept = swirl<D, K>(transfer), restarted = swirl<D, K>(transfer);
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

/// One model makes steps in one pass; in those of the other, averages and heat would stand between the parts, but nothing asks for them.
template <int D, class K>
void identical_in_parts(TransferOptions transfer)
{
  auto one = swirl<D, K>(transfer), parts = swirl<D, K>(transfer);
  begin_sweeps(parts);
  parts.work.averaged.push_back({{}, NodePatchSums<D, 2>(parts.problem.mesh)});
  parts.work.heat.emplace(parts.problem.mesh);
  for (int step = 0; step < 10; ++step) {
    make_step(one, dt);
    make_step(parts, dt);
  }
  ASSERT_FALSE(one.work.errors.worst().has_value());
  end_sweeps(one), end_sweeps(parts);
  EXPECT_EQ(differences(particles_by_id(one), particles_by_id(parts)), none_differ);
  EXPECT_EQ(one.state.energy.internal, parts.state.energy.internal);
}

TEST(Sweep, IsBitwiseIdenticalInParts)
{
  for (const TransferOptions& transfer : all_transfers()) {
    SCOPED_TRACE(static_cast<int>(transfer.scheme) * 10 + (transfer.uses_musl() ? 1 : 0));
    identical_in_parts<2, Projected<2>>(transfer);
    identical_in_parts<3, Projected<3>>(transfer);
    identical_in_parts<2, Linear<2>>(transfer);
    identical_in_parts<3, Linear<3>>(transfer);
    identical_in_parts<2, Umls<2>>(transfer);
  }
}

/// Linear shape functions that are summed through their weights.
template <int D>
struct ThroughWeights : Linear<D> {
  static constexpr bool weighs_vertices = false;
  using Linear<D>::Linear;
};
static_assert(WeighsVertices<Linear<2>, 2> && !WeighsVertices<ThroughWeights<2>, 2>);

/// Sums at vertices, and momentum of MUSL from moments of cells, against sums of every particle.
template <int D>
void same_as_through_weights(TransferOptions transfer)
{
  auto vertices = swirl<D, Linear<D>>(transfer), weights = swirl<D, ThroughWeights<D>>(transfer);
  for (int step = 0; step < 20; ++step) {
    make_step(vertices, dt);
    make_step(weights, dt);
  }
  ASSERT_FALSE(vertices.work.errors.worst().has_value());
  end_sweeps(vertices), end_sweeps(weights);
  const Particles<D>&a = vertices.state.particles, &b = weights.state.particles;
  ASSERT_EQ(a.id, b.id);
  Real wettest = 0;
  for (std::size_t p = 0; p < a.id.size(); ++p) {
    EXPECT_NEAR((a.x[p] - b.x[p]).norm(), 0, 1e-12);
    EXPECT_NEAR((a.v[p] - b.v[p]).norm(), 0, 1e-9);
    EXPECT_NEAR((a.L[p] - b.L[p]).norm(), 0, 1e-7);
    EXPECT_EQ(a.C.empty(), b.C.empty());
    const Real affine = a.C.empty() ? 0 : (a.C[p] - b.C[p]).norm();
    EXPECT_NEAR(affine, 0, 1e-7);
    EXPECT_NEAR((a.F[p] - b.F[p]).norm(), 0, 1e-10);
    EXPECT_NEAR((a.stress[p] - b.stress[p]).norm(), 0, 1e-3);
    EXPECT_NEAR(a.pore[p], b.pore[p], 1e-7);
    wettest = std::max(wettest, a.pore[p]);
  }
  EXPECT_GT(wettest, 1e3);
  EXPECT_NEAR(vertices.state.energy.internal, weights.state.energy.internal, 1e-9 * std::abs(weights.state.energy.internal));
  EXPECT_NEAR(vertices.state.energy.remap, weights.state.energy.remap, 1e-9 * std::abs(weights.state.energy.internal));
  EXPECT_NEAR(vertices.state.crossing, weights.state.crossing, 1e-12);
  EXPECT_NEAR(vertices.state.monitor.speed, weights.state.monitor.speed, 1e-9);
}

TEST(Sweep, SumsAtVerticesAreThoseThroughWeights)
{
  for (const TransferOptions& transfer : all_transfers()) {
    SCOPED_TRACE(static_cast<int>(transfer.scheme) * 10 + (transfer.uses_musl() ? 1 : 0));
    same_as_through_weights<2>(transfer);
    same_as_through_weights<3>(transfer);
  }
}

TEST(Sweep, IsBitwiseIdenticalFromColumns)
{
  for (const TransferOptions& transfer : all_transfers()) {
    SCOPED_TRACE(static_cast<int>(transfer.scheme) * 10 + (transfer.uses_musl() ? 1 : 0));
    identical_from_columns<2, Projected<2>>(transfer);
    identical_from_columns<3, Projected<3>>(transfer);
    identical_from_columns<2, Linear<2>>(transfer);
    identical_from_columns<3, Linear<3>>(transfer);
    identical_from_columns<2, Umls<2>>(transfer);
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

/// Averaged volumes in one body and loads on all particles, beside everything else.
template <class K>
void loaded_is_identical_from_columns()
{
  const auto load = [](Model<2>& m) {
    m.state.materials[1].averages_volume = true;
    auto traction = carried_by_particles<2>(m.problem.mesh, *m.problem.mesh.facet_set("x_max"), m.state.particles);
    traction.traction = {-1e3, 0}, traction.pressure = 2e3;
    m.problem.loads.on_particles.push_back(std::move(traction));
    m.problem.loads.of_place.push_back({.acceleration = [](std::span<const Vec<2>> places, Real time, std::span<Vec<2>> accelerations) {
      for (std::size_t i = 0; i < places.size(); ++i)
        accelerations[i] = Vec<2>(std::sin(100 * time), places[i][0]);
    }});
  };
  const auto loaded = [&] { return swirl<2, K>({.scheme = Scheme::aflip}, 6, OnExit::stop, load); };
  auto kept = loaded(), restarted = loaded();
  for (int step = 0; step < 25; ++step) {
    make_step(kept, dt);
    if (step % 3 == 0)
      copy_to_columns(kept);
    advance(restarted, dt);
  }
  ASSERT_FALSE(kept.work.errors.worst().has_value());
  end_sweeps(kept);
  EXPECT_EQ(differences(particles_by_id(kept), particles_by_id(restarted)), none_differ);
  EXPECT_EQ(kept.state.energy.loads, restarted.state.energy.loads);
  EXPECT_NE(kept.state.energy.loads, 0);
  Real largest = 0;
  for (std::size_t p = 0; p < kept.state.particles.volume_ratio.size(); ++p)
    largest = std::max(largest, std::abs(kept.state.particles.volume_ratio[p] - 1));
  EXPECT_GT(largest, 1e-6);
}

TEST(Sweep, WithLoadsAndAveragedVolumesIsBitwiseIdenticalFromColumns)
{
  loaded_is_identical_from_columns<Projected<2>>();
  loaded_is_identical_from_columns<Linear<2>>();
  loaded_is_identical_from_columns<Umls<2>>();
}

/// A force that is not defined outside the mesh, on a particle that is just outside.
template <class K>
void force_is_not_defined_outside(OnExit policy)
{
  const auto load = [](Model<2>& m) {
    m.problem.loads.of_place.push_back({.acceleration = [](std::span<const Vec<2>> places, Real, std::span<Vec<2>> accelerations) {
      for (std::size_t i = 0; i < places.size(); ++i)
        accelerations[i] = Vec<2>(std::sqrt(places[i][0]), 0);
    }});
  };
  auto m = swirl<2, K>({.scheme = Scheme::aflip}, 6, policy, load);
  const Index before = n_particles(m);
  m.state.particles.x.set(0, Vec<2>(-1e-4, 0.05));
  for (int step = 0; step < 3; ++step)
    make_step(m, dt);
  ASSERT_FALSE(m.work.errors.worst().has_value());
  EXPECT_EQ(n_particles(m), policy == OnExit::remove ? before - 1 : before);
  EXPECT_EQ(m.state.mass.held_count, policy == OnExit::remove ? 0 : 1);
  end_sweeps(m);
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p)
    EXPECT_TRUE(m.state.particles.v[p].allFinite() && m.state.particles.applied[p].allFinite()) << p;
}

TEST(Sweep, AForceThatIsNotDefinedOutsideTheMeshHarmsNoParticle)
{
  for (const OnExit policy : {OnExit::stop, OnExit::remove}) {
    force_is_not_defined_outside<Projected<2>>(policy);
    force_is_not_defined_outside<Umls<2>>(policy);
  }
}

/// A few particles fly over many blocks; in some steps more of a block leave it than stay.
template <class K>
void nothing_is_lost_between_blocks(TransferOptions transfer)
{
  auto m = make_model<K>(unit_box<2>(24, 0.2));
  add_body<2>(
      m, "pebble", rubber(1e3, 0.3, 1000), 6, [](const Vec<2>& x) { return (x - Vec<2>(0.2, 0.3)).norm() < 0.03; },
      [](const Vec<2>&) { return Vec<2>(1, 0.5); });
  m.problem.transfer = transfer;
  m.state.materials[0].averages_volume = true;
  make_ready(m);
  std::set<Index> blocks;
  for (int step = 0; step < 120; ++step) {
    make_step(m, 4e-3);
    ASSERT_NEAR(m.state.mass.on_nodes, m.state.mass.start, 1e-12 * m.state.mass.start) << step;
    for (Index block = 0; block < m.work.strips->blocks(); ++block)
      if (m.work.strips->size(m.work.strips->key(0, block)) > 0)
        blocks.insert(block);
  }
  EXPECT_FALSE(m.work.errors.worst().has_value());
  EXPECT_GT(blocks.size(), 2U);
  EXPECT_NEAR((totals(m).momentum - m.state.mass.start * Vec<2>(1, 0.5)).norm(), 0, 1e-11 * m.state.mass.start);
}

TEST(Sweep, InPartsLosesNothingWhereParticlesLeaveABlock)
{
  for (const TransferOptions& transfer : all_transfers()) {
    SCOPED_TRACE(static_cast<int>(transfer.scheme) * 10 + (transfer.uses_musl() ? 1 : 0));
    nothing_is_lost_between_blocks<Projected<2>>(transfer);
    nothing_is_lost_between_blocks<Linear<2>>(transfer);
  }
}

}  // namespace
}  // namespace talus::testing::sweep_test
