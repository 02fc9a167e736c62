#pragma once
// Access to PETSc, which is in a plugin (libtalus_petsc.so), because it loads a hundred libraries and few scenes need it.
#include "core/nonlinear_solver.hpp"

namespace talus {

/// The functions of the plugin.
struct PetscPart {
  NonlinearSolver& (*solver)();
};

/// Newton's method on the residual alone, with GMRES, preconditioned by a factorization or algebraic multigrid of the matrix that the
/// equations give. Throws EnvironmentError if the plugin is not beside the program or its libraries, or cannot be loaded.
NonlinearSolver& petsc();

}  // namespace talus
