// Bodies in contact at their extremes: very unequal masses and stiffnesses, thin bodies, corners, long rest.  Meshes follow no body.
#include <gtest/gtest.h>

#include "tests/solver/blocks_of_particles.hpp"

namespace talus::testing::contact_extremes_test {
namespace {

template <int D>
struct Shape {
  Shape(std::string of, const NeoHookean& law_of, std::function<bool(const Vec<D>&)> holds, const Vec<D>& v = Vec<D>(Vec<D>::Zero()))
      : name(std::move(of)), law(law_of), inside(std::move(holds)), velocity(v)
  {}
  std::string name;
  NeoHookean law;
  std::function<bool(const Vec<D>&)> inside;
  Vec<D> velocity;
};

/// What fills the box between two corners.
template <int D>
auto between(const Vec<D>& low, const Vec<D>& high)
{
  return [=](const Vec<D>& x) { return (x.array() >= low.array()).all() && (x.array() < high.array()).all(); };
}

/// A square that stands on a corner.
auto diamond(const Vec<2>& centre, Real half)
{
  return [=](const Vec<2>& x) { return (x - centre).cwiseAbs().sum() < half; };
}

/// Adds the particles of a body at those points of the cells that are inside it.
template <int D>
void add_shape(Model<D>& m, const Shape<D>& shape, int per_cell)
{
  auto& p = m.state.particles;
  const Index begin = p.size();
  const auto points = seeding_points<D>(per_cell).value();
  for (Index c = 0; c < m.problem.mesh.n_cells(); ++c)
    for (const auto& B : points) {
      Vec<D> x = Vec<D>::Zero();
      for (std::size_t k = 0; k <= D; ++k)
        x += B[k] * m.problem.mesh.node(m.problem.mesh.cell(c)[k]);
      if (!shape.inside(x))
        continue;
      const Real volume = m.problem.mesh.volume(c) / per_cell;
      p.id.push_back(p.size());
      p.cell.push_back(c);
      p.x.push_back(x);
      p.v.push_back(shape.velocity);
      p.L.push_back(Mat<D>::Zero());
      p.F.push_back(Mat3::Identity());
      p.stress.push_back(Sym3::Zero());
      p.volume0.push_back(volume);
      p.mass.push_back(shape.law.density * volume);
    }
  m.state.bodies.push_back({shape.name, begin, p.size(), {}});
  m.state.materials.push_back(make_material(shape.law, begin, p.size(), shape.name));
}

/// Bodies under gravity on a fixed floor, each with a velocity field of its own, in a box with cells of 1/n.
template <int D>
Model<D> bodies(const std::vector<Shape<D>>& shapes, Real friction, Index n, Real gravity = 10, int per_cell = 4)
{
  auto m = make_model<Projected<D>>(unit_box<D>(n, 0.2));
  m.problem.transfer.scheme = Scheme::aflip;
  for (const Shape<D>& shape : shapes)
    add_shape(m, shape, per_cell);
  m.problem.loads.gravity.acceleration = -gravity * Vec<D>::Unit(D - 1);
  close_off<D>(m, D == 2 ? "y_min" : "z_min", Fixed<D>{});
  Contacts& contacts = m.problem.contacts;
  contacts.n_fields = static_cast<Index>(shapes.size());
  for (Index a = 0; a < contacts.n_fields; ++a) {
    contacts.field_of_body.push_back(a);
    for (Index b = a + 1; b < contacts.n_fields; ++b)
      contacts.laws.push_back({.first = a, .second = b, .friction = friction, .first_body = {}, .second_body = {}});
  }
  make_ready(m);
  return m;
}

/// What a run found.
struct Found {
  Real made = 0;       ///< the most by which kinetic and strain energy exceeded those of the start and the work done [J]
  Real regained = 0;   ///< the most by which that excess rose above a former value [J]
  Real there = 0;      ///< largest sum of both [J]
  std::size_t passed;  ///< particles at the end whose six nearest neighbours are of other bodies
  std::int64_t steps;
};

template <int D>
std::size_t count_passed(const State<D>& state)
{
  const auto& x = state.particles.x;
  std::size_t count = 0;
  const auto body_of = [&](std::size_t p) {
    return std::ranges::find_if(state.bodies, [&](const Body& body) { return static_cast<Index>(p) < body.end; }) - state.bodies.begin();
  };
  for (std::size_t p = 0; p < x.size(); ++p) {
    std::vector<std::pair<Real, bool>> others;
    for (std::size_t q = 0; q < x.size(); ++q)
      if (q != p)
        others.emplace_back((x[p] - x[q]).squaredNorm(), body_of(q) == body_of(p));
    std::ranges::partial_sort(others, others.begin() + 6);
    count += std::none_of(others.begin(), others.begin() + 6, [](const auto& other) { return other.second; });
  }
  return count;
}

template <int D>
Found run(Model<D>& m, Real end)
{
  Found found{};
  const Real start = totals(m).kinetic;
  Real least = 0;
  set_threads(1);  // so few particles are quicker alone
  const auto see = [&](const Model<D>& now, RunEvent event) {
    if (event != RunEvent::step_done || now.state.clock.step % 10 != 0)
      return;
    const EnergyLedger ledger = now.state.energy.at_velocities();
    const Real energy = totals(now).kinetic + ledger.internal;
    found.there = std::max(found.there, energy);
    const Real excess = energy - start - ledger.gravity - ledger.walls;
    found.made = std::max(found.made, excess);
    least = std::min(least, excess);
    found.regained = std::max(found.regained, excess - least);
  };
  run_stage(m, test_stage(end), StepLimits{.cfl = 0.4}, {see, true});
  found.passed = count_passed(m.state);
  found.steps = m.state.clock.step;
  return found;
}

template <int D>
void expect_sound(Model<D>& m, Real end)
{
  const Found found = run(m, end);
  EXPECT_LT(found.made, 1e-3 * found.there);
  EXPECT_EQ(found.passed, 0U);
  std::printf("  %lld steps, %zu particles, energy made %.1e and regained %.1e of %.3g J\n", static_cast<long long>(found.steps),
              m.state.particles.id.size(), found.made / found.there, found.regained / found.there, found.there);
}

/// A block on the floor and another that falls on it.
template <int D>
void drop(const NeoHookean& low, const NeoHookean& high, Real end)
{
  const Index n = D == 2 ? 12 : 6;
  Vec<D> low_corner = Vec<D>::Constant(0.1), high_corner = Vec<D>::Constant(0.9), low_of_high = Vec<D>::Constant(0.25),
         high_of_high = Vec<D>::Constant(0.75), velocity = Vec<D>::Zero();
  low_corner[D - 1] = 0, high_corner[D - 1] = 0.37, low_of_high[D - 1] = 0.38;
  velocity[0] = 0.3, velocity[D - 1] = -1;
  auto m = bodies<D>({{"low", low, between<D>(low_corner, high_corner)}, {"high", high, between<D>(low_of_high, high_of_high), velocity}},
                     0.3, n);
  expect_sound(m, end);
}

template <class S>
class ExtremesIn : public ::testing::Test {};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(ExtremesIn, Dimensions);

TYPED_TEST(ExtremesIn, ABodyTenThousandTimesAsDenseFallsOnAnother)
{
  drop<TypeParam::value>(rubber(1e5, 0.3, 1), rubber(1e5, 0.3, 1e4), TypeParam::value == 2 ? 0.05 : 0.03);
}
TYPED_TEST(ExtremesIn, ABodyFallsOnOneTenThousandTimesAsDense)
{
  drop<TypeParam::value>(rubber(1e5, 0.3, 1e4), rubber(1e5, 0.3, 1), TypeParam::value == 2 ? 0.05 : 0.03);
}
TYPED_TEST(ExtremesIn, ABodyTenThousandTimesAsStiffFallsOnAnother)
{
  drop<TypeParam::value>(rubber(1e5, 0.3, 1000), rubber(1e9, 0.3, 1000), TypeParam::value == 2 ? 0.05 : 0.02);
}
TYPED_TEST(ExtremesIn, ABodyFallsOnOneTenThousandTimesAsStiff)
{
  drop<TypeParam::value>(rubber(1e9, 0.3, 1000), rubber(1e5, 0.3, 1000), TypeParam::value == 2 ? 0.05 : 0.02);
}

TEST(ExtremesInThePlane, ALightBodyIsSqueezedBetweenTwoHeavyOnes)
{
  auto m = bodies<2>({{"low", rubber(1e6, 0.3, 1e4), between<2>({0.1, 0}, {0.9, 0.3})},
                      {"middle", rubber(1e5, 0.3, 1), between<2>({0.3, 0.3}, {0.7, 0.5})},
                      {"high", rubber(1e6, 0.3, 1e4), between<2>({0.25, 0.52}, {0.75, 0.9}), Vec<2>(0, -0.3)}},
                     0.3, 12);
  expect_sound(m, 0.1);
}

TEST(ExtremesInThePlane, ABodyThinnerThanACellIsHitByAnother)
{
  auto m = bodies<2>({{"low", rubber(1e6, 0.3, 1000), between<2>({0.1, 0}, {0.9, 0.3})},
                      {"thin", rubber(1e6, 0.3, 1000), between<2>({0.2, 0.3}, {0.8, 0.34})},
                      {"high", rubber(1e6, 0.3, 1000), between<2>({0.3, 0.37}, {0.7, 0.8}), Vec<2>(0, -1)}},
                     0.3, 12, 10, 6);
  expect_sound(m, 0.4);
}

TEST(ExtremesInThePlane, ThreeBodiesMeetAtANode)
{
  auto m = bodies<2>({{"left", rubber(1e6, 0.3, 1000), between<2>({0.1, 0}, {0.5, 0.34})},
                      {"right", rubber(1e6, 0.3, 1000), between<2>({0.5, 0}, {0.9, 0.34})},
                      {"high", rubber(1e6, 0.3, 1000), between<2>({0.3, 0.37}, {0.7, 0.75}), Vec<2>(0.3, -1)}},
                     0.3, 12);
  expect_sound(m, 0.4);
}

TEST(ExtremesInThePlane, ACornerFallsOnACorner)
{
  for (const Real friction : {0.0, 0.3}) {
    auto m = bodies<2>({{"low", rubber(1e6, 0.3, 1000), diamond({0.5, 0.24}, 0.25)},
                        {"high", rubber(1e6, 0.3, 1000), diamond({0.5, 0.75}, 0.22), Vec<2>(0, -1)}},
                       friction, 12);
    expect_sound(m, 0.3);
  }
}

/// A block at rest on another for so long: it makes no energy and passes through nothing.  Returns how far it sinks and slides meanwhile,
/// after it has come to rest, in cells.
Real creep_at_rest(Real end)
{
  auto m = bodies<2>({{"low", rubber(1e6, 0.3, 1000), between<2>({0.1, 0}, {0.9, 0.36})},
                      {"high", rubber(1e6, 0.3, 1000), between<2>({0.3, 0.36}, {0.7, 0.7})}},
                     0.3, 10);
  const auto middle = [&] {
    Vec<2> sum = Vec<2>::Zero();
    const Body& body = m.state.bodies[1];
    for (Index p = body.begin; p < body.end; ++p)
      sum += m.state.particles.x[static_cast<std::size_t>(p)] / static_cast<Real>(body.end - body.begin);
    return sum;
  };
  const Found first = run(m, 2);
  EXPECT_LT(first.made, 1e-3 * first.there);
  const Vec<2> settled = middle();
  const Real kinetic = totals(m).kinetic;
  const Found rest = run(m, end);
  std::printf("  %lld steps: the block moves %.1e and %.1e m; kinetic energy %.1e, then %.1e J\n", static_cast<long long>(rest.steps),
              middle()[0] - settled[0], middle()[1] - settled[1], kinetic, totals(m).kinetic);
  EXPECT_EQ(rest.passed, 0U);
  EXPECT_LE(totals(m).kinetic, std::max(kinetic, 1e-6 * first.there));
  return (middle() - settled).norm() / 0.1;
}

TEST(ExtremesInThePlane, ABlockRestsOnAnother) { EXPECT_LT(creep_at_rest(4), 0.01); }
// It creeps by 0.056 cells in 845 000 steps (docs/guide/contact.md): what is judged is the energy.
TEST(ExtremesInThePlane, ABlockRestsOnAnotherForAMillionStepsNightly) { EXPECT_LT(creep_at_rest(410), 1); }

}  // namespace
}  // namespace talus::testing::contact_extremes_test
