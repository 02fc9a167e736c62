#pragma once
// One boundary condition of a scene, and the impulses that it has exerted.
#include <string>

#include "mesh/conditions/conditions.hpp"

namespace talus {

template <int D>
struct BoundaryCondition {
  std::string name;
  AnyCondition<D> kind;
  Vec<D> impulse = Vec<D>::Zero();  ///< impulse on the bodies since the start of the run [N s]
  Vec3 angular = Vec3::Zero();      ///< moment of the impulse about the origin [N m s]
  static constexpr auto fields()
  {
    return std::tuple{saved("impulse", &BoundaryCondition::impulse), saved("angular", &BoundaryCondition::angular),
                      saved("kind", &BoundaryCondition::kind)};
  }

  /// The largest speed [m/s] that it prescribes.
  Real peak_speed() const
  {
    return std::visit(
        []<class C>(const C& condition) {
          if constexpr (requires { condition.peak_speed(); })
            return condition.peak_speed();
          else if constexpr (requires { condition.motion.peak_speed(); })
            return condition.motion.peak_speed();
          else
            return Real{0};
        },
        kind);
  }
  /// The record of its motion, or nullptr.
  const Record* record() const
  {
    return std::visit(
        [](const auto& condition) -> const Record* {
          if constexpr (requires { condition.motion.record; })
            return condition.motion.record ? &*condition.motion.record : nullptr;
          else
            return nullptr;
        },
        kind);
  }
};

}  // namespace talus
