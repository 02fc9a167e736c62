#include "app/commands/fos/fos_trials.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "app/observers/results.hpp"
#include "app/run/summary.hpp"
#include "app/setup/laws_in_force.hpp"
#include "app/setup/setup.hpp"
#include "core/word_match.hpp"
#include "io/document/document.hpp"
#include "io/load_mesh.hpp"
#include "io/scene/reader.hpp"
#include "materials/interface/law_variant.hpp"
#include "materials/strength.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

/// Numbers of rows of a run's history and of files of its particles.
constexpr int rows_of_trial = 100, files_of_trial = 10;

/// An increment of a trial that is solved for equilibrium: forces in balance to this share of the loads, in at most so many iterations.
/// Cutting it in halves would not help, as its loads do not change.
constexpr Real residual_of_trial = 1e-4;
constexpr int iterations_of_trial = 20, increments_of_trial = 6;

fs::path default_fos_folder(const fs::path& scene) { return default_results(scene).string() + "_fos"; }

std::size_t stages_until_rest(const Scene& scene)
{
  std::size_t count = 0;
  for (std::size_t i = 0; i < scene.stages.size(); ++i)
    if (seeks_equilibrium(scene.stages[i]))
      count = i + 1;
  return count;
}

Index material_number(const Scene& scene, const std::string& name)
{
  const auto found = std::find_if(scene.materials.begin(), scene.materials.end(), [&](const MaterialSpec& m) { return m.name == name; });
  return static_cast<Index>(found - scene.materials.begin());
}

/// Selects the bodies whose strength is divided, with their materials, among those present in the stage `last`.
void choose_bodies(const FosOptions& options, Index last, FosPlan& plan)
{
  const Scene& scene = plan.spec;
  std::vector<BodySpec> there;
  std::vector<std::string> known;
  for (const BodySpec& body : scene.bodies)
    if (presence_of(body.name, scene.stages).in(last)) {
      there.push_back(body);
      known.push_back(body.name);
    }
  for (const std::string& name : options.bodies)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw Error(fmt::format("--bodies: in the state at rest there is no body \"{}\"{}", name, suggestion(name, known)));
  std::vector<SceneError> problems;
  for (const BodySpec& body : there) {
    const Index number = material_number(scene, body.material);
    const MaterialSpec& material = scene.materials[static_cast<std::size_t>(number)];
    const bool asked = std::find(options.bodies.begin(), options.bodies.end(), body.name) != options.bodies.end();
    if (asked && !has_strength(material))
      problems.push_back({body.where, fmt::format("--bodies: its material \"{}\" has no strength to divide", material.name), ""});
    if (asked || (options.bodies.empty() && has_strength(material))) {
      plan.bodies.push_back(body.name);
      if (std::find(plan.materials.begin(), plan.materials.end(), number) == plan.materials.end())
        plan.materials.push_back(number);
    }
  }
  for (const BodySpec& body : there) {
    const bool chosen = std::find(plan.bodies.begin(), plan.bodies.end(), body.name) != plan.bodies.end();
    const Index number = material_number(scene, body.material);
    if (!chosen && std::find(plan.materials.begin(), plan.materials.end(), number) != plan.materials.end())
      problems.push_back(
          {body.where, fmt::format("its material \"{}\" is that of a body in --bodies too: give it one of its own", body.material), ""});
  }
  if (plan.bodies.empty() && problems.empty())
    problems.push_back({scene.where, "no body has a material with strength that could be divided", ""});
  if (!problems.empty())
    throw SceneErrors(std::move(problems));
}

/// Selects what a trial is: by default what found the state at rest.
void choose_trials(const FosOptions& options, const StageSpec& rest, FosPlan& plan)
{
  plan.criterion = options.criterion;
  plan.criterion.liveliness = options.kinetic.value_or(plan.criterion.liveliness);
  plan.criterion.steadiness = options.steadiness.value_or(plan.criterion.steadiness);
  plan.trials = options.trials.value_or(is_solved(rest) ? TrialKind::equilibrium : TrialKind::run);
  if (plan.trials == TrialKind::equilibrium) {
    if (options.duration || options.damping || options.kinetic)
      throw Error(
          "--duration, --damping and --kinetic belong to trials that are runs (--trials run); static trials have --increments and "
          "--steadiness");
    const int increments = options.increments.value_or(increments_of_trial);
    plan.duration = increments;
    plan.stage = fmt::format("type: static, increments: {}, grow: false, residual: {}, iterations: {}, cuts: 0, unbalanced: 1", increments,
                             residual_of_trial, iterations_of_trial);
    return;
  }
  if (options.increments || options.steadiness)
    throw Error("--increments and --steadiness belong to static trials (--trials static); runs have --duration and --kinetic");
  if (!(plan.before.gravity > 0) && !options.duration)
    throw Error("--duration is needed where there is no gravity: how long a trial lasts follows from it");
  plan.duration = options.duration.value_or(usual_duration(plan.before));
  plan.stage = fmt::format("type: run, damping: {}", options.damping.value_or(0.3));
}

/// The properties of particles and materials before the division.
template <int D>
AtRest measured(const FosPlan& plan)
{
  const Scene& scene = plan.spec;
  AtRest before;
  for (const LoadSpec& load : scene.loads)
    if (const auto* gravity = std::get_if<GravitySpec>(&load))
      before.gravity = Eigen::Map<const Eigen::VectorXd>(gravity->acceleration.data(), std::ssize(gravity->acceleration)).norm();
  const Mesh<D> mesh = load_mesh<D>(scene, folder_of(scene));
  const Setup<D> setup = set_up(scene, mesh);
  const Vec<D> up = upright_of(scene).template head<D>();
  Real low = std::numeric_limits<Real>::infinity(), high = -low;
  before.wave_speed = low;
  for (std::size_t b = 0; b < setup.state.bodies.size(); ++b) {
    const Body& body = setup.state.bodies[b];
    if (std::find(plan.bodies.begin(), plan.bodies.end(), body.name) == plan.bodies.end())
      continue;
    before.wave_speed = std::min(before.wave_speed, setup.state.materials[b].law().wave_speed(Mat3::Identity()));
    for (Index row = body.begin; row < body.end; ++row) {
      const Real at = up.dot(setup.state.particles.x[static_cast<std::size_t>(row)]);
      low = std::min(low, at), high = std::max(high, at);
    }
  }
  before.height = high - low;
  return before;
}

/// The changes of one number of a material and of those in its groups, where they differ.
template <class T>
void tell_difference(const T& before, const T& after, const std::string& path, std::vector<std::string>& changes)
{
  if constexpr (std::is_same_v<T, Real>) {
    if (before != after)
      changes.push_back(fmt::format("{}={}", path, after));
  } else if constexpr (requires { before.has_value(); }) {
    if (before && after)
      tell_difference(*before, *after, path, changes);
  } else if constexpr (HasFields<T>) {
    for_each_field<T>([&](const auto& field) {
      tell_difference(before.*(field.member), after.*(field.member), fmt::format("{}.{}", path, field.key), changes);
    });
  }
}

/// Rewrites a list of the scene: the selected entries, each with some of its keys and additional ones.
class Rewritten {
 public:
  Rewritten(const FosOptions& options, std::string list) : options_(options), list_(std::move(list)) {}
  void keep(std::size_t i, const KeyChoice& keys = {}, const std::string& more = "")
  {
    std::string entry = written_in_scene(options_.scene, options_.set, fmt::format("{}[{}]", list_, i), keys);
    if (!more.empty())
      entry.insert(entry.size() - 1, ", " + more);
    entries_.push_back(std::move(entry));
  }
  std::string change() const { return fmt::format("{}=[{}]", list_, fmt::join(entries_, ", ")); }

 private:
  const FosOptions& options_;
  std::string list_;
  std::vector<std::string> entries_;
};

/// The text in quotes, which YAML reads back unchanged.
std::string in_quotes(const fs::path& path)
{
  Node text;
  text.kind = Node::Kind::scalar;
  text.quoted = true;
  text.text = path.string();
  return in_one_line(text);
}

/// Keeps the stages up to equilibrium.  Throws SceneErrors if a law changes on the way, because it would not be the law in the scene.
void keep_stages(const FosOptions& options, std::size_t n_stages, FosPlan& plan)
{
  Rewritten stages(options, "stages");
  std::vector<SceneError> problems;
  for (std::size_t i = 0; i < n_stages; ++i) {
    const StageSpec& stage = plan.spec.stages[i];
    if (const StageChanges& changes = changes_of(stage); !changes.change.empty() || !changes.weaken.empty())
      problems.push_back(
          {where_of(stage), "change and weaken before the state at rest: give the bodies the material that they have there instead", ""});
    stages.keep(i);
  }
  if (!problems.empty())
    throw SceneErrors(std::move(problems));
  plan.at_rest.changes.push_back(stages.change());
}

/// Keeps the bodies that are present in equilibrium; bodies that appear later are left out.
void keep_bodies(const FosOptions& options, Index last, FosPlan& plan)
{
  Rewritten before(options, "bodies"), then(options, "bodies");
  bool all = true;
  for (std::size_t b = 0; b < plan.spec.bodies.size(); ++b) {
    const Presence presence = presence_of(plan.spec.bodies[b].name, plan.spec.stages);
    all = all && presence.from <= last;
    if (presence.from <= last)
      before.keep(b);
    if (presence.in(last))
      then.keep(b, {.only = BodySpec::keys_without_filling});
  }
  if (!all)
    plan.at_rest.changes.push_back(before.change());
  plan.of_state.push_back(then.change());
}

/// Boundary conditions act in the trials as in the stage that finds equilibrium.
void keep_walls(const FosOptions& options, Index last, FosPlan& plan)
{
  const auto& walls = plan.spec.boundaries;
  if (std::all_of(walls.begin(), walls.end(), [](const BoundaryOptions& wall) { return common_of(wall).during.empty(); }))
    return;
  constexpr std::array<std::string_view, 1> key{"during"};
  Rewritten before(options, "boundaries"), then(options, "boundaries");
  for (std::size_t w = 0; w < walls.size(); ++w) {
    std::vector<std::string> names;
    for (Index s = 0; s <= last; ++s)
      if (const std::string name = name_of(plan.spec.stages[static_cast<std::size_t>(s)]); common_of(walls[w]).acts_in(name))
        names.push_back(in_quotes(name));
    if (common_of(walls[w]).during.empty())
      before.keep(w);
    else if (!names.empty())
      before.keep(w, {.without = key}, fmt::format("during: [{}]", fmt::join(names, ", ")));
    if (common_of(walls[w]).acts_in(name_of(plan.spec.stages[static_cast<std::size_t>(last)])))
      then.keep(w, {.without = key});
  }
  plan.at_rest.changes.push_back(before.change());
  plan.of_state.push_back(then.change());
}

/// The water table of trials is that of the equilibrium.
void keep_table(const FosOptions& options, std::size_t n_stages, FosPlan& plan)
{
  for (std::size_t i = n_stages; i-- > 0;)
    if (changes_of(plan.spec.stages[i]).water)
      return plan.of_state.push_back("water.table=" +
                                     written_in_scene(options.scene, options.set, fmt::format("stages[{}].water.table", i)));
}

/// The scene has been read before: errors after these changes are not errors of the user, so the message names the scene and not a --set
/// that was not typed.
std::string digest_of_changed(const FosPlan& plan, const std::vector<std::string>& changes)
try {
  return scene_digest(read_scene(plan.scene, changes));
} catch (const SceneErrors& e) {
  std::vector<SceneError> problems;
  for (const SceneError& problem : e.problems()) {
    SourceLocation where = plan.spec.where;
    where.path = problem.where.path;
    problems.push_back({where, "a run that talus fos makes of this scene is refused: " + problem.message, ""});
  }
  throw SceneErrors(std::move(problems));
}

}  // namespace

std::vector<std::string> divided(const FosPlan& plan, Real factor)
{
  std::vector<std::string> changes;
  for (const Index number : plan.materials)
    std::visit(
        [&](const auto& law) {
          auto weaker = law;
          divide_strength(weaker, factor);
          tell_difference(law, weaker, fmt::format("materials[{}]", number), changes);
        },
        choices_of(plan.spec.materials[static_cast<std::size_t>(number)].law));
  return changes;
}

PlannedRun trial_of(const FosPlan& plan, Real factor, int times_as_long)
{
  const Real duration = plan.duration * times_as_long;
  PlannedRun run;
  run.changes = plan.of_state;
  const auto add = [&](const std::vector<std::string>& more) { run.changes.insert(run.changes.end(), more.begin(), more.end()); };
  add(divided(plan, factor));
  const bool solves = plan.trials == TrialKind::equilibrium;  // each of its steps is an increment, with a row of its own
  add({fmt::format("stages=[{{duration: {}, {}}}]", duration, plan.stage),
       fmt::format("outputs={{particles: {{every: {}, fields: {}}}, history: {{every: {}, moved: {}}}{}}}",
                   solves ? duration : duration / files_of_trial, plan.fields, duration / (solves ? 1e3 * rows_of_trial : rows_of_trial),
                   plan.moved, plan.picture)});
  run.folder = plan.folder / fmt::format("trial_{}", factor);
  run.scene_digest = digest_of_changed(plan, run.changes);
  return run;
}

FosPlan plan_fos(const FosOptions& options)
{
  FosPlan plan;
  plan.scene = options.scene;
  plan.folder = options.out.value_or(default_fos_folder(options.scene));
  plan.set = options.set;
  plan.quick = options.quick;
  plan.spec = read_scene(options.scene, options.set);
  const Scene& scene = plan.spec;
  const std::size_t n_stages = stages_until_rest(scene);
  if (n_stages == 0) {
    SourceLocation where = scene.where;
    where.path = "stages";
    throw SceneErrors(where, "there is no stage of type geostatic or static: strength is divided in the state at rest that it finds");
  }
  const auto last = static_cast<Index>(n_stages) - 1;
  choose_bodies(options, last, plan);
  plan.before = scene.dimension == 2 ? measured<2>(plan) : measured<3>(plan);
  choose_trials(options, scene.stages[n_stages - 1], plan);

  plan.at_rest.changes = options.set;
  plan.of_state = options.set;
  keep_stages(options, n_stages, plan);
  keep_bodies(options, last, plan);
  keep_walls(options, last, plan);
  keep_table(options, n_stages, plan);
  plan.at_rest.changes.emplace_back("outputs.checkpoint.at_end=true");
  plan.at_rest.folder = plan.folder / "at_rest";
  plan.at_rest.scene_digest = digest_of_changed(plan, plan.at_rest.changes);

  // Relative to the scene, so that both can be moved together.
  const fs::path here = fs::absolute(options.scene).lexically_normal().parent_path();
  const fs::path state = fs::absolute(plan.at_rest.folder).lexically_normal().lexically_relative(here);
  plan.of_state.push_back(fmt::format("initial={{from: {}}}", in_quotes(state)));
  std::vector<std::string> moved;
  for (const std::string& body : options.bodies) {
    plan.columns.push_back("moved_" + body);
    moved.push_back(
        fmt::format("{{name: {}, body: {}, mass_share: {}}}", in_quotes(plan.columns.back()), in_quotes(body), options.mass_share));
  }
  if (options.bodies.empty()) {
    plan.columns.emplace_back("moved");
    moved.push_back(fmt::format("{{name: moved, mass_share: {}}}", options.mass_share));
  }
  plan.keeps_strain = std::any_of(plan.materials.begin(), plan.materials.end(), [&](Index number) {
    return scene.materials[static_cast<std::size_t>(number)].law.description().scalar_variable("plastic_strain").has_value();
  });
  plan.fields = plan.keeps_strain ? "[velocity, displacement, plastic_strain]" : "[velocity, displacement]";
  plan.moved = fmt::format("[{}]", fmt::join(moved, ", "));
  if (const std::string picture = written_in_scene(options.scene, options.set, "outputs.picture"); picture.starts_with('{'))
    plan.picture = ", picture: " + picture;
  trial_of(plan, 1, 1);  // errors of a trial are reported before the equilibrium is computed
  return plan;
}

}  // namespace talus
