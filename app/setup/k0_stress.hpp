#pragma once
// The key `initial_stress` of a stage -> what each body begins with.
#include "app/setup/checks/scene_error_collector.hpp"
#include "solver/stress/initial_stress.hpp"

namespace talus {

/// Of the bodies of the scene, in their order.  Complains of laws without an angle of friction where it asks for one.
std::vector<StartStress> start_stress_of_bodies(const K0Spec& spec, const Scene& scene, SceneErrorCollector& errors);

}  // namespace talus
