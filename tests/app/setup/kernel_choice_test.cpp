// What the check of a scene advises on kernel and transfer.
#include <gmock/gmock.h>

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "app/setup/checks/kernel_choice.hpp"
#include "io/scene/reader.hpp"
#include "tests/app/program.hpp"

namespace talus::kernel_choice_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr KernelUse flowing{.flows = true, .moves = true}, elastic{.moves = true};

/// Two blocks that fill regions, with gravity, and more keys of the scene.
std::string blocks(const std::string& more = "", const std::string& left = "region: left", const std::string& right = "region: right")
{
  return fmt::format(R"(title: Blocks
dimension: 2
mesh: {{grid: {{low: [0, 0], high: [2, 1], cells: [8, 4]}}, groups: [{{name: left, within: {{low: [0, 0], high: [1, 1]}}}},
  {{name: right, within: {{low: [1, 0], high: [2, 1]}}}}]}}
materials: [{{name: rubber, law: neo_hookean, density: 1000, youngs_modulus: 1.0e5, poisson_ratio: 0.3}}]
bodies:
  - {{name: one, material: rubber, {}}}
  - {{name: two, material: rubber, {}}}
time: {{end: 1}}
{})",
                     left, right, more);
}

const std::string gravity = "loads: [{type: gravity, acceleration: [0, -9.81]}]\n";

std::vector<std::string> advice(const std::string& text, const KernelUse& use)
{
  return advice_on_kernel(read_scene_text("scene.yaml", text), use);
}

TEST(KernelChoice, DefaultsNeedNoAdviceWhereBodiesFlow) { EXPECT_THAT(advice(blocks(gravity), flowing), IsEmpty()); }

TEST(KernelChoice, LinearIsAdvisedAgainstOnlyWhereBodiesFlow)
{
  const std::string linear = gravity + "kernel: linear\ntransfer: {scheme: flip}\n";
  EXPECT_THAT(advice(blocks(linear), flowing), ElementsAre(HasSubstr("linear is for particles that stay in their cells")));
  EXPECT_THAT(advice(blocks(linear), elastic), IsEmpty());
  EXPECT_THAT(advice(blocks(linear), KernelUse{.flows = true}), IsEmpty()) << "what seeks rest stays in its cells";
}

TEST(KernelChoice, TheEstimateOfUmlsIsAdvisedAgainstOnUnevenMeshes)
{
  const KernelUse uneven{.moves = true, .uneven_mesh = 0.05};
  const std::string umls = "kernel: umls\ntransfer: {scheme: flip}\n";
  EXPECT_THAT(advice(blocks(umls), uneven), ElementsAre(HasSubstr("umls does not balance a uniform stress")));
  EXPECT_THAT(advice(blocks(umls), elastic), IsEmpty());
  EXPECT_THAT(advice(blocks(umls + "umls: {gradient: exact_force}\n"), uneven), IsEmpty());
  EXPECT_THAT(advice(blocks(), uneven), IsEmpty());
}

TEST(KernelChoice, TransfersThatLoseEnergyInEachStepAreNamedWhereGravityMakesBodiesFlow)
{
  const std::string tpic = "transfer: {scheme: tpic}\n";
  EXPECT_THAT(advice(blocks(gravity + tpic), flowing), ElementsAre(HasSubstr("tpic loses energy in each step")));
  EXPECT_THAT(advice(blocks(tpic), flowing), IsEmpty());
  EXPECT_THAT(advice(blocks(gravity + tpic), elastic), IsEmpty());
  EXPECT_THAT(advice(blocks(gravity + "transfer: {scheme: flip}\n"), flowing), IsEmpty());
}

TEST(KernelChoice, SaflipAndContactsAreNamedWhereBodiesMeet)
{
  const auto meeting = [](const std::string& more) { return blocks(more, "region: left, velocity: [1, 0]"); };
  EXPECT_THAT(advice(meeting(""), elastic),
              ElementsAre(HasSubstr("aflip damps the vibration that an impact leaves"), HasSubstr("`contacts`")));
  EXPECT_THAT(advice(meeting("transfer: {scheme: saflip}\ncontacts: [{between: [one, two]}]\n"), elastic), IsEmpty());
  EXPECT_THAT(advice(meeting(""), flowing), IsEmpty());
  EXPECT_THAT(advice(blocks("", "region: left, velocity: [1, 0]", "region: right, velocity: [1, 0]"), elastic), IsEmpty())
      << "they fly side by side";
  EXPECT_THAT(advice(blocks("", "region: left, velocity: [\"0.0\", \"-0\"]"), elastic), IsEmpty()) << "both rest";
}

TEST(KernelChoice, BendingIsNamedWhereTheSurfaceOfASlenderBodyCutsCells)
{
  const auto shaped = [](const std::string& more) {
    return blocks(more, "region: left", "shape: {type: box, low: [1.1, 0], high: [1.3, 0.9]}");
  };
  const KernelUse beam{.moves = true, .slenderness = {1, 4.5}}, block{.moves = true, .slenderness = {1, 3}};
  EXPECT_THAT(advice(shaped(gravity), beam), ElementsAre(AllOf(HasSubstr("body \"two\" cuts cells"), HasSubstr("exact_force"))));
  EXPECT_THAT(advice(shaped(gravity), block), IsEmpty());
  EXPECT_THAT(advice(shaped(gravity), KernelUse{.flows = true, .moves = true, .slenderness = {1, 4.5}}), IsEmpty());
  EXPECT_THAT(advice(shaped(gravity), KernelUse{.moves = true, .slenderness = {4.5, 1}}), IsEmpty()) << "the mesh follows the first";
  EXPECT_THAT(advice(shaped(""), beam), IsEmpty()) << "nothing bends it";
  EXPECT_THAT(advice(shaped(gravity + "projected: {surfaces: extended}\n"), beam), IsEmpty());
  EXPECT_THAT(advice(block_scene(gravity + "time: {end: 1}\n"), KernelUse{.moves = true, .slenderness = {5}}),
              ElementsAre(HasSubstr("body \"block\"")));
  EXPECT_THAT(
      advice(block_scene(gravity + "time: {end: 1}\n", ", reference: {update: never}"), KernelUse{.moves = true, .slenderness = {5}}),
      IsEmpty());
  EXPECT_THAT(advice(shaped(gravity + "kernel: umls\numls: {gradient: exact_force}\n"), beam), IsEmpty());
}

TEST(KernelChoice, SlendernessIsLengthOverThicknessInAnyDirection)
{
  Particles<2> particles;
  const auto add_grid = [&](int along, int across, Real angle) {
    for (int i = 0; i < along; ++i)
      for (int j = 0; j < across; ++j)
        particles.x.push_back(Eigen::Rotation2D<Real>(angle) * Vec<2>(i, j) + Vec<2>(100, -7));
  };
  add_grid(40, 10, 0.6);
  add_grid(10, 10, 0.3);
  std::vector<Body> bodies(3);
  bodies[0].begin = 0, bodies[0].end = 400;
  bodies[1].begin = 400, bodies[1].end = 500;
  bodies[2].begin = bodies[2].end = 500;
  const std::vector<Real> found = slenderness(particles, bodies);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_NEAR(found[0], std::sqrt((40.0 * 40 - 1) / (10.0 * 10 - 1)), 1e-9) << "variances of evenly spaced points";
  EXPECT_NEAR(found[1], 1, 1e-6);
  EXPECT_EQ(found[2], 1);
}

class KernelChoiceOfProgram : public Program {};

TEST_F(KernelChoiceOfProgram, TheCheckPrintsAdviceAndTheRunDoesNot)
{
  std::string beam = block_scene(gravity + "time: {end: 0.01}\n");
  beam.replace(beam.find("[0.5, 0]"), 8, "[0, 1.1]");
  beam.replace(beam.find("[1.5, 1]"), 8, "[2, 1.4]");
  write("beam.yaml", beam);
  write("block.yaml", block_scene(gravity + "time: {end: 0.01}\n"));
  const Outcome check = talus("check beam.yaml"), run = talus("run beam.yaml --out r");
  ASSERT_EQ(check.code, 0) << check.err;
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(check.out, HasSubstr("  advice: the surface of body \"block\" cuts cells, where projected is too soft in bending"));
  EXPECT_THAT(run.out, Not(HasSubstr("advice")));
  EXPECT_THAT(talus("check block.yaml").out, Not(HasSubstr("advice"))) << "as long as high";
}

}  // namespace
}  // namespace talus::kernel_choice_test
