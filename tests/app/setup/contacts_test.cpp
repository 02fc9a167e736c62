// Contacts of a scene: which bodies share a velocity field, what is refused, what is warned of, and what a run writes.
#include <gmock/gmock.h>

#include "app/setup/contacts_of_scene.hpp"
#include "tests/app/program.hpp"

namespace talus::contacts_test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Three blocks: low, high on top of it, and far, away from both.
std::string three_blocks(const std::string& contacts, const std::string& bottom_of_high = "0.5")
{
  return "title: Blocks\ndimension: 2\nmesh: {grid: {low: [0, 0], high: [3, 1.5], cells: [12, 6]}}\ntime: {end: 0.01}\n"
         "materials: [{name: stone, law: neo_hookean, density: 1000, youngs_modulus: 1.0e6, poisson_ratio: 0.3}]\n"
         "bodies:\n  - {name: low, material: stone, shape: {type: box, low: [0, 0], high: [1, 0.5]}, particles_per_cell: 4}\n"
         "  - {name: high, material: stone, shape: {type: box, low: [0, " +
         bottom_of_high +
         "], high: [1, 1]}, particles_per_cell: 4, velocity: [0, -1]}\n"
         "  - {name: far, material: stone, shape: {type: box, low: [2.25, 0], high: [3, 0.5]}, particles_per_cell: 4}\n"
         "outputs: {history: {every: 0.002}}\ncontacts:\n" +
         contacts;
}

class ContactsOfScene : public Program {
 protected:
  Outcome check(const std::string& contacts, const std::string& bottom_of_high = "0.5")
  {
    write("blocks.yaml", three_blocks(contacts, bottom_of_high));
    return talus("check blocks.yaml");
  }
};

TEST_F(ContactsOfScene, WhatCannotBeIsRefusedWithItsPlace)
{
  const Outcome outcome = check(
      "  - {between: [low, high], friction: -1}\n  - {between: [low, low]}\n  - {between: [high, low]}\n"
      "  - {between: [low]}\n  - {between: [low, far], tied: true, cohesion: 3}\n  - {between: [lwo, high]}\n");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("blocks.yaml:12:38: error: contacts[0].friction: -1 must be >= 0\n"));
  EXPECT_THAT(outcome.err, HasSubstr("blocks.yaml:13:5: error: contacts[1]: a body has no contact with itself"));
  EXPECT_THAT(outcome.err,
              HasSubstr("blocks.yaml:14:15: error: contacts[2].between: contacts[0] is between \"high\" and \"low\" already\n"));
  EXPECT_THAT(outcome.err, HasSubstr("blocks.yaml:15:5: error: contacts[3]: between takes the names of two bodies\n"));
  EXPECT_THAT(outcome.err, HasSubstr("blocks.yaml:16:5: error: contacts[4]: tied bodies do not slide"));
  EXPECT_THAT(outcome.err, HasSubstr("error: contacts[5].between[0]: there is no body \"lwo\""));
}

TEST_F(ContactsOfScene, BodiesThatOverlapAtTheStartAreRefused)
{
  const Outcome outcome = check("  - {between: [low, high]}\n", "0.25");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("blocks.yaml:12:5: error: contacts[0].between: \"high\" overlaps \"low\" at the start"));
}

TEST_F(ContactsOfScene, BodiesThatOverlapWithoutAContactOfTheirOwnAreRefused)
{
  const Outcome outcome = check("  - {between: [low, far]}\n  - {between: [high, far]}\n", "0.25");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("bodies[1] \"high\".shape: \"high\" overlaps \"low\" at the start"));
}

TEST_F(ContactsOfScene, PairsWithoutAContactAreNamed)
{
  const Outcome outcome = check("  - {between: [low, high], friction: 0.5}\n");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err,
              HasSubstr("no contact says what acts between \"low\" and \"far\": where they touch, they slide without friction"));
  EXPECT_THAT(outcome.err, HasSubstr("between \"high\" and \"far\""));
  EXPECT_THAT(outcome.out, Not(HasSubstr("move as one")));
  EXPECT_THAT(outcome.out, HasSubstr("contact of \"low\" and \"high\": friction 0.5"));
}

TEST_F(ContactsOfScene, TiedBodiesHaveOneContactWithOthers)
{
  const Outcome two_frictions = check(
      "  - {between: [low, far], tied: true}\n  - {between: [low, high], friction: 0.5}\n"
      "  - {between: [far, high], friction: 0.4}\n");
  EXPECT_EQ(two_frictions.code, 2);
  EXPECT_THAT(two_frictions.err, HasSubstr("blocks.yaml:14:5: error: contacts[2].between: tied bodies slide as one"));
  const Outcome circle =
      check("  - {between: [low, far], tied: true}\n  - {between: [far, high], tied: true}\n  - {between: [low, high]}\n");
  EXPECT_EQ(circle.code, 2);
  EXPECT_THAT(circle.err, HasSubstr("contacts[2].between: \"low\" and \"high\" are tied to each other by other contacts"));
}

TEST_F(ContactsOfScene, HistoryHasForceAndLossesOfEachContact)
{
  write("blocks.yaml", three_blocks("  - {between: [low, high], friction: 0.5}\n  - {between: [low, far], tied: true}\n"));
  ASSERT_EQ(talus("run blocks.yaml --out out").code, 0);
  const std::string history = read("out/history.csv");
  EXPECT_THAT(history, HasSubstr("contact_low_high_x [N],contact_low_high_y [N],contact_friction_low_high [J],contact_loss_low_high [J]"));
}

TEST(ContactsOfBodies, ShareFieldsWhereNothingPutsThemApart)
{
  Scene scene;
  std::vector<Body> bodies;
  for (const char* name : {"a", "b", "c", "d", "e"})
    bodies.push_back({name, 0, 0, {}});
  SceneErrorCollector errors(scene);
  std::vector<std::string> warnings;
  EXPECT_TRUE(contacts_of(scene, bodies, errors, warnings).laws.empty());
  const auto contact = [](const char* a, const char* b, Real friction, bool tied) {
    ContactSpec spec;
    spec.between = {a, b}, spec.friction = friction, spec.tied = tied;
    return spec;
  };
  scene.contacts = {contact("d", "b", 0.3, false), contact("c", "b", 0, true)};
  const Contacts contacts = contacts_of(scene, bodies, errors, warnings);
  EXPECT_EQ(contacts.n_fields, 3);
  EXPECT_EQ(contacts.field_of_body, (std::vector<Index>{0, 1, 1, 2, 0})) << "a and e in no contact, b and c tied, d";
  ASSERT_EQ(contacts.laws.size(), 3u);
  EXPECT_EQ(contacts.laws[2].name(), "b_d");
  EXPECT_EQ(contacts.laws[2].friction, 0.3);
  EXPECT_EQ(warnings.size(), 2u);
}

TEST(ContactsOfBodies, LeaveOutBodiesThatCouldNotBeFilled)
{
  Scene scene;
  ContactSpec slides, sticks;
  slides.between = {"a", "none"};
  sticks.between = {"none", "b"}, sticks.tied = true;
  scene.contacts = {slides, sticks};
  SceneErrorCollector errors(scene);
  std::vector<std::string> warnings;
  const Contacts contacts = contacts_of(scene, {{"a", 0, 0, {}}, {"b", 0, 0, {}}}, errors, warnings);
  ASSERT_EQ(contacts.laws.size(), 1u) << "that of the two bodies that are there, which no contact names together";
  EXPECT_EQ(contacts.laws[0].friction, 0);
  EXPECT_TRUE(contacts_of(scene, {}, errors, warnings).laws.empty());
}

}  // namespace
}  // namespace talus::contacts_test
