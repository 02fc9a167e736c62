// The only file that sees muParser.
#include "app/expression.hpp"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "core/words.hpp"

namespace talus {

struct Formula::Machine {
  mu::Parser parser;
  Vec3 place = Vec3::Zero();
  Real time = 0;
};

namespace {

/// muParser would store into what is named.
bool assigns(std::string_view text)
{
  for (std::size_t at = text.find('='); at != text.npos; at = text.find('=', at + 1)) {
    const char before = at == 0 ? ' ' : text[at - 1], after = at + 1 == text.size() ? ' ' : text[at + 1];
    if (after == '=')
      ++at;
    else if (before != '<' && before != '>' && before != '!')
      return true;
  }
  return false;
}

[[noreturn]] void refuse(const std::string& text, std::string_view known, const std::string& why)
{
  constexpr std::size_t longest_quote = 200;
  throw std::invalid_argument(
      fmt::format("{} is no formula of {}: {}", text.size() <= longest_quote ? fmt::format("\"{}\"", text) : "this long text", known, why));
}

/// Reads the text of a formula of what `define` names, `known` in words, and has its value once: what is wrong with the text shows then.
template <class Define>
Real read_formula(const std::string& text, std::string_view known, Define&& define, mu::Parser& parser)
{
  constexpr std::size_t most_characters = 10'000;
  if (text.size() > most_characters)
    refuse(text, known, fmt::format("it has more than {} characters", most_characters));
  if (assigns(text))
    refuse(text, known, "it cannot assign; == compares");
  Real value = 0;
  try {
    parser.DefineConst("pi", std::numbers::pi);
    define();
    parser.SetExpr(text);
    value = parser.Eval();
  } catch (const mu::ParserError& e) {
    refuse(text, known, e.GetMsg());
  }
  if (parser.GetNumResults() > 1)
    refuse(text, known, fmt::format("it has {} values; decimals are written with a point", parser.GetNumResults()));
  return value;
}

}  // namespace

Formula::Formula(const std::string& text) : machine_(std::make_shared<Machine>())
{
  mu::Parser& parser = machine_->parser;
  const auto place_and_time = [&] {
    parser.DefineVar("x", &machine_->place[0]);
    parser.DefineVar("y", &machine_->place[1]);
    parser.DefineVar("z", &machine_->place[2]);
    parser.DefineVar("t", &machine_->time);
  };
  read_formula(text, "x, y, z and t", place_and_time, parser);
}

Real Formula::operator()(const Vec3& place, Real time) const
{
  machine_->place = place;
  machine_->time = time;
  return machine_->parser.Eval();
}

namespace {

/// Slope in the middle of three values.
Real slope(Real left, Real middle, Real right, Real width_left, Real width_right)
{
  const Real backward = (middle - left) / width_left, forward = (right - middle) / width_right;
  if (!std::isfinite(backward) || !std::isfinite(forward))
    return std::isfinite(forward) ? forward : std::isfinite(backward) ? backward : 0;
  constexpr Real steep = 10;  // times the other side: not a kink any more, a jump
  const Real flatter = std::abs(backward) < std::abs(forward) ? backward : forward;
  if (std::max(std::abs(backward), std::abs(forward)) > steep * std::abs(flatter))
    return flatter;
  return (right - left) / (width_left + width_right);
}

}  // namespace

std::vector<Vec3> gradients(const std::string& formula, std::span<const Vec3> places, std::span<const Real> sizes)
{
  const Formula value(formula);
  const Real share = std::cbrt(std::numeric_limits<Real>::epsilon());  // truncation and round-off are alike there
  std::vector<Vec3> found(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Real middle = value(places[i], 0);
    for (int d = 0; d < 3; ++d) {
      Vec3 left = places[i], right = places[i];
      left[d] -= share * sizes[i];
      right[d] += share * sizes[i];
      found[i][d] = slope(value(left, 0), middle, value(right, 0), places[i][d] - left[d], right[d] - places[i][d]);
    }
  }
  return found;
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

Real evaluate(const std::string& formula, std::span<const NamedNumber> names)
{
  std::vector<std::string> known;
  for (const NamedNumber& one : names)
    known.push_back(one.name);
  mu::Parser parser;
  const auto define = [&] {
    for (const NamedNumber& one : names)
      parser.DefineConst(one.name, one.value);
  };
  const Real value = read_formula(formula, known.empty() ? "numbers" : or_list(known), define, parser);
  if (!std::isfinite(value))
    throw std::invalid_argument(fmt::format("\"{}\" is {}", formula, value));
  return value;
}

}  // namespace talus
