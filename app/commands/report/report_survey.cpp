#include "app/commands/report/report_survey.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.hpp"
#include "core/word_match.hpp"

namespace talus {

namespace {

/// Whether a field is useful as colours; position and id are not.
bool is_shown(const StoredField& field) { return field.name != "position" && field.name != "body"; }

std::vector<std::string> names_of_fields(const StoredParticles& particles)
{
  std::vector<std::string> names;
  for (const StoredField& field : particles.fields)
    if (field.name != "position")
      names.push_back(field.name);
  return names;
}

}  // namespace

std::string words_of(const ViewedField& field) { return field.component.empty() ? field.name : field.name + ':' + field.component; }

std::vector<ViewedField> fields_to_show(const StoredParticles& particles, const std::vector<std::string>& asked,
                                        const std::string& of_picture)
{
  std::vector<ViewedField> shown;
  const auto add = [&](const ViewedField& field) {
    const auto same = [&](const ViewedField& other) { return words_of(other) == words_of(field); };
    if (std::none_of(shown.begin(), shown.end(), same))
      shown.push_back(field);
  };
  for (const std::string& text : asked) {
    const auto field = ViewedField::of(text);
    const StoredField* there = stored_field(particles, field.name);
    if (there == nullptr)
      throw Error(
          fmt::format("--fields: the particles have no field \"{}\"{}", field.name, suggestion(field.name, names_of_fields(particles))));
    field.component_of(there->components);
    add(field);
  }
  if (!asked.empty())
    return shown;
  const auto first = ViewedField::of(of_picture);
  if (stored_field(particles, first.name) != nullptr)
    add(first);
  for (const StoredField& field : particles.fields)
    if (is_shown(field))
      add({field.name});
  return shown;
}

namespace {

namespace fs = std::filesystem;

Vec3 place(std::span<const Real> places, std::size_t p) { return Eigen::Map<const Vec3>(places.data() + 3 * p); }

/// The data of a frame for the survey.
struct Looked {
  std::span<const Real> places;
  const StoredField *velocity, *displacement;
  std::vector<Real> body;
  Vec3 start(std::size_t row, const Vec3& in_first_frame) const
  {
    return displacement == nullptr ? in_first_frame : Vec3(place(places, row) - place(displacement->values, row));
  }
};

std::optional<ValueRange> finite_range(const std::vector<Real>& values)
{
  std::optional<ValueRange> range;
  for (const Real value : values)
    if (std::isfinite(value)) {
      if (!range)
        range = {value, value};
      range->low = std::min(range->low, value);
      range->high = std::max(range->high, value);
    }
  return range;
}

struct Way {
  Vec3 then, now;
  Real mass;
};

std::optional<MovedMass> moved_mass(const std::vector<Way>& ways, const ReachRule& rule, const Vec3& up)
{
  MovedMass moved;
  std::vector<Vec3> then, now;
  std::vector<Real> masses;
  for (const Way& way : ways)
    if ((way.now - way.then).norm() >= rule.moved)
      then.push_back(way.then), now.push_back(way.now), masses.push_back(way.mass);
  if (now.empty())
    return std::nullopt;
  moved.count = static_cast<std::int64_t>(now.size());
  moved.low = moved.high = now.front();
  for (const Vec3& x : now) {
    moved.low = moved.low.cwiseMin(x);
    moved.high = moved.high.cwiseMax(x);
  }
  const Reach reach = *reach_of(then, now, masses, up, rule.mass_share);
  moved.height = reach.height, moved.length = reach.length;
  return moved;
}

using RowPairs = std::vector<std::pair<std::size_t, std::size_t>>;

/// The rows of the ids in ascending order.
std::vector<std::size_t> rows_by_id(const std::vector<std::int64_t>& ids)
{
  std::vector<std::size_t> rows(ids.size());
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  std::ranges::sort(rows, {}, [&](std::size_t row) { return ids[row]; });
  return rows;
}

/// The rows of the ids that both lists have, in ascending order of the ids.
RowPairs common_rows(const std::vector<std::int64_t>& a, const std::vector<std::int64_t>& b)
{
  const std::vector<std::size_t> rows_a = rows_by_id(a), rows_b = rows_by_id(b);
  RowPairs pairs;
  for (std::size_t i = 0, j = 0; i < rows_a.size() && j < rows_b.size();)
    if (a[rows_a[i]] == b[rows_b[j]])
      pairs.emplace_back(rows_a[i++], rows_b[j++]);
    else
      ++(a[rows_a[i]] < b[rows_b[j]] ? i : j);
  return pairs;
}

/// The survey of the rows of body `b`, or of all.
MassSurvey survey_of(const Looked& looked, const RowPairs& common, const RunSurvey& run, std::optional<std::size_t> b,
                     const SurveyTask& task)
{
  const auto belongs = [&](std::size_t row) { return !b || (row < looked.body.size() && looked.body[row] == static_cast<Real>(*b)); };
  const auto runs_out = [&](std::size_t row) {
    const auto body = static_cast<std::size_t>(row < looked.body.size() ? looked.body[row] : 0);
    return b || body >= task.runs_out.size() || task.runs_out[body];
  };
  MassSurvey mass;
  constexpr Real infinity = std::numeric_limits<Real>::infinity();
  Vec3 low = Vec3::Constant(infinity), high = Vec3::Constant(-infinity);
  Real crest = -infinity, speed = 0;
  for (std::size_t row = 0; row < looked.places.size() / 3; ++row) {
    if (!belongs(row))
      continue;
    ++mass.count;
    const Vec3 x = place(looked.places, row);
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
    crest = std::max(crest, x.dot(task.up));
    if (looked.velocity != nullptr)
      speed = std::max(speed, place(looked.velocity->values, row).norm());
  }
  if (mass.count == 0)
    return mass;
  mass.low = low, mass.high = high, mass.crest = crest;
  if (looked.velocity != nullptr)
    mass.speed = speed;
  std::vector<Way> ways;
  std::optional<Real> furthest;
  for (const auto& [first, row] : common)
    if (belongs(row)) {
      const Vec3 now = place(looked.places, row), in_first_frame = place(run.places, first);
      furthest = std::max(furthest.value_or(0), (now - in_first_frame).norm());
      if (runs_out(row))
        ways.push_back({looked.start(row, in_first_frame), now, run.masses[first]});
    }
  mass.displacement = furthest;
  mass.moved = moved_mass(ways, task.rule, task.up);
  return mass;
}

/// Volumes of the first frame, or equal volumes if the files have none, times the density of their bodies if it is known.
std::vector<Real> masses_of(const StoredParticles& particles, const SurveyTask& task)
{
  const StoredField* volume = stored_field(particles, "volume");
  std::vector<Real> masses = volume != nullptr ? volume->values : std::vector<Real>(particles.ids.size(), 1);
  const StoredField* body = stored_field(particles, "body");
  const bool known = !task.mass.empty() && std::all_of(task.mass.begin(), task.mass.end(), [](Real mass) { return mass > 0; });
  if (body == nullptr || !known)
    return masses;
  std::vector<Real> whole(task.mass.size(), 0);
  const auto number = [&](std::size_t p) {
    return static_cast<std::size_t>(std::clamp<Real>(body->values[p], 0, static_cast<Real>(whole.size() - 1)));
  };
  for (std::size_t p = 0; p < masses.size(); ++p)
    whole[number(p)] += masses[p];
  for (std::size_t p = 0; p < masses.size(); ++p)
    masses[p] *= task.mass[number(p)] / whole[number(p)];
  return masses;
}

void begin(const StoredParticles& particles, const SurveyTask& task, RunSurvey& survey)
{
  survey.fields = fields_to_show(particles, task.fields, task.of_picture);
  survey.begun = true;
  for (const ViewedField& field : survey.fields) {
    const StoredField& there = *stored_field(particles, field.name);
    survey.labels.push_back(field.label(there.components));
    survey.units.push_back(there.unit);
    survey.components.push_back(there.components);
  }
  survey.ids = particles.ids;
  survey.places = particles.fields.front().values;
  survey.masses = masses_of(particles, task);
}

/// Throws unless fields have as many components as in the first frame; velocities and displacements three, bodies and volumes one.
void require_components(const StoredParticles& particles, const fs::path& file, const RunSurvey& survey)
{
  const auto require = [&](std::string_view name, int components) {
    if (const StoredField* field = stored_field(particles, name); field != nullptr && field->components != components)
      throw EnvironmentError(
          fmt::format("cannot read {}: field \"{}\" has {} components, not {}", file.string(), name, field->components, components));
  };
  for (std::size_t f = 0; f < survey.fields.size(); ++f)
    require(survey.fields[f].name, survey.components[f]);
  require("velocity", 3);
  require("displacement", 3);
  require("body", 1);
  require("volume", 1);
}

FrameSurvey survey_of(Real time, const fs::path& file, const SurveyTask& task, RunSurvey& survey)
{
  FrameSurvey frame{time, file, state_of(file), 0, {}, {}};
  const StoredParticles particles = read_particles(file);
  require_components(particles, file, survey);
  if (!survey.begun)
    begin(particles, task, survey);
  frame.count = static_cast<std::int64_t>(particles.ids.size());
  for (const ViewedField& viewed : survey.fields) {
    const StoredField* field = stored_field(particles, viewed.name);
    frame.fields.push_back(field == nullptr ? std::nullopt : finite_range(viewed_values(*field, viewed)));
  }
  Looked looked{particles.fields.front().values, stored_field(particles, "velocity"), stored_field(particles, "displacement"), {}};
  if (const StoredField* body = stored_field(particles, "body"))
    looked.body = body->values;
  const RowPairs common = common_rows(survey.ids, particles.ids);
  frame.masses.push_back(survey_of(looked, common, survey, std::nullopt, task));
  for (std::size_t b = 0; task.bodies > 1 && b < task.bodies; ++b)
    frame.masses.push_back(survey_of(looked, common, survey, b, task));
  return frame;
}

}  // namespace

std::string state_of(const fs::path& file)
{
  std::error_code not_there;
  const auto size = fs::file_size(file, not_there);
  const auto time = fs::last_write_time(file, not_there);
  return not_there ? "" : fmt::format("{}-{}", size, time.time_since_epoch().count());
}

void look_over(const fs::path& folder, const SurveyTask& task, RunSurvey& survey)
{
  survey.left_out.clear();
  std::vector<std::pair<Real, fs::path>> listed;
  if (fs::exists(folder / "particles.pvd"))
    try {
      listed = read_pvd(folder / "particles.pvd");
    } catch (const EnvironmentError& damaged) {
      survey.left_out.push_back(fmt::format("all particles are left out: {}", damaged.what()));
    }
  std::vector<FrameSurvey> known = std::move(survey.frames);
  survey.frames.clear();
  if (known.empty() || listed.empty() || known.front().file != listed.front().second ||
      known.front().state != state_of(known.front().file)) {
    std::vector<std::string> left_out = std::move(survey.left_out);
    survey = {};  // results of another run
    survey.left_out = std::move(left_out);
    known.clear();
  }
  for (const auto& entry : listed) {
    const Real time = entry.first;
    const fs::path& file = entry.second;
    const auto same = [&](const FrameSurvey& frame) { return frame.file == file && frame.state == state_of(file); };
    if (const auto before = std::find_if(known.begin(), known.end(), same); before != known.end()) {
      survey.frames.push_back(std::move(*before));
      continue;
    }
    try {
      survey.frames.push_back(survey_of(time, file, task, survey));
    } catch (const EnvironmentError& e) {
      survey.left_out.push_back(fmt::format("the frame at t = {:.6g} s is left out: {}", time, e.what()));
    }
  }
}

ValueRange range_over_frames(const RunSurvey& survey, std::size_t field)
{
  std::optional<ValueRange> all;
  for (const FrameSurvey& frame : survey.frames)
    if (const auto& range = frame.fields[field]) {
      if (!all)
        all = range;
      all->low = std::min(all->low, range->low);
      all->high = std::max(all->high, range->high);
    }
  return all.value_or(ValueRange{0, 0});
}

}  // namespace talus
