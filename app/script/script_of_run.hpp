#pragma once
// The script of a run: calls its functions between the steps.
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "app/observers/recorder.hpp"
#include "io/python/python_script.hpp"
#include "io/scene/scene.hpp"
#include "solver/run_view.hpp"

namespace talus {

/// Calls start() before the first step of this process, step() after every so many steps, when the files of the step have been written, and
/// end() after the last step, or before the run stops as asked.  A script that changes nothing does not change the results, bitwise.  Does
/// nothing in a scene without a script.
template <int D>
class ScriptOfRun {
 public:
  /// Reads the script, whose path starts in the folder of the scene.  `folder`: the results.  Throws SceneErrors for what is wrong in the
  /// script and with more than one rank, EnvironmentError without Python.
  ScriptOfRun(const Scene& scene, std::filesystem::path folder);
  ~ScriptOfRun();
  ScriptOfRun(const ScriptOfRun&) = delete;
  ScriptOfRun& operator=(const ScriptOfRun&) = delete;

  /// Adds the columns of the script to the history; to be called before the run begins.  `recorder` must outlive this.
  void join(Recorder<D>& recorder);
  /// To be called at each event before the files of the run are written, and afterwards; adds the wall time [s].  RunError for an exception
  /// of the script.
  void before_files(const RunView<D>& view, RunEvent event, Real& seconds);
  void after_files(const RunView<D>& view, RunEvent event, Real& seconds);
  /// Calls f(reason), `reason` being that for which the script stops the run, or empty; and end() if f throws Stopped.
  template <class F>
  void stop_if_asked(const RunView<D>& view, F&& f)
  {
    try {
      f(reason_to_stop());
    } catch (const Stopped&) {
      end(view);
      throw;
    }
  }

 private:
  class Host;
  std::string reason_to_stop() const;
  void end(const RunView<D>& view);
  template <class F>
  void visit(const RunView<D>& view, std::optional<VelocityChange> velocities, F&& f);
  void call(std::string_view function, const RunView<D>& view, std::optional<VelocityChange> velocities);

  std::unique_ptr<PythonScript> script_;  // none without a script
  std::unique_ptr<Host> host_;
  Index every_ = 1;
  std::size_t n_stages_ = 0;
  SourceLocation where_;
  bool began_ = false;
};

extern template class ScriptOfRun<2>;
extern template class ScriptOfRun<3>;

}  // namespace talus
