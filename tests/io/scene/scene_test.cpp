// Every key of the scenes in tests/io/scenes is found again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "io/document/value_type.hpp"
#include "io/scene/reader.hpp"
#include "io/scene/scene.hpp"
#include "materials/interface/law_variant.hpp"

namespace talus::scene_test {
namespace {

using testing::ElementsAre;

const std::filesystem::path folder = std::filesystem::path(TALUS_SOURCE_DIR) / "tests/io/scenes";

Scene scene(const std::string& name) { return read_scene(folder / name); }

TEST(Scene, ReadsTheHead)
{
  const Scene s = scene("plane.yaml");
  EXPECT_EQ(s.title, "Slope — \"über\" all");
  EXPECT_EQ(s.dimension, 2);
  EXPECT_EQ(s.kernel, "umls");
  EXPECT_EQ(s.time.cfl, 0.3);
  EXPECT_EQ(s.time.max_step, 1e-3);
  EXPECT_EQ(s.time.min_step, 1e-9);
  EXPECT_EQ(s.transfer.scheme, Scheme::flip);
  EXPECT_EQ(s.transfer.musl, false);
  EXPECT_EQ(s.transfer.pic_damping_time, 0.5);
  EXPECT_EQ(s.on_exit, OnExit::remove);
  EXPECT_EQ(s.threads, 2);
  EXPECT_EQ(s.file, (folder / "plane.yaml").string());
}

TEST(Scene, ReadsChoicesOfTheKernelUmls)
{
  const Scene s = scene("plane.yaml");
  ASSERT_TRUE(s.umls.has_value());
  EXPECT_EQ(s.umls->gradient, UmlsGradient::exact_force);
  EXPECT_FALSE(scene("solid.yaml").umls.has_value());
}

TEST(Scene, ReadsChoicesOfTheProjectedKernelAndItsTransfer)
{
  const Scene s = scene("solid.yaml");
  EXPECT_EQ(s.kernel, "projected");
  ASSERT_TRUE(s.projected.has_value());
  EXPECT_EQ(s.projected->surfaces, AtSurfaces::extended);
  EXPECT_EQ(s.transfer.scheme, Scheme::aflip);
  EXPECT_EQ(s.transfer.pic_damping_crossings, 3);
  EXPECT_FALSE(scene("plane.yaml").projected.has_value());
}

TEST(Scene, ReadsWhatBeginsAsAnotherRunLeftIt)
{
  const Scene s = scene("solid.yaml");
  ASSERT_TRUE(s.initial.has_value());
  EXPECT_EQ(s.initial->from, "../bolted");
  ASSERT_EQ(s.initial->bodies.size(), 1U);
  EXPECT_EQ(s.initial->bodies[0].body, "nut");
  EXPECT_EQ(s.initial->bodies[0].from, "bolt");
  EXPECT_EQ(s.initial->velocity, Carried::zero);
  EXPECT_EQ(s.initial->displacement, Carried::keep);
  EXPECT_TRUE(s.outputs.checkpoint.at_end);
  EXPECT_FALSE(s.bodies.at(2).fills());
  EXPECT_FALSE(s.bodies.at(2).particles_per_cell.has_value()) << "there are no cells to fill";
  EXPECT_FALSE(scene("plane.yaml").initial.has_value());
}

TEST(Scene, ReadsInlineGeometry)
{
  const MeshSpec mesh = scene("plane.yaml").mesh;
  ASSERT_EQ(mesh.regions.size(), 2U);
  EXPECT_EQ(mesh.regions[0].name, "soil");
  EXPECT_THAT(std::get<Polygon>(mesh.regions[0].shape).points,
              ElementsAre(ElementsAre(0, 0), ElementsAre(10, 0), ElementsAre(10, 2), ElementsAre(4, 5), ElementsAre(0, 5)));
  EXPECT_THAT(std::get<Box>(mesh.regions[1].shape).high, ElementsAre(11, 6));
  EXPECT_EQ(mesh.size, 0.5);
  ASSERT_EQ(mesh.refine.size(), 1U);
  EXPECT_EQ(mesh.refine[0].size, 0.1);
  EXPECT_THAT(mesh.refine[0].within.low, ElementsAre(3, 3));
  ASSERT_EQ(mesh.groups.size(), 1U);
  EXPECT_EQ(mesh.groups[0].name, "crest");
  EXPECT_EQ(mesh.groups[0].of, "soil:boundary");
  EXPECT_THAT(mesh.groups[0].within->high, ElementsAre(4.1, 5.1));
  EXPECT_FALSE(mesh.grid.has_value());
}

TEST(Scene, ReadsShapesThatArePutTogetherAndNamesOfSides)
{
  const MeshSpec mesh = scene("shapes.yaml").mesh;
  ASSERT_EQ(mesh.regions.size(), 5U);
  const auto& rock = std::get<Polygon>(mesh.regions[0].shape);
  ASSERT_EQ(rock.holes.size(), 1U);
  EXPECT_THAT(rock.holes[0], ElementsAre(ElementsAre(2, 2), ElementsAre(4, 2), ElementsAre(3, 4)));
  EXPECT_THAT(rock.sides, ElementsAre("base", "right", "top", "left"));
  EXPECT_EQ(std::get<Ring>(mesh.regions[1].shape).inner_radius, 2);
  const auto& cut = std::get<Difference>(mesh.regions[2].shape);
  EXPECT_EQ(std::get<Sphere>(cut.without.at(0)).radius, 2);
  EXPECT_EQ(std::get<Union>(mesh.regions[3].shape).of.size(), 2U);
  EXPECT_EQ(std::get<Intersection>(mesh.regions[4].shape).of.size(), 2U);
  EXPECT_THAT(mesh.groups.at(0).facing, ElementsAre(0, 1));
  EXPECT_EQ(mesh.groups.at(0).angle, 10);
  EXPECT_FALSE(mesh.groups.at(0).within.has_value());
}

TEST(Scene, ReadsAGrid)
{
  const GridSpec grid = scene("solid.yaml").mesh.grid.value();
  EXPECT_THAT(grid.low, ElementsAre(0, 0, -1));
  EXPECT_THAT(grid.high, ElementsAre(4, 4, 1));
  EXPECT_THAT(grid.cells, ElementsAre(8, 8, 4));
  EXPECT_EQ(grid.jitter, 0.2);
}

TEST(Scene, ReadsAMeshOfTerrain)
{
  const MeshSpec mesh = scene("terrain.yaml").mesh;
  const TerrainSpec terrain = mesh.terrain.value();
  EXPECT_EQ(terrain.ground.file, "ground.tif");
  EXPECT_EQ(terrain.crs, "EPSG:32633");
  EXPECT_EQ(terrain.domain.size(), 4U);
  ASSERT_EQ(terrain.layers.size(), 3U);
  EXPECT_EQ(terrain.layers[0].within_file, "slide.geojson");
  EXPECT_EQ(terrain.layers[1].bottom.depth, 3);
  EXPECT_EQ(terrain.layers[2].size, 10);
  EXPECT_EQ(terrain.air.value().of, "slide");
  EXPECT_EQ(terrain.refine.at(1).along.size(), 2U);
  EXPECT_EQ(terrain.obstacles.at(1).outline_file, "house.geojson");
}

TEST(Scene, ReadsMaterialsWithTheKeysOfTheirLaws)
{
  const Scene s = scene("plane.yaml");
  ASSERT_EQ(s.materials.size(), 2U);
  EXPECT_EQ(s.materials[0].name, "clay");
  const auto& clay = std::get<DruckerPrager>(choices_of(s.materials[0].law));
  EXPECT_EQ(clay.density, 1900);
  EXPECT_EQ(clay.youngs_modulus, 5e6);
  EXPECT_EQ(clay.poisson_ratio, 0.3);
  EXPECT_EQ(clay.friction_angle, 31);
  EXPECT_EQ(clay.dilation_angle, 1);
  EXPECT_EQ(enum_names(clay.match)[static_cast<std::size_t>(clay.match)], "plane_strain");
  const auto& rock = std::get<LinearElastic>(choices_of(s.materials[1].law));
  EXPECT_EQ(rock.density, 2650);
  EXPECT_EQ(rock.bulk_modulus, 3e9);
  EXPECT_EQ(rock.shear_modulus, 2e9);
  EXPECT_FALSE(rock.youngs_modulus || rock.poisson_ratio || rock.lame_lambda);
}

TEST(Scene, ReadsGroupsOfALaw)
{
  const Scene s = scene("solid.yaml");
  const auto& copper = std::get<JohnsonCook>(choices_of(s.materials.at(1).law));
  EXPECT_EQ(copper.reference_rate, JohnsonCook{}.reference_rate);
  EXPECT_EQ(copper.conductivity, 386);
  EXPECT_EQ(copper.damage.value().d3, -3.03);
  EXPECT_EQ(copper.mie_gruneisen.value().s, 1.489);
  EXPECT_FALSE(copper.initial_temperature.has_value());
}

TEST(Scene, ReadsArtificialViscosity)
{
  const Scene plane = scene("plane.yaml"), solid = scene("solid.yaml");
  EXPECT_FALSE(plane.materials.at(0).bulk_viscosity.has_value());
  EXPECT_EQ(plane.materials.at(1).bulk_viscosity.value().linear, 0.06);
  EXPECT_EQ(plane.materials.at(1).bulk_viscosity.value().quadratic, 1.5);
  EXPECT_EQ(solid.materials.at(1).bulk_viscosity.value().linear, BulkViscosity{}.linear);
}

TEST(Scene, ReadsBodies)
{
  const Scene plane = scene("plane.yaml"), solid = scene("solid.yaml");
  EXPECT_EQ(plane.bodies.at(0).region, "soil");
  EXPECT_EQ(plane.bodies.at(0).material, "clay");
  EXPECT_EQ(plane.bodies.at(0).particles_per_cell, 6);
  EXPECT_THAT(plane.bodies.at(0).velocity, ElementsAre("0.1 * sin(x)", "0"));
  EXPECT_FALSE(plane.bodies.at(0).shape.has_value());
  EXPECT_EQ(plane.bodies.at(0).f_bar, true);
  EXPECT_EQ(solid.bodies.at(1).f_bar, false);
  EXPECT_FALSE(plane.bodies.at(1).f_bar.has_value());
  EXPECT_EQ(std::get<Sphere>(plane.bodies.at(1).shape.value()).radius, 0.4);
  EXPECT_EQ(plane.bodies.at(1).particles_per_cell, 4);
  EXPECT_THAT(std::get<Cylinder>(solid.bodies.at(0).shape.value()).from, ElementsAre(1, 1, -0.5));
  EXPECT_THAT(std::get<Polygon>(solid.bodies.at(1).shape.value()).extrude, ElementsAre(-0.5, 0.5));
}

TEST(Scene, ReadsLoadsAndBoundaries)
{
  const Scene s = scene("plane.yaml");
  const auto& gravity = std::get<GravitySpec>(s.loads.at(0));
  EXPECT_THAT(gravity.acceleration, ElementsAre(0, -9.81));
  EXPECT_EQ(gravity.table(0.25), 0.25);
  const auto& weight = std::get<TractionSpec>(s.loads.at(1));
  EXPECT_EQ(weight.on, "crest");
  EXPECT_THAT(weight.traction, ElementsAre(0, -1000));
  EXPECT_EQ(weight.carried_by, Carrier::mesh);
  EXPECT_EQ(weight.table(7), 1);
  EXPECT_EQ(std::get<TractionSpec>(s.loads.at(2)).pressure, 500);
  EXPECT_EQ(std::get<TractionSpec>(s.loads.at(4)).on, "stone:boundary");
  EXPECT_EQ(std::get<TractionSpec>(s.loads.at(4)).water_level, 2);
  EXPECT_EQ(std::get<TractionSpec>(s.loads.at(4)).unit_weight, 1.0e4);
  EXPECT_EQ(std::get<FixedOptions>(s.boundaries.at(0)).on, "y_min");
  EXPECT_EQ(std::get<RollerOptions>(s.boundaries.at(1)).on, "x_min");
  EXPECT_THAT(std::get<PrescribedVelocityOptions>(s.boundaries.at(2)).velocity, ElementsAre(0.1, 0));
  EXPECT_EQ(std::get<PrescribedVelocityOptions>(s.boundaries.at(2)).table(1.25), 0.5);
  EXPECT_EQ(std::get<FrictionOptions>(s.boundaries.at(3)).coefficient, 0.4);
}

TEST(Scene, ReadsStages)
{
  const Scene s = scene("plane.yaml");
  const auto& rest = std::get<GeostaticSpec>(s.stages.at(0));
  EXPECT_EQ(rest.duration, 5);
  EXPECT_EQ(rest.ramp, 1);
  EXPECT_EQ(rest.damping, 0.5);
  EXPECT_EQ(rest.residual, 1e-4);
  EXPECT_FALSE(rest.elastic);
  EXPECT_FALSE(rest.reset_displacement);
  EXPECT_EQ(rest.initial_stress.value().k0, 0.5);
  EXPECT_EQ(std::get<RunSpec>(s.stages.at(1)).duration, 3);
  EXPECT_EQ(std::get<RunSpec>(s.stages.at(1)).damping, 0.05);
}

TEST(Scene, ReadsWhatStagesChange)
{
  const Scene s = scene("plane.yaml");
  EXPECT_EQ(name_of(s.stages.at(0)), "geostatic");
  EXPECT_EQ(name_of(s.stages.at(2)), "built");
  const StageChanges &built = changes_of(s.stages.at(2)), &shaken = changes_of(s.stages.at(3));
  EXPECT_THAT(built.appear, ElementsAre("stone"));
  EXPECT_EQ(built.change.at(0).body, "slope");
  EXPECT_EQ(built.change.at(0).material, "rock");
  EXPECT_THAT(shaken.vanish, ElementsAre("stone"));
  EXPECT_EQ(shaken.weaken.at(0).body, "slope");
  EXPECT_EQ(shaken.weaken.at(0).factor, 1.3);
  EXPECT_THAT(common_of(s.boundaries.at(3)).during, ElementsAre("built", "shaken"));
  EXPECT_TRUE(common_of(s.boundaries.at(3)).acts_in("shaken"));
  EXPECT_FALSE(common_of(s.boundaries.at(3)).acts_in("geostatic"));
  const Presence stone = presence_of("stone", s.stages), slope = presence_of("slope", s.stages);
  EXPECT_EQ(stone.from, 2);
  EXPECT_EQ(stone.until, 3);
  EXPECT_TRUE(slope.in(0) && slope.in(3));
}

TEST(Scene, ReadsOutputs)
{
  const OutputSpec out = scene("plane.yaml").outputs;
  EXPECT_EQ(out.particles.value().every, 0.1);
  EXPECT_THAT(out.particles->fields_wanted, ElementsAre("velocity", "stress", "plastic_strain"));
  EXPECT_EQ(out.mesh.value().every, 0.2);
  EXPECT_THAT(out.mesh->fields_wanted, ElementsAre("mass", "reaction"));
  EXPECT_EQ(out.history.value().every, 0.01);
  EXPECT_EQ(out.history->points.at(0).name, "top");
  EXPECT_THAT(out.history->points.at(0).at, ElementsAre(1, 5));
  EXPECT_EQ(out.history->points.at(0).body, "slope");
  EXPECT_EQ(out.history->fronts.at(0).name, "toe");
  EXPECT_EQ(out.history->fronts.at(0).direction, Direction::x_plus);
  EXPECT_EQ(out.history->fronts.at(0).mass_share, 0.995);
  EXPECT_EQ(out.picture.field, "stress");
  EXPECT_THAT(out.picture.range, ElementsAre(0, 1e5));
  EXPECT_THAT(out.picture.view, ElementsAre(0, -1, 0));
  EXPECT_THAT(out.picture.up, ElementsAre(0, 0, 1));
  EXPECT_FALSE(out.picture.mesh);
}

TEST(Scene, AccuracyScalesTheCellsAndSetsWhatIsLeftOpen)
{
  const auto with = [](const std::string& name, const std::string& accuracy) {
    return read_scene(folder / name, std::vector<std::string>{"accuracy=" + accuracy});
  };
  const Scene draft = with("plane.yaml", "draft"), fine = with("plane.yaml", "fine");
  EXPECT_EQ(draft.mesh.size, 1.0);
  EXPECT_EQ(draft.mesh.refine.at(0).size, 0.2);
  EXPECT_EQ(draft.time.cfl, 0.3) << "given";
  EXPECT_EQ(draft.bodies.at(0).particles_per_cell, 6) << "given";
  EXPECT_EQ(draft.bodies.at(1).particles_per_cell, 3);
  EXPECT_EQ(fine.mesh.size, 0.25);
  EXPECT_EQ(fine.bodies.at(1).particles_per_cell, 12);
  EXPECT_EQ(with("smallest.yaml", "draft").time.cfl, 0.8);
  EXPECT_THAT(with("solid.yaml", "fine").mesh.grid.value().cells, ElementsAre(16, 16, 8));
  EXPECT_EQ(with("solid.yaml", "fine").bodies.at(0).particles_per_cell, 14);
  EXPECT_EQ(with("smallest.yaml", "standard").time.cfl, scene("smallest.yaml").time.cfl);
}

TEST(Scene, KeepsDefaultsOfWhatIsNotGiven)
{
  const Scene s = scene("smallest.yaml"), untouched;
  EXPECT_EQ(s.kernel, untouched.kernel);
  EXPECT_EQ(s.time.cfl, 0.4);
  EXPECT_EQ(s.bodies.at(0).particles_per_cell, 4);
  EXPECT_EQ(s.transfer.scheme, untouched.transfer.scheme);
  EXPECT_EQ(s.on_exit, untouched.on_exit);
  EXPECT_TRUE(s.loads.empty() && s.boundaries.empty() && s.stages.empty());
  EXPECT_FALSE(s.outputs.particles || s.outputs.mesh || s.outputs.history);
}

TEST(Scene, TakesAnEmptyListOfWhatNeedNotBeThereAsNone)
{
  EXPECT_TRUE(read_scene(folder / "smallest.yaml", std::vector<std::string>{"loads=[]", "stages=[]"}).stages.empty());
  EXPECT_THROW(read_scene(folder / "smallest.yaml", std::vector<std::string>{"bodies=[]"}), SceneErrors);
}

TEST(Scene, ReadsWhenItsStateIsKept)
{
  const CheckpointSpec asked = scene("solid.yaml").outputs.checkpoint, usual = scene("plane.yaml").outputs.checkpoint;
  EXPECT_EQ(asked.every, 2);
  EXPECT_EQ(asked.steps, 500);
  EXPECT_EQ(asked.wall_time, 60);
  EXPECT_EQ(asked.keep, 3);
  EXPECT_FALSE(usual.every || usual.steps);
  EXPECT_EQ(usual.wall_time, 900);
  EXPECT_EQ(usual.keep, 2);
}

TEST(Scene, ReadsHowParametersVary)
{
  const auto variation = scene("plane.yaml").materials.at(1).variation;
  ASSERT_EQ(variation.size(), 2U);
  EXPECT_EQ(variation[0].parameter, "shear_modulus");
  EXPECT_EQ(variation[0].distribution, Distribution::normal);
  EXPECT_EQ(variation[0].coefficient_of_variation, 0.1);
  EXPECT_THAT(variation[0].correlation_length, ElementsAre(40, 4));
  EXPECT_EQ(variation[0].covariance, Covariance::gaussian);
  EXPECT_EQ(variation[0].seed, 3);
  EXPECT_EQ(variation[0].minimum, 1e9);
  EXPECT_EQ(variation[0].maximum, 3e9);
  EXPECT_EQ(variation[1].distribution, Distribution::lognormal);
  EXPECT_EQ(variation[1].covariance, Covariance::exponential);
  EXPECT_EQ(variation[1].seed, 1);
  EXPECT_EQ(variation[1].correlated_with, "shear_modulus");
  EXPECT_EQ(variation[1].correlation, 0.5);
  EXPECT_EQ(variation[1].trend, "1 + 0.1 * y");
  EXPECT_FALSE(variation[1].minimum || variation[1].maximum);
}

TEST(Scene, KnowsWhereEverythingWasAskedFor)
{
  const Scene s = scene("plane.yaml");
  EXPECT_EQ(to_string(s.materials.at(1).where), s.file + ":27:5");
  EXPECT_EQ(s.materials.at(1).where.path, "materials[1] \"rock\"");
  EXPECT_EQ(std::get<FrictionOptions>(s.boundaries.at(3)).where.path, "boundaries[3]");
  EXPECT_EQ(std::get<FrictionOptions>(s.boundaries.at(3)).where.line, 42);
  EXPECT_EQ(s.outputs.history.value().points.at(0).where.path, "outputs.history.points[0] \"top\"");
}

/// Adds all keys that a value can ask for, except those of laws.
void add_keys(const ValueType& type, std::set<std::string>& keys)
{
  if (type.entry != nullptr)
    return add_keys(*type.entry, keys);
  for (const StructType* one : type.structs)
    for (const FieldType& field : one->fields) {
      keys.emplace(field.key);
      if (!field.is_alternative)
        add_keys(*field.type, keys);
    }
}

TEST(Scene, SaysHowWaterFlows)
{
  const Scene s = scene("flow.yaml");
  const FlowSpec flow = s.water.value().flow.value();
  ASSERT_EQ(flow.bodies.size(), 2U);
  EXPECT_EQ(flow.bodies[0].porosity, 0.4);
  EXPECT_EQ(flow.bodies[0].biot, 0.9);
  EXPECT_TRUE(flow.bodies[0].kozeny_carman);
  EXPECT_EQ(flow.bodies[0].retention.value().exponent, 2.5);
  EXPECT_EQ(flow.bodies[1].permeability, 1e-3);
  EXPECT_EQ(flow.bodies[1].bulk_modulus, 2.2e9);
  EXPECT_FALSE(flow.bodies[1].retention.has_value());
  EXPECT_EQ((std::pair{flow.heads.at(0).level, flow.pond.value().level}), (std::pair{1.5, 1.8}));
  EXPECT_EQ(flow.inflow.at(0).table(1), 1);
  EXPECT_EQ(flow.rain.value().rate, 1e-6);
  EXPECT_EQ(flow.pace(0), 100);
  EXPECT_EQ(flow.surface, SurfaceFlow::drained);
}

TEST(Scene, ExamplesUseEveryKeyThereIs)
{
  std::string text;
  for (const std::string name : {"plane.yaml", "solid.yaml", "smallest.yaml", "terrain.yaml", "section.yaml", "shapes.yaml", "flow.yaml"})
    text += scene(name).text;
  text += read_scene(folder / "own_laws.yaml", {}, Libraries::closed).text;
  std::set<std::string> keys;
  add_keys(value_type<Scene>(), keys);
  EXPECT_GT(keys.size(), 60U);
  keys.erase("geometry");     // another file; tests of the mesher read one
  keys.erase("domain_file");  // instead of domain
  for (const auto& key : keys)
    EXPECT_THAT(text, testing::HasSubstr(key + ":"));
}

}  // namespace
}  // namespace talus::scene_test
