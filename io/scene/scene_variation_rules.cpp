// Rules of the list `variation` of materials.
#include <fmt/format.h>

#include "io/scene/scene_rule_base.hpp"
#include "materials/interface/varied_law.hpp"

namespace talus {

namespace {

class VariationRules : private SceneRuleBase {
 public:
  using SceneRuleBase::SceneRuleBase;

  std::vector<Finding> broken()
  {
    for (std::size_t m = 0; m < scene_.materials.size(); ++m)
      if (!scene_.materials[m].variation.empty())
        material(fmt::format("materials[{}].variation", m), scene_.materials[m]);
    return std::move(findings_);
  }

 private:
  void material(const std::string& path, const MaterialSpec& material)
  {
    const std::vector<LawNumber> numbers = numbers_that_vary(material.law);
    std::vector<std::string> known;
    for (const LawNumber& number : numbers)
      known.emplace_back(number.key);
    const auto& list = material.variation;
    for (std::size_t i = 0; i < list.size(); ++i) {
      const ParameterVariation& one = list[i];
      const std::string at = fmt::format("{}[{}]", path, i);
      const auto earlier = [&](const std::string& parameter) {
        return std::find_if(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(i), [&](const ParameterVariation& other) {
                 return other.parameter == parameter;
               }) != list.begin() + static_cast<std::ptrdiff_t>(i);
      };
      if (known.empty() && !one.parameter.empty())
        add(at + ".parameter", fmt::format("law \"{}\" has no parameter that can vary in space", material.law.name()));
      else if (!one.parameter.empty() && std::ranges::find(known, one.parameter) == known.end())
        add(at + ".parameter",
            fmt::format("\"{}\" of law \"{}\" cannot vary in space; of the numbers that are given and not 0, these can: {}", one.parameter,
                        material.law.name(), fmt::join(known, ", ")));
      if (!one.parameter.empty() && earlier(one.parameter))
        add(at + ".parameter", fmt::format("\"{}\" varies already", one.parameter));
      if (!one.correlated_with.empty() && !earlier(one.correlated_with))
        add(at + ".correlated_with", fmt::format("no entry before this one is about \"{}\"", one.correlated_with));
      if (one.correlation_length.size() > 1)
        fits(at + ".correlation_length", one.correlation_length);
    }
  }
};

}  // namespace

std::vector<Finding> broken_variation_rules(const Scene& scene) { return VariationRules(scene).broken(); }

}  // namespace talus
