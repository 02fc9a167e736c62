#pragma once
// The key `initial_stress` of a stage -> the ratio of stresses of each body.
#include "app/complaints.hpp"
#include "core/table.hpp"

namespace talus {

/// Of the bodies of the scene, in their order: by the depth [m] below the ground.  Complains of laws without an angle of friction where it asks for one.
std::vector<Table> k0_of_bodies(const K0Spec& spec, const Scene& scene, Complaints& complaints);

}  // namespace talus
