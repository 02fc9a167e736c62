#pragma once
// Formulas of place and time in scenes, such as "0.1 * sin(pi * x / 50)".
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace talus {

/// A formula of x, y, z [m] and the time t [s], read once and evaluated often, by any number of threads at once.
class Formula {
 public:
  /// std::invalid_argument, in words: no formula.
  explicit Formula(const std::string& text);
  Real operator()(const Vec3& place, Real time) const;
  /// The same at many places; `values` has their number.  Cheaper than one by one.
  void operator()(std::span<const Vec3> places, Real time, std::span<Real> values) const;

 private:
  struct Machine;
  class Machines;
  std::shared_ptr<Machines> machines_;
};

/// Value of `formula` at each place (x, y, z; [m]).  Known are x, y, z, the time t (here 0), the constant pi, the operators + - * / ^, comparisons,
/// `condition ? a : b`, and the usual functions (sin, cos, exp, sqrt, abs, min, ...).
/// Throws std::invalid_argument, in words: no formula, or its value is not finite somewhere.
std::vector<Real> evaluate(const std::string& formula, std::span<const Vec3> places);

/// Names of the functions that formulas know.
std::vector<std::string> functions_of_formulas();

/// Derivatives of `formula` along x, y, z at each place by central differences; `sizes` [m] are lengths over which the formula is meant
/// to be resolved there, such as those of cells.  They err by about eps^(2/3) of value / size; what does not depend on a coordinate has
/// the derivative 0 along it to the bit.  Beside a jump, or the end of where the formula is finite, the derivative is that of the
/// flatter side.  std::invalid_argument, in words: no formula.
std::vector<Vec3> gradients(const std::string& formula, std::span<const Vec3> places, std::span<const Real> sizes);

}  // namespace talus
