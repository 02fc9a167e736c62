// Grounds and outlines from files, and records of motion: what a scene names besides its mesh.
#include "core/error.hpp"
#include "io/scene/record_file.hpp"
#include "io/terrain/surface_file.hpp"
#include "tests/fuzz/entries.hpp"
#include "tests/fuzz/memory_file.hpp"

namespace talus {

namespace {

/// Read as the ground of a scene beside it, and asked whether it covers a square.
void take_surface(std::string_view bytes, const std::string& extension)
{
  const MemoryFile file(bytes, extension);
  SurfaceSpec spec;
  spec.file = file.path().filename().string();
  spec.where = {"scene.yaml", 1, 1, "mesh.terrain.ground"};
  MapPlan plan;
  plan.directory = file.path().parent_path();
  std::vector<SceneError> problems;
  std::vector<std::string> repairs;
  if (const auto surface = read_surface(spec, plan, problems, repairs))
    check_cover(*surface, spec.where, {{0, 0}, {10, 0}, {10, 10}, {0, 10}}, "domain", problems);
}

}  // namespace

void fuzz_raster(std::string_view bytes) { take_surface(bytes, ".tif"); }
void fuzz_points(std::string_view bytes) { take_surface(bytes, ".csv"); }
void fuzz_stl(std::string_view bytes) { take_surface(bytes, ".stl"); }

void fuzz_outlines(std::string_view bytes)
{
  const MemoryFile file(bytes, ".geojson");
  MapPlan plan;
  plan.directory = file.path().parent_path();
  plan.crs = "EPSG:32633";
  std::vector<SceneError> problems;
  std::vector<std::string> repairs;
  read_outlines(file.path().filename().string(), {"scene.yaml", 1, 1, "mesh.terrain.domain_file"}, plan, problems, repairs);
}

void fuzz_record(std::string_view bytes)
{
  const MemoryFile file(bytes);
  RecordOptions spec;
  spec.unit = RecordUnit::g;
  for (const Baseline baseline : {Baseline::as_recorded, Baseline::velocity, Baseline::displacement})
    try {
      spec.baseline = baseline;
      describe(spec, read_record(file.path(), spec));
    } catch (const SceneErrors&) {
    }
}

}  // namespace talus
