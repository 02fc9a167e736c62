#pragma once
// Rules between the blocks of a scene: names that must exist, vectors that must fit the dimension.
#include <string>
#include <vector>

#include "io/scene/scene.hpp"

namespace talus {

/// A broken rule with the path of its key, such as "bodies[1].material"; the key need not exist.
struct Finding {
  std::string path, message;
};

/// The errors of a scene as a whole, apart from its mesh.  Parts that could not be read are empty and skipped.
std::vector<Finding> broken_rules(const Scene& scene);
/// The errors of the block `mesh`, of the block `outputs`, and of the changes by stages.
std::vector<Finding> broken_mesh_rules(const Scene& scene);
std::vector<Finding> broken_output_rules(const Scene& scene);
std::vector<Finding> broken_stage_rules(const Scene& scene);
/// The errors of the block `rigid`.
std::vector<Finding> broken_rigid_rules(const Scene& scene);
/// The errors of the lists `variation` of materials.
std::vector<Finding> broken_variation_rules(const Scene& scene);
/// The errors of the keys `reference` and `resample` of bodies.
std::vector<Finding> broken_reference_rules(const Scene& scene);

/// What a body can touch that would not know where it is if its reference were never renewed, in words; empty if it stands alone between walls
/// to which it sticks.
std::vector<std::string> contacts_of_body(const Scene& scene, const BodySpec& body);

/// The names of kernels in a scene.
std::vector<std::string> kernel_names();

}  // namespace talus
