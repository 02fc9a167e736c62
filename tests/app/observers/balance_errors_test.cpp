// What the balances of a run say against it, and what becomes of the run then.
#include "app/observers/accounts.hpp"

#include <gmock/gmock.h>

#include "tests/app/program.hpp"

namespace talus::failed_accounts_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

RunSummary sound(Real plastic, Real transfer)
{
  RunSummary summary;
  summary.mass.emplace().closure = {0, 1e-9, "mass at the start"};
  summary.momentum.emplace().closure = {1e-15, 1e-9, "momenta"};
  summary.angular_momentum.emplace().closure = {0.01, 0.05, "moments"};
  summary.angular_momentum->transfer_share = 0.09;
  summary.energy = EnergyAudit{{{"gravity_work", 100}, {"plastic", plastic}, {"transfer_loss", transfer}}, {0.02, 0.05, "largest term"}};
  return summary;
}

TEST(FailedAccounts, ASoundRunHasNone) { EXPECT_THAT(failed_accounts(sound(80, 7.9), 0), IsEmpty()); }

TEST(FailedAccounts, ALossBeyondATenthOfThePlasticWorkIsOne)
{
  EXPECT_THAT(failed_accounts(sound(80, 8.1), 0), ElementsAre(HasSubstr("0.101 of the plastic work")));
  EXPECT_THAT(failed_accounts(sound(40, 50), 0),
              ElementsAre(HasSubstr("lost 50 J between them (transfer_loss), 1.25 of the plastic work")));
  EXPECT_THAT(failed_accounts(sound(0.5, 50), 0), IsEmpty()) << "plastic work that is next to nothing decides nothing";
  EXPECT_THAT(failed_accounts(sound(0, 50), 0), IsEmpty());
}

TEST(FailedAccounts, ALossOfAngularMomentumBeyondATenthIsOne)
{
  RunSummary summary = sound(80, 5);
  summary.angular_momentum->transfer_share = 0.11;
  EXPECT_THAT(failed_accounts(summary, 0), ElementsAre(HasSubstr("lost 0.11 of the angular momentum between them")));
}

TEST(FailedAccounts, EveryBalanceThatDoesNotCloseIsOne)
{
  RunSummary summary = sound(80, 5);
  summary.energy->closure.relative = 0.29;
  EXPECT_THAT(failed_accounts(summary, 0),
              ElementsAre("the balance of energy does not close: 0.29 of the largest term is not accounted for, more than 0.05"));
  summary.momentum->closure.relative = std::numeric_limits<Real>::quiet_NaN();
  summary.mass->closure.relative = 1e-8;
  summary.angular_momentum->closure.relative = 0.06;
  EXPECT_THAT(failed_accounts(summary, 0),
              ElementsAre(HasSubstr("of mass "), HasSubstr("of momentum "), HasSubstr("of angular momentum "), HasSubstr("of energy ")));
}

TEST(FailedAccounts, TheLossOfBodiesThatHardlyMovedIsNotJudged)
{
  RunSummary summary = sound(80, 50);
  EXPECT_EQ(failed_accounts(summary, 99).size(), 1u);
  EXPECT_THAT(failed_accounts(summary, 101), IsEmpty());
}

/// A block of soft clay that falls onto a floor with cells much too large.
const std::string splash = R"(title: Splash
dimension: 2
mesh: {grid: {low: [0, 0], high: [4, 2], cells: [8, 4]}}
time: {end: 0.3}
materials:
  - {name: clay, law: drucker_prager, density: 1000, youngs_modulus: 1.0e6, poisson_ratio: 0.3, friction_angle: 0, cohesion: 500, match: plane_strain}
bodies:
  - {name: block, material: clay, shape: {type: box, low: [1, 0.5], high: [2, 1.5]}, particles_per_cell: 3, velocity: [2, -3]}
loads: [{type: gravity, acceleration: [0, -10]}]
boundaries: [{type: fixed, on: y_min}]
outputs: {history: {every: 0.01}}
)";

class FailedAccountsOfARun : public Program {};

TEST_F(FailedAccountsOfARun, AreWarningsAtTheTopAndWithStrictAnError)
{
  write("splash.yaml", splash);
  const std::string what = "particles and nodes lost ";
  const Outcome warned = talus("run splash.yaml --out warned --quiet");
  EXPECT_EQ(warned.code, 0);
  EXPECT_THAT(warned.err, StartsWith("warning: " + what));
  EXPECT_THAT(read("warned/summary.json"), HasSubstr("\"status\": \"done\""));
  const std::string summary = read("warned/summary.json"), warnings = summary.substr(summary.find("\"warnings\": ["));
  EXPECT_LT(warnings.find(what), warnings.find(']')) << warnings;

  for (const char* way : {"--strict", "--set strict=true"}) {
    const Outcome strict = talus(fmt::format("run splash.yaml --out strict {}", way));
    EXPECT_EQ(strict.code, 1) << way;
    EXPECT_THAT(strict.err, StartsWith("error: " + what));
    EXPECT_THAT(strict.err, Not(HasSubstr("warning: " + what)));
    EXPECT_THAT(strict.out, HasSubstr("audit: ")) << "the results are there";
    EXPECT_THAT(read("strict/summary.json"), HasSubstr("\"status\": \"failed\""));
    EXPECT_THAT(read("strict/summary.json"), HasSubstr("\"message\": \"" + what));
    EXPECT_EQ(read("strict/history.csv"), read("warned/history.csv"));
  }
  write("sound.yaml", block_scene("time: {end: 0.01}\nstrict: true\n", ", velocity: [2, 0]"));
  const Outcome sound = talus("run sound.yaml --out sound --quiet");
  EXPECT_EQ(sound.code, 0) << sound.err;
  EXPECT_EQ(sound.err, "");
}

}  // namespace
}  // namespace talus::failed_accounts_test
