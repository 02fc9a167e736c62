#include "app/commands/report/report_metrics.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace talus {

namespace {

constexpr Real nothing = std::numeric_limits<Real>::quiet_NaN();
constexpr std::string_view axis_letters = "xyz";

/// A horizontal direction of run-out.
struct Outward {
  std::string word;  ///< for example "+x"
  Index axis;
  bool positive;
  Real front(const Vec3& low, const Vec3& high) const { return positive ? high[axis] : low[axis]; }
  Real advance(Real from, Real to) const { return positive ? to - from : from - to; }
};

/// The directions along all axes but the one nearest to `up`; along all axes without gravity.
std::vector<Outward> directions(const MetricTask& task)
{
  Index vertical = 0;
  for (Index d = 1; d < task.dimension; ++d)
    if (std::abs(task.up[d]) > std::abs(task.up[vertical]))
      vertical = d;
  std::vector<Outward> all;
  for (Index d = 0; d < task.dimension; ++d)
    if (!task.gravity || d != vertical)
      for (const bool positive : {true, false})
        all.push_back({fmt::format("{}{}", positive ? '+' : '-', axis_letters[static_cast<std::size_t>(d)]), d, positive});
  return all;
}

/// The names of all bodies together, and of each if there are several.
std::vector<std::string> names_of_masses(const MetricTask& task)
{
  std::vector<std::string> names{task.bodies.size() == 1 ? task.bodies.front() : "all bodies"};
  if (task.bodies.size() > 1)
    names.insert(names.end(), task.bodies.begin(), task.bodies.end());
  return names;
}

/// The largest value over all frames, with its time.
template <class Value>
std::optional<std::pair<Real, Real>> largest(const RunSurvey& survey, std::size_t m, Value&& value)
{
  std::optional<std::pair<Real, Real>> found;
  for (const FrameSurvey& frame : survey.frames)
    if (const std::optional<Real> here = value(frame.masses[m]); here && (!found || *here > found->first))
      found = {*here, frame.time};
  return found;
}

/// The metrics of one body, or of all.
class MassMetrics {
 public:
  MassMetrics(const RunSurvey& survey, std::size_t m, std::string group, const MetricTask& task, std::vector<PageMetric>& all)
      : survey_(survey),
        m_(m),
        first_(survey.frames.front().masses[m]),
        last_(survey.frames.back().masses[m]),
        group_(std::move(group)),
        task_(task),
        all_(all)
  {}

  void add()
  {
    if (first_.count == 0 || last_.count == 0)
      return;
    if (task_.gravity)
      add_crest();
    for (const Outward& way : directions(task_))
      add_front(way);
    if (task_.gravity && last_.moved)
      add_way(*last_.moved);
    add_motion();
    if (last_.count != first_.count)
      tell("particles that are gone", static_cast<Real>(first_.count - last_.count), "",
           fmt::format("{} at the first output", first_.count));
  }

 private:
  void tell(const std::string& name, Real value, const std::string& unit, const std::string& note)
  {
    all_.push_back({group_, name, value, unit, note});
  }
  Real begin() const { return survey_.frames.front().time; }
  Real end() const { return survey_.frames.back().time; }

  void add_crest()
  {
    tell("crest", last_.crest, "m",
         fmt::format("highest particle against gravity at t = {:.6g} s; at t = {:.6g} s {:.6g} m", end(), begin(), first_.crest));
    tell("drop of the crest", first_.crest - last_.crest, "m",
         "how much lower the highest particle is at the end than at the first output");
  }
  void add_front(const Outward& way)
  {
    const Real from = way.front(first_.low, first_.high), to = way.front(last_.low, last_.high);
    tell("front along " + way.word, to, "m",
         fmt::format("outermost particle at t = {:.6g} s; at t = {:.6g} s {:.6g} m", end(), begin(), from));
    tell("advance along " + way.word, way.advance(from, to), "m", "how far the outermost particle is beyond the one at the first output");
  }
  /// Values that the run has written are used unchanged, so that page, summary and runout.csv agree.
  void add_way(const MovedMass& moved)
  {
    Real height = moved.height, length = moved.length;
    std::string when = fmt::format("at t = {:.6g} s", end());
    if (const auto H = task_.runout["H"], L = task_.runout["L"], time = task_.runout["time"];
        m_ == 0 && H && L && time && !H->empty() && std::isfinite(H->back())) {
      height = H->back(), length = L->back();
      when = fmt::format("by runout.csv at t = {:.6g} s", time->back());
    }
    tell("height H", height, "m",
         fmt::format("from the crown, the highest place at the start of what has come further than {:.4g} m, down to the front; {}",
                     task_.rule.moved, when));
    tell("length L", length, "m",
         task_.rule.mass_share < 1
             ? fmt::format("from the crown out to the front on the level; {:.3g} % of the mass that has moved lies beyond",
                           100 * (1 - task_.rule.mass_share))
             : std::string("from the crown out to the front on the level, the outermost particle that has moved"));
    if (length > 0) {
      tell("H/L", height / length, "", "the smaller, the more mobile");
      tell("angle of reach", std::atan2(height, length) * 180 / std::numbers::pi, "deg", "its tangent is H/L");
    }
    tell("share that has moved", static_cast<Real>(moved.count) / static_cast<Real>(last_.count), "",
         "particles that have moved, as above, over all");
  }
  void add_motion()
  {
    if (const auto speed = largest(survey_, m_, [](const MassSurvey& mass) { return mass.speed; }))
      tell("largest speed", speed->first, "m/s", fmt::format("of a particle at an output time; at t = {:.6g} s", speed->second));
    if (const auto way = largest(survey_, m_, [](const MassSurvey& mass) { return mass.displacement; }))
      tell("largest displacement", way->first, "m",
           fmt::format("of a particle from where it was at the first output; at t = {:.6g} s", way->second));
  }

  const RunSurvey& survey_;
  std::size_t m_;
  const MassSurvey &first_, &last_;
  std::string group_;
  const MetricTask& task_;
  std::vector<PageMetric>& all_;
};

void add_history(const HistoryTable& history, const MetricTask& task, std::vector<PageMetric>& all)
{
  for (const FrontSpec& front : task.fronts) {
    const auto column = history[front.name];
    if (!column || column->empty())
      continue;
    all.push_back(
        {"fronts of the history", front.name, column->back(), "m",
         fmt::format("{}{} along {}, at the last row; in the first row {:.6g} m",
                     front.mass_share < 1 ? fmt::format("coordinate beyond which {:.3g} % of the mass lies", 100 * (1 - front.mass_share))
                                          : std::string("outermost particle"),
                     front.body.empty() ? "" : " of " + front.body, enum_names(front.direction)[static_cast<std::size_t>(front.direction)],
                     column->front())});
  }
}

}  // namespace

std::vector<PageMetric> metrics_of(const RunSurvey& survey, const HistoryTable& history, const MetricTask& task)
{
  std::vector<PageMetric> all;
  const auto names = names_of_masses(task);
  if (!survey.frames.empty())
    for (std::size_t m = 0; m < std::min(names.size(), survey.frames.front().masses.size()); ++m)
      MassMetrics(survey, m, (task.gravity ? "run-out" : "motion") + (names.size() > 1 ? ", " + names[m] : ""), task, all).add();
  add_history(history, task, all);
  return all;
}

RunOutTable run_out_of(const RunSurvey& survey, const MetricTask& task)
{
  RunOutTable table;
  const auto names = names_of_masses(task);
  std::vector<Real> times;
  for (const FrameSurvey& frame : survey.frames)
    times.push_back(frame.time);
  table.columns.push_back({"time", "s"});
  table.values.push_back(times);
  for (std::size_t m = 0; m < names.size(); ++m) {
    const std::string of = m == 0 ? "" : names[m] + ": ";
    const auto add = [&](const std::string& name, const char* unit, auto&& value) {
      std::vector<Real> column;
      for (const FrameSurvey& frame : survey.frames)
        column.push_back(m < frame.masses.size() && frame.masses[m].count > 0 ? value(frame.masses[m]) : nothing);
      table.columns.push_back({of + name, unit});
      table.values.push_back(std::move(column));
    };
    if (task.gravity)
      add("crest", "m", [](const MassSurvey& mass) { return mass.crest; });
    for (const Outward& way : directions(task)) {
      add("front along " + way.word, "m", [&](const MassSurvey& mass) { return way.front(mass.low, mass.high); });
      add("front of what has moved along " + way.word, "m",
          [&](const MassSurvey& mass) { return mass.moved ? way.front(mass.moved->low, mass.moved->high) : nothing; });
    }
    if (task.gravity) {
      add("height H", "m", [](const MassSurvey& mass) { return mass.moved ? mass.moved->height : nothing; });
      add("length L", "m", [](const MassSurvey& mass) { return mass.moved ? mass.moved->length : nothing; });
    }
    add("largest speed", "m/s", [](const MassSurvey& mass) { return mass.speed.value_or(nothing); });
    add("largest displacement", "m", [](const MassSurvey& mass) { return mass.displacement.value_or(nothing); });
  }
  return table;
}

}  // namespace talus
