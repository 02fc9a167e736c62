// What ranks set up by parts is together what one sets up alone, to the last bit.  A test that leaves early on one rank makes the others
// wait: EXPECT, not ASSERT.
#include <gtest/gtest.h>

#include "app/setup/seed.hpp"
#include "app/setup/setup.hpp"
#include "core/parallel/communicator.hpp"
#include "io/load_mesh.hpp"
#include "io/scene/reader.hpp"
#include "mesh/partition.hpp"
#include "solver/particles/redistribute.hpp"

namespace talus::set_up_ranks_test {
namespace {

std::size_t z(std::int64_t i) { return static_cast<std::size_t>(i); }

/// Some blocks of cells; two bodies share cells, a third lies in a corner; a load hangs on single particles, a wall has two sides.
Scene three_bodies()
{
  return read_scene_text("three.yaml", R"yaml(title: Three bodies
dimension: 2
mesh: {grid: {low: [0, 0], high: [2, 1], cells: [40, 20]}}
time: {end: 1}
materials:
  - {name: rubber, law: neo_hookean, density: 1000, youngs_modulus: 1.0e5, poisson_ratio: 0.3}
  - {name: steel, law: von_mises, density: 7800, youngs_modulus: 2.0e8, poisson_ratio: 0.3, yield_stress: 1.0e5}
bodies:
  - {name: low, material: rubber, shape: {type: box, low: [0, 0], high: [2, 0.51]}, particles_per_cell: 3, velocity: ["2 * x", "-y"]}
  - {name: high, material: steel, shape: {type: box, low: [0.2, 0.49], high: [1.8, 0.8]}, particles_per_cell: 4}
  - {name: corner, material: rubber, shape: {type: box, low: [1.9, 0.9], high: [2, 1]}, particles_per_cell: 1, velocity: [3, 4]}
boundaries: [{type: roller, on: x_min}, {type: friction, on: y_min, coefficient: 0.2}]
loads:
  - {type: gravity, acceleration: [0, -9.81]}
  - {type: traction, on: y_max, pressure: 10, carried_by: particles}
  - {type: traction, on: x_min, pressure: 20, carried_by: particles}
)yaml");
}

class SetUpOnRanks : public testing::Test {
 protected:
  Communicator& ranks = world();
  Scene scene = three_bodies();
  Mesh<2> mesh = load_mesh<2>(scene.mesh, ".");
  talus::Setup<2> whole = set_up(scene, mesh, one_rank()), part = set_up(scene, mesh, ranks);

  /// Each row here is that of its id in the whole, where rows are ids.
  void expect_rows_of_the_whole() const
  {
    for (std::size_t b = 0; b < whole.state.bodies.size(); ++b) {
      const Body &mine = part.state.bodies[b], &all = whole.state.bodies[b];
      EXPECT_EQ(mine.name, all.name);
      EXPECT_EQ(ranks.sum(std::int64_t{mine.size()}), all.size());
      EXPECT_EQ(part.state.materials[b].begin, mine.begin);
      EXPECT_EQ(part.state.materials[b].end, mine.end);
      for (Index row = mine.begin; row < mine.end; ++row) {
        const std::size_t p = z(row), id = z(part.state.particles.id[p]);
        EXPECT_TRUE(row == mine.begin || part.state.particles.id[p - 1] < part.state.particles.id[p]);
        EXPECT_TRUE(static_cast<Index>(id) >= all.begin && static_cast<Index>(id) < all.end);
        EXPECT_EQ(part.state.particles.x[p], whole.state.particles.x[id]);
        EXPECT_EQ(part.state.particles.v[p], whole.state.particles.v[id]);
        EXPECT_EQ(part.state.particles.L[p], whole.state.particles.L[id]);
        EXPECT_EQ(part.state.particles.mass[p], whole.state.particles.mass[id]);
        EXPECT_EQ(part.state.particles.volume0[p], whole.state.particles.volume0[id]);
      }
    }
    EXPECT_EQ(ranks.sum(std::int64_t{part.state.particles.size()}), whole.state.particles.size());
  }
};

TEST_F(SetUpOnRanks, EachFillsItsBlocksAndAllTogetherTheWhole)
{
  const IndexRange mine = cells_to_fill(mesh, ranks);
  EXPECT_EQ(mine.begin % block_cells, 0);
  EXPECT_EQ(ranks.sum(std::int64_t{mine.end - mine.begin}), mesh.n_cells());
  EXPECT_EQ(part.n_particles, whole.state.particles.size());
  expect_rows_of_the_whole();
  for (std::size_t p = 0; p < part.state.particles.cell.size(); ++p) {
    EXPECT_EQ(part.state.particles.cell[p], whole.state.particles.cell[z(part.state.particles.id[p])]);
    EXPECT_TRUE(mine.begin <= part.state.particles.cell[p] && part.state.particles.cell[p] < mine.end);
  }
}

TEST_F(SetUpOnRanks, WhatIsOfAllParticlesIsTheSameOnEachRank)
{
  EXPECT_EQ(whole.warnings.size(), 3U) << "cells shared by two bodies, two areas without particles behind a part of them";
  EXPECT_EQ(part.warnings, whole.warnings);
  EXPECT_EQ(part.conditions.limits.speed, whole.conditions.limits.speed);
  EXPECT_EQ(part.conditions.limits.least_energy, whole.conditions.limits.least_energy);
  EXPECT_EQ(part.conditions.loads.on_particles.size(), 2U);
  for (std::size_t k = 0; k < part.conditions.loads.on_particles.size(); ++k) {
    EXPECT_FALSE(whole.conditions.loads.on_particles[k].id.empty());
    EXPECT_EQ(part.conditions.loads.on_particles[k].id, whole.conditions.loads.on_particles[k].id);
    EXPECT_EQ(part.conditions.loads.on_particles[k].area, whole.conditions.loads.on_particles[k].area);
  }
  EXPECT_EQ(part.state.boundary.closed_facets(mesh), whole.state.boundary.closed_facets(mesh));
}

TEST_F(SetUpOnRanks, ParticlesGoToTheOwnersOfTheirBlocks)
{
  std::vector<std::int64_t> weights(z(blocks_of(mesh.n_cells())), 0);
  for (const Index cell : whole.state.particles.cell)
    ++weights[z(cell / block_cells)];
  const Part<2> here = cut(mesh, partition(mesh, weights, ranks.size()), ranks.rank(), 2);
  receive_owned_particles(ranks, here.subdomain, part.state.bodies, part.state.materials, part.state.particles);
  expect_rows_of_the_whole();
  for (std::size_t p = 0; p < part.state.particles.cell.size(); ++p) {
    const Index cell = part.state.particles.cell[p];
    EXPECT_TRUE(cell != none && here.subdomain.owns_cell(cell));
    EXPECT_EQ(here.subdomain.whole_cell(cell), whole.state.particles.cell[z(part.state.particles.id[p])]);
  }
}

}  // namespace
}  // namespace talus::set_up_ranks_test
