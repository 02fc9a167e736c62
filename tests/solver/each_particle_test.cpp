// Sums over the particles of a view, by hand.
#include "solver/each_particle.hpp"

#include <gtest/gtest.h>

#include "materials/interface/constitutive_law_of.hpp"
#include "materials/law_examples.hpp"
#include "materials/laws.hpp"
#include "mesh/generate/generate.hpp"

namespace talus::each_particle_test {
namespace {

TEST(PlasticWork, IsThatOfTheBodiesAsked)
{
  const Problem<2> problem{Mesh<2>(box<2>(Vec<2>::Zero(), Vec<2>::Ones(), {1, 1}))};
  State<2> state;
  state.bodies = {{"first", 0, 1, {}}, {"second", 1, 3, {}}};
  for (const Body& body : state.bodies)
    state.materials.push_back(make_material(law_example<VonMises>(), body.begin, body.end, body.name));
  state_of<VonMises>(state.materials[0], 0).plastic_work = 1e6;
  state_of<VonMises>(state.materials[1], 0).plastic_work = 10, state_of<VonMises>(state.materials[1], 1).plastic_work = 1000;
  state.particles.volume0.assign(3, 7);
  state.particles.volume0.set(1, 2), state.particles.volume0.set(2, 3);
  CellOrder order;
  order.row = {0, 1, 2}, order.first = {0, 1, 3}, order.blocks = 1;
  const std::vector<VelocityField<2>> fields;
  const RunView<2> view{problem, state, order, fields, "the only", "run", 0, 0};
  EXPECT_EQ(plastic_work(view, {1, 2}), 10 * 2 + 1000 * 3);
  EXPECT_EQ(plastic_work(view), 10 * 2 + 1000 * 3 + 7e6);
}

}  // namespace
}  // namespace talus::each_particle_test
