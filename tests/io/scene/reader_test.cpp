// Bad scenes and their exact messages; files that are no scenes; overrides; what YAML has and scenes do not.
#include "io/scene/reader.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <random>
#include <sstream>

#include "materials/law_variant.hpp"
#include "tests/io/scratch_folder.hpp"

namespace talus::reader_test {

namespace {

using testing::HasSubstr;
using testing::StartsWith;

const std::filesystem::path folder = std::filesystem::path(TALUS_SOURCE_DIR) / "tests/io";

std::string text_of(const std::filesystem::path& file)
{
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::filesystem::path write(const std::filesystem::path& file, const std::string& text)
{
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

/// The message of a scene that must be refused.
std::string message(const std::filesystem::path& file, const std::vector<std::string>& overrides = {})
{
  try {
    read_scene(file, overrides);
  } catch (const SceneErrors& errors) {
    return errors.what();
  }
  ADD_FAILURE() << file << " was read without a complaint";
  return "";
}

std::string without(std::string text, const std::string& part)
{
  for (auto at = text.find(part); at != text.npos; at = text.find(part))
    text.erase(at, part.size());
  return text;
}

std::vector<std::string> names_of_bad_scenes()
{
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "bad_scenes"))
    if (entry.path().extension() == ".yaml")
      names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

class BadScene : public testing::TestWithParam<std::string> {};

TEST_P(BadScene, HasExactlyTheExpectedMessage)
{
  const auto file = folder / "bad_scenes" / (GetParam() + ".yaml");
  const std::string shown = without(message(file), (folder / "bad_scenes").string() + "/");
  EXPECT_EQ(shown + "\n", text_of(folder / "bad_scenes" / (GetParam() + ".expected")));
}
INSTANTIATE_TEST_SUITE_P(Reader, BadScene, testing::ValuesIn(names_of_bad_scenes()), [](const auto& param) { return param.param; });

TEST(Reader, KnowsAtLeastTwoHundredKindsOfBadScenes) { EXPECT_GE(names_of_bad_scenes().size(), 200U); }

TEST(Reader, RefusesAFileThatDoesNotExist)
{
  EXPECT_EQ(message("nowhere/scene.yaml"), "nowhere/scene.yaml: error: there is no such file\n1 error, nothing was run.");
}

TEST(Reader, RefusesAFolder)
{
  const ScratchFolder scratch;
  EXPECT_THAT(message(scratch.path()), HasSubstr("error: this is a folder, not a file"));
}

TEST(Reader, RefusesADevice) { EXPECT_THAT(message("/dev/zero"), HasSubstr("error: this is not an ordinary file")); }

TEST(Reader, RefusesAFileTooLargeToBeAScene)
{
  const ScratchFolder scratch;
  EXPECT_THAT(message(write(scratch / "large.yaml", std::string(4'000'001, '#'))),
              HasSubstr("error: the file has 4 MB; at most 4 MB are read"));
}

TEST(Reader, RefusesAMillionBracketsQuickly)
{
  const ScratchFolder scratch;
  EXPECT_THAT(message(write(scratch / "brackets.yaml", "title: " + std::string(1'000'000, '['))),
              HasSubstr("more than 40 lists and mappings inside each other"));
  EXPECT_THAT(message(write(scratch / "braces.yaml", std::string(1'000'000, '{'))),
              HasSubstr("more than 40 lists and mappings inside each other"));
}

TEST(Reader, StopsAfterAHundredErrors)
{
  const ScratchFolder scratch;
  std::string text;
  for (int i = 0; i < 100'000; ++i)
    text += fmt::format("k{}: 1\n", i);
  const std::string shown = message(write(scratch / "many.yaml", text));
  EXPECT_THAT(shown, HasSubstr("more errors follow"));
  EXPECT_THAT(shown, testing::EndsWith("101 errors, nothing was run."));
}

TEST(Reader, AcceptsByteOrderMarkAndLinesOfWindows)
{
  const ScratchFolder scratch;
  const std::string plain = text_of(folder / "scenes/plane.yaml");
  std::string other = "\xEF\xBB\xBF";
  for (const char c : plain)
    other += c == '\n' ? "\r\n" : std::string(1, c);
  const Scene scene = read_scene(write(scratch / "scene.yaml", other));
  EXPECT_EQ(scene.text, plain);
  EXPECT_EQ(scene.bodies.at(0).where.line, read_scene(folder / "scenes/plane.yaml").bodies.at(0).where.line);
}

TEST(Reader, OverridesReplaceValues)
{
  const std::vector<std::string> overrides{"bodies[0].particles_per_cell=8", "loads[0].acceleration=[1, -2]", "title=a = b",
                                           "materials[0].cohesion=7e3"};
  const Scene scene = read_scene(folder / "scenes/plane.yaml", overrides);
  EXPECT_EQ(scene.bodies.at(0).particles_per_cell, 8);
  EXPECT_EQ(std::get<GravitySpec>(scene.loads.at(0)).acceleration, (std::vector<Real>{1, -2}));
  EXPECT_EQ(scene.title, "a = b");
  EXPECT_EQ(std::get<DruckerPrager>(choices_of(scene.materials.at(0).law)).cohesion, 7e3);
}

TEST(Reader, OverridesAddMissingMappings)
{
  const Scene scene =
      read_scene(folder / "scenes/smallest.yaml", std::vector<std::string>{"transfer.scheme=tpic", "outputs.history.every=0.5"});
  EXPECT_EQ(scene.transfer.scheme, TransferScheme::tpic);
  EXPECT_EQ(scene.outputs.history.value().every, 0.5);
}

TEST(Reader, LaterOverridesWin)
{
  EXPECT_EQ(read_scene(folder / "scenes/smallest.yaml", std::vector<std::string>{"time.end=2", "time.end=3"}).time.end, 3);
}

TEST(Reader, ErrorsInOverridesQuoteTheOverride)
{
  const auto file = folder / "scenes/smallest.yaml";
  const auto complaint = [&](const std::string& text) { return message(file, {text}); };
  const std::string end = "\n1 error, nothing was run.";
  EXPECT_EQ(complaint("time.end=2x"), "--set time.end=2x: error: time.end: \"2x\" is not a number" + end);
  EXPECT_EQ(complaint("time.end=-1"), "--set time.end=-1: error: time.end: -1 must be > 0 s" + end);
  EXPECT_EQ(complaint("time.end="), "--set time.end=: error: time.end: the value is missing, expected a number" + end);
  EXPECT_EQ(complaint("time.ned=1"), "--set time.ned=1: error: time: unknown key \"ned\" — did you mean \"end\"?" + end);
  EXPECT_EQ(complaint("time.end"), "--set time.end: error: write it as key=value" + end);
  EXPECT_EQ(complaint("=3"), "--set =3: error: \"\" is no path of keys such as time.end or bodies[0].material" + end);
  EXPECT_THAT(complaint("a..b=3"), StartsWith("--set a..b=3: error: \"a..b\" is no path of keys"));
  EXPECT_THAT(complaint("bodies[0=3"), StartsWith("--set bodies[0=3: error: \"bodies[0\" is no path of keys"));
  EXPECT_THAT(complaint("bodies[0]name=3"), StartsWith("--set bodies[0]name=3: error: \"bodies[0]name\" is no path of keys"));
  EXPECT_THAT(complaint("bodies[99999999999999999999]=3"), HasSubstr("is no path of keys"));
  EXPECT_EQ(complaint("bodies[1].name=a"),
            "--set bodies[1].name=a: error: bodies: there is no [1]: the list has 1 entries, counted from 0" + end);
  EXPECT_EQ(complaint("title[0]=a"), "--set title[0]=a: error: title: there is no [0]: it is not a list" + end);
  EXPECT_EQ(complaint("title.name=a"), "--set title.name=a: error: title: there is no key \"name\": it is not a mapping" + end);
  EXPECT_THAT(complaint("title=[a"), StartsWith("--set title=[a: error: this is not YAML"));
  EXPECT_EQ(complaint("title=\"a"), "--set title=\"a: error: this is not YAML: illegal EOF in scalar; a quote is not closed" + end);
  EXPECT_EQ(complaint("title=*a"), "--set title=*a: error: this is not YAML: the referenced anchor is not defined" + end);
  EXPECT_EQ(complaint("time={end: 1, end: 2}"), "--set time={end: 1, end: 2}: error: duplicate key \"end\"" + end);
}

TEST(Reader, PointsToEveryProblemOnce)
{
  try {
    read_scene(folder / "bad_scenes/many_at_once.yaml");
    FAIL();
  } catch (const SceneErrors& errors) {
    const auto& list = errors.problems();
    ASSERT_EQ(list.size(), 9U);
    EXPECT_TRUE(std::is_sorted(list.begin(), list.end(), [](const SceneError& a, const SceneError& b) {
      return std::pair(a.where.line, a.where.column) < std::pair(b.where.line, b.where.column);
    }));
    EXPECT_EQ(list[5].where.path, "materials[0] \"clay\".poisson_ratio");
    EXPECT_EQ(list[5].where.line, 10);
    EXPECT_EQ(list[5].source_line.substr(static_cast<std::size_t>(list[5].where.column) - 1, 3), "0.7");
  }
}

TEST(Reader, ReadsAPointTest)
{
  const ScratchFolder scratch;
  const auto file = write(scratch / "triaxial.yaml", R"(
material: {law: linear_elastic, density: 2000, youngs_modulus: 1e7, poisson_ratio: 0.25}
initial_stress: [-1e5, -1e5, -1e5, 0, 0, 0]
path:
  - steps: 50
    time: 2
    controls:
      xx: {quantity: stress, value: -1e5}
      yy: {quantity: stress, value: -1e5}
      zz: {quantity: strain_rate, value: -0.01}
)");
  const PointTest test = read_point_path(file);
  EXPECT_EQ(std::get<LinearElastic>(choices_of(test.material.law)).youngs_modulus, 1e7);
  EXPECT_EQ(test.initial_stress, (std::array<Real, 6>{-1e5, -1e5, -1e5, 0, 0, 0}));
  ASSERT_EQ(test.path.size(), 1U);
  EXPECT_EQ(test.path[0].steps, 50);
  EXPECT_EQ(test.path[0].controls.xx.value().quantity, Controlled::stress);
  EXPECT_EQ(test.path[0].controls.zz.value().value, -0.01);
  EXPECT_FALSE(test.path[0].controls.xy.has_value());
  EXPECT_EQ(test.path[0].where.line, 5);
  EXPECT_THROW(read_point_path(file, std::vector<std::string>{"initial_stress=[1, 2]"}), SceneErrors);
}

/// Tokens of a text: words, numbers, blanks, line ends and every other character by itself.
std::vector<std::string> tokens_of(const std::string& text)
{
  std::vector<std::string> tokens;
  const auto kind = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.' ? 1 : c == ' ' ? 2 : 0; };
  for (const char c : text)
    if (!tokens.empty() && kind(c) != 0 && kind(tokens.back().back()) == kind(c))
      tokens.back() += c;
    else
      tokens.emplace_back(1, c);
  return tokens;
}

TEST(Reader, AnswersEveryDamagedSceneWithASceneOrWithErrors)
{
  const ScratchFolder scratch;
  const std::vector<std::string> strange{"\t", ":", "- ",  "[",  "]",     "{",  "}", "&a ",   "*a",   "<<",   "!!int ",
                                         "\"", "'", "|\n", "\n", "---\n", "? ", "~", "1e999", ".nan", "\xFF", std::string(1, '\0'),
                                         "%",  "#"};
  std::mt19937 random(20240611);
  int read = 0, refused = 0;
  for (const std::string name : {"plane.yaml", "solid.yaml", "terrain.yaml"}) {
    const auto good = tokens_of(text_of(folder / "scenes" / name));
    for (int mutant = 0; mutant < 1500; ++mutant) {
      auto tokens = good;
      const auto pick = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
      for (std::size_t changes = 1 + pick(3); changes > 0; --changes) {
        const std::size_t at = pick(tokens.size());
        switch (pick(4)) {
          case 0: tokens.erase(tokens.begin() + static_cast<std::ptrdiff_t>(at)); break;
          case 1: tokens.insert(tokens.begin() + static_cast<std::ptrdiff_t>(at), tokens[at]); break;
          case 2: tokens[at] = good[pick(good.size())]; break;
          default: tokens[at] = strange[pick(strange.size())];
        }
      }
      std::string text;
      for (const auto& token : tokens)
        text += token;
      try {
        read_scene(write(scratch / "mutant.yaml", text));
        ++read;
      } catch (const SceneErrors& errors) {
        ++refused;
        ASSERT_FALSE(errors.problems().empty()) << text;
        for (const SceneError& problem : errors.problems())
          ASSERT_THAT(problem.where.file, testing::EndsWith("mutant.yaml")) << text;
      }
    }
  }
  // Some damage is none (blanks, comments, other numbers), most is.
  EXPECT_GT(read, 100);
  EXPECT_GT(refused, 1000);
}

}  // namespace

}  // namespace talus::reader_test
