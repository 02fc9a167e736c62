// The scenes on which restarts and ranks are tested have every law, kernel and boundary condition that there is.
#include "tests/app/scenes_of_all.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "kernels/kernels.hpp"
#include "materials/laws.hpp"
#include "mesh/conditions/conditions.hpp"

namespace talus::scenes_of_all_test {
namespace {

/// Whether the key has that word in one of the scenes.
bool is_somewhere(const std::string& key, std::string_view word)
{
  const auto scenes = scenes_of_all();
  return std::any_of(scenes.begin(), scenes.end(), [&](const SceneCase& scene) {
    const std::string text = scene.parts.text(), wanted = key + ": " + std::string(word);
    const auto ends_word = [&](std::size_t at) { return at == text.size() || text.find_first_of(",}\n", at) == at; };
    for (std::size_t at = text.find(wanted); at != text.npos; at = text.find(wanted, at + 1))
      if (ends_word(at + wanted.size()))
        return true;
    return false;
  });
}

TEST(ScenesOfAll, HaveEveryBoundaryCondition)
{
  for_each_type(Conditions<2>{}, []<class C>() { EXPECT_TRUE(is_somewhere("type", C::Options::name)) << C::Options::name; });
}

TEST(ScenesOfAll, HaveEveryLaw)
{
  for_each_type(Laws{}, []<class L>() { EXPECT_TRUE(is_somewhere("law", L::name)) << L::name; });
}

/// The one without a name in a scene is the default.
TEST(ScenesOfAll, HaveEveryKernel)
{
  for_each_type(Kernels<2>{}, []<class K>() { EXPECT_TRUE(K::name == "projected" || is_somewhere("kernel", K::name)) << K::name; });
}

TEST(ScenesOfAll, DoNotHaveWhatThereIsNot)
{
  EXPECT_FALSE(is_somewhere("law", "newton"));
  EXPECT_FALSE(is_somewhere("type", "roll"));
}

}  // namespace
}  // namespace talus::scenes_of_all_test
