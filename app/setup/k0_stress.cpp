#include "app/setup/k0_stress.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "materials/interface/law_variant.hpp"

namespace talus {

namespace {

/// Sine of the angle of friction in triaxial compression; nothing for a law that has none.
template <class Law>
std::optional<Real> sine_of_friction(const Law& law)
{
  if constexpr (requires { law.friction_angle; })
    return std::sin(law.friction_angle * (std::numbers::pi / 180));
  else if constexpr (requires { law.critical_state_slope; })
    return 3 * law.critical_state_slope / (6 + law.critical_state_slope);
  else
    return std::nullopt;
}

std::vector<std::string> laws_with_friction()
{
  std::vector<std::string> names;
  for_each_type(Laws{}, [&]<class L>() {
    if (sine_of_friction(L{}))
      names.emplace_back(L::name);
  });
  return names;
}

Table constant(Real value) { return {{{0, value}}}; }

/// (1 - sin phi) ocr^(sin phi), at most passive [Jaky 1944; Mayne & Kulhawy 1982].
Real from_friction(Real sine, Real ocr) { return std::min((1 - sine) * std::pow(ocr, sine), (1 + sine) / (1 - sine)); }

Mat3 matrix_of(const UniformStressSpec& s)
{
  Mat3 stress;
  stress << s.xx, s.xy, s.xz, s.xy, s.yy, s.yz, s.xz, s.yz, s.zz;
  return stress;
}

}  // namespace

std::vector<StartStress> start_stress_of_bodies(const K0Spec& spec, const Scene& scene, SceneErrorCollector& errors)
{
  std::vector<StartStress> all;
  for (const BodySpec& body : scene.bodies) {
    const K0Rule& rule = spec.of(body.name);
    Table& table = all.emplace_back(StartStress{.k0 = constant(rule.k0.value_or(1))}).k0;
    if (rule.stress)
      all.back().given = matrix_of(*rule.stress);
    if (!rule.k0_table.empty())
      table.points.clear();
    for (const std::vector<Real>& point : rule.k0_table)
      table.points.push_back({point.at(0), point.at(1)});
    const auto material =
        std::find_if(scene.materials.begin(), scene.materials.end(), [&](const MaterialSpec& m) { return m.name == body.material; });
    if (!rule.from_friction || material == scene.materials.end())
      continue;
    const auto sine = std::visit([](const auto& law) { return sine_of_friction(law); }, choices_of(material->law));
    if (sine)
      table = constant(from_friction(*sine, rule.ocr));
    else
      errors.add(spec.where, "from_friction",
                 fmt::format("the law of body \"{}\" has no angle of friction; of the laws {} have one", body.name,
                             or_list(laws_with_friction())));
  }
  return all;
}

}  // namespace talus
