#pragma once
// The interpreter, and exceptions of Python as errors of Talus; a part of libtalus_python.so.
#include <pybind11/embed.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <cfenv>
#include <memory>
#include <string>

#include "io/python/python_script.hpp"
#include "materials/interface/talus_law.h"

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

/// An exception with its place, the last line of `file` in the traceback or else the last line of all: "hooks.py:4: in step(): KeyError: 'a'".
/// Prints the traceback on standard error if asked.
std::string place_of(pybind11::error_already_set& error, const std::string& file, bool with_traceback);
/// Prints the traceback of an exception and throws RunError with its place.
[[noreturn]] void throw_located(pybind11::error_already_set& error, const std::string& file);

/// What the plugin offers: see open_python_script() and open_python_law().
std::unique_ptr<PythonScript> embedded_script(const std::string& file);
const talus_law* embedded_law(const std::string& file, const std::string& name);

}  // namespace talus
