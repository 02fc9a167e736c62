// talus run
#include <fmt/format.h>

#include "app/commands.hpp"
#include "app/quick.hpp"
#include "app/results.hpp"
#include "app/summary.hpp"
#include "core/parallel.hpp"
#include "io/gmsh_mesh.hpp"
#include "io/gmsh_write.hpp"
#include "io/reader.hpp"
#include "io/whole_file.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

/// One run in its folder, from mesh to summary.
template <int D>
class Run {
 public:
  Run(Scene scene, fs::path folder, const RunOptions& options) : scene_(std::move(scene)), folder_(std::move(folder)), options_(options) {}

  void operator()()
  {
    auto mesh = load_mesh<D>(scene_.mesh, folder_of(scene_));
    watch_.lap(mesh_seconds_);
    auto setup = set_up(scene_, mesh);
    if (options_.quick)
      shorten(first_step(mesh, setup), setup.stages, scene_.outputs);
    prepare(mesh, setup);
    Recorder<D> recorder(folder_, scene_.outputs, stages_, options_.quiet);
    watch_.lap(build_seconds_);
    try {
      simulate(scene_, std::move(mesh), std::move(setup),
               {[&](const Frame<D>& frame, Moment moment) { recorder.watch(frame, moment); },
                [&](const StageResult& result) { recorder.stage_done(result); }});
    } catch (const RunError& e) {
      const std::string message =
          fmt::format("{}{}", e.what(), recorder.last_output().empty() ? "" : fmt::format("; last good output {}", recorder.last_output()));
      finish(recorder, RunStatus::failed, message);
      throw RunError(message);
    }
    finish(recorder, RunStatus::done, "");
    if (!options_.quiet)
      fmt::print("{}results in {}\n", table(recorder), folder_.string());
  }

 private:
  /// The folder, the mesh and the scene in it, and a summary that says "not ended".
  void prepare(const Mesh<D>& mesh, const Setup<D>& setup)
  {
    stages_ = setup.stages;
    prepare_results(folder_);
    summary_ = begin_summary(scene_, mesh, setup);
    write_summary(folder_ / "summary.json", summary_);
    write_whole(folder_ / "scene.yaml", scene_.text);
    write_msh(folder_ / "mesh.msh", mesh);
    write_mesh<D>(folder_ / "mesh.vtu", 0, mesh, {}, {});
    for (const std::string& warning : setup.warnings)
      fmt::print(stderr, "warning: {}\n", warning);
    if (!options_.quiet)
      fmt::print("{}: {} particles, {} cells, {} nodes, kernel {}, transfer {}, {} thread{}\n", scene_.title, setup.particles.size(),
                 mesh.n_cells(), mesh.n_nodes(), scene_.kernel, summary_.transfer, threads(), threads() == 1 ? "" : "s");
    std::fflush(stdout);
  }

  void finish(const Recorder<D>& recorder, RunStatus status, const std::string& message)
  {
    Real steps = 0;
    watch_.lap(steps);
    summary_.status = status;
    summary_.message = message;
    summary_.wall_seconds = {{"mesh", mesh_seconds_, ""}, {"build", build_seconds_, ""}};
    summary_.wall_total = mesh_seconds_ + build_seconds_ + steps;
    complete(recorder, options_.quick, summary_);
    summary_.files.insert(summary_.files.begin(), {"scene.yaml", "mesh.msh", "mesh.vtu"});
    write_summary(folder_ / "summary.json", summary_);
  }

  Scene scene_;
  fs::path folder_;
  const RunOptions& options_;
  StopWatch watch_;
  Real mesh_seconds_ = 0, build_seconds_ = 0;
  std::vector<Stage> stages_;
  RunSummary summary_;
};

}  // namespace

void run_scene(const RunOptions& options)
{
  Scene scene = read_scene(options.scene, options.set);
  const Index wanted = options.threads.value_or(scene.threads);
  if (wanted > 0)
    set_threads(wanted);
  if (options.quick)
    coarsen(scene);
  const fs::path folder = options.out.value_or(default_results(options.scene));
  if (scene.dimension == 2)
    Run<2>(std::move(scene), folder, options)();
  else
    Run<3>(std::move(scene), folder, options)();
}

}  // namespace talus
