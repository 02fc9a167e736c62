#include <gmock/gmock.h>

#include "io/output/bench_json.hpp"
#include "tests/app/program.hpp"

namespace talus::bench_test {

namespace {

using testing::HasSubstr;

class Bench : public Program {
 protected:
  /// A file as `talus bench` writes it, with times `factor` as long.
  void write_report(const std::string& name, Real factor) const
  {
    BenchReport report;
    report.version = "0", report.commit = "0", report.compiler = "-", report.build = "-", report.flags = "-", report.processor = "-";
    for (const char* kernel : {"linear", "umls"}) {
      BenchResult result;
      result.setting = {.kernel = kernel, .transfer = "tpic", .law = "neo_hookean", .dimension = 2, .per_cell = 4, .threads = 1};
      result.particles = 1000, result.steps = 1;
      result.ns = result.cpu = {100 * factor, 95 * factor, 110 * factor};
      report.results.push_back(result);
    }
    write_bench(folder_ / name, report);
  }
};

std::size_t times(const std::string& word, const std::string& text)
{
  std::size_t count = 0;
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
    ++count;
  return count;
}

TEST_F(Bench, MeasuresTheUsualSettingsAndWritesThemDown)
{
  const Outcome outcome = talus("bench --particles 2000 --repeats 1 --steps 1 --json speed.json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("particle-steps per second and core"));
  const BenchReport report = read_bench(folder_ / "speed.json");
  EXPECT_FALSE(report.compiler.empty());
  for (const BenchResult& r : report.results) {
    SCOPED_TRACE(r.setting.kernel + " " + r.setting.transfer + " " + r.setting.law);
    EXPECT_NEAR(static_cast<Real>(r.particles), 2000, 1000);
    EXPECT_GT(r.ns.least, 0);
    EXPECT_LE(r.ns.least, r.ns.median);
    EXPECT_LE(r.ns.median, r.ns.most);
    EXPECT_GT(r.bytes_held, 100);
    EXPECT_GT(r.bytes_moved, r.bytes_held);
    Real phases = 0;
    for (const BenchPhase& phase : r.phases)
      phases += phase.ns;
    EXPECT_NEAR(phases, r.ns.median, 1e-6 * r.ns.median) << "one repeat: what is left is counted as rest";
  }
  EXPECT_GE(report.results.size(), 12u + 2 + 2) << "kernels and transfers in 3-D and 2-D, laws, few particles";
}

TEST_F(Bench, WordsMakeAProduct)
{
  const Outcome outcome = talus(
      "bench --particles 1000 --repeats 2 --steps 1 --kernel linear,projected --transfer flip --law newtonian,von_mises --dimension 2 "
      "--per-cell 3,4 --threads 1 --json speed.json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(read_bench(folder_ / "speed.json").results.size(), 8u);
}

TEST_F(Bench, OptionsStandBesideTheSameBlockWithoutAny)
{
  const Outcome outcome = talus("bench --options --particles 1000 --repeats 1 --steps 1 --json speed.json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  for (const char* option : {"f_bar", "friction", "bulk_viscosity", "traction", "body_force", "history", "nothing"})
    EXPECT_THAT(outcome.out, HasSubstr(option));
  const BenchReport report = read_bench(folder_ / "speed.json");
  EXPECT_EQ(report.results.front().setting.option, "");
  const auto bytes = [&](const std::string& option) {
    const auto found =
        std::find_if(report.results.begin(), report.results.end(), [&](const auto& r) { return r.setting.option == option; });
    return found == report.results.end() ? 0 : found->bytes_held;
  };
  EXPECT_EQ(bytes("nothing"), bytes(""));
  const auto more = [&](const std::string& option) { return bytes(option) - bytes(""); };
  const auto number = more("bulk_viscosity");  // with its share of the room that strips keep
  EXPECT_GT(number, sizeof(Real));
  EXPECT_NEAR(more("f_bar"), 2 * number, 0.01 * number);
  EXPECT_NEAR(more("traction"), 3 * number, 0.01 * number);
}

TEST_F(Bench, OnRanksTellsWhatEachHoldsAndSends)
{
  const Outcome alone = talus("bench --mpi --particles 20000 --repeats 1 --steps 2 --warm-up 1 --json alone.json");
  ASSERT_EQ(alone.code, 0) << alone.err;
  EXPECT_THAT(alone.out, testing::AllOf(HasSubstr("on 1 rank\n"), HasSubstr("imbalance 1.000"), HasSubstr("particle-steps per second")));
  const Outcome three = talus("bench --mpi --particles 20000 --repeats 2 --steps 2 --warm-up 1 --json three.json", launcher_of(3));
  ASSERT_EQ(three.code, 0) << three.err;
  EXPECT_THAT(three.out, HasSubstr("on 3 ranks\n"));
  EXPECT_THAT(three.out, testing::ContainsRegex("imbalance 1\\.[01]")) << "each particle is one rank's";
  const std::string file = read("three.json");
  EXPECT_THAT(file, HasSubstr("\"format\": \"talus bench ranks 1\""));
  EXPECT_EQ(times("\"cells_held\": ", file), 3u);
  EXPECT_EQ(times("\"bytes\": 0.0", file), 0u) << "each sends";
  EXPECT_EQ(times("\"bytes\": 0.0", read("alone.json")), 1u);
  EXPECT_EQ(times("\"stress [s]\": ", file), 3u);
}

TEST_F(Bench, ComparesSettingBySetting)
{
  write_report("now.json", 1);
  write_report("slow.json", 2);
  write_report("near.json", 1.05);
  const Outcome same = talus("bench --from now.json --compare now.json");
  ASSERT_EQ(same.code, 0) << same.err;
  EXPECT_EQ(times(" 1.000 ", same.out), 4u) << "wall and processor time of two settings";
  EXPECT_EQ(times("only", same.out), 0u);
  const Outcome faster = talus("bench --from now.json --compare slow.json");
  EXPECT_EQ(times(" 0.500  faster", faster.out), 4u);
  const Outcome slower = talus("bench --from slow.json --compare now.json");
  EXPECT_EQ(times(" 2.000  slower", slower.out), 4u);
  const Outcome near = talus("bench --from now.json --compare near.json");
  EXPECT_EQ(times(" 0.952 ", near.out), 4u);
  EXPECT_EQ(times(" 0.952  faster", near.out), 0u) << "within the spread: no mark";
}

TEST_F(Bench, WhatMeansNothingEndsWithTwo)
{
  write("other.json", "{\"format\": \"something\"}");
  write("broken.json", "{\"format\": ");
  write("half.json", "{\"format\": \"talus bench 1\"}");
  const std::pair<const char*, const char*> wrong[] = {{"--kernel projcted", "did you mean \"projected\"?"},
                                                       {"--transfer pic", "there is no \"pic\""},
                                                       {"--law rubber", "there is no \"rubber\""},
                                                       {"--per-cell 99", "a cell takes at most 56 particles in 3-D, not 99"},
                                                       {"--dimension 4", ""},
                                                       {"--threads 0", ""},
                                                       {"--particles 0", ""},
                                                       {"--all --options", ""},
                                                       {"--all --mpi", ""},
                                                       {"--mpi --kernel projcted", "did you mean \"projected\"?"},
                                                       {"--compare missing.json", "there is no such file"},
                                                       {"--compare other.json", "not what `talus bench --json` writes"},
                                                       {"--compare broken.json", "not what `talus bench --json` writes"},
                                                       {"--from half.json", "not what `talus bench --json` writes"}};
  for (const auto& [words, message] : wrong) {
    const Outcome outcome = talus(std::string("bench ") + words);
    EXPECT_EQ(outcome.code, 2) << words;
    EXPECT_THAT(outcome.err, HasSubstr(message)) << words;
    EXPECT_THAT(outcome.out, testing::Not(HasSubstr("ns"))) << words;
  }
}

}  // namespace

}  // namespace talus::bench_test
