// The manual and the schema say what the field lists say.
#include "io/scene/manual/manual.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "io/output/output_fields.hpp"
#include "io/scene/scene_rules.hpp"
#include "materials/interface/own_law.hpp"
#include "materials/laws.hpp"

namespace talus::manual_test {

namespace {

using testing::ContainsRegex;
using testing::HasSubstr;

/// The cells of the row of a key below a heading, without blanks around them.
std::map<std::string, std::string> row(const std::string& title, const std::string& key)
{
  const std::string manual = scene_manual();
  const auto heading =
      manual.find("\n## " + title + "\n") != manual.npos ? manual.find("\n## " + title + "\n") : manual.find("\n### " + title + "\n");
  const auto at = manual.find("\n| `" + key + "` ", heading);
  if (heading == manual.npos || at == manual.npos || at > manual.find("\n#", heading + 2)) {
    ADD_FAILURE() << "no " << key << " below " << title;
    return {};
  }
  std::istringstream line(manual.substr(at + 2, manual.find('\n', at + 1) - at - 2));
  std::map<std::string, std::string> cells;
  for (const std::string column : {"key", "type", "unit", "range", "default", "meaning"}) {
    std::string cell;
    std::getline(line, cell, '|');
    const auto first = cell.find_first_not_of(' ');
    cells[column] = first == cell.npos ? "" : cell.substr(first, cell.find_last_not_of(' ') + 1 - first);
  }
  return cells;
}

TEST(Manual, GivesTypeUnitRangeDefaultAndMeaning)
{
  const auto step = row("time", "min_step");
  EXPECT_EQ(step.at("type"), "number");
  EXPECT_EQ(step.at("unit"), "s");
  EXPECT_EQ(step.at("range"), "> 0");
  EXPECT_EQ(step.at("default"), "1e-12");
  EXPECT_THAT(step.at("meaning"), HasSubstr("the run stops"));
}

TEST(Manual, TellsRequiredFromOptionalKeys)
{
  EXPECT_EQ(row("the scene", "title").at("default"), "required");
  EXPECT_EQ(row("the scene", "mesh").at("default"), "required");
  EXPECT_EQ(row("the scene", "kernel").at("default"), "projected");
  EXPECT_EQ(row("time", "end").at("default"), "none");
  EXPECT_EQ(row("time", "max_step").at("default"), "none");
  EXPECT_EQ(row("transfer", "scheme").at("default"), "aflip");
  EXPECT_EQ(row("outputs.particles", "fields").at("default"), "[velocity, displacement, stress]");
  EXPECT_EQ(row("type: geostatic", "elastic").at("default"), "true");
}

TEST(Manual, ListsTheWordsOfEnums)
{
  EXPECT_EQ(row("transfer", "scheme").at("range"), "`flip`, `apic`, `tpic`, `aflip` or `saflip`");
  EXPECT_THAT(row("materials", "law").at("range"), HasSubstr("`drucker_prager`"));
}

TEST(Manual, HasASectionForEveryLawWithItsParametersAndHistory)
{
  const std::string manual = scene_manual();
  for_each_type(Laws{}, [&]<class L>() {
    EXPECT_THAT(manual, HasSubstr("### law: " + std::string(L::name)));
    for_each_field<L>([&](const auto& field) { row("law: " + std::string(L::name), std::string(field.key)); });
    for_each_field<typename L::State>(
        [&](const auto& variable) { EXPECT_THAT(manual, HasSubstr("| `" + std::string(variable.key) + "`")); });
  });
  EXPECT_EQ(row("law: drucker_prager", "friction_angle").at("range"), "[0, 90)");
  EXPECT_EQ(row("law: drucker_prager", "friction_angle").at("unit"), "deg");
}

TEST(Manual, GroupsOfALawHaveTheirOwnSection)
{
  EXPECT_EQ(row("law: johnson_cook", "damage").at("type"), "[johnson_cook.damage](#johnson_cookdamage)");
  EXPECT_EQ(row("johnson_cook.damage", "d2").at("range"), ">= 0");
  EXPECT_EQ(row("von_mises.rate", "reference_rate").at("unit"), "1/s");
  EXPECT_EQ(row("materials.bulk_viscosity", "linear").at("default"), "0.5");
}

TEST(Manual, ElasticConstantsAreOptionalOneByOne)
{
  for (const std::string key : {"youngs_modulus", "poisson_ratio", "bulk_modulus", "shear_modulus", "lame_lambda"})
    EXPECT_EQ(row("law: linear_elastic", key).at("default"), "none");
  EXPECT_EQ(row("law: mohr_coulomb", "poisson_ratio").at("range"), "(-1, 0.5)");
}

TEST(Manual, TellsOutputFieldsAndColumnsWithUnitAndMeaning)
{
  const std::string manual = scene_manual();
  const auto particles = manual.find("\n## outputs.particles\n"), mesh = manual.find("\n## outputs.mesh\n");
  for (const std::string& field : names_of(particle_fields()))
    EXPECT_LT(manual.find("| `" + field + "` ", particles), manual.find("\n## ", particles + 1)) << field;
  for (const std::string& field : names_of(node_fields()))
    EXPECT_LT(manual.find("| `" + field + "` ", mesh), manual.find("\n## ", mesh + 1)) << field;
  EXPECT_THAT(manual, ContainsRegex("`volume` +\\| m\\^D +\\| 1 +\\| volume now"));
  EXPECT_THAT(manual, ContainsRegex("`NAME_ux` `NAME_uy` `NAME_uz` +\\| m +\\| 3 +\\| displacement"));
  EXPECT_THAT(manual, HasSubstr("| `attack_WALL_x` `attack_WALL_y` `attack_WALL_z` | m"));
}

TEST(Manual, NamesEveryKernel)
{
  for (const auto& kernel : kernel_names())
    EXPECT_THAT(scene_manual(), HasSubstr("* `" + kernel + "`: "));
}

TEST(Manual, LinksOnlyToSectionsThatExist)
{
  const std::string manual = scene_manual();
  int links = 0;
  for (auto at = manual.find("]("); at != manual.npos; at = manual.find("](", at + 1), ++links) {
    const auto begin = manual.rfind('[', at) + 1;
    EXPECT_THAT(manual, HasSubstr("\n## " + manual.substr(begin, at - begin) + "\n"));
  }
  EXPECT_GT(links, 15);
}

TEST(Schema, KnowsKeysTypesRangesAndWords)
{
  const auto schema = nlohmann::json::parse(scene_schema());
  const auto& keys = schema.at("properties");
  EXPECT_EQ(schema.at("additionalProperties"), false);
  EXPECT_EQ(keys.at("dimension").at("type"), "integer");
  EXPECT_EQ(keys.at("dimension").at("minimum"), 2);
  EXPECT_EQ(keys.at("dimension").at("maximum"), 3);
  EXPECT_EQ(keys.at("time").at("properties").at("end").at("exclusiveMinimum"), 0);
  EXPECT_EQ(keys.at("transfer").at("properties").at("scheme").at("enum"), (nlohmann::json{"flip", "apic", "tpic", "aflip", "saflip"}));
  EXPECT_EQ(keys.at("materials").at("items").at("allOf").size(), Laws::size + LawsInLibraries::size);
  EXPECT_EQ(keys.at("loads").at("items").at("allOf").at(0).at("then").at("properties").at("type").at("const"), "gravity");
  EXPECT_EQ(keys.at("loads").at("items").at("properties").at("type").at("enum"), (nlohmann::json{"gravity", "body_force", "traction"}));
  EXPECT_THAT(schema.at("required").get<std::vector<std::string>>(),
              testing::UnorderedElementsAre("title", "dimension", "mesh", "materials", "bodies"));
}

TEST(Schema, KnowsGroupsOfLawsAndOptionsOfBodies)
{
  const auto keys = nlohmann::json::parse(scene_schema()).at("properties");
  const auto& laws = keys.at("materials").at("items").at("allOf");
  const auto of_metal = std::find_if(laws.begin(), laws.end(),
                                     [](const auto& law) { return law.at("if").at("properties").at("law").at("const") == "johnson_cook"; });
  ASSERT_NE(of_metal, laws.end());
  const auto& metal = of_metal->at("then");
  EXPECT_EQ(metal.at("additionalProperties"), false);
  const auto& damage = metal.at("properties").at("damage");
  EXPECT_EQ(damage.at("properties").at("d2").at("minimum"), 0);
  EXPECT_THAT(damage.at("required").get<std::vector<std::string>>(), testing::UnorderedElementsAre("d1", "d2", "d3", "d4", "d5"));
  const auto required = metal.at("required").get<std::vector<std::string>>();
  EXPECT_THAT(required, testing::Contains("thermal_exponent"));
  EXPECT_THAT(required, testing::Not(testing::AnyOf(testing::Contains("damage"), testing::Contains("youngs_modulus"))));
  EXPECT_EQ(keys.at("bodies").at("items").at("properties").at("f_bar").at("type"), "boolean");
}

/// f(key, its schema) for every key anywhere in a schema.
template <class F>
void for_each_key(const nlohmann::json& schema, F&& f)
{
  if (const auto keys = schema.find("properties"); keys != schema.end())
    for (const auto& [key, value] : keys->items()) {
      f(key, value);
      for_each_key(value, f);
    }
  if (const auto items = schema.find("items"); items != schema.end())
    for_each_key(*items, f);
  if (const auto all = schema.find("allOf"); all != schema.end())
    for (const auto& one : *all)
      for_each_key(one.at("then"), f);
}

TEST(Schema, EveryKeyIsDescribedWithUnitRangeAndDefault)
{
  const auto schema = nlohmann::json::parse(scene_schema());
  int keys = 0;
  for_each_key(schema, [&](const std::string& key, const nlohmann::json& value) {
    EXPECT_TRUE(value.contains("description")) << key << value.dump();
    ++keys;
  });
  EXPECT_GT(keys, 200);
  const auto& step = schema.at("properties").at("time").at("properties").at("min_step");
  EXPECT_THAT(step.at("description").get<std::string>(), testing::EndsWith(" [s] (range > 0; default 1e-12)"));
  EXPECT_EQ(step.at("default"), 1e-12);
  EXPECT_EQ(schema.at("properties").at("kernel").at("markdownEnumDescriptions").size(), kernel_names().size());
}

}  // namespace

}  // namespace talus::manual_test
