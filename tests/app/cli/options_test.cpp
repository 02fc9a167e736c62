// Options of a body and its material arrive where the step looks for them.
#include <gtest/gtest.h>

#include <fstream>

#include "app/setup/laws_in_force.hpp"
#include "app/setup/setup.hpp"
#include "io/load_mesh.hpp"
#include "io/scene/reader.hpp"
#include "tests/app/program.hpp"

namespace talus::options_test {
namespace {

class Options : public Program {
 protected:
  Material material(const std::string& law, const std::string& body_keys, const std::string& material_keys = "") const
  {
    write("scene.yaml",
          "title: Block\ndimension: 2\nmesh: {grid: {low: [0, 0], high: [1, 1], cells: [2, 2]}}\ntime: {end: 1}\n"
          "materials: [{name: m, " +
              material_keys + "law: " + law +
              "}]\n"
              "bodies: [{name: b, material: m, shape: {type: box, low: [0, 0], high: [1, 1]}" +
              body_keys + "}]\n");
    const Scene scene = read_scene(folder_ / "scene.yaml");
    return set_up<2>(scene, load_mesh<2>(scene.mesh, folder_.path())).state.materials.at(0);
  }
};

const std::string elastic = "density: 1000, youngs_modulus: 1.0e6, poisson_ratio: 0.3";

TEST_F(Options, VolumesAreAveragedByDefaultWherePlasticFlowKeepsThem)
{
  EXPECT_TRUE(material("von_mises, yield_stress: 1.0e3, " + elastic, "").averages_volume);
  EXPECT_FALSE(material("von_mises, yield_stress: 1.0e3, " + elastic, ", f_bar: false").averages_volume);
  EXPECT_FALSE(material("neo_hookean, " + elastic, "").averages_volume);
  EXPECT_TRUE(material("neo_hookean, " + elastic, ", f_bar: true").averages_volume);
}

/// Which bodies average their volume ratio as one, by stage.
TEST_F(Options, BodiesOfOneMaterialAreAveragedAsOneWhileTheirVolumesCountFromOneState)
{
  write("scene.yaml",
        "title: t\ndimension: 2\nmesh: {grid: {low: [0, 0], high: [9, 1], cells: [9, 1]}}\n"
        "materials:\n"
        "  - {name: clay, law: von_mises, yield_stress: 1.0e3, " +
            elastic +
            "}\n"
            "  - {name: peat, law: von_mises, yield_stress: 1.0e3, " +
            elastic +
            "}\n"
            "bodies:\n"
            "  - {name: left, material: clay, shape: {type: box, low: [0, 0], high: [1, 1]}}\n"
            "  - {name: right, material: clay, shape: {type: box, low: [1, 0], high: [2, 1]}}\n"
            "  - {name: other, material: peat, shape: {type: box, low: [2, 0], high: [3, 1]}}\n"
            "  - {name: own, material: clay, shape: {type: box, low: [3, 0], high: [4, 1]}, f_bar: false}\n"
            "  - {name: lift, material: clay, shape: {type: box, low: [4, 0], high: [5, 1]}}\n"
            "stages:\n"
            "  - {type: run, duration: 1}\n"
            "  - {type: run, duration: 1, appear: [lift]}\n"
            "  - {type: run, duration: 1, weaken: [{body: right, factor: 2}]}\n"
            "  - {type: run, duration: 1, change: [{body: left, material: peat}, {body: other, material: clay}]}\n");
  const Scene scene = read_scene(folder_ / "scene.yaml");
  const auto laws = laws_of_stages(scene);
  const auto group = [&](std::size_t stage, std::size_t body) { return averages_with(laws.at(stage).at(body)); };
  enum : std::size_t { left, right, other, own, lift };
  EXPECT_NE(group(0, left), none);
  EXPECT_EQ(group(0, left), group(0, right));
  EXPECT_NE(group(0, left), group(0, other)) << "another material";
  EXPECT_EQ(group(0, own), none) << "averages nothing";
  EXPECT_NE(group(1, lift), group(1, left)) << "the ratio of the lift counts from a later state";
  EXPECT_EQ(group(2, left), group(0, left)) << "a body that is not renewed keeps its number: its law is not set anew";
  EXPECT_NE(group(2, right), group(2, left)) << "a law that is set anew counts from there";
  EXPECT_NE(group(3, other), group(3, right)) << "the same material, from another stage on";
  EXPECT_NE(group(3, left), group(3, other));
}

TEST_F(Options, BulkViscosityBelongsToTheMaterial)
{
  EXPECT_FALSE(material("neo_hookean, " + elastic, "").viscosity);
  const Material viscous = material("neo_hookean, " + elastic, "", "bulk_viscosity: {linear: 0.25}, ");
  ASSERT_TRUE(viscous.viscosity);
  const BulkViscosity viscosity = *viscous.viscosity;
  EXPECT_EQ(viscosity.linear, 0.25);
  EXPECT_EQ(viscosity.quadratic, BulkViscosity{}.quadratic);
}

}  // namespace
}  // namespace talus::options_test
