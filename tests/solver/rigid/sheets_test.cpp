// Sheets that part the material on their two sides: where they part it, where they do not, and what passes through.
#include <gtest/gtest.h>

#include "tests/solver/contact_kinds.hpp"

namespace talus::testing::sheets_test {
namespace {

template <class S>
class SheetIn : public ::testing::Test {};
TYPED_TEST_SUITE(SheetIn, ContactKinds);

/// A sheet x = `at` over these heights, in front of what lies at smaller x.
template <int D>
std::shared_ptr<const RigidShape<D>> upright_sheet(Real low, Real high)
{
  const Real half = (high - low) / 2;
  if constexpr (D == 2)
    return std::make_shared<const RigidShape<2>>(FacetSurface<2>({{0, half}, {0, -half}}, {{0, 1}}), FacetsOf::sheet);
  else
    return std::make_shared<const RigidShape<3>>(
        FacetSurface<3>({{0, -1, -half}, {0, -1, half}, {0, 1, half}, {0, 1, -half}}, {{0, 1, 2}, {0, 2, 3}}), FacetsOf::sheet);
}

struct SheetAt {
  Real x = 0.5, low = -1, high = 2;
  Real mass = 0;  ///< 0: it moves with its velocity
};

template <int D>
bool in_block(const Vec<D>& x)
{
  return (x.template head<D - 1>().array() - 0.5).abs().maxCoeff() < 0.375 && x[D - 1] > 0.1 && x[D - 1] < 0.8;
}

/// A block, and unless there is none a sheet through it or beside it.
template <class S>
Model<S::D> block_and_sheet(const std::optional<SheetAt>& place, const Vec<S::D>& v_sheet,
                            const std::function<Vec<S::D>(const Vec<S::D>&)>& velocity, bool musl = true)
{
  constexpr int D = S::D;
  auto m = make_model<typename S::Kernel>(unit_box<D>(D == 2 ? 16 : 8, 0));
  m.problem.transfer = {.scheme = Scheme::flip, .musl = musl, .pic_damping_time = {}, .pic_damping_crossings = {}};
  add_body<D>(m, "block", rubber(1e4, 0.3, 1000), 4, in_block<D>, velocity);
  if (place) {
    RigidBody<D> sheet{
        .name = "sheet", .shape = upright_sheet<D>(place->low, place->high), .mass = place->mass, .friction = 0, .motion = {}};
    sheet.inertia = place->mass * Mat3::Identity();
    if (place->mass == 0)
      sheet.motion = RigidMotion<D>{v_sheet, Vec3::Zero(), {}};
    RigidState<D> state;
    state.x = Vec<D>::Constant(0.5), state.x[0] = place->x, state.x[D - 1] = (place->low + place->high) / 2, state.v = v_sheet;
    m.problem.rigid.bodies = {sheet};
    m.state.rigid = {state};
  }
  make_ready(m);
  return m;
}

template <int D>
void run(Model<D>& m, int steps, Real dt)
{
  for (int step = 0; step < steps; ++step)
    make_step(m, dt);
  end_sweeps(m);
}

/// The particle with each number.
template <int D>
std::vector<std::size_t> by_id(const Model<D>& m)
{
  std::vector<std::size_t> rows(m.state.particles.id.size());
  for (std::size_t p = 0; p < rows.size(); ++p)
    rows[static_cast<std::size_t>(m.state.particles.id[p])] = p;
  return rows;
}

/// The largest difference of velocities and stresses of particles [m/s] and [Pa].
template <int D>
std::pair<Real, Real> difference(const Model<D>& a, const Model<D>& b)
{
  Real v = 0, stress = 0;
  const auto of_a = by_id(a), of_b = by_id(b);
  for (std::size_t i = 0; i < of_a.size(); ++i) {
    v = std::max(v, (a.state.particles.v[of_a[i]] - b.state.particles.v[of_b[i]]).norm());
    stress = std::max(stress, (a.state.particles.stress[of_a[i]].matrix() - b.state.particles.stress[of_b[i]].matrix()).norm());
  }
  return {v, stress};
}

/// Particles in front of the sheet and behind it.
template <int D>
std::array<Index, 2> count_sides(const Model<D>& m)
{
  std::array<Index, 2> n{};
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p)
    ++n[SideOfSheet(m.state.particles.side[p]).behind ? 1 : 0];
  return n;
}

// Below a sheet whose rim ends above the block, particles have sides, but no node is parted: two fields move as one.
TYPED_TEST(SheetIn, NodesThatItDoesNotPartAreOne)
{
  constexpr int D = TypeParam::D;
  const auto waves = [](const Vec<D>& x) -> Vec<D> {
    return along<D>(D - 1, std::sin(5 * x[0])) + along<D>(0, 0.3 * std::cos(4 * x[D - 1]));
  };
  for (const auto& [musl, damping] : {std::pair{true, 0.0}, std::pair{false, 0.0}, std::pair{true, 0.5}}) {
    auto free = block_and_sheet<TypeParam>({}, Vec<D>::Zero(), waves, musl);
    auto beside = block_and_sheet<TypeParam>(SheetAt{.low = D == 2 ? 0.95 : 1.15}, Vec<D>::Zero(), waves, musl);
    for (auto* const m : {&free, &beside})  // local damping acts on the acceleration that particles of both fields feel
      m->state.stage.damping = damping, m->state.stage.seeks_rest = damping > 0;
    const Real dt = D == 2 ? 1e-3 : 2e-3;
    run(free, 12, dt), run(beside, 12, dt);
    const auto [front, behind] = count_sides(beside);
    EXPECT_GT(front, 20);
    EXPECT_GT(behind, 20);
    const auto [v, stress] = difference(free, beside);
    EXPECT_LT(v, 1e-12);
    EXPECT_LT(stress, 1e-7);
    EXPECT_EQ(beside.state.rigid[0].done.impulse.norm(), 0);
  }
}

TYPED_TEST(SheetIn, BothSidesSlideAlongIt)
{
  constexpr int D = TypeParam::D;
  const auto shear = [](const Vec<D>& x) { return along<D>(D - 1, x[0] < 0.5 ? 1 : -1); };
  auto m = block_and_sheet<TypeParam>(SheetAt{}, Vec<D>::Zero(), shear);
  make_step(m, 1e-7);  // in which particles get their sides
  for (int step = 0; step < 10; ++step)
    make_step(m, 1e-3);
  end_sweeps(m);
  Real off = 0;
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p)
    if (std::abs(m.state.particles.x[p][0] - 0.5) > 0.01)
      off = std::max(off, (m.state.particles.v[p] - shear(m.state.particles.x[p])).norm());
  // The first step mixes both sides near the sheet, by a share of what PIC would.
  EXPECT_LT(off, 1e-2);
  EXPECT_LT(m.state.rigid[0].done.impulse.norm(), 1e-3 * totals(m).mass);
}

TYPED_TEST(SheetIn, AFreeSheetAndTheMaterialKeepTheirMomentum)
{
  constexpr int D = TypeParam::D;
  auto m = block_and_sheet<TypeParam>(SheetAt{.mass = 40}, along<D>(0, 2), [](const Vec<D>&) { return Vec<D>(Vec<D>::Zero()); });
  const auto momentum = [&m] { return Vec<D>(totals(m).momentum + m.problem.rigid.bodies[0].mass * m.state.rigid[0].v); };
  const Vec<D> before = momentum();
  run(m, 20, D == 2 ? 5e-4 : 1e-3);
  EXPECT_LT((momentum() - before).norm(), 1e-11 * before.norm());
  EXPECT_LT(m.state.rigid[0].v[0], 1.9);
  EXPECT_GT(m.state.rigid[0].done.impulse[0], 0);
}

// A sheet that is pushed through a block takes with it all that is in front of its way, and nothing that is behind.
TYPED_TEST(SheetIn, NothingPassesThroughIt)
{
  constexpr int D = TypeParam::D;
  constexpr Real speed = 1;
  auto m = block_and_sheet<TypeParam>(SheetAt{}, along<D>(0, speed), [](const Vec<D>&) { return Vec<D>(Vec<D>::Zero()); });
  std::vector<bool> was_ahead;
  const auto rows = by_id(m);
  for (const std::size_t row : rows)
    was_ahead.push_back(m.state.particles.x[row][0] > 0.5);
  const Real dt = D == 2 ? 5e-4 : 1e-3, h = D == 2 ? 1 / 16.0 : 1 / 8.0;
  run(m, static_cast<int>(0.1 / dt), dt);
  EXPECT_NEAR(m.state.rigid[0].x[0], 0.6, 1e-9);
  Index passed = 0, ahead = 0;
  Real deepest = 0;
  const auto now = by_id(m);
  for (std::size_t i = 0; i < now.size(); ++i) {
    const Real x = m.state.particles.x[now[i]][0];
    ahead += was_ahead[i] ? 1 : 0;
    passed += SideOfSheet(m.state.particles.side[now[i]]).behind != was_ahead[i] && std::abs(x - 0.6) < 2 * h ? 1 : 0;
    if (was_ahead[i])
      deepest = std::max(deepest, 0.6 - x);
    else
      EXPECT_LT(x, 0.6) << "nothing is drawn along";
  }
  EXPECT_EQ(passed, 0);
  EXPECT_GT(ahead, 50);
  EXPECT_LT(deepest, 0.25 * h);
}

TEST(SideOfSheet, IsANumberAndBack)
{
  for (const Index sheet : {none, 0, 1, 7})
    for (const bool behind : {false, true})
      for (const bool kept : {false, true})
        for (const bool changes : {false, true}) {
          if (sheet == none && (behind || kept))
            continue;
          SideOfSheet side;
          side.sheet = sheet, side.behind = behind, side.kept = kept, side.changes = changes;
          EXPECT_EQ(SideOfSheet(side.number()), side);
        }
  EXPECT_EQ(SideOfSheet().number(), 0);
}

// A particle that a sheet has pushed a little beyond itself stays on its side until it is past the rim.
TEST(SheetIn2D, SidesAreKept)
{
  auto m = block_and_sheet<Kind<2, Linear>>(SheetAt{}, Vec<2>::Zero(), [](const Vec<2>&) { return Vec<2>(Vec<2>::Zero()); });
  Sheets<2>& sheets = m.work.sheets;
  sheets.find(m.problem.mesh, m.problem.rigid, m.state.rigid);
  const auto side = [&](const Vec<2>& x, const SideOfSheet& before) {
    return sheets.side(m.problem.mesh, m.problem.rigid, m.state.rigid, m.problem.locator(m.problem.mesh, x, 0).value(), x, before);
  };
  const SideOfSheet first = side({0.48, 0.5}, {});
  EXPECT_FALSE(first.behind);
  EXPECT_TRUE(first.kept);
  EXPECT_FALSE(first.changes);
  const SideOfSheet other = side({0.52, 0.5}, {});
  EXPECT_TRUE(other.behind);
  EXPECT_TRUE(other.changes) << "it was in front, as all that has no side";
  EXPECT_FALSE(side({0.52, 0.5}, first).behind) << "it was pushed through";
  EXPECT_EQ(side({0.95, 0.5}, first).sheet, none);
  SideOfSheet of_another = first;
  of_another.sheet = 3;
  EXPECT_TRUE(side({0.52, 0.5}, of_another).behind);
}

}  // namespace
}  // namespace talus::testing::sheets_test
