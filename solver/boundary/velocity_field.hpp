#pragma once
// The nodes of bodies that share one velocity field.
#include "solver/boundary/small_mass_nodes.hpp"

namespace talus {

/// Sums and motion of the nodes of a velocity field.  Bodies in contact have fields of their own on the same mesh, as in Bardenhagen,
/// Brackbill and Sulsky, The material-point method for granular materials, Comput. Methods Appl. Mech. Engrg. 187, 2000.
template <int D>
struct VelocityField {
  Nodes<D> nodes;
  SmallMassNodes<D> small_mass_nodes;
};

}  // namespace talus
