#pragma once
// The contacts of a scene as velocity fields and what acts between them.
#include <string>
#include <vector>

#include "app/setup/checks/scene_error_collector.hpp"
#include "core/particles.hpp"
#include "io/scene/scene.hpp"
#include "solver/contact/contacts.hpp"

namespace talus {

/// Bodies of the scene that are tied, and all that no contact names, share a velocity field; every other body has its own.  Where no
/// contact says what acts between two fields, they slide without friction, and a warning says so.
Contacts contacts_of(const Scene& scene, const std::vector<Body>& bodies, SceneErrorCollector& errors, std::vector<std::string>& warnings);

}  // namespace talus
