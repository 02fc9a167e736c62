#include "io/scene/study.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "io/scene/reader.hpp"
#include "io/scene/study_samples.hpp"
#include "tests/io/scratch_folder.hpp"

namespace talus::study_test {

namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class StudyFile : public testing::Test {
 protected:
  ScratchFolder folder_;

  StudyFile() { std::ofstream(folder_ / "scene.yaml") << "title: any\n"; }
  Study read(const std::string& text) const
  {
    std::ofstream(folder_ / "study.yaml") << text;
    return read_study(folder_ / "study.yaml");
  }
  /// Messages without the folder.
  std::string message(const std::string& text) const
  {
    try {
      read(text);
      return "none";
    } catch (const SceneErrors& e) {
      std::string shown = e.what();
      const std::string path = folder_.path().string() + "/";
      for (auto at = shown.find(path); at != shown.npos; at = shown.find(path))
        shown.erase(at, path.size());
      return shown;
    }
  }
  static std::vector<std::string> changes(const Study& study)
  {
    std::vector<std::string> all;
    for (const StudyCase& one : cases_of(study)) {
      std::string words;
      for (const std::string& change : changes_of(study, one))
        words += (words.empty() ? "" : " ") + change;
      all.push_back(words);
    }
    return all;
  }
};

TEST_F(StudyFile, IsAGridUnlessItSaysRowsAndTheLastKeyVariesFastest)
{
  const std::string vary = "scene: scene.yaml\nvary:\n  time.end: [1, 2.50]\n  mesh.size: [0.1, 0.2]\n";
  EXPECT_THAT(changes(read(vary)), ElementsAre("time.end=1 mesh.size=0.1", "time.end=1 mesh.size=0.2", "time.end=2.50 mesh.size=0.1",
                                               "time.end=2.50 mesh.size=0.2"));
  EXPECT_THAT(changes(read(vary + "combine: rows\n")), ElementsAre("time.end=1 mesh.size=0.1", "time.end=2.50 mesh.size=0.2"));
}

TEST_F(StudyFile, SamplesFillEachPartOfEachDistributionOnce)
{
  const std::string text =
      "scene: scene.yaml\nvary:\n  a: {low: 10, high: 20}\n  b: {low: 0, mode: 1, high: 4}\ncombine: latin\nsamples: 10\n";
  const auto column = [&](const Study& study, std::size_t k) {
    std::vector<Real> values;
    for (const StudyCase& one : cases_of(study))
      values.push_back(std::stod(one[k].text));
    return values;
  };
  const Study study = read(text);
  std::vector<Real> a = column(study, 0), b = column(study, 1);
  ASSERT_EQ(a.size(), 10U);
  EXPECT_FALSE(std::is_sorted(a.begin(), a.end()));
  EXPECT_EQ(column(read(text + "seed: 1\n"), 0), a);
  EXPECT_NE(column(read(text + "seed: 2\n"), 0), a);
  EXPECT_EQ(column(read("scene: scene.yaml\nvary:\n  a: {low: 10, high: 20}\ncombine: latin\nsamples: 10\n"), 0), a)
      << "another key changes nothing";
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_GE(a[i], 10 + static_cast<Real>(i));
    EXPECT_LE(a[i], 11 + static_cast<Real>(i));
    const auto below = [](Real x) { return x < 1 ? x * x / 4 : 1 - (4 - x) * (4 - x) / 12; };  // share of the triangle up to x
    EXPECT_GE(below(b[i]), 0.1 * static_cast<Real>(i) - 1e-5);
    EXPECT_LE(below(b[i]), 0.1 * static_cast<Real>(i + 1) + 1e-5);
  }
}

TEST(StudySamples, QuantilesAreThoseOfTheDistributions)
{
  const Spread normal{.low = {}, .mode = {}, .high = {}, .mean = 5, .deviation = 2};
  EXPECT_NEAR(quantile(normal, 0.5), 5, 1e-12);
  EXPECT_NEAR(quantile(normal, 0.5 + 0.5 * std::erf(std::sqrt(0.5)) / std::erf(3 * std::sqrt(0.5))), 7, 1e-9);  // one deviation of three
  EXPECT_GE(quantile(normal, 1e-12), -1);
  const Spread cut{.low = 4, .mode = {}, .high = {}, .mean = 5, .deviation = 2};
  EXPECT_NEAR(quantile(cut, 1e-9), 4, 1e-6);
  const Spread triangle{.low = 1, .mode = 2, .high = 5, .mean = {}, .deviation = {}};
  EXPECT_NEAR(quantile(triangle, 0.25), 2, 1e-12);
  EXPECT_NEAR(quantile(triangle, 0.75), 5 - std::sqrt(0.25 * 4 * 3), 1e-12);
}

TEST_F(StudyFile, ATornadoVariesOneKeyAtATime)
{
  EXPECT_THAT(changes(read("scene: scene.yaml\nvary:\n  a: {low: 1, high: 2}\n  b: {mean: 10, deviation: 3}\ncombine: tornado\n")),
              ElementsAre("a=1.5 b=10", "a=1 b=10", "a=2 b=10", "a=1.5 b=7", "a=1.5 b=13"));
}

TEST_F(StudyFile, SaysWhatIsNoDistribution)
{
  const std::string shown = message(
      "scene: scene.yaml\nvary:\n  a: [1, 2]\n  b: {low: 2, high: 1}\n  c: {mean: 1}\n  d: {low: 1, mode: 3, high: 2}\n  e: {hihg: "
      "1}\ncombine: "
      "latin\n");
  for (const char* line :
       {"study.yaml:3:6: error: vary.a: expected a distribution, such as {low: 1, high: 2}",
        "study.yaml:4:6: error: vary.b: low 2 must be below high 1", "study.yaml:5:6: error: vary.c: mean and deviation belong together",
        "study.yaml:6:6: error: vary.d: mode 3 is not between low 1 and high 2",
        "study.yaml:7:7: error: vary.e: unknown key \"hihg\" — did you mean \"high\"?",
        "study.yaml:8:10: error: combine: latin needs samples"})
    EXPECT_THAT(shown, HasSubstr(line));
  EXPECT_THAT(message("scene: scene.yaml\nvary:\n  a: {low: 1, high: 2}\n"),
              HasSubstr("study.yaml:3:6: error: vary.a: a distribution is of combine: latin or tornado"));
  EXPECT_THAT(message("scene: scene.yaml\nvary:\n  a: [1]\nsamples: 3\n"),
              HasSubstr("study.yaml:4:10: error: samples: is of combine: latin"));
}

TEST_F(StudyFile, ValuesOfAnyKindAreWrittenAsSetTakesThem)
{
  const Study study = read(
      "scene: scene.yaml\nvary:\n  a:\n    - [0.5, \"x, \\\"y\\\"\"]\n    - {type: box, low: [0, 0]}\n    - plain words\n    - '1'\n    - "
      "true\n");
  EXPECT_THAT(changes(study),
              ElementsAre("a=[0.5, \"x, \\\"y\\\"\"]", "a={\"type\": box, \"low\": [0, 0]}", "a=plain words", "a=\"1\"", "a=true"));
}

TEST_F(StudyFile, KnowsWhereValuesAndNamesStand)
{
  const Study study = read("scene: scene.yaml\nvary: {time.end: [1, 2]}\ncollect: [steps, toe]\n");
  EXPECT_EQ(scene_of(study), folder_ / "scene.yaml");
  const SourceLocation& where = study.vary.at(0).values.at(1).at.where;
  EXPECT_EQ(where.line, 2);
  EXPECT_EQ(where.column, 22);
  EXPECT_EQ(where.path, "vary.time.end[1]");
  ASSERT_EQ(study.collect.size(), 2U);
  EXPECT_EQ(study.collect[1].text, "toe");
  EXPECT_EQ(study.collect[1].at.where.line, 3);
}

TEST_F(StudyFile, SaysAllThatIsWrongAtOnce)
{
  const std::string shown = message("scene: other.yaml\nvary:\n  a=b: [1]\n  time.end: 3\n  time.cfl: []\ncombine: gridd\ncolect: [a]\n");
  for (const char* line :
       {"study.yaml:1:8: error: scene: there is no file other.yaml", "study.yaml:3:3: error: vary.a=b: \"a=b\" is no path of keys",
        "study.yaml:4:13: error: vary.time.end: expected a list [..., ...], found a single value",
        "study.yaml:5:13: error: vary.time.cfl: the list is empty",
        "study.yaml:6:10: error: combine: unknown word \"gridd\" — did you mean \"grid\"?",
        "study.yaml:7:1: error: unknown key \"colect\" — did you mean \"collect\"?", "6 errors"})
    EXPECT_THAT(shown, HasSubstr(line));
}

TEST_F(StudyFile, RefusesWhatMakesNoCases)
{
  EXPECT_THAT(message("scene: scene.yaml\n"), HasSubstr("missing key \"vary\""));
  EXPECT_THAT(message("scene: scene.yaml\nvary:\n"), HasSubstr("the value is missing"));
  EXPECT_THAT(message("scene: scene.yaml\nvary: {}\n"), HasSubstr("study.yaml:2:7: error: vary: expected a mapping of keys"));
  EXPECT_THAT(message("scene: scene.yaml\nvary: [1, 2]\n"), HasSubstr("expected a mapping of keys"));
  EXPECT_THAT(message("vary: {a: [1]}\n"), HasSubstr("missing key \"scene\""));
}

TEST_F(StudyFile, RefusesRowsOfUnequalLengthAndCasesTwice)
{
  EXPECT_THAT(message("scene: scene.yaml\nvary:\n  a: [1, 2]\n  b: [1]\ncombine: rows\n"),
              HasSubstr("study.yaml:4:6: error: vary.b: has 1 values where a has 2"));
  EXPECT_THAT(message("scene: scene.yaml\nvary:\n  a: [1, 2, 1]\n"), HasSubstr("study.yaml:3:13: error: vary.a[2]: 1 stands here twice"));
  EXPECT_EQ(message("scene: scene.yaml\nvary:\n  a: [1, 1]\n  b: [1, 2]\ncombine: rows\n"), "none");
  std::string many = "[0";
  for (int i = 1; i < 101; ++i)
    many += ", " + std::to_string(i);
  EXPECT_THAT(message("scene: scene.yaml\nvary:\n  a: " + many + "]\n  b: " + many + "]\n"),
              HasSubstr("vary: these are more than 10000 cases"));
}

}  // namespace

}  // namespace talus::study_test
