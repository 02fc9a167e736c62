#pragma once
// Ground and slip surfaces drawn at random, as meshes of columns: bowls, wedges and scarps, such as slopes have.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "mesh/generate/columns.hpp"
#include "mesh/generate/generate.hpp"
#include "mesh/generate/random.hpp"

namespace talus::test {

/// Surfaces over a plan of 120 m by 100 m: elevation [m] at a place.
struct Terrain {
  std::function<Real(const Vec<2>&)> ground, slip;
};

/// A ground that falls along x, undulates and may have a scarp of 45 to 75 degrees; below it a bowl, a wedge, or a layer of equal depth.
inline Terrain random_terrain(std::uint64_t seed)
{
  std::mt19937_64 random(seed);
  const auto between = [&](Real low, Real high) { return low + (high - low) * uniform(random); };
  const Real fall = between(0.1, 0.6), wave = between(0, 3), length = between(20, 60), phase = between(0, 6);
  const bool has_scarp = uniform(random) < 0.4;
  const Real edge = between(30, 70), height = has_scarp ? between(5, 30) : 0;
  const Real steepness = std::tan(between(45, 75) * std::numbers::pi / 180), turned = between(-0.5, 0.5);
  Terrain terrain;
  terrain.ground = [=](const Vec<2>& x) {
    const Real across = x[0] - edge + turned * (x[1] - 50);
    return 150 - fall * x[0] + wave * std::sin((x[0] + 0.7 * x[1]) / length * 2 * std::numbers::pi + phase) -
           std::clamp(across * steepness, Real{0}, height);
  };
  const auto kind = static_cast<int>(between(0, 3));
  // The numbers are drawn one after the other: compilers differ in which argument of a call they work out first.
  const auto pair = [&](Real x_low, Real x_high, Real y_low, Real y_high) {
    const Real y = between(y_low, y_high), x = between(x_low, x_high);
    return Vec<2>(x, y);
  };
  const Vec<2> centre = pair(40, 80, 35, 65), half = pair(20, 45, 15, 40);
  const Real depth = between(4, 25), dip = between(0.2, 1.0);
  const auto ground = terrain.ground;
  if (kind == 0)
    terrain.slip = [=](const Vec<2>& x) {
      const Real inside = 1 - (x - centre).cwiseQuotient(half).squaredNorm();
      return ground(x) + (inside > 0 ? -depth * std::sqrt(inside) : Real{1});
    };
  else if (kind == 1)
    terrain.slip = [=](const Vec<2>& x) {
      return ground(centre) - depth + dip * std::abs(x[1] - centre[1]) - 0.3 * fall * (x[0] - centre[0]);
    };
  else
    terrain.slip = [=](const Vec<2>& x) { return ground(x) - depth; };
  return terrain;
}

/// Cells of about `size` metres in what lies between the slip surface and the ground, with 20 m of air above the ground.
inline MeshData<3> mesh_of(const Terrain& terrain, Real size, std::uint64_t seed)
{
  const auto cells = [&](Real extent) { return static_cast<Index>(std::lround(extent / size)); };
  MeshData<2> plan = jittered(box(Vec<2>(0, 0), Vec<2>(120, 100), {cells(120), cells(100)}, Diagonals::random, seed), 0.25, seed);
  Stack<3> stack{{plan.nodes, plan.cells}, {}, {Slab{}, Slab{}}};
  Slab &mass = stack.slabs[0], &air = stack.slabs[1];
  for (const Vec<2>& x : plan.nodes) {
    const Real ground = terrain.ground(x), slip = terrain.slip(x);
    stack.bottom.push_back(ground - slip < size / 4 ? ground : slip);
    mass.top.push_back(ground);
    air.top.push_back(ground + 20);
    mass.height.push_back(size), air.height.push_back(size);
  }
  mass.group.assign(plan.cells.size(), 0), air.group.assign(plan.cells.size(), 1);
  Columns<3> columns = fill_columns(stack);
  MeshData<3> data;
  data.nodes = std::move(columns.nodes);
  data.cells = std::move(columns.cells);
  return data;
}

}  // namespace talus::test
