// The functions that libtalus_petsc.so exports; the only source that uses PETSc.
#define OMPI_SKIP_MPICXX 1  // NOLINT(readability-identifier-naming): MPI's name for leaving out its old C++ classes
#include <petscsnes.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "io/equations/petsc_plugin.hpp"

namespace talus {

namespace {

/// Unknowns of all ranks up to which the matrix of the preconditioner is factorized.
constexpr PetscInt most_factorized = 200000;

/// Of a linear system.  GMRES keeps that many vectors: begun anew after fewer, it breaks down where materials are nearly incompressible.
constexpr PetscInt most_linear_iterations = 400;
/// Of the size of the unknowns, by which trials differ whose difference is a derivative.  With less, rounding of small strains counts.
constexpr PetscReal relative_difference = 1e-7;

void check(PetscErrorCode code, const char* call)
{
  if (code == 0)
    return;
  const char* text = nullptr;
  PetscErrorMessage(code, &text, nullptr);
  throw EnvironmentError(std::string("PETSc's ") + call + " failed: " + (text != nullptr ? text : "unknown error"));
}
#define TALUS_PETSC(call, ...) check(call(__VA_ARGS__), #call)

/// An object of PETSc that is destroyed at the end.
template <class Object, PetscErrorCode (*destroy)(Object*)>
class Owned {
 public:
  Owned() = default;
  Owned(const Owned&) = delete;
  Owned& operator=(const Owned&) = delete;
  ~Owned() { destroy(&object_); }
  Object* operator&() noexcept { return &object_; }     // NOLINT(google-runtime-operator): PETSc's functions write to it
  operator Object() const noexcept { return object_; }  // NOLINT(google-explicit-constructor)

 private:
  Object object_ = nullptr;
};

/// Begins PETSc, and MPI unless the program has; they end with the program.
void begin_petsc()
{
  PetscBool begun = PETSC_FALSE;
  PetscInitialized(&begun);
  if (begun)
    return;
  TALUS_PETSC(PetscOptionsSetValue, nullptr, "-skip_petscrc", nullptr);
  TALUS_PETSC(PetscOptionsSetValue, nullptr, "-no_signal_handler", nullptr);
  TALUS_PETSC(PetscInitialize, nullptr, nullptr, nullptr, nullptr);
  TALUS_PETSC(PetscPushErrorHandler, PetscIgnoreErrorHandler, nullptr);
  std::atexit([] {
    int ended = 0;
    MPI_Finalized(&ended);
    if (ended == 0)
      PetscFinalize();
  });
}

MPI_Comm comm_of_run()
{
  int size = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  return size > 1 ? PETSC_COMM_WORLD : PETSC_COMM_SELF;
}

/// What PETSc's callbacks need.
struct Context {
  const NonlinearEquations& equations;
  std::exception_ptr error;  ///< of a callback
};

PetscErrorCode find_residual(SNES, ::Vec x, ::Vec f, void* context)
{
  auto& all = *static_cast<Context*>(context);
  try {
    const PetscScalar* in = nullptr;
    PetscScalar* out = nullptr;
    PetscInt n = 0;
    TALUS_PETSC(VecGetLocalSize, x, &n);
    TALUS_PETSC(VecGetArrayRead, x, &in);
    TALUS_PETSC(VecGetArray, f, &out);
    const auto size = static_cast<std::size_t>(n);
    if (!all.equations.residual({in, size}, {out, size}))
      std::fill_n(out, size, std::numeric_limits<Real>::infinity());  // of which line searches take a shorter step
    TALUS_PETSC(VecRestoreArray, f, &out);
    TALUS_PETSC(VecRestoreArrayRead, x, &in);
    return 0;
  } catch (...) {
    all.error = std::current_exception();
    return PETSC_ERR_USER;
  }
}

PetscErrorCode keep_matrices(SNES, ::Vec, ::Mat derivative, ::Mat, void*)
{
  MatAssemblyBegin(derivative, MAT_FINAL_ASSEMBLY);
  return MatAssemblyEnd(derivative, MAT_FINAL_ASSEMBLY);
}

void set_preconditioner(const NonlinearEquations& equations, ::Mat matrix)
{
  std::vector<PetscInt> rows, columns;
  std::vector<PetscScalar> values;
  equations.add_preconditioner([&](std::int64_t row, std::int64_t column, Real value) {
    rows.push_back(static_cast<PetscInt>(row));
    columns.push_back(static_cast<PetscInt>(column));
    values.push_back(value);
  });
  TALUS_PETSC(MatSetPreallocationCOO, matrix, static_cast<PetscCount>(rows.size()), rows.data(), columns.data());
  TALUS_PETSC(MatSetValuesCOO, matrix, values.data(), ADD_VALUES);
}

void set_linear_solver(SNES snes, PetscInt unknowns)
{
  KSP ksp = nullptr;
  PC pc = nullptr;
  TALUS_PETSC(SNESGetKSP, snes, &ksp);
  TALUS_PETSC(KSPSetType, ksp, KSPGMRES);
  TALUS_PETSC(KSPGMRESSetRestart, ksp, most_linear_iterations);
  TALUS_PETSC(KSPSetPCSide, ksp, PC_RIGHT);
  TALUS_PETSC(KSPSetTolerances, ksp, 1e-3, PETSC_DEFAULT, PETSC_DEFAULT, most_linear_iterations);
  TALUS_PETSC(KSPGetPC, ksp, &pc);
  if (unknowns <= most_factorized) {
    TALUS_PETSC(PCSetType, pc, PCLU);
    TALUS_PETSC(PCFactorSetMatSolverType, pc, MATSOLVERMUMPS);
  } else {
    TALUS_PETSC(PCSetType, pc, PCGAMG);
  }
  TALUS_PETSC(SNESKSPSetUseEW, snes, PETSC_TRUE);
  TALUS_PETSC(SNESKSPSetParametersEW, snes, 2, 0.1, 0.1, 0.9, 1.5, 1.5, 0.1);
}

std::string words_of(SNESConvergedReason reason)
{
  switch (reason) {
    case SNES_DIVERGED_FNORM_NAN: return "the forces became infinite";
    case SNES_DIVERGED_MAX_IT: return "no balance was found";
    case SNES_DIVERGED_LINE_SEARCH: return "no step brought the forces nearer to balance";
    case SNES_DIVERGED_LINEAR_SOLVE: return "the linear system was not solved, as where a part moves without resistance";
    default: return "Newton's method stopped (" + std::string(SNESConvergedReasons[reason]) + ")";
  }
}

class PetscSolver final : public NonlinearSolver {
 public:
  PetscSolver() { begin_petsc(); }
  NonlinearResult solve(const NonlinearEquations& equations, std::span<Real> x) override
  {
    const MPI_Comm comm = comm_of_run();
    const auto own = static_cast<PetscInt>(equations.unknowns);
    Owned<::Vec, VecDestroy> solution, residual;
    Owned<::Mat, MatDestroy> matrix, derivative;
    Owned<SNES, SNESDestroy> snes;
    Context context{.equations = equations, .error = {}};
    TALUS_PETSC(VecCreateMPIWithArray, comm, equations.block, own, PETSC_DETERMINE, x.data(), &solution);
    TALUS_PETSC(VecDuplicate, solution, &residual);
    TALUS_PETSC(MatCreate, comm, &matrix);
    TALUS_PETSC(MatSetSizes, matrix, own, own, PETSC_DETERMINE, PETSC_DETERMINE);
    TALUS_PETSC(MatSetBlockSize, matrix, equations.block);
    TALUS_PETSC(MatSetType, matrix, MATAIJ);
    set_preconditioner(equations, matrix);
    TALUS_PETSC(SNESCreate, comm, &snes);
    TALUS_PETSC(SNESSetType, snes, SNESNEWTONLS);
    TALUS_PETSC(SNESSetFunction, snes, residual, find_residual, &context);
    TALUS_PETSC(MatCreateSNESMF, snes, &derivative);
    TALUS_PETSC(MatMFFDSetFunctionError, derivative, relative_difference);
    TALUS_PETSC(SNESSetJacobian, snes, derivative, matrix, keep_matrices, &context);
    TALUS_PETSC(SNESSetLagPreconditioner, snes, -2);
    TALUS_PETSC(SNESSetTolerances, snes, equations.tolerance, 0, 0, equations.most_iterations, -1);
    PetscInt unknowns = 0;
    TALUS_PETSC(VecGetSize, solution, &unknowns);
    set_linear_solver(snes, unknowns);
    TALUS_PETSC(SNESSetFromOptions, snes);
    const PetscErrorCode code = SNESSolve(snes, nullptr, solution);
    if (context.error)
      std::rethrow_exception(context.error);
    check(code, "SNESSolve");
    return result_of(snes);
  }

 private:
  static NonlinearResult result_of(SNES snes)
  {
    SNESConvergedReason reason{};
    PetscInt iterations = 0, linear = 0;
    PetscReal norm = 0;
    TALUS_PETSC(SNESGetConvergedReason, snes, &reason);
    TALUS_PETSC(SNESGetIterationNumber, snes, &iterations);
    TALUS_PETSC(SNESGetLinearSolveIterations, snes, &linear);
    TALUS_PETSC(SNESGetFunctionNorm, snes, &norm);
    return {.converged = reason > 0,
            .reason = reason > 0 ? std::string() : words_of(reason),
            .iterations = static_cast<int>(iterations),
            .linear_iterations = static_cast<int>(linear),
            .norm = norm};
  }
};

NonlinearSolver& the_solver()
{
  static PetscSolver solver;
  return solver;
}

}  // namespace

}  // namespace talus

extern "C" {
extern const talus::PetscPart talus_petsc_part;
const talus::PetscPart talus_petsc_part{talus::the_solver};
}
