#pragma once
// The block `mesh.terrain` of a scene: columns of cells over a plan, between surfaces.
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/fields.hpp"
#include "io/scene/scene_surface.hpp"

namespace talus {

/// The plan of a scene in two dimensions: a straight line on the map.
struct TerrainSectionSpec {
  std::vector<Real> from, to;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{required("from", &TerrainSectionSpec::from, any, "m", "[east, north] of x = 0"),
                      required("to", &TerrainSectionSpec::to, any, "m", "[east, north] of the other end; x grows towards it")};
  }
  void check(std::vector<std::string>& problems) const;
};

/// The material between a surface and the one above it.
struct LayerSpec {
  std::string name;
  SurfaceSpec bottom;
  std::vector<std::vector<Real>> within;
  std::string within_file;
  std::optional<Real> size;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{
        required("name", &LayerSpec::name, any, "-", "its cells are the group layer:NAME, the facets below them layer:NAME:bottom"),
        group("bottom", &LayerSpec::bottom,
              "its lower surface; where this is not below the surface above, or not known, the layer has no thickness"),
        optional("within", &LayerSpec::within, any, "m",
                 "corners [east, north] of an area (two: a rectangle; 2-D without section: [x from], [x to]), with vertical sides; outside "
                 "of it the "
                 "cells belong to the next layer, those of the last to none"),
        optional("within_file", &LayerSpec::within_file, any, "-",
                 "the same as polygons of a file (GeoJSON, shapefile), relative to the scene"),
        optional("size", &LayerSpec::size, positive, "m", "height of its cells; default the size of the mesh")};
  }
  void check(std::vector<std::string>& problems) const;
};

/// Space above the ground for moving material.
struct AirSpec {
  Real height{};
  std::optional<Real> reach, size;
  std::string of;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{required("height", &AirSpec::height, positive, "m", "above the ground"),
                      optional("reach", &AirSpec::reach, between(0, 90), "deg",
                               "air only where a line that falls at this angle from a point of the layer `of` passes above the ground; the "
                               "angle of the line from "
                               "the crest to the toe of the run-out, Fahrboeschung, with some to spare; default everywhere"),
                      optional("of", &AirSpec::of, any, "-", "layer that `reach` is counted from; default the first one"),
                      optional("size", &AirSpec::size, positive, "m", "height of its cells; default the size of the mesh")};
  }
  void check(std::vector<std::string>& problems) const;
};

/// Smaller cells along a line on the map.
struct FinerSpec {
  std::vector<std::vector<Real>> along;
  std::string down_from;
  Real width{}, size{};
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{
        optional("along", &FinerSpec::along, any, "m", "a line through [east, north] (2-D without section: [x])"),
        optional("down_from", &FinerSpec::down_from, any, "-", "or the name of a layer: the line of steepest descent from its centre"),
        required("width", &FinerSpec::width, positive, "m", "of the strip along the line"),
        required("size", &FinerSpec::size, positive, "m", "edge length there, growing by a third from cell to cell outside")};
  }
  void check(std::vector<std::string>& problems) const;
};

/// A rigid obstacle on the ground, whose cells are left out.
struct ObstacleSpec {
  std::string name;
  std::vector<std::vector<Real>> outline;
  std::string outline_file;
  Real height{};
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{required("name", &ObstacleSpec::name, any, "-", "its facets are the group obstacle:NAME"),
                      optional("outline", &ObstacleSpec::outline, any, "m",
                               "corners [east, north] (two: a rectangle; 2-D without section: [x from], [x to])"),
                      optional("outline_file", &ObstacleSpec::outline_file, any, "-",
                               "the same as polygons of a file (GeoJSON, shapefile), relative to the scene"),
                      required("height", &ObstacleSpec::height, positive, "m", "above the ground")};
  }
  void check(std::vector<std::string>& problems) const;
};

struct TerrainSpec {
  SurfaceSpec ground;
  std::vector<std::vector<Real>> domain;
  std::string domain_file;
  std::vector<Real> origin;
  std::string crs;
  std::optional<TerrainSectionSpec> section;
  std::vector<LayerSpec> layers;
  std::optional<AirSpec> air;
  std::vector<FinerSpec> refine;
  std::vector<ObstacleSpec> obstacles;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{
        group("ground", &TerrainSpec::ground, "the surface of the ground"),
        optional("domain", &TerrainSpec::domain, any, "m",
                 "corners [east, north] of what is meshed (two: a rectangle; 2-D without section: [x from], [x to]); default all that the "
                 "ground "
                 "covers"),
        optional("domain_file", &TerrainSpec::domain_file, any, "-",
                 "the same as polygons of a file (GeoJSON, shapefile), relative to the scene"),
        optional("origin", &TerrainSpec::origin, any, "m",
                 "[east, north] on the map of x = y = 0; default the low corner of the domain, rounded down to 100 m. Heights are kept"),
        optional("crs", &TerrainSpec::crs, any, "-", "coordinate system of the map, such as EPSG:32633, where the files do not say"),
        group("section", &TerrainSpec::section, "2-D: the line on the map along which x is counted"),
        optional_list("layers", &TerrainSpec::layers,
                      "what lies below the ground, from the top down; default nothing: the ground is rigid"),
        group("air", &TerrainSpec::air, "what is meshed above the ground, the cell group air"),
        optional_list("refine", &TerrainSpec::refine, "strips with smaller cells"),
        optional_list("obstacles", &TerrainSpec::obstacles, "rigid things on the ground")};
  }
  void check(std::vector<std::string>& problems) const;
};

}  // namespace talus
