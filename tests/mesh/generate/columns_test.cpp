// Columns between surfaces: what they hold is what lies between the surfaces, and neighbours fit, whatever the surfaces do.
#include "mesh/generate/columns.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "mesh/generate/generate.hpp"
#include "mesh/generate/random.hpp"

namespace talus::columns_test {
namespace {

template <int D>
Plan<D> unit_plan(Index n)
{
  if constexpr (D == 3) {
    MeshData<2> data = jittered<2>(box(Vec<2>(0, 0), Vec<2>(1, 1), {n, n}, Diagonals::random), 0.2, 7);
    return {data.nodes, data.cells};
  } else {
    Plan<2> plan;
    for (Index i = 0; i <= n; ++i)
      plan.nodes.push_back(Vec<1>(static_cast<Real>(i) / n));
    for (Index i = 1; i <= n; ++i)
      plan.cells.push_back({i, i - 1});  // either way round
    return plan;
  }
}

template <int D>
Real extent(const Plan<D>& plan, Index c)
{
  const auto& n = plan.cells[c];
  if constexpr (D == 2) {
    return std::abs(plan.nodes[n[1]][0] - plan.nodes[n[0]][0]);
  } else {
    const Vec<2> a = plan.nodes[n[1]] - plan.nodes[n[0]], b = plan.nodes[n[2]] - plan.nodes[n[0]];
    return std::abs(a[0] * b[1] - a[1] * b[0]) / 2;
  }
}

Slab level(const std::vector<Real>& below, Real thickness, Real height, Index group, std::size_t plan_cells)
{
  Slab slab{below, std::vector<Real>(below.size(), height), std::vector<Index>(plan_cells, group)};
  for (Real& z : slab.top)
    z += thickness;
  return slab;
}

template <int D>
MeshData<D> data_of(const Columns<D>& columns)
{
  MeshData<D> data;
  data.nodes = columns.nodes;
  data.cells = columns.cells;
  for (Index c = 0; c < static_cast<Index>(columns.cells.size()); ++c)
    data.cell_sets[std::to_string(columns.group[c])].push_back(c);
  for (const auto& front : columns.fronts)
    data.facet_sets[front.group_below == none || front.group_above == none ? "ends" : "between"].push_back(front.nodes);
  for (const auto& side : columns.sides)
    data.facet_sets[side.plan_cell == none ? "rim" : "walls"].push_back(side.nodes);
  return data;
}

template <int D>
std::size_t count(const Mesh<D>& mesh, const std::string& set)
{
  const auto facets = mesh.facet_set(set);
  return facets ? facets->size() : 0;
}

/// Slabs of random thickness, each missing over half of the plan, with cells left out at random.
template <int D>
Stack<D> random_stack(std::uint64_t seed)
{
  std::mt19937_64 random(seed);
  Stack<D> stack{unit_plan<D>(5), {}, {}};
  const std::size_t nodes = stack.plan.nodes.size(), cells = stack.plan.cells.size();
  for (std::size_t n = 0; n < nodes; ++n)
    stack.bottom.push_back(uniform(random));
  const std::vector<Real>* below = &stack.bottom;
  for (int s = 0; s < 4; ++s) {
    Slab slab;
    for (std::size_t n = 0; n < nodes; ++n) {
      slab.top.push_back((*below)[n] + (uniform(random) < 0.5 ? 0 : uniform(random)));
      slab.height.push_back(0.05 + 0.5 * uniform(random));
    }
    for (std::size_t c = 0; c < cells; ++c)
      slab.group.push_back(uniform(random) < 0.2 ? none : s % 3);  // the first and the last have the same name
    stack.slabs.push_back(std::move(slab));
    below = &stack.slabs.back().top;
  }
  return stack;
}

/// What lies between the surfaces, by group.
template <int D>
std::map<Index, Real> volumes(const Stack<D>& stack)
{
  std::map<Index, Real> sums;
  for (std::size_t s = 0; s < stack.slabs.size(); ++s)
    for (Index c = 0; c < static_cast<Index>(stack.plan.cells.size()); ++c)
      for (const Index n : stack.plan.cells[c])
        sums[stack.slabs[s].group[c]] +=
            extent(stack.plan, c) / D * (stack.slabs[s].top[n] - (s == 0 ? stack.bottom[n] : stack.slabs[s - 1].top[n]));
  return sums;
}

template <int D>
void expect_fits(std::uint64_t seed)
{
  SCOPED_TRACE(seed);
  const Stack<D> stack = random_stack<D>(seed);
  const Columns<D> columns = fill_columns(stack);
  const Mesh<D> mesh(data_of(columns));  // refuses flat cells, overlaps, sets of facets that are none
  EXPECT_LE(columns.cells.size(), cells_of(stack));
  for (const auto& [group, volume] : volumes(stack)) {
    const auto cells = group == none ? std::nullopt : mesh.cell_set(std::to_string(group));
    Real sum = 0;
    for (const Index c : cells.value_or(std::vector<Index>{}))
      sum += mesh.volume(c);
    EXPECT_NEAR(sum, group == none ? 0 : volume, 1e-13);
  }
  // Every facet of the outline has its name: were a side cut in two ways, the pieces would be boundary inside the plan.
  EXPECT_EQ(mesh.boundary_facets().size(), count(mesh, "ends") + count(mesh, "rim") + count(mesh, "walls"));
  const auto rim = mesh.facet_set("rim");
  for (const Facet f : rim.value_or(std::vector<Facet>{})) {
    bool on_rim = false;
    for (int d = 0; d < D - 1; ++d)
      for (const Real plane : {0.0, 1.0}) {
        bool all = true;
        for (const Index n : mesh.nodes_of(f))
          all = all && mesh.node(n)[d] == plane;
        on_rim = on_rim || all;
      }
    EXPECT_TRUE(on_rim);
  }
}

TEST(Columns, HoldWhatLiesBetweenSurfacesAndFit)
{
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    expect_fits<2>(seed);
    expect_fits<3>(seed);
  }
}

TEST(Columns, EqualSlabsAreKuhnsDivision)
{
  Stack<3> stack{unit_plan<3>(1), std::vector<Real>(4, 0), {}};
  stack.slabs.push_back(level(stack.bottom, 1, 0.5, 0, 2));
  const Columns<3> columns = fill_columns(stack);
  const Mesh<3> mesh(data_of(columns));
  EXPECT_EQ(mesh.n_cells(), 2 * 3 * 2);  // prisms of three tetrahedra
  EXPECT_EQ(cells_of(stack), 12);
  for (Index c = 0; c < mesh.n_cells(); ++c)
    EXPECT_DOUBLE_EQ(mesh.volume(c), 1.0 / 12);
  EXPECT_EQ(columns.fronts.size(), 4u);  // below and above
  EXPECT_EQ(columns.sides.size(), 4u * 2 * 2);
}

TEST(Columns, ASlabWithoutThicknessCostsNothing)
{
  Stack<2> stack{unit_plan<2>(4), std::vector<Real>(5, 0), {}};
  stack.slabs.push_back(level(stack.bottom, 0.5, 0.25, 0, 4));
  const auto thick = fill_columns(stack).cells;
  stack.slabs.push_back(level(stack.slabs.back().top, 0, 0.25, 1, 4));
  stack.slabs.insert(stack.slabs.begin(), level(stack.bottom, 0, 0.25, 2, 4));
  const auto columns = fill_columns(stack);
  EXPECT_EQ(columns.cells, thick);
  for (const auto& front : columns.fronts)
    EXPECT_TRUE(front.group_below == none || front.group_above == none);
}

TEST(Columns, WhatIsLeftOutHasWalls)
{
  Stack<2> stack{unit_plan<2>(3), std::vector<Real>(4, 0), {}};
  stack.slabs.push_back(level(stack.bottom, 0.5, 0.25, 0, 3));
  stack.slabs.push_back(level(stack.slabs.back().top, 0.5, 0.25, 1, 3));
  stack.slabs[0].group[1] = none;
  const Columns<2> columns = fill_columns(stack);
  const Mesh<2> mesh(data_of(columns));
  EXPECT_EQ(count(mesh, "walls"), 2u * 2);
  for (const auto& side : columns.sides)
    EXPECT_TRUE(side.plan_cell == none || (side.plan_cell == 1 && side.slab == 0));
  const auto roof = std::find_if(columns.fronts.begin(), columns.fronts.end(),
                                 [](const auto& front) { return front.plan_cell == 1 && front.group_above == 1; });
  ASSERT_NE(roof, columns.fronts.end());
  EXPECT_EQ(roof->slab_below, 0);  // left out, but known
  EXPECT_EQ(roof->group_below, none);
}

}  // namespace
}  // namespace talus::columns_test
