#pragma once
// Surfaces without motion along their normal, with free sliding.
#include "mesh/conditions/boundary_common.hpp"
#include "mesh/conditions/condition_setup.hpp"

namespace talus {

struct RollerOptions : BoundaryCommon {
  static constexpr std::string_view name = "roller";
  static constexpr auto fields() { return std::tuple{on_key("facet group without normal motion; sliding is free"), during_key()}; }
};

template <int D>
struct Roller {
  using Options = RollerOptions;
  static constexpr bool two_sided = true;
  static Roller make(const Options&, const ConditionSetup<D>&) { return {}; }

  template <class Node>
  void act(Node& node, const Vec<D>& normal) const noexcept
  {
    node.push(-node.v.dot(normal) * normal);
  }
  static void constrain(Vec<D>& v, const Vec<D>& normal) noexcept { v -= v.dot(normal) * normal; }
};

}  // namespace talus
