#pragma once
// Errors by their cause: wrong input, a run that failed or was stopped, and failures of the environment.
#include <stdexcept>
#include <string>
#include <vector>

namespace talus {

/// A position in a scene or mesh file, with the key.  Lines and columns count from one; zero means unknown.
struct SourceLocation {
  std::string file;
  int line = 0;
  int column = 0;
  std::string path;  ///< the key, such as `materials[1] "clay".friction_angle`
};
/// The location as text, such as "scenes/slope.yaml:23:21", without the parts that are unknown.
std::string to_string(const SourceLocation& where);

class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One error of the input.
struct SceneError {
  SourceLocation where;
  std::string message;
  std::string source_line;  ///< text of the line, empty if unknown
};

/// All errors of a scene or a mesh, printed like the errors of a compiler.  Exit code 2.
class SceneErrors : public Error {
 public:
  explicit SceneErrors(std::vector<SceneError> problems);
  SceneErrors(const SourceLocation& where, const std::string& message) : SceneErrors(std::vector<SceneError>{{where, message, {}}}) {}
  const std::vector<SceneError>& problems() const noexcept { return problems_; }

 private:
  std::vector<SceneError> problems_;
};

/// A simulation that failed; the message names step, time, particle and position.  Exit code 1.
class RunError : public Error {
 public:
  using Error::Error;
};

/// A run that was stopped on request after its state had been saved.  Exit code 4.
class Stopped : public Error {
 public:
  using Error::Error;
};

/// A failure of disk, library or display, which no change of the scene can correct.  Exit code 3.
class EnvironmentError : public Error {
 public:
  using Error::Error;
};

}  // namespace talus
