#pragma once
// Formulas of position in scenes, such as "0.1 * sin(pi * x / 50)".
#include <span>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace talus {

/// Value of `formula` at each place (x, y, z; [m]).  Known are x, y, z, the constant pi, the operators + - * / ^, comparisons,
/// `condition ? a : b`, and the usual functions (sin, cos, exp, sqrt, abs, min, ...).
/// Throws std::invalid_argument, in words: no formula, or its value is not finite somewhere.
std::vector<Real> evaluate(const std::string& formula, std::span<const Vec3> places);

}  // namespace talus
