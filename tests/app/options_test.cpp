// Options of a body and its material arrive where the step looks for them.
#include <gtest/gtest.h>

#include <fstream>

#include "app/setup.hpp"
#include "io/gmsh_mesh.hpp"
#include "io/reader.hpp"
#include "tests/app/program.hpp"

namespace talus::options_test {
namespace {

class Options : public Program {
 protected:
  AnyBatch material(const std::string& law, const std::string& body_keys, const std::string& material_keys = "") const
  {
    write("scene.yaml",
          "title: Block\ndimension: 2\nmesh: {grid: {low: [0, 0], high: [1, 1], cells: [2, 2]}}\ntime: {end: 1}\n"
          "materials: [{name: m, " +
              material_keys + "law: " + law +
              "}]\n"
              "bodies: [{name: b, material: m, shape: {type: box, low: [0, 0], high: [1, 1]}" +
              body_keys + "}]\n");
    const Scene scene = read_scene(folder_ / "scene.yaml");
    return set_up<2>(scene, load_mesh<2>(scene.mesh, folder_.path())).materials.at(0);
  }
};

const std::string elastic = "density: 1000, youngs_modulus: 1.0e6, poisson_ratio: 0.3";

TEST_F(Options, VolumesAreAveragedByDefaultWherePlasticFlowKeepsThem)
{
  EXPECT_TRUE(averages_volume(material("von_mises, yield_stress: 1.0e3, " + elastic, "")));
  EXPECT_FALSE(averages_volume(material("von_mises, yield_stress: 1.0e3, " + elastic, ", f_bar: false")));
  EXPECT_FALSE(averages_volume(material("neo_hookean, " + elastic, "")));
  EXPECT_TRUE(averages_volume(material("neo_hookean, " + elastic, ", f_bar: true")));
}

TEST_F(Options, BulkViscosityBelongsToTheMaterial)
{
  EXPECT_FALSE(has_bulk_viscosity(material("neo_hookean, " + elastic, "")));
  const AnyBatch viscous = material("neo_hookean, " + elastic, "", "bulk_viscosity: {linear: 0.25}, ");
  ASSERT_TRUE(has_bulk_viscosity(viscous));
  const BulkViscosity viscosity = *std::get<Batch<NeoHookean>>(viscous).viscosity;
  EXPECT_EQ(viscosity.linear, 0.25);
  EXPECT_EQ(viscosity.quadratic, BulkViscosity{}.quadratic);
}

}  // namespace
}  // namespace talus::options_test
