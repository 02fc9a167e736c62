#pragma once
// A script in Python that a run calls between its steps, and what it can see of the run.
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/types.hpp"

namespace talus {

/// Numbers that the script sees as an array, which it cannot change.
struct ScriptArray {
  char number = 'd';                            ///< type in the notation of Python's module struct: d, i or q
  const void* first = nullptr;                  ///< the first number
  std::vector<std::int64_t> shape, strides;     ///< strides in bytes
  std::shared_ptr<const void> owner = nullptr;  ///< while a copy of it exists, the numbers stay where they are and do not change
};

/// Time and step of the run.
struct ScriptClock {
  Real time{}, dt{};  ///< of the state, and the length of the last step [s]
  std::int64_t step{};
  std::string stage;
};

/// A body: rows [begin, end) of the arrays of all particles.
struct ScriptBody {
  std::string name, material, law;
  std::int64_t begin{}, end{};
};

/// The run as its script sees it, between two steps.  Functions with a name throw std::out_of_range if there is no such thing, and
/// std::invalid_argument, with the reason, for what cannot be done.
class ScriptHost {
 public:
  ScriptHost() = default;
  virtual ~ScriptHost() = default;
  ScriptHost(const ScriptHost&) = delete;
  ScriptHost& operator=(const ScriptHost&) = delete;

  virtual int dimension() const = 0;
  virtual std::string folder() const = 0;  ///< of the results
  virtual ScriptClock clock() const = 0;
  virtual std::vector<ScriptBody> bodies() const = 0;
  /// Arrays of all particles, or of those of a body given by its number.
  virtual std::vector<std::string> particle_names(std::optional<std::size_t> body) const = 0;
  virtual ScriptArray particles(const std::string& name, std::optional<std::size_t> body) = 0;
  virtual std::vector<std::string> node_names() const = 0;
  virtual ScriptArray nodes(const std::string& name) = 0;
  /// The values of the last row of history.csv; empty without rows.
  virtual std::vector<std::pair<std::string, Real>> history() const = 0;

  /// Sets the velocities of these particles, `dimension` numbers each [m/s].
  virtual void set_velocities(std::optional<std::size_t> body, std::span<const Real> values) = 0;
  /// Stops the run before the next step, as a signal does.
  virtual void stop(const std::string& reason) = 0;
};

/// The functions that a script may have.
inline constexpr std::string_view start_function = "start", step_function = "step", end_function = "end", history_function = "history";

/// A script that has been read.
class PythonScript {
 public:
  PythonScript() = default;
  virtual ~PythonScript() = default;
  PythonScript(const PythonScript&) = delete;
  PythonScript& operator=(const PythonScript&) = delete;

  virtual bool has(std::string_view function) const = 0;
  /// Columns of history.csv that it adds, with their units: its dictionary `columns`.
  virtual const std::vector<std::pair<std::string, std::string>>& columns() const = 0;
  /// Calls start(), step() or end().  What the script keeps of `host` raises an exception when it is used later.  Throws RunError with
  /// file, line, function and message of an exception, whose traceback is on standard error then.
  virtual void call(std::string_view function, ScriptHost& host) = 0;
  /// The values of its columns from history().  Throws RunError.
  virtual std::vector<Real> row(ScriptHost& host) = 0;
};

/// Starts Python, if it does not run, and reads a script.  Throws RunError, as PythonScript::call(), for what is wrong in the script, and
/// EnvironmentError without Python or NumPy.
std::unique_ptr<PythonScript> open_python_script(const std::string& file);

}  // namespace talus
