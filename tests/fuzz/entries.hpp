#pragma once
// What takes bytes from outside, one function each: libFuzzer calls them (harness.cpp), and so does the test that replays what it has found
// (corpus_test.cpp).  They return where the bytes are good or are refused with a reason; any other exception gets out, a defect.
#include <array>
#include <string>
#include <string_view>

namespace talus {

/// A scene: read, and where it is small its mesh and its formulas.
void fuzz_scene(std::string_view bytes);
/// A mesh file, in 2-D and in 3-D.
void fuzz_msh(std::string_view bytes);
/// A checkpoint: the bytes of the file, or else lines that say how to change a good one (checkpoint_entry.cpp).
void fuzz_checkpoint(std::string_view bytes);
/// A raster as a ground, of whatever format GDAL takes it for.
void fuzz_raster(std::string_view bytes);
/// Points x, y, z as a ground.
void fuzz_points(std::string_view bytes);
/// Triangles as a ground.
void fuzz_stl(std::string_view bytes);
/// Outlines on the map.
void fuzz_outlines(std::string_view bytes);
/// A record of motion, with each kind of correction.
void fuzz_record(std::string_view bytes);
/// A file of particles or of a mesh, behind a good one of the same run, as report, watch and render look at it.
void fuzz_particles(std::string_view bytes);
/// The list of such files.
void fuzz_series(std::string_view bytes);
/// summary.json and progress.json.
void fuzz_summary(std::string_view bytes);
/// history.csv, read and gone on with.
void fuzz_history(std::string_view bytes);
/// The head of a request to the server of talus watch.
void fuzz_request(std::string_view bytes);

struct FuzzEntry {
  const char* name;
  void (*take)(std::string_view bytes);
};
/// cmake/TalusFuzz.cmake and tools/fuzz.sh have the same names.
inline constexpr std::array<FuzzEntry, 13> fuzz_entries{{{"scene", fuzz_scene},
                                                         {"msh", fuzz_msh},
                                                         {"checkpoint", fuzz_checkpoint},
                                                         {"raster", fuzz_raster},
                                                         {"points", fuzz_points},
                                                         {"stl", fuzz_stl},
                                                         {"outlines", fuzz_outlines},
                                                         {"record", fuzz_record},
                                                         {"particles", fuzz_particles},
                                                         {"series", fuzz_series},
                                                         {"summary", fuzz_summary},
                                                         {"history", fuzz_history},
                                                         {"request", fuzz_request}}};

}  // namespace talus
