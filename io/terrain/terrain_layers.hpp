#pragma once
// Layers of terrain over a plan: the bottom of each after corrections.
#include <string>
#include <vector>

#include "io/terrain/terrain_plan.hpp"

namespace talus {

/// Layers thinner than this fraction of a cell are removed: they would require short steps and contain little.
inline constexpr Real thinnest = 0.25;

struct TerrainLayers {
  std::vector<std::vector<Real>> bottoms;  ///< for each layer and plan node [m]; never above the bottom of the previous layer or the ground
  std::vector<Marks> inside;               ///< for each layer and plan cell: whether it lies within the area of the layer
};

/// Computes the layers from the ground downwards.  Errors are added to `problems`, descriptions of corrections to the notes.
template <int D>
TerrainLayers lay(const TerrainSpec& spec, const SurveyedPlan<D>& plan, TerrainInput& input, std::vector<SceneError>& problems);

/// The meshed region as text, "512000 to 512060 east, 5180000 to 5180030 north".
std::string domain_in_words(const TerrainInput& input);

}  // namespace talus
