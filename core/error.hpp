#pragma once
// Kinds of failure, one hierarchy: the input is wrong, the run failed or was stopped, the environment is wrong.
#include <stdexcept>
#include <string>
#include <vector>

namespace talus {

/// Where something was asked for: a place in a scene or mesh file.  Lines and columns count from one; zero means unknown.
struct SourceLocation {
  std::string file;
  int line = 0;
  int column = 0;
  std::string path;  ///< the key, such as `materials[1] "clay".friction_angle`
};
/// "scenes/slope.yaml:23:21", or as much of it as is known.
std::string to_string(const SourceLocation& where);

class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One thing that is wrong with the input.
struct SceneError {
  SourceLocation where;
  std::string message;
  std::string source_line;  ///< text of the line, empty if unknown
};

/// Everything that is wrong with a scene or a mesh, printed like a compiler's errors.  Exit code 2.
class SceneErrors : public Error {
 public:
  explicit SceneErrors(std::vector<SceneError> problems);
  SceneErrors(const SourceLocation& where, const std::string& message) : SceneErrors(std::vector<SceneError>{{where, message, {}}}) {}
  const std::vector<SceneError>& problems() const noexcept { return problems_; }

 private:
  std::vector<SceneError> problems_;
};

/// The simulation failed: names step, time, particle, place.  Exit code 1.
class RunError : public Error {
 public:
  using Error::Error;
};

/// Somebody asked the run to stop, and its state has been kept.  Exit code 4.
class Stopped : public Error {
 public:
  using Error::Error;
};

/// Disk, library or display: nothing the scene could mend.  Exit code 3.
class EnvironmentError : public Error {
 public:
  using Error::Error;
};

}  // namespace talus
