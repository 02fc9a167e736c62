// talus drive
#include <fmt/format.h>

#include "app/commands/drive_command.hpp"
#include "core/display_text.hpp"
#include "core/word_match.hpp"
#include "io/files/atomic_file.hpp"
#include "io/pictures/settings/launch_render.hpp"
#include "io/scene/reader.hpp"
#include "materials/laboratory/laboratory.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 6> pairs{"xx", "yy", "zz", "xy", "yz", "xz"};

struct MeasuredColumn {
  std::string_view name;
  const std::vector<Real>& values;
};

/// The table, and columns of one number per row behind the time.
std::string csv_of(const PointTable& table, const std::vector<MeasuredColumn>& columns = {})
{
  std::string text = "time [s]";
  for (const MeasuredColumn& column : columns)
    text += fmt::format(",{}", column.name);
  for (const char i : {'x', 'y', 'z'})
    for (const char j : {'x', 'y', 'z'})
      text += fmt::format(",F_{}{} [-]", i, j);
  for (const auto pair : pairs)
    text += fmt::format(",stress_{} [Pa]", pair);
  text += ",p [Pa],q [Pa]";
  for (const std::string& name : table.history_names)
    text += "," + name;
  text += '\n';
  for (std::size_t n = 0; n < table.rows.size(); ++n) {
    const PointRow& row = table.rows[n];
    text += fmt::format("{}", row.time);
    for (const MeasuredColumn& column : columns)
      text += fmt::format(",{}", column.values[n]);
    for (Index i = 0; i < 9; ++i)
      text += fmt::format(",{}", row.F(i / 3, i % 3));
    for (const Real component : pack(row.stress))
      text += fmt::format(",{}", component);
    text += fmt::format(",{},{}", row.p, row.q);
    for (const Real value : row.history)
      text += fmt::format(",{}", value);
    text += '\n';
  }
  return text;
}

/// One particle of a law as a scene or a test file gives it.
Material one_particle(const AnyLaw& law, const std::string& name, const SourceLocation& where) { return {law.model(), 0, 1, name, where}; }

void drive_along_paths(const DriveOptions& options)
{
  const PointTest test = read_point_path(options.file, options.set);
  const Sym3 start = Eigen::Map<const Sym3>(test.initial_stress.data());
  const std::string text = csv_of(drive(one_particle(test.material.law, "point", test.material.where), test.path, unpack(start)));
  if (options.out)
    write_whole(*options.out, text);
  else
    fmt::print("{}", text);
}

Laboratory test_named(const std::string& name)
{
  const auto known = enum_names(Laboratory{});
  const auto found = std::find(known.begin(), known.end(), name);
  if (found == known.end())
    throw Error(fmt::format("unknown test \"{}\"{}", name, suggestion(name, std::vector<std::string>(known.begin(), known.end()))));
  return static_cast<Laboratory>(found - known.begin());
}

const MaterialSpec& material_named(const Scene& scene, const std::optional<std::string>& name)
{
  std::vector<std::string> known;
  for (const MaterialSpec& material : scene.materials) {
    known.push_back(material.name);
    if (name ? material.name == *name : scene.materials.size() == 1)
      return material;
  }
  SourceLocation where = scene.materials.front().where;
  where.path = "materials";
  if (!name)
    throw SceneErrors(where, fmt::format("--material is needed where there are several: {}", or_list(known)));
  throw SceneErrors(where, fmt::format("--material: there is no material \"{}\"{}", *name, suggestion(*name, known)));
}

TestPlan plan_of(const DriveOptions& options)
{
  TestPlan plan = usual_plan(test_named(*options.test));
  plan.pressure = options.pressure.value_or(plan.pressure);
  plan.strain = options.strain.value_or(plan.strain);
  plan.rate = options.rate.value_or(plan.rate);
  plan.steps = options.steps.value_or(plan.steps);
  return plan;
}

/// What a test measures, in the words of a column.
std::array<std::string_view, 2> columns_of(Laboratory test)
{
  switch (test) {
    case Laboratory::simple_shear: return {"shear_strain [-]", "shear_stress [Pa]"};
    case Laboratory::oedometer: return {"axial_strain [-]", "vertical_stress [Pa]"};
    default: return {"axial_strain [-]", "stress_difference [Pa]"};
  }
}

void print_result(const TestPlan& plan, const TestResult& result, const std::vector<ClosedForm>& forms)
{
  const bool oedometer = plan.test == Laboratory::oedometer;
  const Real peak = result.stress[result.peak], end = result.stress.back();
  const ScaledUnit unit = scaled_unit("Pa", peak);
  std::string_view what = columns_of(plan.test)[1];
  what.remove_suffix(std::string_view(" [Pa]").size());
  fmt::print("  {:<40} {:>24}\n", "", fmt::format("{} [{}]", what, unit.name));
  fmt::print("  {:<40} {:>24.6g}\n", fmt::format("driven: largest, at strain {:.4g}", result.strain[result.peak]), peak * unit.factor);
  fmt::print("  {:<40} {:>24.6g}\n", fmt::format("driven: at the end, strain {:.4g}", result.strain.back()), end * unit.factor);
  if (oedometer)
    fmt::print("  {:<40} {:>24}\n  {:<40} {:>24.6g}\n", "", "s_xx / s_zz", "driven: at the end", result.lateral_over_vertical);
  const Real driven = oedometer ? result.lateral_over_vertical : peak;
  for (const ClosedForm& form : forms) {
    fmt::print("  {:<40} {:>24.6g}", "closed form: " + form.name, form.value * (oedometer ? 1 : unit.factor));
    if (form.value > 0)
      fmt::print("   driven {:+.2f} %", 100 * (driven / form.value - 1));
    fmt::print("\n");
  }
  if (forms.empty())
    fmt::print("  of this law nothing is known in closed form for this test\n");
}

/// The measured curve over the closed forms, drawn from the table.
void plot_test(const std::string& title, const fs::path& table, const fs::path& picture, const std::array<std::string_view, 2>& columns,
               const std::vector<ClosedForm>& forms)
{
  std::vector<std::string> arguments{"chart", table.string(),          "--title", title,           "--x", std::string(columns[0]),
                                     "--y",   std::string(columns[1]), "--out",   picture.string()};
  for (const ClosedForm& form : forms)
    arguments.insert(arguments.end(), {"--level", form.name, fmt::format("{}", form.value)});
  launch_render(arguments);
}

void drive_through_test(const DriveOptions& options)
{
  const TestPlan plan = plan_of(options);
  const Scene scene = read_scene(options.file, options.set);
  const MaterialSpec& material = material_named(scene, options.material);
  const TestResult result = perform(one_particle(material.law, material.name, material.where), plan);
  fmt::print("{} of \"{}\" ({}): pressure {:.6g} Pa, strain {:.6g} at {:.6g} 1/s in {} steps\n", *options.test, material.name,
             material.law.name(), plan.pressure, plan.strain, plan.rate, plan.steps);
  const std::vector<ClosedForm> forms = closed_forms(material.law, plan, result);
  print_result(plan, result, forms);
  const auto [strain, stress] = columns_of(plan.test);
  if (!options.out && !options.plot)
    return;
  const fs::path table = options.out.value_or(fs::path(options.plot.value_or("")).replace_extension(".csv"));
  write_whole(table, csv_of(result.table, {{strain, result.strain}, {stress, result.stress}}));
  if (options.plot)
    plot_test(fmt::format("{} of {} ({})", *options.test, material.name, material.law.name()), table, *options.plot, {strain, stress},
              plan.test == Laboratory::oedometer ? std::vector<ClosedForm>{} : forms);
}

}  // namespace

void drive_law(const DriveOptions& options)
{
  if (options.test)
    drive_through_test(options);
  else
    drive_along_paths(options);
}

}  // namespace talus
