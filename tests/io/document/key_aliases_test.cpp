// Two words for one key: `where` for `on`, which readers of YAML 1.1 take for true.
#include "io/document/key_aliases.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>

#include <variant>

#include "io/scene/manual/manual.hpp"
#include "io/scene/reader.hpp"

namespace talus::key_words_test {

namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// With every struct that has a key `on`, which is `word` here.
std::string scene_text(const std::string& word)
{
  const std::string text =
      "title: Walls\ndimension: 2\nmesh: {grid: {low: [0, 0], high: [1, 1], cells: [4, 4]}}\ntime: {end: 1}\n"
      "materials: [{name: rubber, law: hencky, density: 1000, youngs_modulus: 1.0e5, poisson_ratio: 0.3}]\n"
      "bodies: [{name: block, material: rubber, region: all}]\n"
      "loads: [{type: traction, on: g0, pressure: 1}]\n"
      "boundaries: [{type: fixed, on: g1}, {type: roller, on: g2}, {type: velocity, on: g3, velocity: [0, 1]}, {type: friction, on: g4, "
      "coefficient: 0.1}, {type: compliant_base, on: g5, density: 2000, s_wave: 100, p_wave: 200}, {type: free_field, on: g6}]\n"
      "outputs: {history: {every: 1, walls: [{on: g1}]}}\n";
  return std::regex_replace(text, std::regex("\\bon: "), word + ": ");
}

std::vector<std::string> groups_of(const Scene& scene)
{
  std::vector<std::string> groups;
  groups.push_back(std::get<TractionSpec>(scene.loads.at(0)).on);
  for (const BoundaryOptions& boundary : scene.boundaries)
    std::visit([&](const auto& spec) { groups.push_back(spec.on); }, boundary);
  groups.push_back(scene.outputs.history.value().walls.at(0).on);
  return groups;
}

std::string complaint(const std::string& text, const std::vector<std::string>& overrides = {})
{
  try {
    read_scene_text("walls.yaml", text, overrides);
  } catch (const SceneErrors& errors) {
    return errors.what();
  }
  ADD_FAILURE() << "read without a complaint";
  return "";
}

TEST(KeyWords, WhereIsReadAsOnWhereverItStands)
{
  const auto expected = ElementsAre("g0", "g1", "g2", "g3", "g4", "g5", "g6", "g1");
  EXPECT_THAT(groups_of(read_scene_text("walls.yaml", scene_text("on"))), expected);
  EXPECT_THAT(groups_of(read_scene_text("walls.yaml", scene_text("where"))), expected);
  EXPECT_THAT(groups_of(read_scene_text("walls.yaml", scene_text("\"on\""))), expected);
}

TEST(KeyWords, ChangesMayUseEitherWord)
{
  for (const std::string there : {"on", "where"})
    for (const std::string change : {"on", "where"}) {
      const std::vector<std::string> set{"boundaries[1]." + change + "=g7"};
      EXPECT_EQ(groups_of(read_scene_text("walls.yaml", scene_text(there), set)).at(2), "g7") << there << ' ' << change;
    }
}

TEST(KeyWords, MessagesHaveTheWordThatIsWritten)
{
  std::string text = scene_text("where");
  text.replace(text.find("where: g2"), 9, "where: [g2]");
  EXPECT_THAT(complaint(text), HasSubstr("boundaries[1].where: expected"));
  text = scene_text("where");
  text.replace(text.find("{where: g1}"), 11, "{where: g9}");
  EXPECT_THAT(complaint(text), HasSubstr("outputs.history.walls[0].where: there is no wall \"g9\""));
}

TEST(KeyWords, WhatReadersOfYaml11MakeOfOnIsExplainedOnce)
{
  const std::string said = complaint(scene_text("true"));
  std::size_t times = 0;
  for (auto at = said.find("\"true\" is what a reader of YAML 1.1"); at != said.npos; at = said.find("\"true\" is what", at + 1))
    ++times;
  EXPECT_EQ(times, 8U) << said;
  EXPECT_THAT(said, Not(HasSubstr("missing key")));
  EXPECT_THAT(said, Not(HasSubstr("unknown key")));
}

TEST(KeyWords, TheManualKnowsBothWords)
{
  EXPECT_THAT(manual_of("where"), HasSubstr("\"where\" is another word for this key"));
  EXPECT_EQ(manual_of("roller.where"), manual_of("roller.on"));
  EXPECT_THAT(scene_schema(), HasSubstr("\"where\""));
}

TEST(KeyWords, OnlyKeysOfFlowGetAdviceOnFlow)
{
  for (const std::string_view word : {"permeability", "hydraulic_conductivity", "seepage", "darcy_velocity", "intrinsic_permeability"})
    EXPECT_THAT(std::string(advice_on_flow(word)), HasSubstr("block water")) << word;
  for (const std::string_view word : {"cohesion", "conductivity", "table", "suction", "preconsolidation"})
    EXPECT_EQ(advice_on_flow(word), "") << word;
}

}  // namespace

}  // namespace talus::key_words_test
