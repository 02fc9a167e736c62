// The only file that sees muParser.
#include "app/expression.hpp"

#include <fmt/format.h>
#include <muParser.h>

#include <numbers>
#include <stdexcept>

namespace talus {

std::vector<Real> evaluate(const std::string& formula, std::span<const Vec3> places)
{
  std::vector<Real> values;
  values.reserve(places.size());
  Vec3 at = Vec3::Zero();
  try {
    mu::Parser parser;
    parser.DefineConst("pi", std::numbers::pi);
    parser.DefineVar("x", &at[0]);
    parser.DefineVar("y", &at[1]);
    parser.DefineVar("z", &at[2]);
    parser.SetExpr(formula);
    parser.Eval();  // what is wrong with the text shows without any place, too
    for (const Vec3& place : places) {
      at = place;
      values.push_back(parser.Eval());
    }
  } catch (const mu::ParserError& e) {
    throw std::invalid_argument(fmt::format("\"{}\" is no formula of x, y and z: {}", formula, e.GetMsg()));
  }
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i]))
      throw std::invalid_argument(
          fmt::format("\"{}\" is {} at ({:.6g}, {:.6g}, {:.6g})", formula, values[i], places[i][0], places[i][1], places[i][2]));
  return values;
}

}  // namespace talus
