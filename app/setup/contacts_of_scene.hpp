#pragma once
// The contacts of a scene as velocity fields and what acts between them.
#include <string>
#include <vector>

#include "app/setup/checks/scene_error_collector.hpp"
#include "app/setup/setup.hpp"
#include "core/particles.hpp"
#include "io/scene/scene.hpp"
#include "solver/contact/contacts.hpp"
#include "solver/contact/cut_law.hpp"

namespace talus {

/// Bodies of the scene that are tied, and all that no contact names, share a velocity field; every other body has its own.  Where no
/// contact says what acts between two fields, they slide without friction, and a warning says so.
Contacts contacts_of(const Scene& scene, const std::vector<Body>& bodies, SceneErrorCollector& errors, std::vector<std::string>& warnings);

/// In words.
std::string describe(const ContactLaw& law);

/// What acts between the sides of the cuts of a scene, in its order.
std::vector<CutLaw> cuts_of(const Scene& scene);
std::string describe(const CutLaw& law);

/// An error for every contact whose bodies overlap at the start: cells hold more than they have room for.  Every rank has to ask.
template <int D>
void check_overlaps(const Scene& scene, const Mesh<D>& mesh, const Setup<D>& setup, Communicator& ranks, SceneErrorCollector& errors);

}  // namespace talus
