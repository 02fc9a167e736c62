#pragma once
// Walls with Coulomb friction, which material may leave freely.
#include <algorithm>

#include "mesh/conditions/boundary_common.hpp"
#include "mesh/conditions/condition_setup.hpp"

namespace talus {

struct FrictionOptions : BoundaryCommon {
  static constexpr std::string_view name = "friction";
  Real coefficient{};
  bool gap = false;
  static constexpr auto fields()
  {
    return std::tuple{
        on_key("facet group that acts as a wall: no penetration, free separation"),
        required("coefficient", &FrictionOptions::coefficient, non_negative, "-",
                 "Coulomb friction coefficient, tangent of the wall friction angle"),
        optional("gap", &FrictionOptions::gap, any, "-",
                 "the wall acts where the surface of material touches it; without, at all its nodes that have mass, and so up to "
                 "a cell early"),
        during_key()};
  }
};

template <int D>
struct Friction {
  using Options = FrictionOptions;
  static constexpr bool two_sided = false;
  Real coefficient{};  ///< coefficient of friction [-]
  bool gap = false;    ///< whether it acts only where material touches it
  static Friction make(const Options& options, const ConditionSetup<D>&) { return {options.coefficient, options.gap}; }

  /// Applies the wall to a node; the normal points out of the mesh.  A normal velocity into the wall is removed, and the tangential
  /// velocity is reduced by at most the coefficient times the removed velocity.  The work of the tangential impulse is heat.
  template <class Node>
  void act(Node& node, const Vec<D>& normal) const noexcept
  {
    const Real into = node.v.dot(normal);
    if (into <= 0)
      return;
    node.push(-into * normal);
    const Real slip = node.v.norm(), limit = coefficient * into;  // the velocity is tangential now
    node.apply_friction(slip <= limit ? Vec<D>(-node.v) : Vec<D>(-limit / slip * node.v));
  }
  static void constrain(Vec<D>& v, const Vec<D>& normal) noexcept { v -= std::max(v.dot(normal), Real{0}) * normal; }
};

}  // namespace talus
