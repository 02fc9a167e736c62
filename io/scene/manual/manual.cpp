#include "io/scene/manual/manual.hpp"

#include <fmt/ranges.h>

#include <iterator>
#include <utility>

#include "io/scene/manual/formula_words.hpp"
#include "io/scene/manual/manual_parts.hpp"
#include "io/scene/manual/markdown_table.hpp"

namespace talus {

namespace {

constexpr std::string_view introduction = R"(# Scene files

What a scene file can say. This page is written by `talus manual` out of the lists that also read the file, so it cannot be out of date.

* A scene is a YAML file. Keys may come in any order; a key that is not listed here is an error, and so is one that comes twice.
* Units are SI; angles are in degrees. Stress is positive in tension, pressure in compression.
* Numbers are decimal and finite, without leading zeros and without units: `1.0e6`, `-9.81`. Switches are `true` or `false`.
* A vector has one number per dimension.
* A range holds for every number of a list: `> 0` positive, `[0, 1)` from 0, included, to 1, excluded.
* A table is a list of `[time, value]` with growing times: linear in between, constant outside.
* Paths of files are relative to the scene.
* Anchors, aliases, merge keys and tags of YAML are not read.
* `where` is another word for the key `on`, which programs that read YAML 1.1 (PyYAML) take for the switch `true`.
* `--set key=value` on the command line replaces or adds a value: `--set time.end=2 --set 'bodies[0].particles_per_cell=6'`.
)";

constexpr std::string_view about_formulas =
    R"md(Where a key takes a formula (`velocity` of a body, `acceleration` of a load of type `body_force`), it is written in quotes: `"0.1 * sin(pi * x / 50)"`.

* It may name the place `x`, `y`, `z` [m], the time `t` [s], which is 0 in what begins with the scene, and the constants `pi` and `_e`; a template of `talus new` its own answers instead.
* Operators, the weakest first: `condition ? a : b`, `||`, `&&`, comparisons `==` `!=` `<` `>` `<=` `>=` (1 where they hold, else 0), `+` `-`, `*` `/`, `^`. Powers are taken from the right, and before a sign: `-2^2` is -4.
* Decimals have a point. Nothing can be assigned. A value that is not finite is an error that names the place.
)md";

std::string to_markdown(const ManualOutputs& outputs)
{
  std::vector<std::array<std::string, 4>> rows;
  for (const ManualOutput& output : outputs.rows) {
    std::vector<std::string> names;
    std::transform(output.names.begin(), output.names.end(), std::back_inserter(names), code);
    rows.push_back({fmt::format("{}", fmt::join(names, " ")), output.unit, std::to_string(output.components), output.meaning});
  }
  return fmt::format("\n{}\n\n{}", outputs.heading, to_table({"name", "unit", "numbers", "meaning"}, rows));
}

std::string to_markdown(const ManualPart& part)
{
  std::string text = fmt::format("\n{} {}\n\n", part.chosen.empty() ? "##" : "###", part.title) + part.text;
  if (!part.rows.empty() || part.text.empty() || !part.chosen.empty())
    text += to_table({"key", "type", "unit", "range", "default", "meaning"}, part.rows);
  for (const ManualOutputs& outputs : part.outputs)
    text += to_markdown(outputs);
  return text;
}

}  // namespace

std::string formula_manual()
{
  std::vector<std::array<std::string, 2>> rows;
  for (const FormulaFunction& function : formula_functions)
    rows.push_back({code(function.call), std::string(function.meaning)});
  return std::string(about_formulas) + "\n" + to_table({"function", "value"}, rows);
}

std::string scene_manual()
{
  std::string text(introduction), after_first = "\nKernels:\n\n";
  for (const auto& kernel : kernel_summaries())
    after_first += fmt::format("* `{}`: {}\n", kernel[0], kernel[1]);
  for (const ManualPart& part : manual_parts())
    text += to_markdown(part) + std::exchange(after_first, "");
  return text + "\n## formulas\n\n" + formula_manual();
}

}  // namespace talus
