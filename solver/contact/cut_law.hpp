#pragma once
// What acts between the two sides of a cut.
#include <string>

#include "core/types.hpp"

namespace talus {

/// The sides of a cut do not penetrate each other and do not attract each other, unless they are tied: then they move as one.
struct CutLaw {
  std::string group;    ///< of the facets of the mesh
  Real friction = 0;    ///< Coulomb's coefficient [-]
  Real cohesion = 0;    ///< shear stress that is carried without pressure, while the sides touch [Pa]
  Real tied_until = 0;  ///< time from which the sides may move apart [s]; infinite if they never may
};

}  // namespace talus
