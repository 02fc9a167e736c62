#pragma once
// Formulas of place and time in scenes, such as "0.1 * sin(pi * x / 50)".
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace talus {

/// A formula of x, y, z [m] and the time t [s], read once and evaluated often.  One thread at a time.
class Formula {
 public:
  /// std::invalid_argument, in words: no formula.
  explicit Formula(const std::string& text);
  Real operator()(const Vec3& place, Real time) const;

 private:
  struct Machine;
  std::shared_ptr<Machine> machine_;
};

/// Value of `formula` at each place (x, y, z; [m]).  Known are x, y, z, the time t (here 0), the constant pi, the operators + - * / ^, comparisons,
/// `condition ? a : b`, and the usual functions (sin, cos, exp, sqrt, abs, min, ...).
/// Throws std::invalid_argument, in words: no formula, or its value is not finite somewhere.
std::vector<Real> evaluate(const std::string& formula, std::span<const Vec3> places);

}  // namespace talus
