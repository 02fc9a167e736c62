// talus fos makes its runs of every example scene with a geostatic stage, whatever keys it has.
#include <gmock/gmock.h>

#include <algorithm>

#include "tests/app/program.hpp"

namespace talus::fos_scenes_test {

namespace {

namespace fs = std::filesystem;
using testing::AnyOf;
using testing::HasSubstr;

const fs::path examples = fs::path(TALUS_SOURCE_DIR) / "scenes";

/// Names of the folders of scenes/ whose scene seeks a state at rest.
std::vector<std::string> scenes_at_rest()
{
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(examples))
    if (const fs::path scene = entry.path() / "scene.yaml";
        fs::exists(scene) && read_whole(scene).find("type: geostatic") != std::string::npos)
      names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

TEST(FosScenes, ThereAreSome) { EXPECT_GE(scenes_at_rest().size(), 5U); }

class FosOfScene : public Program, public testing::WithParamInterface<std::string> {};

/// Runs that are cut short say nothing of the slope; they say whether a trial is a scene that can be run.  A hundred times the strength holds.
TEST_P(FosOfScene, MakesTrials)
{
  const Outcome outcome =
      talus("fos '" + (examples / GetParam() / "scene.yaml").string() +
            "' --out out --quick --from 0.01 --to 100 --width 100 --duration 1 --jobs 1 --threads 1 --no-pictures --quiet");
  EXPECT_THAT(outcome.code, AnyOf(0, 1)) << outcome.err;  // 1: all hold, or all fail
  EXPECT_THAT(read("out/trial_0.01/summary.json"), HasSubstr("\"status\": \"done\"")) << outcome.err;
}
INSTANTIATE_TEST_SUITE_P(Examples, FosOfScene, testing::ValuesIn(scenes_at_rest()), [](const auto& scene) { return scene.param; });

}  // namespace

}  // namespace talus::fos_scenes_test
