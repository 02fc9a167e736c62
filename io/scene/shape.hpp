#pragma once
// Simple solids: inline geometry for the mesher, and regions that bodies fill.
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "core/error.hpp"
#include "core/fields.hpp"

namespace talus {

/// Adds an error unless low < high along every axis.
void check_corners(const std::vector<Real>& low, const std::vector<Real>& high, std::vector<std::string>& problems);

/// An axis-parallel box.
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

/// A disk in 2-D, a ball in 3-D.
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

/// A straight circular cylinder (3-D).
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

/// A simple polygon in the x-y plane, optionally with holes; in 3-D it is extruded along z.
struct Polygon {
  static constexpr std::string_view name = "polygon";
  std::vector<std::vector<Real>> points;
  std::vector<Real> extrude;
  std::vector<std::vector<std::vector<Real>>> holes = {};
  std::vector<std::string> sides = {};
  static constexpr auto fields()
  {
    return std::tuple{
        required("points", &Polygon::points, any, "m", "corners [x, y] in order, not closed"),
        optional("extrude", &Polygon::extrude, any, "m", "3-D only: [z from, z to]"),
        optional("holes", &Polygon::holes, any, "m", "polygons inside that are left out, each a list of corners [x, y]"),
        optional(
            "sides", &Polygon::sides, any, "-",
            "names of the sides, the first from the first corner to the second; sides of one name are one. Facets of a region on a side "
            "are the group REGION:NAME, those at hole number i REGION:hole_i; loads act on BODY:NAME and BODY:hole_i")};
  }
  void check(std::vector<std::string>& problems) const;
};

/// The points between two concentric circles in 2-D, or two spheres in 3-D.
struct Ring {
  static constexpr std::string_view name = "ring";
  std::vector<Real> centre;
  Real inner_radius{}, radius{};
  static constexpr auto fields()
  {
    return std::tuple{required("centre", &Ring::centre, any, "m", "centre, one number per dimension"),
                      required("inner_radius", &Ring::inner_radius, positive, "m",
                               "radius of the hole: in a region the facets there are the group REGION:inner"),
                      required("radius", &Ring::radius, positive, "m", "outer radius")};
  }
  void check(std::vector<std::string>& problems) const;
};

/// A shape that is not combined from others.
using SimpleShape = std::variant<Box, Sphere, Cylinder, Polygon, Ring>;

/// The points in one shape and in none of the others.
struct Difference {
  static constexpr std::string_view name = "difference";
  SimpleShape of;
  std::vector<SimpleShape> without;
  static constexpr auto fields()
  {
    return std::tuple{
        required("of", &Difference::of, any, "-", "a shape that is not put together from others"),
        required_list("without", &Difference::without, "what is left out of it: shapes that are not put together from others")};
  }
};

/// The points in at least one of several shapes.
struct Union {
  static constexpr std::string_view name = "union";
  std::vector<SimpleShape> of;
  static constexpr auto fields()
  {
    return std::tuple{required_list("of", &Union::of, "shapes that are not put together from others; they may overlap")};
  }
};

/// The points in all of several shapes.
struct Intersection {
  static constexpr std::string_view name = "intersection";
  std::vector<SimpleShape> of;
  static constexpr auto fields()
  {
    return std::tuple{required_list("of", &Intersection::of, "shapes that are not put together from others")};
  }
};

using Shape = std::variant<Box, Sphere, Cylinder, Polygon, Ring, Difference, Union, Intersection>;

/// Calls f(SimpleShape) for the shape, or for each shape of a combination.
template <class F>
void for_each_part(const Shape& shape, F&& f)
{
  std::visit(
      [&]<class S>(const S& s) {
        if constexpr (std::is_same_v<S, Difference>) {
          f(s.of);
          for (const SimpleShape& part : s.without)
            f(part);
        } else if constexpr (std::is_same_v<S, Union> || std::is_same_v<S, Intersection>) {
          for (const SimpleShape& part : s.of)
            f(part);
        } else {
          f(SimpleShape(s));
        }
      },
      shape);
}

/// Whether x (one number per dimension of the scene) lies in the shape or on its surface.  The shape must fit the dimension.
bool contains(const Shape& shape, std::span<const Real> x) noexcept;

}  // namespace talus
