#pragma once
// The block `mesh` of a scene.
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/fields.hpp"
#include "io/scene/scene_terrain.hpp"
#include "io/scene/shape.hpp"

namespace talus {

/// A named solid of inline geometry.  Regions that touch share their faces; an overlap belongs to the earlier region.
struct RegionSpec {
  std::string name;
  Shape shape;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{required("name", &RegionSpec::name, any, "-", "name of the cells: bodies refer to it"),
                      required("shape", &RegionSpec::shape, any, "-", "the solid")};
  }
};

/// Names the facets whose corners all lie in a box, or that face a direction, or both.
struct GroupSpec {
  std::string name, of = "boundary";
  std::optional<Box> within;
  SourceLocation where;
  std::vector<Real> facing = {};
  Real angle = 30;
  static constexpr auto fields()
  {
    return std::tuple{
        required("name", &GroupSpec::name, any, "-", "name of the facets: boundaries and loads refer to it"),
        optional(
            "of", &GroupSpec::of, any, "-",
            "facet group to choose from: the outline of a region is region:boundary, that of the mesh boundary, and all facets between "
            "two cells are inside"),
        group("within", &GroupSpec::within, "facets with all corners in this box (give it some slack)"),
        optional("facing", &GroupSpec::facing, any, "-",
                 "facets whose normal, out of the mesh or out of the region whose outline they are, points into this direction"),
        optional("angle", &GroupSpec::angle, between(0, 180), "deg", "by which the normal may differ from facing")};
  }
  void check(std::vector<std::string>& problems) const;
};

/// A box in which cells are smaller.
struct RefineSpec {
  Box within;
  Real size{};
  static constexpr auto fields()
  {
    return std::tuple{group("within", &RefineSpec::within, "where"),
                      required("size", &RefineSpec::size, positive, "m", "edge length inside the box")};
  }
};

/// Built-in box of equal simplices, optionally jittered: needs no mesher.
struct GridSpec {
  std::vector<Real> low, high;
  std::vector<Index> cells;
  Real jitter = 0;
  static constexpr auto fields()
  {
    return std::tuple{required("low", &GridSpec::low, any, "m", "corner with the smallest coordinates"),
                      required("high", &GridSpec::high, any, "m", "corner with the largest coordinates"),
                      required("cells", &GridSpec::cells, positive, "-",
                               "intervals along each axis; each square is cut in 2 triangles, each cube in 6 tetrahedra"),
                      optional("jitter", &GridSpec::jitter, from_to_below(0, 0.5), "-",
                               "interior nodes moved at random by up to this share of the spacing")};
  }
  void check(std::vector<std::string>& problems) const;
};

/// Exactly one of file, geometry, regions, grid, terrain.
struct MeshSpec {
  std::string file, geometry;
  std::optional<Real> size;
  std::vector<RegionSpec> regions;
  std::vector<RefineSpec> refine;
  std::vector<GroupSpec> groups;
  std::optional<GridSpec> grid;
  std::optional<TerrainSpec> terrain;
  Index smoothing = 0;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{
        optional("file", &MeshSpec::file, any, "-", "a gmsh .msh file (2.2 or 4.1, ascii or binary), relative to the scene"),
        optional("geometry", &MeshSpec::geometry, any, "-",
                 "a .geo or .step file to be meshed; a .geo is a program: run only those you trust"),
        optional("size", &MeshSpec::size, positive, "m", "edge length of the cells, for geometry, regions and terrain"),
        optional_list("regions", &MeshSpec::regions, "inline geometry: named solids"),
        optional_list("refine", &MeshSpec::refine, "boxes with smaller cells, for geometry and regions"),
        optional_list("groups", &MeshSpec::groups,
                      "names for parts of the boundary, of outlines or of the inside, added to those of the mesh; x_min, x_max, y_min, ... "
                      "and boundary always exist"),
        group("grid", &MeshSpec::grid, "built-in box"),
        group("terrain", &MeshSpec::terrain, "columns of cells between surfaces: ground, layers below it, air above it"),
        optional("smoothing", &MeshSpec::smoothing, within(0, 100), "-",
                 "so many times interior nodes move to the centre of their cells, for a more accurate kernel projected; nodes "
                 "of boundaries and groups stay")};
  }
  void check(std::vector<std::string>& problems) const;
};

}  // namespace talus
