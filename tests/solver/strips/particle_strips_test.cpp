// Particles in strips: what is stored of them, and what observers read.
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "solver/each_particle.hpp"
#include "tests/solver/strips/swirl.hpp"

namespace talus::testing::particle_strips_test {
namespace {

constexpr Real dt = swirl_dt;

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
      add(p.x()), add(p.displacement()), add(p.v()), add(p.stress());
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
  const Stage stage = test_stage(1);
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

TEST(ParticleStrips, ACopyIsThatOfTheColumnsAndLaterStepsDoNotChangeIt)
{
  auto m = swirl<3>({.scheme = Scheme::aflip}), other = swirl<3>({.scheme = Scheme::aflip});
  EXPECT_FALSE(take_copy(m)) << "the particles are in their columns only";
  for (int step = 0; step < 3; ++step)
    make_step(m, dt), make_step(other, dt);
  auto copy = take_copy(m);
  ASSERT_TRUE(copy);
  EXPECT_EQ(m.state.particles.size(), 0);
  EXPECT_EQ(m.state.materials[1].history.size(), 0);
  make_step(m, dt);
  copy_to_columns(other);
  const auto then = particles_by_id(other);
  drop_copy(other);
  make_step(other, dt);
  end_sweeps(m), end_sweeps(other);
  EXPECT_EQ(differences(particles_by_id(m), particles_by_id(other)), none_differ) << "the steps go on as without a copy";
  EXPECT_NE(differences(then, particles_by_id(other)), none_differ);
  m.state.bodies = std::move(copy->bodies), m.state.materials = std::move(copy->materials), m.state.particles = std::move(copy->particles);
  EXPECT_EQ(differences(particles_by_id(m), then), none_differ);
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
}  // namespace talus::testing::particle_strips_test
