#pragma once
// The block `contacts` of a scene.
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/fields.hpp"

namespace talus {

/// What acts between two bodies where they touch.
struct ContactSpec {
  std::vector<std::string> between;
  Real friction = 0, cohesion = 0;
  bool tied = false;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{
        required("between", &ContactSpec::between, any, "-", "the names of two bodies"),
        optional("friction", &ContactSpec::friction, non_negative, "-", "Coulomb's coefficient: shear over pressure at which they slide"),
        optional("cohesion", &ContactSpec::cohesion, non_negative, "Pa",
                 "shear stress that the contact carries beside friction while the bodies touch; nothing holds them against a pull"),
        optional("tied", &ContactSpec::tied, any, "-",
                 "they stick to each other as parts of one body do, also under a pull, as bodies without a contact do")};
  }
  void check(std::vector<std::string>& problems) const
  {
    if (between.size() != 2)
      problems.emplace_back("between takes the names of two bodies");
    else if (between[0] == between[1])
      problems.emplace_back("a body has no contact with itself: between takes two different bodies");
    if (tied && (friction > 0 || cohesion > 0))
      problems.emplace_back("tied bodies do not slide: leave out friction and cohesion, or tied");
  }
};

}  // namespace talus
