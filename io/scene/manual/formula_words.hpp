#pragma once
// Functions and constants of formulas in scenes, for the manual.  A test compares them with the parser (app/setup/expression.hpp).
#include <array>
#include <string_view>

namespace talus {

/// A function of formulas, as it is called.
struct FormulaFunction {
  std::string_view name, call, meaning;
};

inline constexpr std::array<FormulaFunction, 26> formula_functions{{
    {"sin", "sin(a)", "sine; angles are in radians"},
    {"cos", "cos(a)", "cosine"},
    {"tan", "tan(a)", "tangent"},
    {"asin", "asin(a)", "arc sine"},
    {"acos", "acos(a)", "arc cosine"},
    {"atan", "atan(a)", "arc tangent"},
    {"atan2", "atan2(y, x)", "angle of the direction (x, y), from -pi to pi"},
    {"sinh", "sinh(a)", "hyperbolic sine"},
    {"cosh", "cosh(a)", "hyperbolic cosine"},
    {"tanh", "tanh(a)", "hyperbolic tangent: a step of finite width"},
    {"asinh", "asinh(a)", "inverse of sinh"},
    {"acosh", "acosh(a)", "inverse of cosh"},
    {"atanh", "atanh(a)", "inverse of tanh"},
    {"exp", "exp(a)", "e to the power of a"},
    {"ln", "ln(a)", "natural logarithm"},
    {"log", "log(a)", "natural logarithm too"},
    {"log2", "log2(a)", "logarithm to the base 2"},
    {"log10", "log10(a)", "logarithm to the base 10"},
    {"sqrt", "sqrt(a)", "square root"},
    {"abs", "abs(a)", "modulus"},
    {"sign", "sign(a)", "-1, 0 or 1"},
    {"rint", "rint(a)", "nearest whole number; halves go up"},
    {"min", "min(a, b, ...)", "smallest"},
    {"max", "max(a, b, ...)", "largest"},
    {"sum", "sum(a, b, ...)", "sum"},
    {"avg", "avg(a, b, ...)", "mean"},
}};

}  // namespace talus
