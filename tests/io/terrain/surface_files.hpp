#pragma once
// Files of surfaces in a scratch folder, and a plane that they hold.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "io/files/atomic_file.hpp"
#include "io/terrain/point_file.hpp"
#include "io/terrain/raster_file.hpp"
#include "io/terrain/surface_file.hpp"
#include "tests/io/scratch_folder.hpp"

namespace talus::surface_file_test {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

inline constexpr Real nan = std::numeric_limits<Real>::quiet_NaN();
inline constexpr Real east = 512000, north = 5180000;

/// A plane over the map, 12 cells of 5 m by 10.
inline Real plane(Real x, Real y) { return 700 + 0.5 * (x - east) - 0.25 * (y - north); }
inline Raster sloping()
{
  Raster raster;
  raster.columns = 12;
  raster.rows = 10;
  raster.west = east;
  raster.south = north;
  raster.dx = raster.dy = 5;
  raster.crs = "EPSG:32633";
  for (Index r = 0; r < raster.rows; ++r)
    for (Index c = 0; c < raster.columns; ++c)
      raster.values.push_back(plane(east + 5 * (c + 0.5), north + 5 * (r + 0.5)));
  return raster;
}

class SurfaceFile : public testing::Test {
 protected:
  std::optional<SurfaceRead> read(const SurfaceSpec& spec) { return read_surface(spec, plan, problems, repairs); }
  std::optional<SurfaceRead> read(const std::string& file)
  {
    SurfaceSpec spec;
    spec.file = file;
    spec.where = {"slope.yaml", 7, 3, "mesh.terrain.ground"};
    return read(spec);
  }
  std::optional<SurfaceRead> read_points_of_scene(std::vector<std::vector<Real>> points)
  {
    SurfaceSpec spec;
    spec.points = std::move(points);
    return read(spec);
  }
  std::string only_problem() const
  {
    EXPECT_EQ(problems.size(), 1U);
    return problems.empty() ? "" : to_string(problems[0].where) + ": " + problems[0].message;
  }
  std::string only_repair() const
  {
    EXPECT_EQ(repairs.size(), 1U);
    return repairs.empty() ? "" : repairs[0];
  }
  void expect_plane(const SurfaceRead& surface, Real tolerance = 1e-9) const
  {
    for (Real x = east + 3; x < east + 57; x += 2.7)
      for (Real y = north + 3; y < north + 47; y += 3.1)
        EXPECT_NEAR(surface.at({x, y}), plane(x, y), tolerance) << x << ' ' << y;
  }

  ScratchFolder folder;
  MapPlan plan{folder.path(), "", false, {}};
  std::vector<SceneError> problems;
  std::vector<std::string> repairs;
};

}  // namespace talus::surface_file_test
