#include "io/output/summary_json.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "core/error.hpp"
#include "io/files/atomic_file.hpp"
#include "tests/io/scratch_folder.hpp"

namespace talus::summary_json_test {

namespace {

Real number(const SummaryBack& back, const char* name)
{
  const NamedValue* found = find_number(back.numbers, name);
  return found != nullptr ? found->value : std::numeric_limits<Real>::infinity();
}

TEST(SummaryJson, ReadsBackWhatTheReportHasWritten)
{
  const ScratchFolder folder;
  RunSummary summary;
  summary.status = RunStatus::failed, summary.message = "lost";
  summary.steps = 7, summary.simulated_time = 0.1 + 0.2;
  summary.wall_total = 3;
  summary.bodies = {{"a", "m", "neo_hookean", 5, 2.5}, {"b", "m", "neo_hookean", 6, 3.5}};
  summary.stages = {{"run", 7, 0.3, std::nullopt, "quick"}};
  summary.energy =
      EnergyAudit{{{"kinetic", 1.5, "J"}, {"plastic", std::nan(""), "J"}, {"stage 0 run: kinetic", 9, "J"}}, {1e-3, 1, "largest term"}};
  summary.mass = MassAudit{6, 6, 0, 0, {0, 1, "mass"}};
  write_summary(folder / "summary.json", summary);

  const SummaryBack back = read_summary(folder / "summary.json");
  EXPECT_EQ(back.status, "failed");
  EXPECT_EQ(back.message, "lost");
  EXPECT_EQ(number(back, "steps"), 7) << "not that of a stage";
  EXPECT_EQ(number(back, "simulated_time"), 0.1 + 0.2);
  EXPECT_EQ(number(back, "cost.wall"), 3);
  EXPECT_EQ(number(back, "kinetic"), 1.5);
  EXPECT_EQ(number(back, "balances.energy.terms.kinetic"), 1.5);
  EXPECT_TRUE(std::isnan(number(back, "plastic"))) << "null in the file";
  EXPECT_EQ(number(back, "energy.closure"), 1e-3);
  EXPECT_EQ(number(back, "bodies[1].mass"), 3.5);
  EXPECT_EQ(find_number(back.numbers, "kinetic")->unit, "J");
  EXPECT_EQ(find_number(back.numbers, "closure"), nullptr) << "there are two";
  EXPECT_EQ(find_number(back.numbers, "kine"), nullptr);
}

TEST(SummaryJson, RefusesWhatIsSomethingElse)
{
  const ScratchFolder folder;
  EXPECT_THROW(read_summary(folder / "missing.json"), EnvironmentError);
  for (const char* text : {"", "{}", "[1]", "{\"program\": {}, \"scene\": 3}"}) {
    std::ofstream(folder / "summary.json") << text;
    EXPECT_THROW(read_summary(folder / "summary.json"), EnvironmentError) << text;
  }
}

TEST(SummaryJson, WhatIsNestedTooDeeplyIsRefused)
{
  const ScratchFolder folder;
  write_summary(folder / "summary.json", {});
  const std::string whole = read_whole(folder / "summary.json");
  const auto with = [&](const std::string& value) {
    write_whole(folder / "b.json", "{\"more\": " + value + "," + whole.substr(whole.find('{') + 1));
    read_summary(folder / "b.json");
  };
  const auto nested = [](std::size_t n) { return std::string(n, '[') + "1" + std::string(n, ']'); };
  EXPECT_NO_THROW(with(nested(20)));
  for (const std::size_t n : {100, 1000, 200'000})
    EXPECT_THROW(with(nested(n)), EnvironmentError) << n;
  EXPECT_THROW(with(std::string(200'000, '[')), EnvironmentError);
}

}  // namespace

}  // namespace talus::summary_json_test
