// Tables of points: what names, units and signs mean, and what is refused with its line.
#include "io/points/start_points.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "core/error.hpp"
#include "io/files/atomic_file.hpp"
#include "io/points/column_names.hpp"
#include "tests/io/scratch_folder.hpp"

namespace talus::start_points_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string plain = "x,y,stress_xx,stress_yy,stress_zz,stress_xy\n0,0,-1,-2,-3,4\n1,0,-1,-2,-3,4\n\n# said\n0,1,-5,-6,-7,8\n";

class Points : public testing::Test {
 protected:
  StartPoints read(const std::string& text, const StartStateSpec& spec = {}, int dimension = 2,
                   const std::vector<HistoryVariable>& history = {}) const
  {
    write_whole(folder_ / "state.csv", text);
    return read_start_points(spec, folder_ / "state.csv", dimension, history);
  }
  std::string refusal(const std::string& text, const StartStateSpec& spec = {}, int dimension = 2,
                      const std::vector<HistoryVariable>& history = {}) const
  {
    try {
      read(text, spec, dimension, history);
    } catch (const SceneErrors& wrong) {
      std::string all;
      for (const SceneError& problem : wrong.problems())
        all += (problem.where.line > 0 ? std::to_string(problem.where.line) : std::string("-")) + ": " + problem.message + "\n";
      return all;
    }
    return "";
  }
  ScratchFolder folder_;
};

TEST_F(Points, ReadsATable)
{
  const StartPoints points = read(plain);
  ASSERT_EQ(points.x.size(), 3U);
  EXPECT_THAT(points.x[2], ElementsAre(0, 1, 0));
  EXPECT_THAT(points.stress[2], ElementsAre(-5, -6, -7, 8, 0, 0));
  EXPECT_FALSE(points.is_effective);
  EXPECT_TRUE(points.pore.empty());
}

TEST_F(Points, TurnsUnitsAndSigns)
{
  const StartPoints points =
      read("X [cm];Y [cm];\"S11 [kPa]\";S22;S33 (N/m^2);S12;pore pressure\n0;0;1;2;3;4;9\n100;0;1;2;3;4;9\n0;100;1;2;3;4;9\n",
           {.sign = StressSign::compression_positive, .unit = StressUnit::MPa});
  EXPECT_THAT(points.x[1], ElementsAre(1, 0, 0));
  EXPECT_THAT(points.stress[0], ElementsAre(-1e3, -2e6, -3, -4e6, 0, 0));
  EXPECT_THAT(points.pore, ElementsAre(9e6, 9e6, 9e6)) << "a pressure is one in every convention";
}

TEST_F(Points, KnowsTheNamesOfOtherPrograms)
{
  const auto is = [](std::string_view name, PointQuantity quantity, std::size_t component) {
    const ColumnMeaning meaning = meaning_of(name);
    EXPECT_EQ(static_cast<int>(meaning.quantity), static_cast<int>(quantity)) << name;
    EXPECT_EQ(meaning.component, component) << name;
  };
  for (const auto* name : {"x", "X", "position_x", "Points:0", "Points_0", "COORD1", "coord_x"})
    is(name, PointQuantity::position, 0);
  for (const auto* name : {"stress_xy", "sigma_xy", "S12", "S.S12", "sxy", "tau_xy", "\u03c3_xy", "\u03c4xy", "stress:3", "Stress YX"})
    is(name, PointQuantity::stress, 3);
  for (const auto* name : {"effective_stress_yy", "sigma'_yy", "\u03c3'yy", "\u03c3\u2032_yy", "sigma_eff_yy"})
    is(name, PointQuantity::effective_stress, 1);
  is("sigma_z", PointQuantity::stress, 2);
  is("U2", PointQuantity::displacement, 1);
  is("displacement_y", PointQuantity::displacement, 1);
  is("displacement:1", PointQuantity::displacement, 1);
  is("velocity_z", PointQuantity::velocity, 2);
  is("Pore Pressure", PointQuantity::pore_pressure, 0);
  for (const auto* name : {"id", "s1", "plastic_strain", "mass", "stress", "material"})
    is(name, PointQuantity::other, 0);
}

TEST_F(Points, TheNumbersOfComponentsCountAsTheirProgramDoes)
{
  const auto components = [](const std::vector<std::string>& names) {
    std::vector<int> all;
    for (const ColumnMeaning& meaning : meanings_of(names))
      all.push_back(meaning.quantity == PointQuantity::other ? -1 : static_cast<int>(meaning.component));
    return all;
  };
  for (const std::string base : {"velocity", "displacement", "Points", "coordinates"})
    for (const std::string separator : {"_", ":"})
      EXPECT_THAT(components({base + separator + "0", base + separator + "1", base + separator + "2"}), ElementsAre(0, 1, 2)) << base;
  for (const std::string base : {"velocity_", "U", "coordinates "})
    EXPECT_THAT(components({base + "1", base + "2", base + "3"}), ElementsAre(0, 1, 2)) << base;
  EXPECT_THAT(components({"velocity_0", "velocity_1", "velocity_2", "U1", "U2", "V0"}), ElementsAre(0, 1, 2, 0, 1, -1));
  EXPECT_THAT(components({"stress:0", "stress:1", "stress:2", "stress:3", "stress:4", "stress:5"}), ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_THAT(components({"stress_0", "stress_1", "stress_2", "stress_3"}), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(components({"stress:0", "stress:1", "stress:2", "stress:3", "stress:4", "stress:5", "stress:6", "stress:7", "stress:8"}),
              ElementsAre(0, 3, 5, 3, 1, 4, 5, 4, 2));
  EXPECT_THAT(components({"s_1", "s_2", "s_3"}), ElementsAre(-1, -1, -1)) << "principal stresses, perhaps";
}

TEST_F(Points, ATensorWithNineNumbersIsSymmetric)
{
  const std::string names = "x,y,s:0,s:1,s:2,s:3,s:4,s:5,s:6,s:7,s:8\n", rest = "1,0,1,0,0,0,1,0,0,0,1\n0,1,1,0,0,0,1,0,0,0,1\n";
  const StartPoints points = read(names + "0,0,-1,4,5,4,-2,6,5,6,-3\n" + rest);
  EXPECT_THAT(points.stress[0], ElementsAre(-1, -2, -3, 4, 0, 0));
  EXPECT_EQ(refusal(names + "0,0,-1,4,5,3,-2,6,5,6,-3\n" + rest),
            "2: s:1 is 4 and s:3 is 3, in all at 1 of 3 points: a tensor of stress is symmetric\n");
  EXPECT_THAT(read("x,y,sxx,syy,szz,syx\n0,0,1,2,3,4\n1,0,1,1,1,0\n0,1,1,1,1,0\n").stress[0], ElementsAre(1, 2, 3, 4, 0, 0));
}

TEST_F(Points, WhatTheLawRemembersIsInItsUnit)
{
  const std::vector<HistoryVariable> history{{"preconsolidation", "Pa", ""}, {"plastic_strain", "-", ""}, {"age", "d", ""}};
  const auto table = [](const std::string& pressure, const std::string& strain, const std::string& age) {
    return fmt::format(
        "x,y,sxx,syy,szz,sxy,preconsolidation{},plastic_strain{},age{}\n0,0,0,0,0,0,5,6,7\n1,0,0,0,0,0,5,6,7\n0,1,0,0,0,0,5,6,7\n",
        pressure, strain, age);
  };
  const auto first = [&](const std::string& text) {
    const StartPoints points = read(text, {}, 2, history);
    EXPECT_EQ(points.history.size(), 3U);
    std::vector<Real> values;
    for (const auto& [key, column] : points.history)
      values.push_back(column.front());
    return values;
  };
  EXPECT_THAT(first(table("", "", "")), ElementsAre(5, 6, 7));
  EXPECT_THAT(first(table(" [kPa]", " [%]", " [d]")), ElementsAre(5e3, 0.06, 7));
  EXPECT_THAT(first(table(" [MPa]", " [-]", "")), ElementsAre(5e6, 6, 7));
  const std::string wrong = refusal(table(" [bar]", " [m]", " [s]"), {}, 2, history);
  EXPECT_THAT(wrong,
              HasSubstr("1: column \"preconsolidation\" has the unit \"bar\"; known for this history variable: Pa, kPa, MPa, GPa, N/m^2"));
  EXPECT_THAT(wrong, HasSubstr("1: column \"plastic_strain\" has the unit \"m\"; known for this history variable: -, 1 and %"));
  EXPECT_THAT(wrong, HasSubstr("1: column \"age\" has the unit \"s\"; known for this history variable: d"));
}

TEST_F(Points, TakesWhatTheLawRemembersAndTheBodyMoves)
{
  const StartPoints points = read(
      "x y sxx syy szz sxy vx vy ux uy Plastic-Strain word\n0 0 1 1 1 0 3 4 5 6 0.25 a\n1 0 1 1 1 0 3 4 5 6 0.25 b\n0 1 1 1 1 0 3 4 5 6 "
      "0.5 c\n",
      {.displacement = Carried::keep}, 2, {{"plastic_strain", "-", ""}, {"plastic_work", "J/m^3", ""}});
  EXPECT_THAT(points.velocity[0], ElementsAre(3, 4, 0));
  EXPECT_THAT(points.displacement[0], ElementsAre(5, 6, 0));
  ASSERT_EQ(points.history.size(), 1U);
  EXPECT_EQ(points.history[0].first, "plastic_strain");
  EXPECT_THAT(points.history[0].second, ElementsAre(0.25, 0.25, 0.5));
  EXPECT_THAT(points.unused, ElementsAre("word"));
}

TEST_F(Points, SelectsThoseOfABody)
{
  const std::string text =
      "x,y,sxx,syy,szz,sxy,material\n0,0,1,1,1,0,1\n1,0,1,1,1,0,1\n0,1,1,1,1,0,1.0\n0,1,2,2,2,0,2\n1,1,nan,2,2,0,clay\n";
  EXPECT_EQ(read(text, {.select = SelectSpec{"material", "1", {}}}).x.size(), 3U);
  EXPECT_THAT(refusal(text, {.select = SelectSpec{"material", "3", {}}}),
              HasSubstr("has \"3\" in column \"material\"; there are 1, 2, clay"));
  EXPECT_THAT(refusal(text, {.select = SelectSpec{"soil", "3", {}}}), HasSubstr("has no column \"soil\"; it has x, y, sxx"));
  EXPECT_THAT(refusal(text), HasSubstr("6: sxx is \"nan\", which is no finite number"));
}

TEST_F(Points, PointsAtOnePlaceHaveOneValue)
{
  EXPECT_EQ(read(plain + "1,0,-1,-2,-3,4\n").merged, 1);
  EXPECT_EQ(
      refusal(plain + "1,0,-1,-2,-3.5,4\n"),
      "7: it lies where that of line 3 does, (1, 0), and has other values: average them, give values of cells (data), or tell materials "
      "apart (select)\n");
}

/// A stress of some kPa is larger by far than every velocity.
TEST_F(Points, QuantitiesOfPointsAtOnePlaceAreComparedByThemselves)
{
  const std::string names = "x,y,sxx,syy,szz,sxy,pore_pressure,vx,vy,ux,uy,plastic_strain\n";
  const std::string rest = "1,0,-1e5,-1e5,-1e5,0,1e4,2,0,0.1,0,0.02\n0,1,-1e5,-1e5,-1e5,0,1e4,2,0,0.1,0,0.02\n";
  const auto wrong = [&](const std::string& twice) {
    return refusal(names + rest + "0,0,-1e5,-1e5,-1e5,0,1e4,0,0,0,0,0\n" + twice, {.displacement = Carried::keep}, 2,
                   {{"plastic_strain", "-", ""}});
  };
  EXPECT_EQ(wrong("0,0,-1e5,-1e5,-1e5,1e-2,1e4,1e-7,0,0,1e-9,1e-9\n"), "") << "rounding";
  EXPECT_THAT(wrong("0,0,-1e5,-1e5,-1e5,0,1e4,1e-3,0,0,0,0\n"), HasSubstr("5: it lies where that of line 4 does"));
  EXPECT_THAT(wrong("0,0,-1e5,-1e5,-1e5,0,1e4,0,0,0,1e-4,0\n"), HasSubstr("5: it lies where that of line 4 does"));
  EXPECT_THAT(wrong("0,0,-1e5,-1e5,-1e5,0,1e4,0,0,0,0,1e-3\n"), HasSubstr("5: it lies where that of line 4 does"));
  EXPECT_THAT(wrong("0,0,-1e5,-1e5,-1e5,1,1e4,0,0,0,0,0\n"), HasSubstr("5: it lies where that of line 4 does"));
}

TEST_F(Points, WhatIsMissingOrWrongIsSaidWithItsLine)
{
  EXPECT_EQ(refusal("x,y,sxx,syy,sxy\n0,0,1,1,1\n"),
            "1: column stress_zz is missing, the stress out of the plane; there are x, y, sxx, syy, sxy\n");
  EXPECT_THAT(refusal(plain, {}, 3), HasSubstr("1: column z is missing; there are"));
  EXPECT_THAT(refusal(plain, {}, 3), HasSubstr("1: columns stress_yz, stress_xz are missing"));
  EXPECT_THAT(refusal("1,2,3\n4,5,6\n"), HasSubstr("1: a line of names is needed before the numbers"));
  EXPECT_EQ(refusal(plain + "1,2\n"), "7: there are 2 entries, and 6 names in line 1\n");
  EXPECT_EQ(refusal(plain + "1,2,,0,0,inf\n"),
            "7: stress_xx is \"\", which is no finite number\n7: stress_xy is \"inf\", which is no finite number\n");
  EXPECT_THAT(refusal("x [ft]," + plain.substr(2)), HasSubstr("1: column \"x\" has the unit \"ft\"; known are m, km, cm and mm"));
  EXPECT_THAT(refusal("x,y,sxx,s11,syy,szz,sxy\n0,0,1,1,1,1,0\n"), HasSubstr("1: the columns \"sxx\" and \"s11\" have one meaning"));
  EXPECT_EQ(refusal("x,y,sxx,syy,szz,sxy\n0,0,1,1,1,0\n1,0,1,1,1,0\n"), "-: there are 2 points: 3 or more are needed, not on one line\n");
  EXPECT_EQ(refusal("# nothing\n"), "-: there is nothing in it\n");
  EXPECT_THAT(refusal(plain, {.displacement = Carried::keep}), HasSubstr("it has no columns of the displacement"));
  EXPECT_THROW(read_start_points({}, folder_ / "other.csv", 2, {}), EnvironmentError);
  EXPECT_THROW(read_start_points({}, folder_ / "other.vtk", 2, {}), EnvironmentError);
}

}  // namespace
}  // namespace talus::start_points_test
