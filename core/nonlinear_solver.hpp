#pragma once
// Systems of nonlinear equations, and who solves them.
#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "core/types.hpp"

namespace talus {

/// f(x) = 0, of which each rank has some rows: those of its own unknowns.  Unknowns and residuals have no unit; they are about 1 in size.
struct NonlinearEquations {
  std::size_t unknowns = 0;  ///< of this rank, numbered across the ranks in their order
  int block = 1;             ///< unknowns of a node, which follow each other
  /// Computes f(x) of the own rows; false, on all ranks, where f is not defined.  Collective.
  std::function<bool(std::span<const Real> x, std::span<Real> f)> residual;
  /// Calls add(row, column, value) for entries of a matrix like the derivative of f, with numbers across the ranks; entries of the same
  /// place are added up.
  std::function<void(const std::function<void(std::int64_t row, std::int64_t column, Real value)>& add)> add_preconditioner;
  Real tolerance = 1e-8;     ///< of the 2-norm of f
  int most_iterations = 50;  ///< of Newton's method
};

struct NonlinearResult {
  bool converged = false;
  std::string reason;         ///< why not
  int iterations = 0;         ///< of Newton's method
  int linear_iterations = 0;  ///< of the linear systems in them
  Real norm = 0;              ///< of f at the end
};

/// Finds x from a first guess.  Collective.  Does not throw because no solution was found.
class NonlinearSolver {
 public:
  NonlinearSolver() = default;
  NonlinearSolver(const NonlinearSolver&) = delete;
  NonlinearSolver& operator=(const NonlinearSolver&) = delete;
  virtual ~NonlinearSolver() = default;
  virtual NonlinearResult solve(const NonlinearEquations& equations, std::span<Real> x) = 0;
};

}  // namespace talus
