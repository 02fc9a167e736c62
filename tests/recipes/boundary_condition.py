"""A rough wall: one file in mesh/conditions, one line in conditions.hpp, and a scene of the tests of restart and ranks that has it."""
from recipe import BLOCK, Built, Recipe, Tree

HEADER = """#pragma once
// Rough walls, which material may leave freely.
#include <algorithm>

#include "mesh/conditions/boundary_common.hpp"
#include "mesh/conditions/condition_setup.hpp"

namespace talus {

struct RoughOptions : BoundaryCommon {
  static constexpr std::string_view name = "rough";
  static constexpr auto fields() { return std::tuple{on_key("facet group that holds what presses against it"), during_key()}; }
};

template <int D>
struct Rough {
  using Options = RoughOptions;
  static constexpr bool two_sided = false;
  static Rough make(const Options&, const ConditionSetup<D>&) { return {}; }

  /// A node that moves into the wall stops; the work of the tangential impulse is heat.
  template <class Node>
  void act(Node& node, const Vec<D>& normal) const noexcept
  {
    const Real into = node.v.dot(normal);
    if (into <= 0)
      return;
    node.push(-into * normal);
    node.apply_friction(-node.v);
  }
  static void constrain(Vec<D>& v, const Vec<D>& normal) noexcept { v -= std::max(v.dot(normal), Real{0}) * normal; }
};

}  // namespace talus
"""


def apply(tree: Tree) -> None:
    conditions, scenes = "mesh/conditions/conditions.hpp", "tests/app/scenes_of_all.hpp"
    tree.write("mesh/conditions/rough.hpp", HEADER)
    tree.insert_behind('#include "mesh/conditions/roller.hpp"\n', conditions, '#include "mesh/conditions/rough.hpp"\n')
    tree.insert_behind("    Roller<D>,\n", conditions, "    Rough<D>,\n")
    old = tree.read(scenes)
    mark = "{type: roller, on: x_min}, {type: fixed, on: x_max}"
    assert mark in old
    tree.write(scenes, old.replace(mark, "{type: rough, on: x_min}, {type: fixed, on: x_max}", 1))


def works(built: Built) -> None:
    built.run("--gtest_brief=1", "--gtest_filter=ConditionContract*", program="talus_solver_tests")
    built.run("--gtest_brief=1", "--gtest_filter=ScenesOfAll*", program="talus_app_tests")
    scene = BLOCK.replace("{type: fixed, on: y_min}", "{type: rough, on: y_min}").replace("high: [1.5, 2]", "high: [1.5, 1.5]").replace("low: [0.5, 1]", "low: [0.5, 0]")
    built.write("wall.yaml", scene + "  history: {every: 0.002, walls: [{on: y_min}]}\n")
    built.run("run", "wall.yaml", "--out", "wall", "--quiet")
    assert "facet group that holds what presses against it" in built.run("manual", "rough")


RECIPE = Recipe(apply, works, most_files=2, test_targets=("talus_solver_tests", "talus_app_tests"))
