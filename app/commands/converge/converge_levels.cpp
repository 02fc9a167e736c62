#include "app/commands/converge/converge_levels.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "app/observers/results.hpp"
#include "app/run/simulate.hpp"
#include "app/run/summary.hpp"
#include "app/setup/quick.hpp"
#include "io/load_mesh.hpp"
#include "io/scene/accuracy.hpp"
#include "io/scene/reader.hpp"
#include "mesh/digest.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

/// Sizes of the cells of two levels that differ by less than this factor tell nothing.  Those of Celik et al. 2008 differ by 1.3 at least.
constexpr Real hardly_smaller = 1.1;
/// Ratios of sizes that are this far from the wanted one, as a share of it, get a warning; so do ratios of the axes of a grid.
constexpr Real about = 0.1;

std::string level_name(Real factor) { return fmt::format("cells_x{:.4g}", factor); }

/// Throws SceneErrors with all reasons why the cells of the scene cannot be scaled with its particles.
void refuse_fixed_cells(const Scene& scene)
{
  std::vector<SceneError> problems;
  const auto refuse = [&](SourceLocation where, const char* key, const std::string& message) {
    where.path = key;
    problems.push_back({std::move(where), message, ""});
  };
  const MeshSpec& mesh = scene.mesh;
  if (!mesh.file.empty())
    refuse(mesh.where, "mesh.file",
           "the cells of a mesh file stay as they are: give mesh.geometry with mesh.size, mesh.regions, mesh.grid or mesh.terrain; or run "
           "the scene on several files with talus sweep");
  if (scene.initial)
    refuse(scene.initial->where, "initial",
           "the particles of another run keep their number, so that smaller cells would have fewer of them: study the scene of that run");
  if (!problems.empty())
    throw SceneErrors(std::move(problems));
}

/// Errors of levels: each once, and in the scene where they are in changes that the user did not type.
class LevelErrors {
 public:
  explicit LevelErrors(const Scene& scene) : scene_(scene) {}

  void add(const ConvergeLevel& level, const SceneErrors& errors)
  {
    for (const SceneError& problem : errors.problems()) {
      SceneError here = problem;
      const bool not_typed =
          std::ranges::any_of(level.of_mesh, [&](const std::string& change) { return here.where.file == "--set " + change; });
      if (not_typed) {
        here.where = scene_.mesh.where;
        here.where.path = problem.where.path;
        here.source_line.clear();
      }
      if (seen_.insert(to_string(here.where) + here.where.path + here.message).second) {
        if (level.factor != 1)
          here.message += fmt::format(" (with {})", fmt::join(level.of_mesh, ", "));
        problems_.push_back(std::move(here));
      }
    }
  }
  void throw_if_any() const
  {
    if (!problems_.empty())
      throw SceneErrors(problems_);
  }

 private:
  const Scene& scene_;
  std::set<std::string> seen_;
  std::vector<SceneError> problems_;
};

template <int D>
void measure(const ConvergePlan& plan, const Scene& scene, ConvergeLevel& level)
{
  const Mesh<D> mesh = load_mesh<D>(scene, folder_of(scene));
  level.mesh_digest = digest_text(digest(mesh));
  level.cells = mesh.n_cells();
  Real volume = 0;
  for (Index c = 0; c < mesh.n_cells(); ++c)
    volume += mesh.volume(c);
  level.size = std::pow(volume / static_cast<Real>(mesh.n_cells()), Real{1} / D);
  Setup<D> setup = set_up(scene, mesh);
  level.particles = setup.n_particles;
  const CaseStatus status = status_of(level, plan.quick);
  if (status.state != CaseState::done && !status.goes_on_from)
    estimate<D>(scene, mesh, std::move(setup));  // what the kernel refuses is an error before anything runs
}

/// Completes the level.  Throws SceneErrors.
void look_at(const ConvergePlan& plan, ConvergeLevel& level)
{
  Scene scene = read_scene(plan.scene, level.changes);
  level.scene_digest = scene_digest(scene);
  if (plan.quick)
    coarsen(scene);
  if (scene.dimension == 2)
    measure<2>(plan, scene, level);
  else
    measure<3>(plan, scene, level);
}

/// Warns of grids whose cells have another shape at some level.
void compare_shapes(const MeshSpec& mesh, ConvergePlan& plan)
{
  for (const ConvergeLevel& level : plan.levels) {
    MeshSpec scaled = mesh;
    scale_cells(scaled, level.factor);
    Real least = std::numeric_limits<Real>::infinity(), most = 0;
    for (std::size_t axis = 0; axis < mesh.grid->cells.size(); ++axis) {
      const Real factor = static_cast<Real>(mesh.grid->cells[axis]) / static_cast<Real>(scaled.grid->cells[axis]);
      least = std::min(least, factor), most = std::max(most, factor);
    }
    if (most <= (1 + about) * least)
      continue;
    plan.warnings.push_back(fmt::format(
        "{}: mesh.grid.cells: {} of a level is not similar to {} in the scene: orders cannot be relied on; --ratio 2 --finer {} "
        "keeps all levels similar",
        to_string(plan.spec.mesh.where), fmt::format("[{}]", fmt::join(scaled.grid->cells, ", ")),
        fmt::format("[{}]", fmt::join(mesh.grid->cells, ", ")), plan.levels.size() - 1));
    return;
  }
}

/// Throws SceneErrors if cells hardly change from level to level; warns if they do not change as wanted.
void compare_sizes(Real ratio, ConvergePlan& plan)
{
  for (std::size_t i = 0; i + 1 < plan.levels.size(); ++i) {
    const ConvergeLevel &coarse = plan.levels[i], &fine = plan.levels[i + 1];
    const Real measured = coarse.size / fine.size;
    SourceLocation where = plan.spec.mesh.where;
    where.path = "mesh";
    if (measured < hardly_smaller)
      throw SceneErrors(where,
                        fmt::format("cells of {:.4g} m and of {:.4g} m hardly differ, although their sizes were scaled by {:.4g}: do "
                                    "sizes in the geometry, or few intervals of a grid, set them?",
                                    coarse.size, fine.size, ratio));
    if (std::abs(measured / ratio - 1) > about)
      plan.warnings.push_back(
          fmt::format("cells of {:.4g} m are {:.4g} times as large as those of {:.4g} m, not {:.4g} times; orders are "
                      "computed with the sizes that the cells have",
                      coarse.size, measured, fine.size, ratio));
  }
}

}  // namespace

std::vector<std::string> scaled_mesh(const MeshSpec& mesh, Real factor)
{
  MeshSpec scaled = mesh;
  scale_cells(scaled, factor);
  std::vector<std::string> changes;
  const auto add = [&](const std::string& key, Real size) { changes.push_back(fmt::format("{}={:.6g}", key, size)); };
  if (scaled.size)
    add("mesh.size", *scaled.size);
  for (std::size_t i = 0; i < scaled.refine.size(); ++i)
    add(fmt::format("mesh.refine[{}].size", i), scaled.refine[i].size);
  if (scaled.grid)
    changes.push_back(fmt::format("mesh.grid.cells=[{}]", fmt::join(scaled.grid->cells, ", ")));
  if (const auto& terrain = scaled.terrain) {
    for (std::size_t i = 0; i < terrain->layers.size(); ++i)
      if (terrain->layers[i].size)
        add(fmt::format("mesh.terrain.layers[{}].size", i), *terrain->layers[i].size);
    if (terrain->air && terrain->air->size)
      add("mesh.terrain.air.size", *terrain->air->size);
    for (std::size_t i = 0; i < terrain->refine.size(); ++i)
      add(fmt::format("mesh.terrain.refine[{}].size", i), terrain->refine[i].size);
  }
  return changes;
}

ConvergePlan plan_convergence(const ConvergeOptions& options)
{
  ConvergePlan plan;
  plan.scene = options.scene;
  plan.folder = options.out.value_or(default_results(options.scene).string() + "_convergence");
  plan.quick = options.quick;
  plan.spec = read_scene(options.scene, options.set);
  refuse_fixed_cells(plan.spec);
  std::vector<std::string> as_written = options.set;
  as_written.emplace_back("accuracy=standard");  // which scales nothing
  const MeshSpec mesh = read_scene(options.scene, as_written).mesh;
  for (int k = options.levels - 1 - options.finer; k >= -options.finer; --k) {
    ConvergeLevel level;
    level.factor = k == 0 ? 1 : std::pow(options.ratio, k);
    if (k != 0)
      level.of_mesh = scaled_mesh(mesh, level.factor);
    level.changes = options.set;
    level.changes.insert(level.changes.end(), level.of_mesh.begin(), level.of_mesh.end());
    level.folder = plan.folder / level_name(level.factor);
    plan.levels.push_back(std::move(level));
  }
  // The scene itself comes first: its errors are those of the user.
  LevelErrors errors(plan.spec);
  std::vector<ConvergeLevel*> in_turn;
  for (ConvergeLevel& level : plan.levels)
    in_turn.insert(level.factor == 1 ? in_turn.begin() : in_turn.end(), &level);
  for (ConvergeLevel* level : in_turn)
    try {
      look_at(plan, *level);
    } catch (const SceneErrors& e) {
      errors.add(*level, e);
    }
  errors.throw_if_any();
  if (mesh.grid)
    compare_shapes(mesh, plan);
  compare_sizes(options.ratio, plan);
  return plan;
}

}  // namespace talus
