#pragma once
// Files of run-out: maps as rasters, and sections through them.
#include <filesystem>

#include "app/observers/runout_columns.hpp"
#include "io/files/runout_maps.hpp"
#include "mesh/geometry/raster.hpp"

namespace talus {

/// A map with one value per cell of the plan; NaN means no value.
struct NamedMap {
  MapKind kind;
  std::vector<Real> values;
};

Raster raster_of(const RunoutPlan& plan, const std::vector<Real>& values, std::string_view unit);
void write_map(const std::filesystem::path& file, const Raster& raster);

/// Points in the plan, and the distance of each along the section [m].
struct SectionPoints {
  std::vector<std::array<Real, 2>> places;
  std::vector<Real> distances;
};
/// Points along a line, at most `step` [m] apart, including its corners.
SectionPoints points_along(const std::vector<std::array<Real, 2>>& corners, Real step);
/// The centres of the cells of a plan with one row.
SectionPoints points_of_row(const PlanGrid& grid);
/// A table of all maps at these points.
std::string section_text(const RunoutPlan& plan, const std::vector<NamedMap>& maps, const SectionPoints& points);

}  // namespace talus
