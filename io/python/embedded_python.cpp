#include "io/python/embedded_python.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

#include "core/error.hpp"

namespace talus {

namespace py = pybind11;

namespace {

PyThreadState* main_thread = nullptr;  // of Python, while it waits to be used

void end_python()
{
  PyEval_RestoreThread(main_thread);
  Py_FinalizeEx();
}

/// NumPy and other packages in C take the functions of Python from the process, but plugins keep what they load to themselves.
void show_python_to_packages()
{
  Dl_info python{};
  if (dladdr(reinterpret_cast<const void*>(&Py_IsInitialized), &python) != 0)
    dlopen(python.dli_fname, RTLD_NOW | RTLD_GLOBAL | RTLD_NOLOAD);
}

void import_numpy()
{
  try {
    py::module_::import("numpy");
  } catch (py::error_already_set& error) {
    throw EnvironmentError(fmt::format("a script needs NumPy for Python {} (Debian: python3-numpy): {}", PY_VERSION, error.what()));
  }
}

struct Frame {
  std::string file, function;
  int line = 0;
};

/// The frame in which the exception was raised: the last one in `file`, or else the last of all.
Frame frame_of(const py::error_already_set& error, const std::string& file)
{
  Frame frame;
  bool found = false;
  for (const py::handle one : py::module_::import("traceback").attr("extract_tb")(error.trace() ? error.trace() : py::none())) {
    const auto name = py::str(one.attr("filename")).cast<std::string>();
    if (found && name != file)
      continue;
    found = name == file;
    frame = {name, py::str(one.attr("name")).cast<std::string>(), one.attr("lineno").cast<int>()};
  }
  return frame;
}

std::string located(const py::error_already_set& error, const std::string& file)
{
  const auto type = py::str(error.type().attr("__name__")).cast<std::string>();
  if (error.matches(PyExc_SyntaxError)) {
    const py::object& value = error.value();
    const auto number = [&](const char* key) { return value.attr(key).is_none() ? 0 : value.attr(key).cast<int>(); };
    return fmt::format("{}:{}:{}: {}: {}", py::str(value.attr("filename")).cast<std::string>(), number("lineno"), number("offset"), type,
                       py::str(value.attr("msg")).cast<std::string>());
  }
  const Frame frame = frame_of(error, file);
  const auto message = py::str(error.value()).cast<std::string>();
  const std::string what = message.empty() ? type : type + ": " + message;
  if (frame.file.empty())
    return fmt::format("{}: {}", file, what);
  const std::string function = frame.function == "<module>" ? "" : fmt::format("in {}(): ", frame.function);
  return fmt::format("{}:{}: {}{}", frame.file, frame.line, function, what);
}

}  // namespace

void start_python()
{
  if (Py_IsInitialized() != 0)
    return;
  show_python_to_packages();
  PyConfig config;
  PyConfig_InitPythonConfig(&config);
  config.parse_argv = 0;
  config.install_signal_handlers = 0;  // signals stop the run
  config.write_bytecode = 0;           // nothing is written beside the script
  py::initialize_interpreter(&config, 0, nullptr, false);
  main_thread = PyEval_SaveThread();
  std::atexit(end_python);
  const PythonInUse use;
  for (const char* const stream : {"stdout", "stderr"})
    if (const py::object there = py::module_::import("sys").attr(stream); !there.is_none())
      there.attr("reconfigure")(py::arg("line_buffering") = true);
  import_numpy();
}

py::dict read_script(const std::string& file)
{
  std::ifstream stream(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (!stream)
    throw RunError(fmt::format("{}: the file cannot be read", file));
  const py::module_ sys = py::module_::import("sys"), path = py::module_::import("os.path"), builtins = py::module_::import("builtins");
  py::list arguments;
  arguments.append(file);
  sys.attr("argv") = arguments;
  sys.attr("path").attr("insert")(0, path.attr("dirname")(path.attr("abspath")(file)));
  const py::object name = path.attr("splitext")(path.attr("basename")(file)).attr("__getitem__")(0);
  const py::object module = py::module_::import("types").attr("ModuleType")(name);
  module.attr("__file__") = file;
  sys.attr("modules")[name] = module;
  const py::dict names = module.attr("__dict__");
  builtins.attr("exec")(builtins.attr("compile")(py::bytes(text), file, "exec"), names);
  return names;
}

std::string place_of(py::error_already_set& error, const std::string& file, bool with_traceback)
{
  try {
    std::string message = located(error, file);
    if (with_traceback)
      py::module_::import("traceback").attr("print_exception")(error.type(), error.value(), error.trace() ? error.trace() : py::none());
    return message;
  } catch (const py::error_already_set& another) {  // of the text of the exception
    return fmt::format("{}: {}", file, another.what());
  }
}

void throw_located(py::error_already_set& error, const std::string& file) { throw RunError(place_of(error, file, true)); }

}  // namespace talus
