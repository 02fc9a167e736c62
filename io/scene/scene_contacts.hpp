#pragma once
// The blocks `contacts` and `cuts` of a scene.
#include <optional>
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

/// Facets inside the mesh at which the material comes apart: a fault, a joint, a sheet pile.
struct CutSpec {
  std::string on;
  Real friction = 0, cohesion = 0;
  bool tied = false;
  std::optional<Real> tied_until;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{
        required("on", &CutSpec::on, any, "-", "facet group inside the mesh, whose nodes are doubled"),
        optional("friction", &CutSpec::friction, non_negative, "-", "Coulomb's coefficient: shear over pressure at which the sides slide"),
        optional("cohesion", &CutSpec::cohesion, non_negative, "Pa",
                 "shear stress carried beside friction while the sides press on each other; nothing holds them against a pull"),
        optional("tied", &CutSpec::tied, any, "-", "the sides move as one, also under a pull, during the whole run"),
        optional("tied_until", &CutSpec::tied_until, positive, "s", "the sides move as one in steps that begin before this time")};
  }
  void check(std::vector<std::string>& problems) const
  {
    if (tied && (friction > 0 || cohesion > 0))
      problems.emplace_back("a cut that is always tied does not slide: leave out friction and cohesion, or tied");
    if (tied && tied_until)
      problems.emplace_back("only one of tied (always) and tied_until may be given");
  }
};

}  // namespace talus
