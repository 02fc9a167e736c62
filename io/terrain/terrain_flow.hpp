#pragma once
// Where what lies on terrain will flow, before anything is computed: straight down, and no farther than energy lines reach.
#include <array>
#include <optional>
#include <vector>

#include "io/terrain/terrain_input.hpp"

namespace talus {

/// Mean place of a layer, by its thickness; nothing if it has none.
std::optional<MapPlace> centre_of_layer(const TerrainInput& input, std::size_t layer);

/// From a place down over the ground, in strides that get longer where the ground has pits, until no place up to eight strides around is lower.
MapLine steepest_descent(const TerrainInput& input, const MapPlace& from, Real stride);

/// Lines that fall from sources (east, north, height) in all directions, by `fall` [m] for each metre.
class EnergyLines {
 public:
  EnergyLines(std::vector<std::array<Real, 3>> sources, Real fall);
  /// Of the highest line over a place.
  Real height(const MapPlace& place) const noexcept;

 private:
  std::vector<std::array<Real, 3>> highest_;  ///< those above which no line of another passes, from the highest down
  Real fall_;
};

}  // namespace talus
