#pragma once
// The interpreter, and exceptions of Python as errors of Talus; a part of libtalus_python.so.
#include <pybind11/embed.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <cfenv>
#include <string>

namespace talus {

/// Starts the interpreter at the first call; it ends with the process.  Throws EnvironmentError without NumPy.
void start_python();

/// While it exists, this thread may use Python.  Afterwards the rounding and the treatment of small numbers are those of before, which
/// packages change; steps depend on them.
class PythonInUse {
 public:
  PythonInUse() { std::fegetenv(&arithmetic_); }
  ~PythonInUse() { std::fesetenv(&arithmetic_); }
  PythonInUse(const PythonInUse&) = delete;
  PythonInUse& operator=(const PythonInUse&) = delete;

 private:
  std::fenv_t arithmetic_{};
  pybind11::gil_scoped_acquire lock_;
};

/// Runs a file as a module and returns its names.  Its folder is where it finds other modules first.  Throws exceptions of Python, and RunError
/// if there is no such file.
pybind11::dict read_script(const std::string& file);

/// Prints the traceback of an exception on standard error and throws RunError with its place: the last line of `file` in the traceback, or
/// else the last line of all.
[[noreturn]] void throw_located(pybind11::error_already_set& error, const std::string& file);

}  // namespace talus
