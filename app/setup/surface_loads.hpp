#pragma once
// Tractions and pressures on the sides of bodies that fill a shape.
#include "app/setup/checks/scene_error_collector.hpp"
#include "app/setup/setup.hpp"

namespace talus {

/// The body of a name BODY:SIDE; nothing if no body of the scene begins it.
const BodySpec* body_of_side(const Scene& scene, const std::string& name);

/// All names BODY:SIDE of a scene.
template <int D>
std::vector<std::string> sides_of_bodies(const Scene& scene);

/// Adds the load on a side of a body.  Every rank has to ask.
template <int D>
void add_surface_load(const BodySpec& body, const TractionSpec& spec, const Mesh<D>& mesh, Communicator& ranks, SceneErrorCollector& errors,
                      Setup<D>& setup);

}  // namespace talus
