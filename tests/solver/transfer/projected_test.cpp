// Kernels with a node part in the solver: the way to the nodes is the way back transposed, linear motions are exact at surfaces too.
#include <gtest/gtest.h>

#include <random>

#include "tests/solver/blocks_of_particles.hpp"

namespace talus::testing::projected_test {
namespace {

template <int N>
struct Dimension {
  static constexpr int D = N;
};
template <class S>
class ProjectedIn : public ::testing::Test {};
using Dimensions = ::testing::Types<Dimension<2>, Dimension<3>>;
TYPED_TEST_SUITE(ProjectedIn, Dimensions);

/// A ball that cuts cells, with random stress and velocity in its particles; every particle's cell is known.
template <class S>
Model<S::D> ball(bool of_two_materials = false, AtSurfaces surfaces = AtSurfaces::plain)
{
  constexpr int D = S::D;
  auto m = make_model<Projected<D>>(unit_box<D>(D == 2 ? 10 : 6, 0.2), {.surfaces = surfaces});
  m.problem.transfer = {.scheme = Scheme::flip, .musl = false, .pic_damping_time = {}, .pic_damping_crossings = {}};
  const auto inside = [](const Vec<D>& x) { return (x - Vec<D>::Constant(0.5)).norm() < 0.4; };
  const auto on_top = [](const Vec<D>& x) { return x[D - 1] + 0.3 * x[0] > 0.65; };
  for (const bool top : {true, false})
    if (top || of_two_materials)
      add_body<D>(m, top ? "top" : "bottom", rubber(1e4, 0.3, 1000), D == 2 ? 6 : 10,
                  [&](const Vec<D>& x) { return inside(x) && (!of_two_materials || on_top(x) == top); });
  std::mt19937 random(1);
  std::uniform_real_distribution<Real> number(-1, 1);
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p) {
    Vec<D> x = m.state.particles.x[p], v;
    for (int d = 0; d < D; ++d)
      x[d] += 1e-3 * number(random), v[d] = number(random);
    m.state.particles.x.set(p, x);
    m.state.particles.v.set(p, v);
  }
  make_ready(m);
  advance(m, 1e-12);
  set_each(m.state.particles.stress, [&](std::size_t) { return Sym3(Sym3::NullaryExpr([&] { return number(random); })); });
  return m;
}

/// Any velocities at all, and what the particles read of them; nothing moves.
template <int D>
void read_random_motion(Model<D>& m)
{
  std::mt19937 random(2);
  std::uniform_real_distribution<Real> number(-1, 1);
  for (auto& node : m.work.fields[0].nodes.motion)
    for (int d = 0; d < D; ++d)
      node.change[d] = node.v[d] = number(random);
}

/// Sums the particles on nodes, gives these a motion and lets the particles read it.  The stress of the particles is kept.
template <int D, class SetMotion>
void sum_and_read(Model<D>& m, SetMotion&& set_motion)
{
  const auto stress = m.state.particles.stress;
  begin_sweeps(m);
  m.work.strips->send_leavers(m.problem.subdomain, m.work.migration);
  m.transfer->particles_to_nodes(m);
  m.transfer->assemble_nodes(m);
  set_motion(m);
  m.work.stress_sums.assign(m.work.strips->keys(), {});
  m.transfer->nodes_to_particles(m, Kick{}, 0, {});
  end_sweeps(m);
  m.state.particles.stress = stress;
}

template <class S>
void forces_do_the_work_that_strains_the_particles(bool of_two_materials, AtSurfaces surfaces)
{
  constexpr int D = S::D;
  auto m = ball<S>(of_two_materials, surfaces);
  sum_and_read(m, read_random_motion<D>);
  EXPECT_EQ(transfer_of<Projected<D>>(m).rows().interfaces.mixed_nodes() > 10, of_two_materials);
  EXPECT_EQ(transfer_of<Projected<D>>(m).rows().extension.extended().size() > 10, surfaces == AtSurfaces::extended);
  Real power = 0, stress_power = 0, size = 0;
  for (std::size_t n = 0; n < m.work.fields[0].nodes.sum.size(); ++n)
    power += m.work.fields[0].nodes.sum[n].force.dot(m.work.fields[0].nodes.motion[n].v);
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p) {
    const Mat<D> sigma = unpack(m.state.particles.stress[p]).template topLeftCorner<D, D>();
    stress_power += m.state.particles.volume[p] * sigma.cwiseProduct(m.state.particles.L[p]).sum();
    size += m.state.particles.volume[p] * sigma.norm() * m.state.particles.L[p].norm();
  }
  EXPECT_NEAR(power, -stress_power, 1e-13 * size);
  EXPECT_GT(size, 0.1);
}

TYPED_TEST(ProjectedIn, ForcesDoTheWorkThatStrainsTheParticles)
{
  for (const bool of_two_materials : {false, true})
    for (const AtSurfaces surfaces : {AtSurfaces::plain, AtSurfaces::extended})
      forces_do_the_work_that_strains_the_particles<TypeParam>(of_two_materials, surfaces);
}

TYPED_TEST(ProjectedIn, MomentumIsScatteredByTheTransposeOfTheGather)
{
  auto m = ball<TypeParam>();
  const auto v = m.state.particles.v;
  sum_on_nodes(m);
  read_random_motion(m);
  m.state.particles.v.assign(m.state.particles.v.size(), Vec<TypeParam::D>::Zero());
  read_nodes(m, 0);  // flip: the increment, which is the velocity here
  Real nodes = 0, particles = 0, size = 0;
  for (std::size_t n = 0; n < m.work.fields[0].nodes.sum.size(); ++n)
    nodes += m.work.fields[0].nodes.sum[n].momentum.dot(m.work.fields[0].nodes.motion[n].v);
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p) {
    particles += m.state.particles.mass[p] * v[p].dot(m.state.particles.v[p]);
    size += m.state.particles.mass[p] * v[p].norm() * m.state.particles.v[p].norm();
  }
  EXPECT_NEAR(nodes, particles, 1e-13 * size);
}

TYPED_TEST(ProjectedIn, LinearMotionsAreStrainedExactlyUpToTheSurface)
{
  constexpr int D = TypeParam::D;
  const Mat<D> A = Mat<D>::Random();
  for (const auto& [of_two_materials, surfaces] : {std::pair{false, AtSurfaces::plain}, std::pair{true, AtSurfaces::plain},
                                                   std::pair{false, AtSurfaces::extended}, std::pair{true, AtSurfaces::extended}}) {
    auto m = ball<TypeParam>(of_two_materials, surfaces);
    sum_and_read(m, [&](Model<D>& of) {
      for (Index n = 0; n < of.problem.mesh.n_nodes(); ++n)
        of.work.fields[0].nodes.motion[static_cast<std::size_t>(n)].v = A * of.problem.mesh.node(n) + Vec<D>::Ones();
    });
    for (std::size_t p = 0; p < m.state.particles.L.size(); ++p)
      ASSERT_LT((m.state.particles.L[p] - A).norm(), 1e-12);
  }
}

/// The velocities of a node without particles, beside a surface along the first axis, are those of the motion inside continued along the
/// surface; across it they are its own.  Without extension it is as it was.
TYPED_TEST(ProjectedIn, NodesBesideASurfaceContinueTheMotionAlongIt)
{
  constexpr int D = TypeParam::D;
  for (const AtSurfaces at_surfaces : {AtSurfaces::extended, AtSurfaces::plain}) {
    auto m = make_model<Projected<D>>(unit_box<D>(D == 2 ? 10 : 6, 0.0), {.surfaces = at_surfaces});
    m.problem.transfer = {.scheme = Scheme::flip, .musl = false, .pic_damping_time = {}, .pic_damping_crossings = {}};
    add_body<D>(m, "layer", rubber(1e4, 0.3, 1000), D == 2 ? 6 : 10, [](const Vec<D>& x) { return x[D - 1] < 0.5; });
    make_ready(m);
    sum_and_read(m, [](Model<D>& of) {
      for (Index n = 0; n < of.problem.mesh.n_nodes(); ++n) {
        const Vec<D>& x = of.problem.mesh.node(n);
        of.work.fields[0].nodes.motion[static_cast<std::size_t>(n)].v = (x[D - 1] > 0.5 + 1e-9 ? 7 : x[D - 1]) * Vec<D>::Ones();
      }
    });
    const auto& extension = transfer_of<Projected<D>>(m).rows().extension;
    EXPECT_EQ(extension.extended().size() > 5, at_surfaces == AtSurfaces::extended);
    int above = 0;
    for (const Index n : extension.extended()) {
      const Vec<D>& x = m.problem.mesh.node(n);
      if ((x.template head<D - 1>().array() < 0.3).any() || (x.template head<D - 1>().array() > 0.7).any())
        continue;  // where the surface ends, it has no clear direction
      // (E v - v_n) / (x - 7) = (1 - n n) 1 for this motion, of which n follows
      const Vec<D> along = (extension.velocity(n, Vec<D>::Zero()) - 7 * Vec<D>::Ones()) / (x[D - 1] - 7);
      EXPECT_NEAR(along.squaredNorm(), along.sum(), 1e-9) << "a projection";
      const Vec<D> normal = (Vec<D>::Ones() - along) / std::sqrt(D - along.sum());
      EXPECT_GT(normal[D - 1], D == 2 ? 1 - 1e-9 : 0.99) << "in 3-D the cells of the box are not mirrored, and the normal leans a little";
      ++above;
    }
    EXPECT_EQ(above > 0, at_surfaces == AtSurfaces::extended);
  }
}

/// Single particles and films have no inside whose motion could be continued.
TYPED_TEST(ProjectedIn, SingleParticlesExtendNothing)
{
  constexpr int D = TypeParam::D;
  auto m = make_model<Projected<D>>(unit_box<D>(D == 2 ? 10 : 6, 0.2), {.surfaces = AtSurfaces::extended});
  m.problem.transfer = {.scheme = Scheme::flip, .musl = false, .pic_damping_time = {}, .pic_damping_crossings = {}};
  Index cell = 0;
  while ((centroid(m.problem.mesh, cell) - Vec<D>::Constant(0.5)).norm() > 0.15)
    ++cell;
  add_body<D>(m, "particle", rubber(1e4, 0.3, 1000), D == 2 ? 6 : 10, [&](const Vec<D>& x) { return x == centroid(m.problem.mesh, cell); });
  m.state.particles.volume0.assign(m.state.particles.volume0.size(), 0.1 * m.problem.mesh.volume(cell));
  make_ready(m);
  sum_on_nodes(m);
  EXPECT_TRUE(transfer_of<Projected<D>>(m).rows().extension.extended().empty());
}

/// Bodies of one material have no nodes between materials.
TYPED_TEST(ProjectedIn, BodiesOfOneMaterialShareTheirGradients)
{
  constexpr int D = TypeParam::D;
  const auto mixed_nodes = [](const std::array<Index, 2>& kinds) {
    auto m = make_model<Projected<D>>(unit_box<D>(D == 2 ? 8 : 4, 0.2));
    m.problem.transfer = {.scheme = Scheme::flip, .musl = false, .pic_damping_time = {}, .pic_damping_crossings = {}};
    for (const bool top : {true, false})
      add_body<D>(m, top ? "top" : "bottom", rubber(1e4, 0.3, 1000), D == 2 ? 6 : 10, [&](const Vec<D>& x) { return (x[0] > 0.5) == top; });
    for (std::size_t b = 0; b < kinds.size(); ++b)
      m.state.materials[b].kind = kinds[b];
    make_ready(m);
    sum_on_nodes(m);
    return transfer_of<Projected<D>>(m).rows().interfaces.mixed_nodes();
  };
  EXPECT_EQ(mixed_nodes({3, 3}), 0U);
  EXPECT_GT(mixed_nodes({3, 4}), 5U);
}

/// Bodies of different materials that meet at a boundary of cells: motion of one alone does not strain the other.
TYPED_TEST(ProjectedIn, AMotionOfOneMaterialDoesNotStrainTheOther)
{
  constexpr int D = TypeParam::D;
  auto m = make_model<Projected<D>>(unit_box<D>(D == 2 ? 8 : 4, 0.0));
  m.problem.transfer = {.scheme = Scheme::flip, .musl = false, .pic_damping_time = {}, .pic_damping_crossings = {}};
  for (const bool top : {true, false})
    add_body<D>(m, top ? "slide" : "base", rubber(1e4, 0.3, 1000), D == 2 ? 6 : 10,
                [&](const Vec<D>& x) { return (x[D - 1] > 0.5) == top; });
  make_ready(m);
  sum_and_read(m, [](Model<D>& of) {
    for (Index n = 0; n < of.problem.mesh.n_nodes(); ++n)
      of.work.fields[0].nodes.motion[static_cast<std::size_t>(n)].v =
          (of.problem.mesh.node(n)[D - 1] > 0.5 + 1e-9 ? 1 : 0) * Vec<D>::UnitX();
  });
  Real most = 0;
  for (std::size_t p = 0; p < m.state.particles.L.size(); ++p)
    if (m.state.particles.x[p][D - 1] < 0.5) {
      ASSERT_EQ(m.state.particles.L[p].norm(), 0) << "of the base";
    } else {
      most = std::max(most, m.state.particles.L[p].norm());
    }
  EXPECT_GT(most, 1);
}

/// A film of particles on the floor, a fiftieth of a cell thick, that is pulled along it and has ends: the nodes above it have hardly
/// any mass, and must not run away under its stress.
TEST(Projected, HoldsAFilmOnAWall)
{
  auto m = make_model<Projected<2>>(unit_box<2>(8, 0.2));
  m.problem.transfer = {.scheme = Scheme::aflip, .musl = true, .pic_damping_time = {}, .pic_damping_crossings = 25};
  add_body<2>(m, "film", rubber(1e5, 0.3, 1000), 12, [](const Vec<2>& x) { return x[1] < 0.1 && x[0] > 0.25 && x[0] < 0.75; });
  const Real share = 0.02;
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p) {
    m.state.particles.v.set(p, {0.1 * std::sin(12 * m.state.particles.x[p][0]), 0});
    m.state.particles.x.set(p, m.state.particles.x[p].cwiseProduct(Vec<2>(1, share)));
    m.state.particles.volume0.set(p, share * m.state.particles.volume0[p]);
    m.state.particles.mass.set(p, share * m.state.particles.mass[p]);
  }
  close_off(m, "y_min", Roller<2>{});
  m.problem.loads.gravity.acceleration = {0, -10};
  make_ready(m);
  const Real kinetic = totals(m).kinetic;
  ASSERT_NO_THROW(run_until(m, 0.05));
  EXPECT_LT(totals(m).kinetic, kinetic);
  for (const auto& x : m.state.particles.x.values()) {
    EXPECT_GT(x[1], 0);
    EXPECT_LT(x[1], 1.1 * share / 8) << "the height of the film at the start";
  }
}

/// A block slides on a rough floor: its momentum is what gravity and the floor gave, and the floor rubs with its share of what it bears.
void slide_on_a_rough_floor(Scheme scheme)
{
  auto m = make_model<Projected<2>>(unit_box<2>(8, 0.2));
  m.problem.transfer = {.scheme = scheme, .musl = true, .pic_damping_time = {}, .pic_damping_crossings = 25};
  add_body<2>(m, "block", rubber(1e5, 0.3, 1000), 6, [](const Vec<2>& x) { return x[0] < 0.6 && x[1] < 0.4; });
  m.state.particles.v.assign(m.state.particles.v.size(), Vec<2>{2, -0.5});
  const Real friction = 0.4;
  close_off(m, "y_min", Friction<2>{friction});
  m.problem.loads.gravity.acceleration = {1, -10};
  make_ready(m);
  const Totals<2> start = totals(m);
  const auto floor = *m.problem.mesh.facet_set("y_min");
  for (int step = 0; step < 60; ++step) {
    advance(m, 1e-3);
    for (const Facet facet : floor)
      for (const Index n : m.problem.mesh.nodes_of(facet))
        if (transfer_of<Projected<2>>(m).rows().projected.sum[static_cast<std::size_t>(n)].is_seen()) {
          ASSERT_GT(transfer_of<Projected<2>>(m).rows().projected.motion[static_cast<std::size_t>(n)].v[1], -1e-12)
              << "what particles read leads into the floor";
        }
  }
  const Totals<2> end = totals(m);
  const Vec<2> floor_gave = m.state.boundary.conditions()[0].impulse,
               gravity_gave = end.mass * (m.state.clock.time - m.state.clock.lag) * m.problem.loads.gravity.acceleration;
  EXPECT_LT((end.momentum - start.momentum - floor_gave - gravity_gave).norm(), 1e-10 * start.momentum.norm());
  EXPECT_LT(-floor_gave[0], friction * (1 + 1e-10) * floor_gave[1]);
  EXPECT_GT(-floor_gave[0], 0.75 * friction * floor_gave[1]);
}

TEST(Projected, AFloorGivesMomentumAndRubsWithItsShare)
{
  for (const Scheme scheme : {Scheme::flip, Scheme::aflip, Scheme::tpic})
    slide_on_a_rough_floor(scheme);
}

/// A body without stiffness, all of its particles in cells at the boundary of the mesh, which is free: nothing but transfer.
Real motion_left(Index cells, int steps)
{
  auto m = make_model<Projected<2>>(unit_box<2>(cells, 0.2));
  m.problem.transfer = {.scheme = Scheme::tpic, .musl = false, .pic_damping_time = {}, .pic_damping_crossings = {}};
  add_body<2>(m, "dust", rubber(1e-9, 0, 1000), 6, [](const Vec<2>&) { return true; });
  std::mt19937 random(3);
  std::uniform_real_distribution<Real> number(-1e-9, 1e-9);
  set_each(m.state.particles.v, [&](std::size_t) { return Vec<2>{number(random), number(random)}; });
  make_ready(m);
  const Real start = totals(m).kinetic;
  for (int step = 0; step < steps; ++step)
    advance(m, 1e-2);
  return totals(m).kinetic / start;
}

TEST(Projected, TransferToAndFroMakesNoMotion)
{
  for (const Index cells : {1, 2, 8})
    EXPECT_LT(motion_left(cells, 200), 1) << cells;
}

TEST(Projected, AColumnUnderItsWeightComesToRest)
{
  auto m = make_model<Projected<2>>(Mesh<2>(jittered(box<2>({0, 0}, {2, 12}, {2, 12}), 0.2, 1)));
  m.problem.transfer = {.scheme = Scheme::aflip, .musl = true, .pic_damping_time = {}, .pic_damping_crossings = 25};
  add_body<2>(m, "column", rubber(1e7, 0.3, 1000), 6, [](const Vec<2>& x) { return x[1] < 10; });
  for (const char* side : {"x_min", "x_max", "y_min"})
    close_off(m, side, Roller<2>{});
  m.problem.loads.gravity.acceleration = {0, -10};
  make_ready(m);
  Stage rest = test_stage(6);  // 17 periods of the column
  rest.damping = 0.8;
  rest.residual = 1e-3;
  ASSERT_NO_THROW(run_stage(m, rest, StepLimits{.cfl = 0.4}, [](const auto&, RunEvent) {}));
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p)
    ASSERT_NEAR(m.state.particles.stress[p][1], -1e4 * (10 - m.state.particles.x[p][1]), 1e4) << "the weight of a layer of cells";
}

}  // namespace
}  // namespace talus::testing::projected_test
