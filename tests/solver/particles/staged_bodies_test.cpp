// Bodies taken out of a model and put back into it are what they were; places that are taken are found.
#include "solver/particles/staged_bodies.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/solver/blocks_of_particles.hpp"

namespace talus::bodies_of_stages_test {
namespace {

using testing::add_body;
using testing::rubber;
using M = Model<2>;

/// Three bodies side by side, each in a third of the width.
M three_bodies()
{
  M m = make_model<Linear<2>>(Mesh<2>(box<2>({0, 0}, {3, 1}, {6, 2})));
  for (const int third : {0, 1, 2})
    add_body<2>(m, std::string(1, static_cast<char>('a' + third)), rubber(1e5, 0.3, 1000 + third), 3,
                [third](const Vec<2>& x) { return x[0] > third && x[0] < third + 1; });
  make_ready(m);
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p)
    m.state.particles.v.set(p, {static_cast<Real>(p), 0});
  return m;
}

TEST(BodiesOfStages, AreTheSameAfterTheyWentAndCame)
{
  M m = three_bodies();
  const Particles<2> before = m.state.particles;
  const std::vector<Body> bodies = m.state.bodies;
  const std::vector<Index> goes{1};
  ParticleSet<2> out = extract_bodies<2>(goes, m.state.bodies, m.state.materials, m.state.particles);
  EXPECT_EQ(m.state.bodies[1].size(), 0);
  EXPECT_EQ(m.state.particles.size(), before.size() - bodies[1].size());
  EXPECT_EQ(out.particles.size(), bodies[1].size());
  EXPECT_EQ(out.particles.id.front(), bodies[1].begin) << "its number";
  EXPECT_EQ(m.state.materials[2].begin, m.state.bodies[2].begin);

  insert_particles(std::move(out), m.state.bodies, m.state.materials, m.state.particles);
  EXPECT_EQ(m.state.particles.id, before.id);
  EXPECT_EQ(m.state.particles.cell, before.cell);
  for (std::size_t b = 0; b < m.state.bodies.size(); ++b) {
    EXPECT_EQ(m.state.bodies[b].begin, bodies[b].begin);
    EXPECT_EQ(m.state.bodies[b].end, bodies[b].end);
    EXPECT_EQ(m.state.materials[b].size(), m.state.bodies[b].size());
    EXPECT_EQ(m.state.materials[b].history.size(), m.state.bodies[b].size());
  }
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p) {
    EXPECT_EQ(m.state.particles.v[p][0], static_cast<Real>(p));
    EXPECT_EQ(m.state.particles.x[p], before.x[p]);
  }
}

TEST(BodiesOfStages, OverlapIsWhatCellsHoldBeyondTheirVolume)
{
  const M m = three_bodies();
  const auto volumes = [&](Index body) {
    return volume_in_cells(m.problem.mesh, m.state.particles, m.work.order, [body](Index b) { return b == body; });
  };
  const auto a = volumes(0), b = volumes(1);
  EXPECT_NEAR(std::accumulate(a.begin(), a.end(), Real{0}), 1, 1e-12);
  const Overlap<2> none_at_all = overlap<2>(m.problem.mesh, a, b, one_rank()), all = overlap<2>(m.problem.mesh, a, a, one_rank());
  EXPECT_EQ(none_at_all.cells, 0);
  EXPECT_EQ(none_at_all.share(), 0);
  EXPECT_EQ(none_at_all.place, "");
  EXPECT_EQ(all.cells, 8);
  EXPECT_NEAR(all.share(), 1, 1e-12);
  EXPECT_EQ(all.place.front(), '(');
}

}  // namespace
}  // namespace talus::bodies_of_stages_test
