#include "app/commands/sweep/sweep_cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "app/run/simulate.hpp"
#include "app/run/summary.hpp"
#include "app/setup/quick.hpp"
#include "io/document/document.hpp"
#include "io/load_mesh.hpp"
#include "io/scene/reader.hpp"
#include "mesh/digest.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

/// Errors of the scenes of cases, each reported once: at the value in the study that causes it, or in the scene with the first affected
/// case unless all are affected.
class CaseErrors {
 public:
  void add(const SweepCase& one, const SceneErrors& errors)
  {
    for (const SceneError& problem : errors.problems()) {
      const auto change = std::ranges::find_if(one.changes, [&](const std::string& set) { return problem.where.file == "--set " + set; });
      const bool of_value = change != one.changes.end();
      SceneError here = problem;
      if (of_value) {
        here = one.values[static_cast<std::size_t>(change - one.changes.begin())].problem(problem.message);
        here.where.path = problem.where.path;
      }
      const std::string key = fmt::format("{}: {}: {}", to_string(here.where), here.where.path, here.message);
      const auto [found, is_new] = number_of_.emplace(key, all_.size());
      if (is_new)
        all_.push_back({std::move(here), of_value, {}, one});
      all_[found->second].cases.push_back(one.number);
    }
  }
  /// Throws SceneErrors if there are any.
  void throw_if_any(std::size_t n_cases) const
  {
    std::vector<SceneError> problems;
    for (const Entry& entry : all_) {
      problems.push_back(entry.problem);
      if (entry.of_value || entry.cases.size() == n_cases)
        continue;
      if (const auto k = only_change_within(entry)) {
        problems.back() = entry.first.values[*k].problem(entry.problem.message);
        problems.back().where.path = entry.problem.where.path;
      } else {
        problems.back().message += fmt::format(" (case {}: {})", entry.cases.front(), in_words(entry.first));
      }
    }
    if (!problems.empty())
      throw SceneErrors(std::move(problems));
  }

 private:
  struct Entry {
    SceneError problem;
    bool of_value;
    std::vector<int> cases;
    SweepCase first;  // of the affected ones
  };
  /// The only change that concerns the key of the error, or a part of it.
  static std::optional<std::size_t> only_change_within(const Entry& entry)
  {
    std::string path;  // without the names of entries: bodies[0] "block".shape
    bool in_name = false;
    for (const char c : entry.problem.where.path) {
      in_name = c == '"' ? !in_name : in_name;
      if (!in_name && c != '"' && c != ' ')
        path += c;
    }
    std::optional<std::size_t> found;
    for (std::size_t k = 0; k < entry.first.changes.size(); ++k) {
      const std::string& change = entry.first.changes[k];
      const std::string_view key = std::string_view(change).substr(0, change.find('='));
      if (path.empty() || !(is_within(key, path) || is_within(path, key)))
        continue;
      if (found)
        return std::nullopt;
      found = k;
    }
    return found;
  }

  std::vector<Entry> all_;
  std::map<std::string, std::size_t> number_of_;
};

/// The changes that affect the mesh.
std::string mesh_changes(const SweepCase& one)
{
  std::string text;
  for (const std::string& change : one.changes)
    for (const std::string_view block : {"mesh", "accuracy", "dimension"})
      if (is_within(std::string_view(change).substr(0, change.find('=')), block))
        text += change + '\n';
  return text;
}

Scene scene_of_case(const SweepPlan& plan, const SweepCase& one)
{
  Scene scene = read_scene(scene_of(plan.study), one.changes);
  if (plan.quick)
    coarsen(scene);
  return scene;
}

/// Checks cases with a common mesh.
template <int D>
void check_on_mesh(const SweepPlan& plan, const std::vector<SweepCase*>& cases, CheckDepth depth, CaseErrors& errors)
{
  std::optional<Mesh<D>> mesh;
  try {
    const Scene scene = scene_of_case(plan, *cases.front());
    mesh.emplace(load_mesh<D>(scene, folder_of(scene)));
  } catch (const SceneErrors& e) {
    for (const SweepCase* one : cases)
      errors.add(*one, e);
    return;
  }
  const std::string mesh_digest = digest_text(digest(*mesh));
  for (SweepCase* one : cases) {
    one->mesh_digest = mesh_digest;
    const CaseStatus status = status_of(*one, plan.quick);
    if (depth == CheckDepth::mesh || status.state == CaseState::done || status.goes_on_from)
      continue;  // it was checked when it started
    try {
      const Scene scene = scene_of_case(plan, *one);
      estimate<D>(scene, *mesh, set_up(scene, *mesh));
    } catch (const SceneErrors& e) {
      errors.add(*one, e);
    }
  }
}

}  // namespace

SweepPlan plan_sweep(Study study, fs::path folder, bool quick)
{
  SweepPlan plan{std::move(study), std::move(folder), quick, {}, {}};
  CaseErrors errors;
  for (StudyCase& values : cases_of(plan.study)) {
    SweepCase one;
    one.number = static_cast<int>(plan.cases.size()) + 1;
    one.values = std::move(values);
    one.changes = changes_of(plan.study, one.values);
    one.folder = plan.folder / fmt::format("case_{:04}", one.number);
    try {
      const Scene scene = read_scene(scene_of(plan.study), one.changes);
      one.scene_digest = scene_digest(scene);
      for (const FrontSpec& front : scene.outputs.history ? scene.outputs.history->fronts : std::vector<FrontSpec>{})
        if (std::ranges::find(plan.fronts, front.name) == plan.fronts.end())
          plan.fronts.push_back(front.name);
    } catch (const SceneErrors& e) {
      errors.add(one, e);
    }
    plan.cases.push_back(std::move(one));
  }
  errors.throw_if_any(plan.cases.size());
  return plan;
}

void check_cases(SweepPlan& plan, const std::vector<std::size_t>& chosen, CheckDepth depth)
{
  std::map<std::string, std::vector<SweepCase*>> by_mesh;
  for (const std::size_t i : chosen)
    by_mesh[mesh_changes(plan.cases[i])].push_back(&plan.cases[i]);
  CaseErrors errors;
  for (const auto& [changes, cases] : by_mesh)
    if (scene_of_case(plan, *cases.front()).dimension == 2)
      check_on_mesh<2>(plan, cases, depth, errors);
    else
      check_on_mesh<3>(plan, cases, depth, errors);
  errors.throw_if_any(chosen.size());
}

}  // namespace talus
