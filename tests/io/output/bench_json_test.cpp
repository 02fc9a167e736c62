#include "io/output/bench_json.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "core/error.hpp"
#include "tests/io/scratch_folder.hpp"

namespace talus::bench_json_test {

namespace {

TEST(BenchJson, ReadsBackWhatItWrote)
{
  const ScratchFolder folder;
  BenchReport report;
  report.version = "1.2", report.commit = "abc", report.compiler = "gcc", report.build = "Release", report.flags = "-O3 \"x\"";
  report.processor = "processor", report.cores = 4;
  BenchResult result;
  result.setting = {.kernel = "umls", .transfer = "tpic", .law = "mu_i", .dimension = 3, .per_cell = 8, .threads = 4, .option = "f_bar"};
  result.particles = 1'000'000, result.steps = 5;
  result.ns = {100.25, 99.5, 103}, result.cpu = {399, 398, 401};
  result.repeats = {103, 99.5, 100.25};
  result.phases = {{"scatter", 60.5}, {"anything", 39.75}};
  result.bytes_held = 368, result.bytes_moved = 700;
  report.results.push_back(result);
  write_bench(folder / "speed.json", report);

  const BenchReport back = read_bench(folder / "speed.json");
  EXPECT_EQ(back.flags, report.flags);
  EXPECT_EQ(back.commit, "abc");
  EXPECT_EQ(back.cores, 4);
  ASSERT_EQ(back.results.size(), 1u);
  EXPECT_EQ(back.results[0].setting, result.setting);
  EXPECT_EQ(back.results[0].ns.most, 103);
  EXPECT_EQ(back.results[0].cpu.least, 398);
  EXPECT_EQ(back.results[0].repeats, result.repeats);
  ASSERT_EQ(back.results[0].phases.size(), 2u);
  EXPECT_EQ(back.results[0].phases[1].name, "anything");
  EXPECT_EQ(back.results[0].phases[1].ns, 39.75);
  EXPECT_EQ(back.results[0].bytes_moved, 700);
  EXPECT_NEAR(back.results[0].rate(), 1e3 / 100.25 / 4, 1e-12);
}

TEST(BenchJson, RefusesWhatIsSomethingElse)
{
  const ScratchFolder folder;
  EXPECT_THROW(read_bench(folder / "missing.json"), SceneErrors);
  for (const char* text : {"", "[1, 2]", "{\"format\": 3}", "{\"format\": \"talus bench 1\", \"program\": []}"}) {
    std::ofstream(folder / "other.json") << text;
    EXPECT_THROW(read_bench(folder / "other.json"), SceneErrors) << text;
  }
}

}  // namespace

}  // namespace talus::bench_json_test
