// Keys that name a file of the user: laws in libraries, tables of other programs, scripts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/scene/reader.hpp"
#include "io/scene/scene.hpp"
#include "materials/interface/law_variant.hpp"

namespace talus::files_of_the_user_test {
namespace {

using testing::ElementsAre;

const std::filesystem::path folder = std::filesystem::path(TALUS_SOURCE_DIR) / "tests/io/scenes";

TEST(SceneWithFilesOfTheUser, ReadsTheTableThatABodyStartsWith)
{
  const Scene s = read_scene(folder / "shapes.yaml");
  EXPECT_FALSE(s.bodies.at(1).initial.has_value());
  const StartStateSpec start = s.bodies.at(0).initial.value();
  EXPECT_EQ(start.table, "states/fe.csv");
  EXPECT_EQ(start.sign, StressSign::compression_positive);
  EXPECT_EQ(start.unit, StressUnit::kPa);
  EXPECT_EQ(start.stress, StressMeant::effective);
  EXPECT_EQ(start.data, PointsOf::cells);
  EXPECT_EQ(start.select.value().column, "material");
  EXPECT_EQ(start.select.value().value, "2");
  EXPECT_EQ(start.reach, 1.5);
  EXPECT_EQ(start.velocity, Carried::zero);
  EXPECT_EQ(start.displacement, Carried::keep);
}

TEST(SceneWithFilesOfTheUser, ReadsItsScript)
{
  const ScriptSpec script = read_scene(folder / "plane.yaml").script.value();
  EXPECT_EQ(script.file, "hooks.py");
  EXPECT_EQ(script.every, 20);
  EXPECT_FALSE(read_scene(folder / "solid.yaml").script);
  EXPECT_EQ(ScriptSpec().every, 1);
}

TEST(SceneWithFilesOfTheUser, ReadsLawsOfTheUserWithoutTheirLibraries)
{
  const Scene s = read_scene(folder / "own_laws.yaml", {}, Libraries::closed);
  const auto& own = std::get<LawBySymbol>(choices_of(s.materials.at(0).law));
  EXPECT_EQ(own.library, "laws/libsoil.so");
  EXPECT_EQ(own.symbol, "soil");
  EXPECT_TRUE(own.serial);
  ASSERT_EQ(own.parameters.all.size(), 2U);
  EXPECT_EQ(own.parameters.all[1].name, "cohesion");
  EXPECT_EQ(*own.parameters.find("cohesion"), 5e3);
  EXPECT_FALSE(s.materials.at(0).law.is_open());
  const auto& umat = std::get<UmatLaw>(choices_of(s.materials.at(1).law));
  EXPECT_THAT(umat.constants, ElementsAre(1e7, 0.3));
  EXPECT_EQ(umat.depvar, 2);
  EXPECT_THAT(umat.initial_statev, ElementsAre(0, 1));
  EXPECT_THROW(s.materials.at(0).law.model(), Error);
}

}  // namespace
}  // namespace talus::files_of_the_user_test
