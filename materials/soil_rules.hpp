#pragma once
// Rules between the parameters that laws of soil share.
#include <fmt/format.h>

#include <string>
#include <vector>

#include "core/types.hpp"

namespace talus {

/// Of angles [degrees], cohesions [Pa] and their residual values: what contradicts itself, in words.
template <class Law>
void check_softening(const Law& law, std::vector<std::string>& problems)
{
  const Real residual_friction = law.residual_friction_angle.value_or(law.friction_angle);
  if (law.dilation_angle > law.friction_angle)
    problems.push_back(fmt::format("dilation_angle {} is above friction_angle {}", law.dilation_angle, law.friction_angle));
  else if (law.dilation_angle > residual_friction)
    problems.push_back(fmt::format("dilation_angle {} is above residual_friction_angle {}", law.dilation_angle, residual_friction));
  if (residual_friction > law.friction_angle)
    problems.push_back(fmt::format("residual_friction_angle {} is above friction_angle {}", residual_friction, law.friction_angle));
  if (law.residual_cohesion.value_or(law.cohesion) > law.cohesion)
    problems.push_back(fmt::format("residual_cohesion {} is above cohesion {}", *law.residual_cohesion, law.cohesion));
  if ((law.residual_friction_angle || law.residual_cohesion) && !law.softening_strain)
    problems.emplace_back("residual_friction_angle and residual_cohesion need softening_strain");
  if (law.softening_strain && !law.residual_friction_angle && !law.residual_cohesion)
    problems.emplace_back("softening_strain needs residual_friction_angle or residual_cohesion");
}

}  // namespace talus
