#pragma once
// Estimates of the flow over terrain before a simulation: steepest descent, and a limit from energy lines.
#include <array>
#include <optional>
#include <vector>

#include "io/terrain/terrain_input.hpp"

namespace talus {

/// The centroid of a layer in the plan, weighted by its thickness; nothing if it has no volume.
std::optional<MapPlace> centre_of_layer(const TerrainInput& input, std::size_t layer);

/// The path of steepest descent over the ground from a position, in strides that get longer in pits, until no position up to eight strides
/// around is lower.
MapLine steepest_descent(const TerrainInput& input, const MapPlace& from, Real stride);

/// Energy lines, which fall from sources (east, north, height) in all directions by `fall` [m] per metre.
class EnergyLines {
 public:
  EnergyLines(std::vector<std::array<Real, 3>> sources, Real fall);
  /// The height of the highest line at a position [m].
  Real height(const MapPlace& place) const noexcept;

 private:
  std::vector<std::array<Real, 3>> highest_;  ///< sources that are not below a line of another source, in descending order
  Real fall_;
};

}  // namespace talus
