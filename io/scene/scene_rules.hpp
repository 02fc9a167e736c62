#pragma once
// Rules between the blocks of a scene: names that must exist, vectors that must fit the dimension.
#include <string>
#include <vector>

#include "io/scene/scene.hpp"

namespace talus {

/// A broken rule and the path of the key that it is about, such as "bodies[1].material"; the key need not exist.
struct Finding {
  std::string path, message;
};

/// What is wrong with a scene as a whole, apart from its mesh.  The scene may be half read: what is empty is passed over.
std::vector<Finding> broken_rules(const Scene& scene);
/// Of them those about the block `mesh`, those about `outputs`, and those about what stages change: names, and what is there when.
std::vector<Finding> broken_mesh_rules(const Scene& scene);
std::vector<Finding> broken_output_rules(const Scene& scene);
std::vector<Finding> broken_stage_rules(const Scene& scene);

/// Names a scene may give as kernel.
std::vector<std::string> kernel_names();

}  // namespace talus
