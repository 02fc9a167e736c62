// Reference configurations of a scene: what a body takes where the scene says nothing.
#include <gmock/gmock.h>

#include "tests/app/program.hpp"

namespace talus::references_test {
namespace {

using testing::HasSubstr;
using testing::Not;

class ReferencesOfScene : public Program {
 protected:
  Outcome check(const std::string& reference, const std::string& more = "")
  {
    write("bar.yaml",
          "title: Bar\ndimension: 2\nmesh: {grid: {low: [0, 0], high: [4, 2], cells: [8, 4]}}\ntime: {end: 0.01}\n"
          "materials: [{name: rubber, law: neo_hookean, density: 1000, youngs_modulus: 1.0e6, poisson_ratio: 0.3}]\n"
          "bodies:\n  - {name: bar, material: rubber, shape: {type: box, low: [0, 0], high: [2, 1]}, reference: " +
              reference + "}\n" + more);
    return talus("check bar.yaml");
  }
};

TEST_F(ReferencesOfScene, OfABodyThatCanTouchNothingTheShiftDoesNotCount)
{
  const std::string at = "body \"bar\" takes a new reference configuration at a ", held = "boundaries: [{type: fixed, on: x_min}]\n";
  EXPECT_THAT(check("{update: adaptive}", held).out, HasSubstr(at + "distortion of 0.05\n"));
  EXPECT_THAT(check("{update: adaptive, shift: 0.2}", held).out, HasSubstr(at + "distortion of 0.05 or a shift of 0.2 altitudes"));
  EXPECT_THAT(check("{update: never}", held).out, HasSubstr("body \"bar\" keeps its first reference configuration"));
  EXPECT_THAT(check("{update: always}", held).out, Not(HasSubstr("reference configuration")));
}

TEST_F(ReferencesOfScene, OfOneThatCanItDoes)
{
  for (const std::string more : {"boundaries: [{type: friction, on: y_min, coefficient: 0.3}]\n",
                                 "  - {name: other, material: rubber, shape: {type: box, low: [3, 0], high: [4, 1]}}\n"})
    EXPECT_THAT(check("{update: adaptive, volume_change: 0.3}", more).out,
                HasSubstr("configuration at a change of volume of 0.3 or a shift of 0.1 altitudes"));
}

}  // namespace
}  // namespace talus::references_test
