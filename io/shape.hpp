#pragma once
// Simple solids: inline geometry for the mesher, and regions of space that bodies fill.
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/error.hpp"
#include "core/fields.hpp"

namespace talus {

/// Complains unless low < high along every axis.
void check_corners(const std::vector<Real>& low, const std::vector<Real>& high, std::vector<std::string>& problems);

/// Axis-parallel box.
struct Box {
  static constexpr std::string_view name = "box";
  std::vector<Real> low, high;
  static constexpr auto fields()
  {
    return std::tuple{required("low", &Box::low, any, "m", "corner with the smallest coordinates, one number per dimension"),
                      required("high", &Box::high, any, "m", "corner with the largest coordinates")};
  }
  void check(std::vector<std::string>& problems) const;
};

/// Disk in 2-D, ball in 3-D.
struct Sphere {
  static constexpr std::string_view name = "sphere";
  std::vector<Real> centre;
  Real radius{};
  static constexpr auto fields()
  {
    return std::tuple{required("centre", &Sphere::centre, any, "m", "centre, one number per dimension"),
                      required("radius", &Sphere::radius, positive, "m", "radius")};
  }
};

/// Straight circular cylinder (3-D).
struct Cylinder {
  static constexpr std::string_view name = "cylinder";
  std::vector<Real> from, to;
  Real radius{};
  static constexpr auto fields()
  {
    return std::tuple{required("from", &Cylinder::from, any, "m", "centre of one end face"),
                      required("to", &Cylinder::to, any, "m", "centre of the other end face"),
                      required("radius", &Cylinder::radius, positive, "m", "radius")};
  }
  void check(std::vector<std::string>& problems) const;
};

/// Simple polygon in the x-y plane; in 3-D it is extruded along z.
struct Polygon {
  static constexpr std::string_view name = "polygon";
  std::vector<std::vector<Real>> points;
  std::vector<Real> extrude;
  static constexpr auto fields()
  {
    return std::tuple{required("points", &Polygon::points, any, "m", "corners [x, y] in order, not closed"),
                      optional("extrude", &Polygon::extrude, any, "m", "3-D only: [z from, z to]")};
  }
  void check(std::vector<std::string>& problems) const;
};

using Shape = std::variant<Box, Sphere, Cylinder, Polygon>;

/// True if x (one number per dimension of the scene) lies in the shape or on its surface.  The shape must fit the dimension.
bool contains(const Shape& shape, std::span<const Real> x) noexcept;

}  // namespace talus
