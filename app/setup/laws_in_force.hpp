#pragma once
// Which law a body of a scene has in a stage: its material, or that which a stage has given to it, weakened as stages say.
#include <vector>

#include "io/scene/scene.hpp"
#include "materials/material.hpp"

namespace talus {

/// The material of a body in a stage; nullptr: there is none of that name, which the reader has said.
const MaterialSpec* material_of(const Scene& scene, const BodySpec& body, Index stage);

/// Whether the law of a material has a strength that can be divided.
bool has_strength(const MaterialSpec& material);

/// By how much the strength of that material is divided then; 1: not at all.
Real weakened_by(const Scene& scene, const BodySpec& body, Index stage);

/// Whether the body is there before the stage and has another law from then on: another material, or less strength.
bool is_renewed(const Scene& scene, const BodySpec& body, Index stage);

/// Without particles.  The material must be there.  Bodies of one material average their volume ratio as one (Batch::averages_with) if their
/// ratios count from the same state: they came in the same stage, were renewed in the same stage, and both were filled or both were not.
Material law_in_force(const Scene& scene, const BodySpec& body, Index stage);

/// Of all bodies in the order of the scene, for each stage; of a body before it is there what it begins with.
std::vector<std::vector<Material>> laws_of_stages(const Scene& scene);

}  // namespace talus
