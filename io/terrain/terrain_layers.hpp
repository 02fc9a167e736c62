#pragma once
// Layers of terrain over a plan: where each ends below, after what had to give way.
#include <string>
#include <vector>

#include "io/terrain/terrain_plan.hpp"

namespace talus {

/// Layers thinner than this share of a cell are closed: they would cost short steps, and hold little.
inline constexpr Real thinnest = 0.25;

struct TerrainLayers {
  std::vector<std::vector<Real>> bottoms;  ///< by layer and plan node [m]: nowhere above the bottom of the layer before, or the ground
  std::vector<Marks> inside;               ///< by layer and plan cell: within the sides of the layer
};

/// From the ground down.  What is wrong is added to `problems`, what gave way, in words, to the notes.
template <int D>
TerrainLayers lay(const TerrainSpec& spec, const SurveyedPlan<D>& plan, TerrainInput& input, std::vector<SceneError>& problems);

/// What is meshed, "512000 to 512060 east, 5180000 to 5180030 north".
std::string domain_in_words(const TerrainInput& input);

extern template TerrainLayers lay<2>(const TerrainSpec&, const SurveyedPlan<2>&, TerrainInput&, std::vector<SceneError>&);
extern template TerrainLayers lay<3>(const TerrainSpec&, const SurveyedPlan<3>&, TerrainInput&, std::vector<SceneError>&);

}  // namespace talus
