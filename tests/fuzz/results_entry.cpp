// The files of a run as others read them: they may be damaged or forged.
#include <algorithm>

#include "app/commands/report/report_survey.hpp"
#include "core/display_text.hpp"
#include "core/error.hpp"
#include "io/files/atomic_file.hpp"
#include "io/output/csv.hpp"
#include "io/output/progress_json.hpp"
#include "io/output/summary_json.hpp"
#include "io/output/vtk.hpp"
#include "io/page/page_block.hpp"
#include "io/system/http_request.hpp"
#include "mesh/geometry/outline.hpp"
#include "tests/fuzz/entries.hpp"
#include "tests/fuzz/memory_file.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

/// Refused with a reason, or not.
template <class Take>
void attempt(Take&& take)
{
  try {
    take();
  } catch (const EnvironmentError&) {
  }
}

/// A run of two frames in memory, of which the first is good.
class RunOfTwo {
 public:
  RunOfTwo() : folder_(MemoryFile().path())
  {
    fs::create_directories(folder_);
    PvdSeries series(folder_ / "particles.pvd");
    const std::vector<Column> columns{
        {"velocity", 3, {1, 2, 3, 4, 5, 6}, "m/s"}, {"stress", 6, std::vector<float>(12, 1), "Pa"}, {"body", 1, {0, 1}}};
    write_particles(folder_ / "particles_0.vtp", 0, std::vector<Real>{0, 0, 0, 1, 0, 0}, std::vector<std::int64_t>{1, 2}, columns, "talus");
    series.append(0, folder_ / "particles_0.vtp");
    series.append(1, folder_ / "particles_1.vtp");
  }
  ~RunOfTwo()
  {
    std::error_code stays;
    fs::remove_all(folder_, stays);
  }
  RunOfTwo(const RunOfTwo&) = delete;
  RunOfTwo& operator=(const RunOfTwo&) = delete;
  const fs::path& folder() const noexcept { return folder_; }

 private:
  fs::path folder_;
};

void read_all(const StoredParticles& particles)
{
  for (const StoredField& field : particles.fields) {
    const std::vector<Real> values = viewed_values(field, {field.name});
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    if (!values.empty())
      quantised(values, *low, *high);
  }
}

}  // namespace

void fuzz_particles(std::string_view bytes)
{
  static const RunOfTwo run;
  const fs::path file = run.folder() / "particles_1.vtp";
  write_whole(file, bytes);
  attempt([&] { stored_particle_fields(file); });
  attempt([&] { read_all(read_particles(file)); });
  attempt([&] { read_mesh_fields(file); });
  attempt([&] {
    const StoredMesh mesh = read_mesh(file);
    edges_of(mesh.dimension, mesh.nodes, mesh.corners);
  });
  RunSurvey survey;
  look_over(run.folder(),
            {.up = Vec3::UnitY(),
             .bodies = 2,
             .fields = {},
             .of_picture = "velocity",
             .rule = {.moved = 0, .mass_share = 0.99},
             .runs_out = {},
             .mass = {}},
            survey);
}

void fuzz_series(std::string_view bytes)
{
  const MemoryFile file(bytes);
  attempt([&] {
    read_pvd(file.path());
    PvdSeries series(file.path());
    series.resume(1);
    series.append(2, file.path());
    read_pvd(file.path());
  });
}

void fuzz_summary(std::string_view bytes)
{
  const MemoryFile file(bytes);
  attempt([&] { find_number(read_summary(file.path()).numbers, "kinetic"); });
  if (const auto progress = read_progress(file.path())) {
    bar(progress->share(), 40);
    in_minutes(progress->elapsed);
    in_minutes(progress->left().value_or(0));
  }
}

void fuzz_history(std::string_view bytes)
{
  const MemoryFile file(bytes);
  attempt([&] {
    const HistoryTable history = read_history(file.path());
    HistoryFile::resume(file.path(), history.columns, 1);
    read_history(file.path());
  });
}

void fuzz_request(std::string_view bytes)
{
  try {
    parse_http_request(bytes);
  } catch (const Error&) {
  }
}

}  // namespace talus
