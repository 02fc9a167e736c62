// Laws in Python behind the interface of laws in shared libraries.
#include <fmt/format.h>

#include <array>
#include <cstring>
#include <deque>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "io/python/embedded_python.hpp"
#include "materials/interface/talus_law.h"

namespace talus {

namespace py = pybind11;

namespace {

/// A law of a file, and its description for Talus.
struct PythonLaw {
  std::string file;
  py::object law;
  std::deque<std::string> texts;  ///< which stay where they are
  std::vector<talus_law_parameter> parameters;
  std::vector<talus_law_variable> variables;
  talus_law description{};
};

const char* keep(PythonLaw& law, std::string text) { return law.texts.emplace_back(std::move(text)).c_str(); }

[[noreturn]] void refuse(const PythonLaw& law, const std::string& what)
{
  throw RunError(fmt::format("{}: {}: {}", law.file, law.description.name, what));
}

/// Array of a block: a row per particle, then `shape`, whose components stand `stride` numbers apart.
template <class Number>
py::array rows(const talus_law_block& block, Number* first, std::vector<py::ssize_t> shape, const py::object& owner)
{
  constexpr auto bytes = static_cast<py::ssize_t>(sizeof(Number));
  std::vector<py::ssize_t> all{block.n}, strides{bytes};
  py::ssize_t step = block.stride * bytes;
  for (const py::ssize_t n : shape)
    step *= n;
  for (const py::ssize_t n : shape) {
    step /= n;
    all.push_back(n), strides.push_back(step);
  }
  py::array array(py::dtype::of<std::remove_const_t<Number>>(), all, strides, first, owner);
  if constexpr (std::is_const_v<Number>)
    py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

py::object new_namespace() { return py::module_::import("types").attr("SimpleNamespace")(); }

py::object parameters_of(const PythonLaw& law, const double* values)
{
  py::object all = new_namespace();
  for (std::size_t i = 0; i < law.parameters.size(); ++i)
    all.attr(law.parameters[i].key) = values[i];
  return all;
}

/// What update() gets: numbers, and arrays in the memory of the step.
class BlockOfLaw {
 public:
  BlockOfLaw(const PythonLaw& law, const talus_law_block& block) : object_(new_namespace())
  {
    const py::object owner = py::none();
    object_.attr("n") = block.n, object_.attr("dimension") = block.dimension, object_.attr("elastic") = block.elastic != 0;
    object_.attr("time") = block.time, object_.attr("dt") = block.dt, object_.attr("density") = block.density;
    object_.attr("parameters") = parameters_of(law, block.parameters);
    add("id", rows(block, block.id, {}, owner));
    add("position", rows(block, block.position, {3}, owner));
    add("size", rows(block, block.size, {}, owner));
    add("F_old", rows(block, block.F_old, {3, 3}, owner));
    add("F", rows(block, block.F, {3, 3}, owner));
    add("L", rows(block, block.L, {3, 3}, owner));
    if (block.strain != nullptr) {
      add("rotation", rows(block, block.rotation, {3, 3}, owner));
      add("strain", rows(block, block.strain, {6}, owner));
    }
    add("stress", rows(block, block.stress, {6}, owner));
    add("bulk", rows(block, block.bulk, {}, owner));
    add("shear", rows(block, block.shear, {}, owner));
    py::dict history;
    py::ssize_t first = 0;
    for (const talus_law_variable& variable : law.variables) {
      const std::vector<py::ssize_t> shape =
          variable.components > 1 ? std::vector<py::ssize_t>{variable.components} : std::vector<py::ssize_t>{};
      arrays_.emplace_back(fmt::format("history[\"{}\"]", variable.key), rows(block, block.history + first * block.stride, shape, owner));
      history[py::str(variable.key)] = arrays_.back().second;
      first += variable.components;
    }
    object_.attr("history") = history;
  }

  const py::object& object() const noexcept { return object_; }
  /// The name of an array that somebody else has after the call; nullptr if there is none.
  const std::string* kept()
  {
    object_ = py::none();
    for (const auto& [name, array] : arrays_)
      if (Py_REFCNT(array.ptr()) > 1)
        return &name;
    return nullptr;
  }

 private:
  void add(const char* name, py::array array)
  {
    object_.attr(name) = array;
    arrays_.emplace_back(name, std::move(array));
  }

  py::object object_;
  std::vector<std::pair<std::string, py::array>> arrays_;
};

/// Calls f() and writes what it throws as the message; returns the result of a function of a law.  Blocks fail by the dozen, with the same
/// traceback: only the first is printed.
template <class F>
int answer(const PythonLaw& law, char* message, std::size_t size, F&& f)
{
  static bool with_traceback = true;
  const PythonInUse use;
  std::string what;
  try {
    f();
    return 0;
  } catch (py::error_already_set& error) {
    what = place_of(error, law.file, std::exchange(with_traceback, false));
  } catch (const std::exception& error) {
    what = error.what();
  }
  if (size > 0) {
    what.resize(std::min(what.size(), size - 1));
    std::memcpy(message, what.c_str(), what.size() + 1);
  }
  return 1;
}

int begin(talus_law_setup* setup)
{
  const auto& law = *static_cast<const PythonLaw*>(setup->context);
  return answer(law, setup->message, setup->message_size, [&] {
    const py::object moduli = law.law.attr("begin")(parameters_of(law, setup->parameters), setup->density);
    const auto numbers = moduli.cast<std::vector<double>>();
    if (numbers.size() != 2)
      refuse(law, "begin() has to return the bulk and the shear modulus at rest");
    setup->bulk = numbers[0], setup->shear = numbers[1];
  });
}

int update(talus_law_block* block)
{
  const auto& law = *static_cast<const PythonLaw*>(block->context);
  return answer(law, block->message, block->message_size, [&] {
    BlockOfLaw arrays(law, *block);
    const py::object result = law.law.attr("update")(arrays.object());
    if (!result.is_none())
      refuse(law, "update() writes its results into block.stress and block.history (block.stress[:] = ...), and returns nothing");
    if (const std::string* const name = arrays.kept())
      refuse(law, fmt::format("update() keeps block.{0}, which changes later: keep block.{0}.copy()", *name));
  });
}

int weaken(void* context, double factor, double* parameters)
{
  const auto& law = *static_cast<const PythonLaw*>(context);
  std::array<char, 512> message{};
  const int result = answer(law, message.data(), message.size(), [&] {
    const py::object values = parameters_of(law, parameters);
    law.law.attr("weaken")(values, factor);
    for (std::size_t i = 0; i < law.parameters.size(); ++i)
      parameters[i] = values.attr(law.parameters[i].key).cast<double>();
  });
  if (result != 0)
    throw Error(message.data());
  return 0;
}

/// The entries of a dictionary of the law: {"name": "unit"} or {"name": ("unit", more...)}.
py::dict entries(const PythonLaw& law, const char* name)
{
  if (!py::hasattr(law.law, name))
    return {};
  const py::object given = law.law.attr(name);
  if (!py::isinstance<py::dict>(given))
    refuse(law, fmt::format("{} is not a dictionary {{\"name\": \"unit\"}}", name));
  return given;
}

/// The unit of an entry, and what follows it.
py::tuple tuple_of(const PythonLaw& law, const char* name, const std::string& key, const py::handle& entry, std::size_t most)
{
  const bool is_unit = py::isinstance<py::str>(entry);
  if (!is_unit && !py::isinstance<py::tuple>(entry))
    refuse(law, fmt::format("{}[\"{}\"] is neither a unit nor a tuple that begins with one", name, key));
  py::tuple all = is_unit ? py::make_tuple(entry) : py::reinterpret_borrow<py::tuple>(entry);
  if (all.empty() || all.size() > most || !py::isinstance<py::str>(all[0]))
    refuse(law, fmt::format("{}[\"{}\"] is not a unit and at most {} more", name, key, most - 1));
  return all;
}

void describe_parameters(PythonLaw& law)
{
  constexpr double infinite = std::numeric_limits<double>::infinity();
  for (const auto& [name, entry] : entries(law, "parameters")) {
    const auto key = py::str(name).cast<std::string>();
    const py::tuple all = tuple_of(law, "parameters", key, entry, 4);
    const auto number = [&](std::size_t i, double otherwise) {
      return all.size() > i && !all[i].is_none() ? all[i].cast<double>() : otherwise;
    };
    law.parameters.push_back({keep(law, key), keep(law, all[0].cast<std::string>()), "parameter of a law in Python",
                              number(1, std::numeric_limits<double>::quiet_NaN()), number(2, -infinite), number(3, infinite)});
  }
}

void describe_variables(PythonLaw& law)
{
  for (const auto& [name, entry] : entries(law, "variables")) {
    const auto key = py::str(name).cast<std::string>();
    const py::tuple all = tuple_of(law, "variables", key, entry, 3);
    const int components = all.size() > 1 ? all[1].cast<int>() : 1;
    if (components != 1 && components != 6)
      refuse(law, fmt::format("variables[\"{}\"] has {} components, not 1 or 6", key, components));
    law.variables.push_back({keep(law, key), keep(law, all[0].cast<std::string>()), "history variable of a law in Python", components,
                             components == 6 ? 1 : 0, all.size() > 2 ? all[2].cast<double>() : 0.0});
  }
}

/// Fills the description; throws exceptions of Python, and RunError.
void describe(PythonLaw& law)
{
  for (const char* const function : {"begin", "update"})
    if (!py::hasattr(law.law, function))
      refuse(law, fmt::format("it has no function {}", function));
  const std::string measure = py::hasattr(law.law, "measure") ? law.law.attr("measure").cast<std::string>() : "strain";
  if (measure != "strain" && measure != "deformation")
    refuse(law, fmt::format("measure is \"{}\", not \"strain\" or \"deformation\"", measure));
  describe_parameters(law);
  describe_variables(law);
  const py::object doc = law.law.attr("__doc__");
  const std::string text = doc.is_none() ? "A law in Python." : py::str(doc).cast<std::string>();
  talus_law& d = law.description;
  d.version = TALUS_LAW_VERSION;
  d.measure = measure == "strain" ? TALUS_LAW_STRAIN : TALUS_LAW_DEFORMATION;
  d.summary = keep(law, text.substr(0, text.find('\n')));
  d.n_parameters = static_cast<int32_t>(law.parameters.size()), d.n_variables = static_cast<int32_t>(law.variables.size());
  d.parameters = law.parameters.data(), d.variables = law.variables.data();
  d.context = &law;
  d.begin = begin, d.update = update;
  if (py::hasattr(law.law, "weaken"))
    d.weaken = weaken;
}

}  // namespace

const talus_law* embedded_law(const std::string& file, const std::string& name)
{
  start_python();
  const PythonInUse use;
  // Laws live as long as the process: materials point to them.
  static auto& laws = *new std::map<std::pair<std::string, std::string>, PythonLaw>;
  const std::pair key(file, name);
  if (const auto known = laws.find(key); known != laws.end())
    return &known->second.description;
  PythonLaw& law = laws[key];
  try {
    const py::dict names = read_script(file);
    if (!names.contains(name))
      throw RunError(fmt::format("{}: there is no law {}", file, name));
    law.file = file;
    law.law = names[name.c_str()];
    if (PyType_Check(law.law.ptr()) != 0)
      law.law = law.law();
    law.description.name = keep(law, name);
    describe(law);
    return &law.description;
  } catch (py::error_already_set& error) {
    laws.erase(key);
    throw_located(error, file);
  } catch (...) {
    laws.erase(key);
    throw;
  }
}

}  // namespace talus
