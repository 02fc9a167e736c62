// Words of a command line to settings, and everything that is wrong with them at once.
#include "io/pictures/settings/picture_settings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.hpp"

namespace talus::picture_settings_test {
namespace {

using render::parse_picture;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const render::RunFacts flat{2, 21, {{"velocity", 3}, {"stress", 6}, {"plastic_strain", 1}}};
const render::RunFacts solid{3, 21, flat.fields};

std::vector<std::string> problems_of(std::vector<std::string> words, const render::RunFacts& facts = flat)
{
  words.insert(words.begin(), "run");
  std::vector<std::string> problems;
  render::check(parse_picture(words, problems), facts, problems);
  return problems;
}

std::vector<std::size_t> frames(const std::string& word)
{
  std::vector<std::string> problems;
  const std::vector<std::string> words{"run", "--frames", word};
  return render::chosen(parse_picture(words, problems).frames, 6);
}

TEST(PictureSettings, FramesAreOneOrAFewOrAll)
{
  EXPECT_THAT(frames("last"), ElementsAre(5));
  EXPECT_THAT(frames("first"), ElementsAre(0));
  EXPECT_THAT(frames("3"), ElementsAre(3));
  EXPECT_THAT(frames("all"), ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_THAT(frames("1:4"), ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(frames("1:last:2"), ElementsAre(1, 3, 5));
  EXPECT_THAT(frames("::4"), ElementsAre(0, 4));
  EXPECT_THAT(frames("1::18446744073709551615"), ElementsAre(1));
}

TEST(PictureSettings, WhatIsRightIsTaken)
{
  EXPECT_THAT(problems_of({"--field", "stress:xy", "--range", "-1", "2.5", "--window", "0", "0", "1", "1", "--clip", "y", "3", "--map",
                           "coolwarm"}),
              IsEmpty());
  EXPECT_THAT(problems_of({"--view", "top", "--look-at", "1", "2", "-3", "--zoom", "2", "--orthographic"}, solid), IsEmpty());
}

TEST(PictureSettings, HelpOffersTheWordsThatAreUnderstood)
{
  const auto offered = [](std::string_view name, const auto& words) {
    const auto options = render::Settings::options();
    const auto option = std::find_if(options.begin(), options.end(), [&](const auto& one) { return one.name == name; });
    ASSERT_NE(option, options.end()) << name;
    EXPECT_THAT(std::string(option->values), HasSubstr(fmt::format("{{{}}}", fmt::join(words, ",")))) << name;
  };
  offered("--map", enum_names(render::Map{}));
  offered("--view", enum_names(render::NamedView{}));
  offered("--mesh", enum_names(render::MeshLines{}));
}

TEST(PictureSettings, EverythingWrongIsSaidAtOnce)
{
  EXPECT_THAT(
      problems_of({"--field", "velocty", "--map", "virids", "--size", "10x10", "--frames", "1:x", "--clip", "w", "3", "--zom", "2"}),
      testing::UnorderedElementsAre(HasSubstr("--field: the run has no particle field \"velocty\" — did you mean \"velocity\"?"),
                                    HasSubstr("--map: unknown \"virids\" — did you mean \"viridis\"?"),
                                    HasSubstr("--size: 10 is outside 200 to 10000 pixels"), HasSubstr("--frames: \"x\" is not a number"),
                                    HasSubstr("--clip: wanted are x, y or z and an offset"),
                                    HasSubstr("unknown option --zom — did you mean \"--zoom\"?")));
}

TEST(PictureSettings, WordsOfTheSceneAreTakenAsTheyAre)
{
  for (const std::string word : {"[a, b]", "{}", "--log", "a = b", ""}) {
    std::vector<std::string> problems;
    const std::vector<std::string> picture{"run", "--title", word, "--size", "300x200"},
        surface{"run", "--out", "a.ply", "--body", "0", word, "--body", "1", "b"};
    EXPECT_EQ(parse_picture(picture, problems).title, word);
    const auto bodies = render::parse_surface(surface, problems).bodies;
    ASSERT_EQ(bodies.size(), 2U) << word;
    EXPECT_EQ(bodies[0].name, word);
    EXPECT_EQ(bodies[1].number, 1);
    EXPECT_THAT(problems, IsEmpty()) << word;
  }
}

TEST(PictureSettings, TooManyWordsAreToldWithTheirOption)
{
  EXPECT_THAT(problems_of({"--window", "0", "0", "1", "1", "5"}), ElementsAre(HasSubstr("--window: At Most 4 required but received 5")));
  EXPECT_THAT(problems_of({"--map", "viridis", "cividis"}), ElementsAre(HasSubstr("--map: At Most 1 required")));
}

TEST(PictureSettings, WhatTheRunDoesNotHaveIsRefused)
{
  EXPECT_THAT(problems_of({"--view", "front"}), ElementsAre(HasSubstr("--view: the run is 2-D")));
  EXPECT_THAT(problems_of({"--window", "0", "0", "1", "1"}, solid), ElementsAre(HasSubstr("--window: it is for 2-D")));
  EXPECT_THAT(problems_of({"--look-at", "1", "2"}, solid), ElementsAre(HasSubstr("a point of a 3-D run has 3 coordinates")));
  EXPECT_THAT(problems_of({"--frames", "21"}), ElementsAre(HasSubstr("there is no frame 21: the run has frames 0 to 20")));
  EXPECT_THAT(problems_of({"--field", "stress:yx"}), ElementsAre(HasSubstr("no component \"yx\"; it has xx, yy, zz, xy, yz or xz")));
  EXPECT_THAT(problems_of({"--field", "plastic_strain:x"}), ElementsAre(HasSubstr("is one number")));
  EXPECT_THAT(problems_of({"--out", "a.png", "--frames", "all"}), ElementsAre(HasSubstr("several frames need a folder")));
  EXPECT_THAT(problems_of({"--log", "--range", "0", "1"}), ElementsAre(HasSubstr("--log: a range from 0 has no logarithm")));
}

TEST(SurfaceSettings, FormatsAreThoseThatHoldWhatIsAskedFor)
{
  const auto problems = [](std::vector<std::string> words, const render::RunFacts& facts) {
    words.insert(words.begin(), "run");
    std::vector<std::string> found;
    render::check(render::parse_surface(words, found), facts, found);
    return found;
  };
  EXPECT_THAT(problems({"--out", "a.ply", "--field", "velocity"}, solid), IsEmpty());
  EXPECT_THAT(problems({"--out", "a.obj"}, flat), IsEmpty());
  EXPECT_THAT(problems({}, solid), ElementsAre(HasSubstr("--out: the file is missing")));
  EXPECT_THAT(problems({"--out", "a.vtk"}, solid), ElementsAre(HasSubstr("should end in .ply, .stl or .obj")));
  EXPECT_THAT(problems({"--out", "a.stl"}, flat), ElementsAre(HasSubstr(".stl knows no lines; .obj does")));
  EXPECT_THAT(
      problems({"--out", "a.stl", "--field", "velocity", "--level", "1", "--spacing", "0"}, solid),
      ElementsAre(HasSubstr("--spacing: 0 is not positive"), HasSubstr("only .ply has colours"), HasSubstr("--level: 1 is not below 1")));
}

}  // namespace
}  // namespace talus::picture_settings_test
