// The functions that libtalus_python.so exports, and the types that scripts see: Simulation, Particles, Nodes.
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/error.hpp"
#include "io/python/embedded_python.hpp"
#include "io/python/python_script.hpp"

namespace talus {

namespace py = pybind11;

namespace {

/// The host of a run while its script is called, nothing in between.
class CurrentHost {
 public:
  ScriptHost& operator*() const
  {
    if (host_ == nullptr)
      throw std::runtime_error("a simulation can be used only while the run calls the script: inside start, step, history and end");
    return *host_;
  }
  ScriptHost* set(ScriptHost* host) { return std::exchange(host_, host); }

 private:
  ScriptHost* host_ = nullptr;
};
using Host = std::shared_ptr<CurrentHost>;

py::array array_of(const ScriptArray& numbers)
{
  using Owner = std::shared_ptr<const void>;
  const py::capsule owner(new Owner(numbers.owner), [](void* kept) { delete static_cast<Owner*>(kept); });
  py::array array(py::dtype(std::string(1, numbers.number)), numbers.shape, numbers.strides, numbers.first, owner);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

std::string list_of(const std::vector<std::string>& names) { return fmt::format("{}", fmt::join(names, ", ")); }

/// The arrays of all particles, or of those of a body.
struct ScriptParticles {
  Host host;
  std::optional<std::size_t> number;

  std::vector<std::string> keys() const { return (**host).particle_names(number); }
  ScriptBody body() const
  {
    const std::vector<ScriptBody> all = (**host).bodies();
    if (number)
      return all.at(*number);
    return {"", "", "", 0, all.empty() ? 0 : all.back().end};
  }
  std::size_t size() const { return static_cast<std::size_t>(body().end - body().begin); }
  py::array get(const std::string& name) const
  {
    try {
      return array_of((**host).particles(name, number));
    } catch (const std::out_of_range&) {
      throw py::key_error(fmt::format("particles have no \"{}\"; they have {}", name, list_of(keys())));
    }
  }
  void set(const std::string& name, const py::object& values) const
  {
    if (name != "velocity")
      throw py::type_error(fmt::format(
          "\"{}\" cannot be set: only \"velocity\" can; stress and history follow from the law, and mass and position from the steps",
          name));
    const std::array<std::size_t, 2> shape{size(), static_cast<std::size_t>((**host).dimension())};
    const py::module_ numpy = py::module_::import("numpy");
    const py::object whole = numpy.attr("broadcast_to")(numpy.attr("asarray")(values, py::arg("dtype") = "f8"), shape);
    const auto numbers = py::array_t<Real, py::array::c_style | py::array::forcecast>::ensure(whole);
    const std::span<const Real> all(numbers.data(), static_cast<std::size_t>(numbers.size()));
    for (std::size_t i = 0; i < all.size(); ++i)
      if (!std::isfinite(all[i]))
        throw py::value_error(fmt::format("velocity[{}, {}] is {}: velocities must be finite", i / shape[1], i % shape[1], all[i]));
    (**host).set_velocities(number, all);
  }
};

/// The arrays of nodes.
struct ScriptNodes {
  Host host;
  py::array get(const std::string& name) const
  {
    try {
      return array_of((**host).nodes(name));
    } catch (const std::out_of_range&) {
      throw py::key_error(fmt::format("nodes have no \"{}\"; they have {}", name, list_of((**host).node_names())));
    }
  }
};

struct ScriptSimulation {
  Host host;

  py::dict bodies() const
  {
    py::dict all;
    const std::vector<ScriptBody> list = (**host).bodies();
    for (std::size_t b = 0; b < list.size(); ++b)
      all[py::str(list[b].name)] = ScriptParticles{host, b};
    return all;
  }
  py::dict history() const
  {
    py::dict row;
    for (const auto& [name, value] : (**host).history())
      row[py::str(name)] = value;
    return row;
  }
};

PYBIND11_EMBEDDED_MODULE(_talus_run, m)
{
  m.doc() = "The run that calls this script.";
  const auto body_text = [](std::string ScriptBody::*member) { return [member](const ScriptParticles& p) { return p.body().*member; }; };
  py::class_<ScriptParticles>(m, "Particles", "Arrays of particles by name, which cannot be changed in place; \"velocity\" can be set.")
      .def("__getitem__", &ScriptParticles::get)
      .def("__setitem__", &ScriptParticles::set)
      .def("__len__", &ScriptParticles::size)
      .def("__iter__", [](const ScriptParticles& p) { return py::iter(py::cast(p.keys())); })
      .def("__contains__",
           [](const ScriptParticles& p, const std::string& name) {
             const auto names = p.keys();
             return std::find(names.begin(), names.end(), name) != names.end();
           })
      .def("keys", &ScriptParticles::keys, "Names of the arrays.")
      .def_property_readonly("name", body_text(&ScriptBody::name), "Name of the body; empty for all particles.")
      .def_property_readonly("material", body_text(&ScriptBody::material), "Name of its material.")
      .def_property_readonly("law", body_text(&ScriptBody::law), "Name of its law.")
      .def_property_readonly(
          "rows", [](const ScriptParticles& p) { return py::slice(p.body().begin, p.body().end, 1); },
          "Rows of the body in the arrays of all particles, a slice.");
  py::class_<ScriptNodes>(m, "Nodes", "Arrays of the nodes of the mesh by name.")
      .def("__getitem__", &ScriptNodes::get)
      .def("__iter__", [](const ScriptNodes& n) { return py::iter(py::cast((**n.host).node_names())); })
      .def(
          "keys", [](const ScriptNodes& n) { return (**n.host).node_names(); }, "Names of the arrays.");
  py::class_<ScriptSimulation>(m, "Simulation", "The run, between two steps.")
      .def_property_readonly(
          "time", [](const ScriptSimulation& s) { return (**s.host).clock().time; }, "Simulated time [s].")
      .def_property_readonly(
          "dt", [](const ScriptSimulation& s) { return (**s.host).clock().dt; }, "Length of the last step [s].")
      .def_property_readonly(
          "step", [](const ScriptSimulation& s) { return (**s.host).clock().step; }, "Number of steps done.")
      .def_property_readonly(
          "stage", [](const ScriptSimulation& s) { return (**s.host).clock().stage; }, "Name of the stage.")
      .def_property_readonly(
          "dimension", [](const ScriptSimulation& s) { return (**s.host).dimension(); }, "2 or 3.")
      .def_property_readonly(
          "folder", [](const ScriptSimulation& s) { return (**s.host).folder(); }, "Folder of the results.")
      .def_property_readonly(
          "particles",
          [](const ScriptSimulation& s) {
            return ScriptParticles{s.host, {}};
          },
          "All particles.")
      .def_property_readonly("bodies", &ScriptSimulation::bodies, "Particles of each body, a dictionary by name.")
      .def_property_readonly(
          "nodes", [](const ScriptSimulation& s) { return ScriptNodes{s.host}; }, "Nodes of the mesh.")
      .def_property_readonly("history", &ScriptSimulation::history, "Last row of history.csv, a dictionary; empty before the first.")
      .def(
          "stop", [](const ScriptSimulation& s, const std::string& reason) { (**s.host).stop(reason); }, py::arg("reason") = "",
          "Stops the run before the next step, with a checkpoint to go on from.");
}

/// A script, as the module of Python that it is.
class EmbeddedScript final : public PythonScript {
 public:
  explicit EmbeddedScript(std::string file) : file_(std::move(file))
  {
    const PythonInUse use;
    try {
      read();
    } catch (...) {
      forget();  // while Python is in use
      throw;
    }
  }
  ~EmbeddedScript() override
  {
    const PythonInUse use;
    forget();
  }
  EmbeddedScript(const EmbeddedScript&) = delete;
  EmbeddedScript& operator=(const EmbeddedScript&) = delete;

  bool has(std::string_view function) const override
  {
    const PythonInUse use;
    return globals_.contains(std::string(function));
  }
  const std::vector<std::pair<std::string, std::string>>& columns() const override { return columns_; }

  void call(std::string_view function, ScriptHost& host) override
  {
    const PythonInUse use;
    const Visit visit(*host_, host);
    try {
      globals_[std::string(function).c_str()](simulation_);
    } catch (py::error_already_set& error) {
      throw_located(error, file_);
    }
  }

  std::vector<Real> row(ScriptHost& host) override
  {
    const PythonInUse use;
    const Visit visit(*host_, host);
    try {
      const py::object values = globals_[std::string(history_function).c_str()](simulation_);
      std::vector<Real> row;
      for (const auto& [name, unit] : columns_)
        row.push_back(number_of(values, name));
      return row;
    } catch (py::error_already_set& error) {
      throw_located(error, file_);
    }
  }

 private:
  void read()
  {
    try {
      globals_ = read_script(file_);
      py::module_::import("_talus_run");
      simulation_ = py::cast(ScriptSimulation{host_});
    } catch (py::error_already_set& error) {
      throw_located(error, file_);
    }
    for (const std::string_view one : {start_function, step_function, end_function, history_function})
      check(one);
    if (!has(start_function) && !has(step_function) && !has(end_function) && !has(history_function))
      throw RunError(fmt::format("{}: it has none of the functions start, step, history and end", file_));
    read_columns();
  }
  void forget()
  {
    globals_ = py::object();
    simulation_ = py::object();
  }

  /// The host is that of the run during a call.
  class Visit {
   public:
    Visit(CurrentHost& current, ScriptHost& host) : current_(current), before_(current.set(&host)) {}
    ~Visit() { current_.set(before_); }
    Visit(const Visit&) = delete;
    Visit& operator=(const Visit&) = delete;

   private:
    CurrentHost& current_;
    ScriptHost* before_;
  };

  void check(std::string_view function) const
  {
    if (globals_.contains(std::string(function)) && PyCallable_Check(globals_[std::string(function).c_str()].ptr()) == 0)
      throw RunError(fmt::format("{}: {} is not a function", file_, function));
  }

  void read_columns()
  {
    const bool has_columns = globals_.contains("columns"), has_values = globals_.contains(std::string(history_function));
    if (has_columns && !has_values)
      throw RunError(fmt::format("{}: columns need the function history(simulation), which returns their values", file_));
    if (!has_columns && has_values)
      throw RunError(fmt::format("{}: history() needs a dictionary columns with the names and units of its values", file_));
    if (!has_columns)
      return;
    const py::object given = globals_["columns"];
    if (!py::isinstance<py::dict>(given))
      throw RunError(fmt::format("{}: columns is not a dictionary {{\"name\": \"unit\"}}", file_));
    for (const auto& [name, unit] : given.cast<py::dict>()) {
      if (!py::isinstance<py::str>(name) || !py::isinstance<py::str>(unit))
        throw RunError(fmt::format("{}: columns has an entry that is not \"name\": \"unit\"", file_));
      const auto key = name.cast<std::string>();
      if (key.empty() || key.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_") != std::string::npos)
        throw RunError(fmt::format("{}: columns has the name \"{}\": names have letters, digits and underscores", file_, key));
      columns_.emplace_back(key, unit.cast<std::string>());
    }
  }

  Real number_of(const py::object& values, const std::string& name) const
  {
    const bool is_there = py::isinstance<py::dict>(values) && values.contains(name);
    if (!is_there)
      throw RunError(fmt::format("{}: history() did not return a dictionary with a value of \"{}\"", file_, name));
    const py::object value = values[name.c_str()];
    if (value.is_none())
      return std::numeric_limits<Real>::quiet_NaN();
    return py::float_(value).cast<Real>();
  }

  std::string file_;
  Host host_ = std::make_shared<CurrentHost>();
  py::object globals_ = {};  // names of the script; nothing until Python is in use
  py::object simulation_;
  std::vector<std::pair<std::string, std::string>> columns_;
};

}  // namespace

std::unique_ptr<PythonScript> embedded_script(const std::string& file)
{
  start_python();
  return std::make_unique<EmbeddedScript>(file);
}

}  // namespace talus
