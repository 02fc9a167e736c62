#pragma once
// Dashpots through which plane waves leave a model [Lysmer & Kuhlemeyer 1969].
#include <map>
#include <utility>
#include <vector>

#include "core/tensor.hpp"
#include "core/types.hpp"

namespace talus {

/// The elastic properties of ground that determine its waves.
struct Halfspace {
  Real density{};           ///< [kg/m^3]
  Real s_wave{}, p_wave{};  ///< speeds of shear and pressure waves [m/s]
};

/// Force per velocity [N s/m] of the dashpots of a facet against plane waves that leave through it: density times area times the speed of
/// the wave, p across the facet and s along it [Lysmer & Kuhlemeyer 1969].
template <int D>
Mat<D> impedance(const Halfspace& ground, const Vec<D>& area)
{
  const Real size = area.norm();
  const Vec<D> n = area / size;
  return ground.density * size * (ground.s_wave * Mat<D>::Identity() + (ground.p_wave - ground.s_wave) * n * n.transpose());
}

/// The dashpot of one condition at a node.
template <int D>
struct Dashpot {
  Index condition = none;
  Mat<D> resistance = Mat<D>::Zero();                     ///< force per velocity [N s/m]
  std::vector<std::pair<std::size_t, Vec<D>>> face = {};  ///< free field: layers and their fractions of the area vector [m^(D-1)]
};
template <int D>
using DashpotsOfNodes = std::map<Index, Dashpot<D>>;

}  // namespace talus
