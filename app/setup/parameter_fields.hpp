#pragma once
// Parameters of particles where the material of their body varies in space.
#include <string>
#include <vector>

#include "app/setup/checks/scene_error_collector.hpp"
#include "core/parallel/communicator.hpp"
#include "core/particles.hpp"
#include "materials/interface/material.hpp"

namespace talus {

/// What is wrong with the values of a parameter.
struct ParameterTrouble {
  SourceLocation where;  ///< of the entry of the list `variation`
  std::string key;       ///< of that entry; empty: all of it
  std::string message;
};

/// Sets the factors in the histories of the particles of `material`, at the places where they are; nothing if nothing varies.  Every rank has to
/// ask.
template <int D>
std::vector<ParameterTrouble> set_parameters_in_space(const Particles<D>& particles, Communicator& ranks, Material& material);
/// The same for a scene that is being set up.
template <int D>
void set_parameters_in_space(const Particles<D>& particles, Communicator& ranks, SceneErrorCollector& errors, Material& material)
{
  for (const ParameterTrouble& trouble : set_parameters_in_space(particles, ranks, material))
    errors.add(trouble.where, trouble.key, trouble.message);
}

}  // namespace talus
