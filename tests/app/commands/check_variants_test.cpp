// talus check --variants: many variants of a scene, checked together.
#include <gmock/gmock.h>

#include "tests/app/program.hpp"

namespace talus::variants_test {

namespace {

using testing::HasSubstr;
using testing::Not;

class CheckVariants : public Program {
 protected:
  void SetUp() override
  {
    write("block.yaml", block_scene("boundaries: [{type: fixed, on: y_min}]\ntime: {max_step: 1.0e-3, end: 0.01}\n"
                                    "outputs: {history: {every: 0.01, fronts: [{name: toe, direction: +x}]}}\n"));
  }
  Outcome check(const std::string& depth, const std::string& variants) const
  {
    write("variants.json", R"({"check": ")" + depth + R"(", "quick": false, "variants": [)" + variants + "]}");
    return talus("check block.yaml --variants variants.json");
  }
  /// The text of a key in a text of JSON.
  static std::string behind(const std::string& json, const std::string& key)
  {
    const auto begin = json.find('"' + key + "\":\"") + key.size() + 4;
    return json.substr(begin, json.find('"', begin) - begin);
  }
};

const std::string good = R"({"set": ["time.end=0.005"], "built_on": ""})";
const std::string wrong_key = R"({"set": ["materials[0].youngs_modulus=-1"], "built_on": ""})";
const std::string wrong_group = R"({"set": ["boundaries[0].on=z_min"], "built_on": ""})";

TEST_F(CheckVariants, HaveTheDigestsOfTheRuns)
{
  const Outcome outcome = check("models", good);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  ASSERT_EQ(talus("run block.yaml --quiet --threads 1 --out run --set time.end=0.005").code, 0);
  const std::string summary = read("run/summary.json");
  for (const char* key : {"scene_digest", "mesh_digest"})
    EXPECT_THAT(summary, HasSubstr(behind(outcome.out, key)));
  EXPECT_THAT(outcome.out, testing::AllOf(HasSubstr(R"("fronts":["toe"],"cells":128,"cell_size [m]":0.1767766)"),
                                          HasSubstr(R"("particles":96,"errors":[])")));
}

TEST_F(CheckVariants, SayWhatIsWrongWithEach)
{
  const Outcome outcome = check("models", good + ", " + wrong_key + ", " + wrong_group);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, testing::ContainsRegex("\"errors\":\\[\\]\\},.*must be > 0 Pa.*no node, facet or cell group"));
  EXPECT_THAT(outcome.out, HasSubstr(R"x("file":"--set materials[0].youngs_modulus=-1")x"));
}

TEST_F(CheckVariants, GoAsFarAsIsAsked)
{
  EXPECT_THAT(check("scenes", wrong_group).out, testing::AllOf(HasSubstr(R"("mesh_digest":"")"), HasSubstr(R"("errors":[])")));
  const std::string meshes = check("meshes", wrong_group).out;
  EXPECT_THAT(meshes, testing::AllOf(Not(HasSubstr(R"("mesh_digest":"")")), HasSubstr(R"("errors":[])")));
  const std::string known = R"({"set": ["boundaries[0].on=z_min"], "built_on": ")" + behind(meshes, "mesh_digest") + "\"}";
  EXPECT_THAT(check("models", known).out, HasSubstr(R"("errors":[])")) << "it was built before, on the same mesh";
  EXPECT_THAT(check("models", wrong_group).out, HasSubstr("z_min"));
}

TEST_F(CheckVariants, RefuseAFileOfOtherContents)
{
  write("variants.json", "{}");
  const Outcome outcome = talus("check block.yaml --variants variants.json");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("variants.json names no variants of a scene"));
  EXPECT_EQ(talus("check block.yaml --variants variants.json --set time.end=1").code, 2);
}

}  // namespace

}  // namespace talus::variants_test
