#include "io/equations/petsc_plugin.hpp"

#include "io/system/plugin.hpp"

namespace talus {

NonlinearSolver& petsc()
{
  static const auto& part = *static_cast<const PetscPart*>(open_module("petsc", "talus_petsc_part", "solves for equilibrium with PETSc"));
  return part.solver();
}

}  // namespace talus
