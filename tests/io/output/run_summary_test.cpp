// summary.json as a reader in another language sees it.
#include "io/output/run_summary.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "io/files/atomic_file.hpp"
#include "tests/io/full_disk.hpp"
#include "tests/io/scratch_folder.hpp"

namespace talus::report_test {
namespace {

using nlohmann::json;

RunSummary example()
{
  RunSummary s;
  s.title = "Slope \"A\"";
  s.scene_file = "slope.yaml";
  s.overrides = {"time.end=2"};
  s.scene_digest = "fedcba9876543210";
  s.mesh_digest = "0123456789abcdef";
  s.scene_text = "title: Slope \"A\"  # \xc3\xa9\ndimension: 3\n";
  s.version = "1.2.3";
  s.commit = "0123456789ab";
  s.dimension = 3;
  s.kernel = "umls";
  s.mesh_nodes = 11;
  s.mesh_cells = 24;
  s.mesh_quality = {{"worst", 0.1 + 0.2}};
  s.bodies = {{"soil", "clay", "drucker_prager", 5'000'000'000, 1.5e9}, {"rock", "granite", "linear_elastic", 3, 2.0}};
  s.stages = {{"geostatic", 100, 2.0, 9.5e-4, "reached"}, {"run", 200, 1.0, std::nullopt, "done"}};
  s.steps = 300;
  s.simulated_time = 3.0;
  s.wall_seconds = {{"mesh", 0.5, "s"}, {"scatter", 1.25, "s"}};
  s.energy = EnergyAudit{{{"kinetic", 1.0, "J"}, {"gravity", -2.0, "J"}}, {1e-12, 1e-2, "work of gravity"}};
  s.momentum = MomentumAudit{{0, 0, 0}, {1, 2, 3}, {1, 2, 3}, {1e-15, 1e-9, "impulse"}};
  s.warnings = {"sliver"};
  s.files = {"particles.pvd"};
  return s;
}

TEST(Report, EveryPartReadsBack)
{
  const ScratchFolder folder;
  const RunSummary s = example();
  write_summary(folder / "summary.json", s);
  const json read = json::parse(read_whole(folder / "summary.json"));
  EXPECT_EQ(read["title"], s.title);
  EXPECT_EQ(read["status"], "done");
  EXPECT_FALSE(read.contains("message"));
  EXPECT_EQ(read["scene"]["text"], s.scene_text);
  EXPECT_EQ(read["scene"]["set"], json::array({"time.end=2"}));
  EXPECT_EQ(read["mesh"]["digest"], "0123456789abcdef");
  EXPECT_EQ(read["scene"]["digest"], "fedcba9876543210");
  EXPECT_EQ(s.made_by(), "talus 1.2.3, commit 0123456789ab, , ; scene fedcba9876543210, mesh 0123456789abcdef");
  EXPECT_EQ(read["program"]["commit"], s.commit);
  EXPECT_EQ(read["mesh"]["quality"]["worst"].get<Real>(), 0.1 + 0.2);
  EXPECT_EQ(read["bodies"][0]["particles"].get<std::int64_t>(), 5'000'000'000);
  EXPECT_EQ(read["bodies"][1]["law"], "linear_elastic");
  EXPECT_EQ(read["stages"][0]["residual"].get<Real>(), 9.5e-4);
  EXPECT_FALSE(read["stages"][1].contains("residual"));
  EXPECT_EQ(read["cost"]["wall_by_phase"]["scatter [s]"].get<Real>(), 1.25);
  EXPECT_EQ(read["balances"]["energy"]["terms"]["gravity [J]"].get<Real>(), -2.0);
  EXPECT_EQ(read["balances"]["momentum"]["end [kg m/s]"].get<std::vector<Real>>(), s.momentum->end);
  EXPECT_FALSE(read["balances"].contains("mass"));
  EXPECT_EQ(read["warnings"].get<std::vector<std::string>>(), s.warnings);
  EXPECT_EQ(read["files"].get<std::vector<std::string>>(), s.files);
}

TEST(Report, FailedRunSaysWhy)
{
  RunSummary s = example();
  s.status = RunStatus::failed;
  s.message = "step 12: particle 3 of \"soil\" left the mesh";
  const json read = json::parse(to_json(s));
  EXPECT_EQ(read["status"], "failed");
  EXPECT_EQ(read["message"], s.message);
}

TEST(Report, PhasesKeepTheirOrder)
{
  RunSummary s = example();
  s.wall_seconds = {{"z_first", 1, "s"}, {"a_second", 2, "s"}};
  const std::string text = to_json(s);
  EXPECT_LT(text.find("z_first"), text.find("a_second"));
}

TEST(Report, NumbersThatAreNotFiniteAndBytesThatAreNoTextStayValidJson)
{
  RunSummary s = example();
  s.simulated_time = std::numeric_limits<Real>::quiet_NaN();
  s.scene_text = "title: \xff\xfe";
  const json read = json::parse(to_json(s));
  EXPECT_TRUE(read["simulated_time [s]"].is_null());
  EXPECT_THAT(read["scene"]["text"].get<std::string>(), testing::StartsWith("title: "));
}

TEST(Report, FullDiskIsAnEnvironmentErrorThatNamesTheFile)
{
  const ScratchFolder folder;
  const FullDisk full(100);
  try {
    write_summary(folder / "summary.json", example());
    FAIL() << "wrote more than the disk holds";
  } catch (const EnvironmentError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr((folder / "summary.json").string()));
  }
}

}  // namespace
}  // namespace talus::report_test
