#pragma once
// The file of `talus drive`: one law and its path of loading.
#include <array>
#include <vector>

#include "io/scene/scene.hpp"
#include "materials/laboratory/point_path.hpp"

namespace talus {

/// A law and its parameters, without a name.
struct LawSpec {
  AnyLaw law;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{alternative("law", &LawSpec::law, "constitutive law; its parameters are keys of the same mapping")};
  }
};

struct PointTest {
  LawSpec material;
  std::array<Real, 6> initial_stress{};
  std::vector<PointPath> path;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{group("material", &PointTest::material, "the law"),
                      optional("initial_stress", &PointTest::initial_stress, any, "Pa", "xx, yy, zz, xy, yz, xz; default none"),
                      required_list("path", &PointTest::path, "parts of the test, one after the other")};
  }
};

}  // namespace talus
