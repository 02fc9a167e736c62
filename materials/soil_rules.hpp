#pragma once
// Rules between the parameters that laws of soil share.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
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

/// Angle [degrees] of which the tangent is that of `degrees` over `factor`.
inline Real angle_over(Real degrees, Real factor) noexcept
{
  constexpr Real degree = std::numbers::pi / 180;
  return factor == 1 ? degrees : std::atan(std::tan(degrees * degree) / factor) / degree;
}

/// c / F and tan(phi) / F, at the peak and after softening: on every plane c + s tan(phi) falls to its F-th part.  The tip of the surface
/// stays where it is, at c / tan(phi) by its normal stress.  So does the dilation, as far as friction is left to dilate with; a cut-off of
/// tension falls like a cohesion, and ends at the tip where a factor below 1 lifts it there.
template <class Law>
void divide_soil_strength(Real factor, Law& law) noexcept
{
  law.cohesion /= factor;
  law.friction_angle = angle_over(law.friction_angle, factor);
  if (law.residual_cohesion)
    *law.residual_cohesion /= factor;
  if (law.residual_friction_angle)
    law.residual_friction_angle = angle_over(*law.residual_friction_angle, factor);
  law.dilation_angle = std::min({law.dilation_angle, law.friction_angle, law.residual_friction_angle.value_or(law.friction_angle)});
  if (law.tension_cutoff)
    law.tension_cutoff = std::min(*law.tension_cutoff / factor, law.tip_of_strength());
}

}  // namespace talus
