// The only file that sees muParser.
#include "app/expression.hpp"

#include <fmt/format.h>
#include <muParser.h>

#include <numbers>
#include <stdexcept>

namespace talus {

struct Formula::Machine {
  mu::Parser parser;
  Vec3 place = Vec3::Zero();
  Real time = 0;
};

Formula::Formula(const std::string& text) : machine_(std::make_shared<Machine>())
{
  mu::Parser& parser = machine_->parser;
  try {
    parser.DefineConst("pi", std::numbers::pi);
    parser.DefineVar("x", &machine_->place[0]);
    parser.DefineVar("y", &machine_->place[1]);
    parser.DefineVar("z", &machine_->place[2]);
    parser.DefineVar("t", &machine_->time);
    parser.SetExpr(text);
    parser.Eval();  // what is wrong with the text shows now
  } catch (const mu::ParserError& e) {
    throw std::invalid_argument(fmt::format("\"{}\" is no formula of x, y, z and t: {}", text, e.GetMsg()));
  }
}

Real Formula::operator()(const Vec3& place, Real time) const
{
  machine_->place = place;
  machine_->time = time;
  return machine_->parser.Eval();
}

std::vector<Real> evaluate(const std::string& formula, std::span<const Vec3> places)
{
  const Formula value(formula);
  std::vector<Real> values;
  values.reserve(places.size());
  for (const Vec3& place : places)
    values.push_back(value(place, 0));
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i]))
      throw std::invalid_argument(
          fmt::format("\"{}\" is {} at ({:.6g}, {:.6g}, {:.6g})", formula, values[i], places[i][0], places[i][1], places[i][2]));
  return values;
}

}  // namespace talus
