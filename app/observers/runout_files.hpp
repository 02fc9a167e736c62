#pragma once
// Files of run-out: the columns of runout.csv with the plan for positions, maps as rasters, and sections through them.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/observers/plan_axes.hpp"
#include "core/fields.hpp"
#include "io/files/result_files.hpp"
#include "io/output/csv.hpp"
#include "mesh/geometry/map_frame.hpp"
#include "mesh/geometry/raster.hpp"

namespace talus {

/// The cells of the maps of a run; one row in 2-D.
struct RunoutPlan {
  int dimension = 3;
  PlanAxes axes;
  PlanGrid grid;
  std::optional<MapFrame> map;  ///< position of the mesh on a map

  std::array<Real, 2> on_plan(const Vec3& x) const { return {x[axes.plan[0]], dimension == 3 ? x[axes.plan[1]] : 0}; }
  Real elevation(const Vec3& x) const { return axes.sign * x[axes.vertical]; }
  /// A position of the plan as written to files: in map coordinates, if there is a map.
  std::array<Real, 2> on_map(const std::array<Real, 2>& place) const
  {
    return map ? map->to_map(place[0], dimension == 3 ? place[1] : 0) : place;
  }
  /// The names of these coordinates: east and north, or those of the axes.
  std::vector<std::string> axis_names() const;
};

/// Sums over all moved mass at a sample.  NaN if nothing has moved.
struct RunoutNumbers {
  Real volume = 0;      ///< volume [m^D]
  Real area = 0;        ///< area where it is thicker than the threshold [m^(D-1)]
  Real mean = 0;        ///< mean thickness there [m]
  Real thickest = 0;    ///< largest thickness [m]
  Real fastest = 0;     ///< largest speed of a particle [m/s]
  Real mean_speed = 0;  ///< mean speed of the mass [m/s]
  Real bulk = 0;        ///< speed that `mass_share` of the mass does not exceed [m/s]
  Real kinetic = 0;     ///< kinetic energy [J]
  Vec3 front = Vec3::Zero();
  Real height = 0, length = 0;                ///< from the crown to the front [m]
  Vec3 centre = Vec3::Zero();                 ///< centre of mass
  Real centre_height = 0, centre_length = 0;  ///< displacement of the centre of mass since the start, vertical and horizontal [m]
  Real entrained = 0;                         ///< volume of eroded bodies in it [m^D]
  static constexpr auto fields()
  {
    using N = RunoutNumbers;
    return std::tuple{saved("volume", &N::volume),
                      saved("area", &N::area),
                      saved("mean", &N::mean),
                      saved("thickest", &N::thickest),
                      saved("fastest", &N::fastest),
                      saved("mean_speed", &N::mean_speed),
                      saved("bulk", &N::bulk),
                      saved("kinetic", &N::kinetic),
                      saved("front", &N::front),
                      saved("height", &N::height),
                      saved("length", &N::length),
                      saved("centre", &N::centre),
                      saved("centre_height", &N::centre_height),
                      saved("centre_length", &N::centre_length),
                      saved("entrained", &N::entrained)};
  }
};

/// The columns; with `entrained` if bodies are eroded.
std::vector<CsvColumn> runout_columns(const RunoutPlan& plan, bool erodes);
/// The values of a row, one per column.
std::vector<Real> runout_row(Real time, const RunoutNumbers& now, const RunoutPlan& plan, bool erodes);

/// A sum over a positive whole; NaN if the whole is not positive.
inline Real over(Real sum, Real whole) { return std::isgreater(whole, 0) ? sum / whole : std::numeric_limits<Real>::quiet_NaN(); }

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
