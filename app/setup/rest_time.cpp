#include "app/setup/rest_time.hpp"

#include <algorithm>
#include <cmath>

namespace talus {

template <int D>
Real passage_time(const Setup<D>& setup, const Vec<D>& up)
{
  Real low = std::numeric_limits<Real>::infinity(), high = -low, volume = 0, slowness = 0;
  for (std::size_t b = 0; b < setup.state.bodies.size(); ++b) {
    const Body& body = setup.state.bodies[b];
    Real of_body = 0;
    for (Index row = body.begin; row < body.end; ++row) {
      const auto p = static_cast<std::size_t>(row);
      const Real at = up.dot(setup.state.particles.x[p]);
      low = std::min(low, at), high = std::max(high, at);
      of_body += setup.state.particles.volume0[p];
    }
    volume += of_body;
    slowness += of_body > 0 ? of_body / setup.state.materials[b].law().wave_speed(Mat3::Identity()) : 0;
  }
  return volume > 0 ? (high - low) * slowness / volume : 0;
}

RestTime time_to_rest(const Stage& stage, Real passage)
{
  if (!stage.residual)
    return {stage.duration, stage.duration};
  // Of the usual time, measured: 0.36, 0.40, 0.48, 0.67 (slopes under K0, gravity at once above a tunnel), 0.57 (a column), 0.11 (a wide layer),
  // 1.75 (a water table that falls).
  constexpr Real quickest = 0.1, slowest = 2, passages_of_a_swing = 4;
  if (!(stage.damping > 0))
    return {std::min(stage.ramp, stage.duration), stage.duration};
  const Real swings = std::max(Real{1}, -std::log(*stage.residual) / (2 * stage.damping));
  const Real usual = swings * passages_of_a_swing * passage;
  return {std::min(stage.ramp + quickest * usual, stage.duration), std::min(stage.ramp + slowest * usual, stage.duration)};
}

template Real passage_time<2>(const Setup<2>&, const Vec<2>&);
template Real passage_time<3>(const Setup<3>&, const Vec<3>&);

}  // namespace talus
