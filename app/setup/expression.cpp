// The only file that sees muParser.
#include "app/setup/expression.hpp"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <numbers>
#include <stdexcept>

#include "core/parallel/threads.hpp"

namespace talus {

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

/// A parser has its variables by their addresses, so it serves one thread at a time.
struct Formula::Machine {
  mu::Parser parser;
  Vec3 place = Vec3::Zero();
  Real time = 0;

  explicit Machine(const std::string& text)
  {
    const auto place_and_time = [&] {
      parser.DefineVar("x", &place[0]);
      parser.DefineVar("y", &place[1]);
      parser.DefineVar("z", &place[2]);
      parser.DefineVar("t", &time);
    };
    read_formula(text, "x, y, z and t", place_and_time, parser);
  }
  Machine(const Machine&) = delete;
  Machine& operator=(const Machine&) = delete;
};

/// As many machines for one text as threads have asked at once so far.
class Formula::Machines {
 public:
  explicit Machines(std::string text) : text_(std::move(text)) { give(take()); }

  std::unique_ptr<Machine> take()
  {
    const std::lock_guard lock(mutex_);
    if (idle_.empty())
      return std::make_unique<Machine>(text_);
    std::unique_ptr<Machine> machine = std::move(idle_.back());
    idle_.pop_back();
    return machine;
  }
  void give(std::unique_ptr<Machine> machine)
  {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(machine));
  }

 private:
  std::string text_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Machine>> idle_;
};

Formula::Formula(const std::string& text) : machines_(std::make_shared<Machines>(text)) {}

Real Formula::operator()(const Vec3& place, Real time) const
{
  Real value = 0;
  (*this)(std::span(&place, 1), time, std::span(&value, 1));
  return value;
}

void Formula::operator()(std::span<const Vec3> places, Real time, std::span<Real> values) const
{
  // One by one: muParser's own evaluation of many at once gives the same values and is no faster (docs/development/speed.md).
  std::unique_ptr<Machine> machine = machines_->take();
  machine->time = time;
  for (std::size_t i = 0; i < places.size(); ++i) {
    machine->place = places[i];
    values[i] = machine->parser.Eval();
  }
  machines_->give(std::move(machine));
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
  constexpr Index at_once = 1024;  // places that a thread takes
  const Formula value(formula);
  std::vector<Real> values(places.size());
  parallel_for((static_cast<Index>(places.size()) + at_once - 1) / at_once, [&](Index chunk) {
    const auto begin = static_cast<std::size_t>(chunk * at_once);
    const std::size_t n = std::min<std::size_t>(at_once, places.size() - begin);
    value(places.subspan(begin, n), 0, std::span(values).subspan(begin, n));
  });
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i]))
      throw std::invalid_argument(
          fmt::format("\"{}\" is {} at ({:.6g}, {:.6g}, {:.6g})", formula, values[i], places[i][0], places[i][1], places[i][2]));
  return values;
}

std::vector<std::string> functions_of_formulas()
{
  const mu::Parser parser;  // holds what is asked for
  std::vector<std::string> names;
  for (const auto& [name, function] : parser.GetFunDef())
    names.push_back(name);
  return names;
}

}  // namespace talus
