// What particles read of nodes: the share of PIC, the field of APIC, and loads that act alike through every kernel.
#include <gtest/gtest.h>

#include <random>

#include "tests/solver/blocks_of_particles.hpp"

namespace talus::testing::read_back_test {
namespace {

template <class K>
Model<2> block(const TransferOptions& transfer)
{
  auto m = make_model<K>(unit_box<2>(6, 0.2));
  m.problem.transfer = transfer;
  add_body<2>(m, "block", rubber(1e4, 0.3, 1000), 3, [](const Vec<2>& x) { return (x - Vec<2>(0.5, 0.5)).norm() < 0.35; });
  return m;
}

/// Velocities of the particles after one step from random ones, without an affine field, with this time of PIC.
std::vector<Vec<2>> after_a_step(Scheme scheme, bool musl, std::optional<Real> time)
{
  auto m = block<Umls<2>>({.scheme = scheme, .musl = musl, .pic_damping_time = time, .pic_damping_crossings = {}});
  std::mt19937 random(5);
  std::uniform_real_distribution<Real> number(-1, 1);
  set_each(m.state.particles.v, [&](std::size_t) { return Vec<2>(number(random), number(random)); });
  make_ready(m);
  advance(m, 1e-3);
  std::vector<Vec<2>> v;
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p)
    v.push_back(m.state.particles.v[p]);
  return v;
}

TEST(ReadBack, PicTakesItsShareOfTheVelocityOfTheNodes)
{
  for (const bool musl : {false, true}) {
    const auto flip = after_a_step(Scheme::flip, musl, {}), both = after_a_step(Scheme::flip, musl, 4e-3);
    const auto pic = after_a_step(Scheme::tpic, musl, {});  // which takes what the nodes have
    Real apart = 0;
    for (std::size_t p = 0; p < flip.size(); ++p) {
      EXPECT_LT((both[p] - (0.75 * flip[p] + 0.25 * pic[p])).norm(), 1e-13) << p;
      apart = std::max(apart, (flip[p] - pic[p]).norm());
    }
    EXPECT_GT(apart, 0.1) << "otherwise every share would do";
  }
}

/// The field C leaves no moment of what it does not explain: sum w (v - C r) (x) r = 0, whatever the motion.
TEST(ReadBack, TheFieldOfApicLeavesNoMoment)
{
  using K = Umls<2>;
  const Mesh<2> mesh = unit_box<2>(6, 0.2);
  const K kernel(mesh);
  std::mt19937 random(7);
  std::uniform_real_distribution<Real> number(-1, 1);
  SparseRows<NodeMotion<2>> rows(static_cast<std::size_t>(mesh.n_nodes()));
  for (auto& row : rows)
    row.v = {number(random), number(random)};
  int inside = 0;
  for (Index c = 0; c < mesh.n_cells(); ++c) {
    Vec<2> place = Vec<2>::Zero();
    for (const Index n : mesh.cell(c))
      place += mesh.node(n) / 3;
    if ((place - Vec<2>(0.5, 0.5)).norm() > 0.25)
      continue;
    ++inside;
    K::Cell cell;
    kernel.open(mesh, c, cell);
    Weights<2, K::max_nodes> weights;
    const Pack x[2] = {broadcast(place[0]), broadcast(place[1])};
    kernel.evaluate(cell, x, 1, weights);
    CellMotion<2, K::max_nodes> motion;
    motion.read(rows, cell.nodes, cell.padded_size);
    const Mat<2> C = apic_field(cell, motion, weights, 0, place, Mat<2>(Mat<2>::Zero()));
    NodeWeights<2, K::max_nodes> plain;
    weights.spell_out(0, plain);
    Mat<2> left = Mat<2>::Zero(), whole = Mat<2>::Zero();
    for (std::size_t a = 0; a < cell.nodes.size(); ++a) {
      const Vec<2> r = mesh.node(cell.nodes[a]) - place, v = rows[static_cast<std::size_t>(cell.nodes[a])].v;
      left += plain.w[a] * (v - C * r) * r.transpose();
      whole += plain.w[a] * v * r.transpose();
    }
    EXPECT_LT(left.norm(), 1e-12) << c;
    EXPECT_GT(whole.norm(), 1e-6) << c;
  }
  EXPECT_GT(inside, 5);
}

/// A force of place that is the same everywhere moves a block as gravity does.
template <class K>
void falls_as_in_gravity()
{
  const Vec<2> g(3, -10);
  const auto velocities = [&](bool of_place) {
    auto m = block<K>({.scheme = Scheme::flip, .musl = true, .pic_damping_time = {}, .pic_damping_crossings = {}});
    if (of_place)
      m.problem.loads.of_place.push_back({[&](std::span<const Vec<2>> places, Real, std::span<Vec<2>> accelerations) {
        std::fill_n(accelerations.begin(), places.size(), g);
      }});
    else
      m.problem.loads.gravity.acceleration = g;
    make_ready(m);
    for (int step = 0; step < 5; ++step)
      advance(m, 1e-3);
    std::vector<Vec<2>> v;
    for (std::size_t p = 0; p < m.state.particles.id.size(); ++p)
      v.push_back(m.state.particles.v[p]);
    return v;
  };
  const auto by_place = velocities(true), by_gravity = velocities(false);
  for (std::size_t p = 0; p < by_place.size(); ++p) {
    EXPECT_LT((by_place[p] - by_gravity[p]).norm(), 1e-10) << p;
    EXPECT_GT(by_gravity[p].norm(), 4e-3 * g.norm()) << p;
  }
}

TEST(ReadBack, ForcesOfPlaceReachNodesThroughEveryKernel)
{
  falls_as_in_gravity<Linear<2>>();
  falls_as_in_gravity<Umls<2>>();
  falls_as_in_gravity<Projected<2>>();
}

}  // namespace
}  // namespace talus::testing::read_back_test
