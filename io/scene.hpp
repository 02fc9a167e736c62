#pragma once
// The scene: plain typed values, one struct per block of the file.  Their field lists are the user manual.
//
// A struct may have `Where where` (set by the reader to the place of its mapping) and `void check(std::vector<std::string>&) const`
// (rules between its keys, in words).  Rules between blocks stand in scene_rules.hpp; rules that need the mesh are checked when the
// model is built, with the same error type.
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/error.hpp"
#include "core/fields.hpp"
#include "core/table.hpp"
#include "core/type_list.hpp"
#include "io/shape.hpp"
#include "materials/laws.hpp"

namespace talus {

/// A value of any law: std::variant<LinearElastic, ...>.
using AnyLaw = variant_of<Laws, std::type_identity_t>;

/// A named solid of inline geometry.  Regions that touch share their faces; a later region gives way where two overlap.
struct RegionSpec {
  std::string name;
  Shape shape;
  Where where;
  static constexpr auto fields()
  {
    return std::tuple{required("name", &RegionSpec::name, any, "-", "name of the cells: bodies refer to it"),
                      required("shape", &RegionSpec::shape, any, "-", "the solid")};
  }
};

/// Names the facets whose corners all lie in a box.
struct GroupSpec {
  std::string name, of = "boundary";
  Box within;
  Where where;
  static constexpr auto fields()
  {
    return std::tuple{required("name", &GroupSpec::name, any, "-", "name of the facets: boundaries and loads refer to it"),
                      optional("of", &GroupSpec::of, any, "-",
                               "facet group to choose from: the outline of a region is region:boundary, that of the mesh boundary"),
                      group("within", &GroupSpec::within, "facets with all corners in this box (give it some slack)")};
  }
};

/// A box in which cells are smaller.
struct RefineSpec {
  Box within;
  Real size{};
  static constexpr auto fields()
  {
    return std::tuple{group("within", &RefineSpec::within, "where"),
                      required("size", &RefineSpec::size, positive, "m", "edge length inside the box")};
  }
};

/// Built-in box of equal simplices, optionally jittered: needs no mesher.
struct GridSpec {
  std::vector<Real> low, high;
  std::vector<Index> cells;
  Real jitter = 0;
  static constexpr auto fields()
  {
    return std::tuple{required("low", &GridSpec::low, any, "m", "corner with the smallest coordinates"),
                      required("high", &GridSpec::high, any, "m", "corner with the largest coordinates"),
                      required("cells", &GridSpec::cells, positive, "-",
                               "intervals along each axis; each square is cut in 2 triangles, each cube in 6 tetrahedra"),
                      optional("jitter", &GridSpec::jitter, from_to_below(0, 0.5), "-",
                               "interior nodes moved at random by up to this share of the spacing")};
  }
  void check(std::vector<std::string>& problems) const;
};

/// Exactly one of file, geometry, regions, grid.
struct MeshSpec {
  std::string file, geometry;
  std::optional<Real> size;
  std::vector<RegionSpec> regions;
  std::vector<RefineSpec> refine;
  std::vector<GroupSpec> groups;
  std::optional<GridSpec> grid;
  Where where;
  static constexpr auto fields()
  {
    return std::tuple{optional("file", &MeshSpec::file, any, "-", "a gmsh .msh file (2.2 or 4.1, ascii or binary), relative to the scene"),
                      optional("geometry", &MeshSpec::geometry, any, "-",
                               "a .geo or .step file to be meshed; a .geo is a program: run only those you trust"),
                      optional("size", &MeshSpec::size, positive, "m", "edge length of the cells, for geometry and regions"),
                      optional_list("regions", &MeshSpec::regions, "inline geometry: named solids"),
                      optional_list("refine", &MeshSpec::refine, "boxes with smaller cells, for geometry and regions"),
                      optional_list("groups", &MeshSpec::groups,
                                    "names for parts of the boundary or of outlines, added to those of the mesh; x_min, x_max, y_min, ... "
                                    "and boundary always exist"),
                      group("grid", &MeshSpec::grid, "built-in box")};
  }
  void check(std::vector<std::string>& problems) const;
};

struct TimeSpec {
  Real end = 0;
  std::optional<Real> cfl;  ///< has a value in every scene that was read
  std::optional<Real> max_step;
  Real min_step = 1e-12;
  Where where;
  static constexpr auto fields()
  {
    return std::tuple{
        optional("end", &TimeSpec::end, positive, "s", "end of the run; needed unless there are stages"),
        optional("cfl", &TimeSpec::cfl, within(1e-4, 2), "-",
                 "time step as a share of smallest altitude / (wave speed + particle speed); default by accuracy: 0.8, 0.4, 0.4"),
        optional("max_step", &TimeSpec::max_step, positive, "s", "no step longer than this"),
        optional("min_step", &TimeSpec::min_step, positive, "s",
                 "the run stops, naming the particle, when a shorter step would be needed")};
  }
  void check(std::vector<std::string>& problems) const;
};

enum class TransferScheme : std::uint8_t { flip, apic, tpic };
constexpr std::array<std::string_view, 3> words(TransferScheme) { return {"flip", "apic", "tpic"}; }

struct TransferSpec {
  TransferScheme scheme = TransferScheme::flip;
  std::optional<bool> musl;
  std::optional<Real> pic_damping_time;
  Where where;
  static constexpr auto fields()
  {
    return std::tuple{
        optional_choice("scheme", &TransferSpec::scheme,
                        "flip (increments), apic (affine, own matrix) or tpic (affine, velocity gradient)"),
        optional("musl", &TransferSpec::musl, any, "-",
                 "map momentum back to the nodes before the velocity gradient is taken; default true for flip, false otherwise"),
        optional("pic_damping_time", &TransferSpec::pic_damping_time, positive, "s",
                 "flip only: share dt/time of plain PIC in each step; default none")};
  }
  void check(std::vector<std::string>& problems) const;
};

struct MaterialSpec {
  std::string name;
  std::optional<BulkViscosity> bulk_viscosity;
  AnyLaw law;
  Where where;
  static constexpr auto fields()
  {
    return std::tuple{required("name", &MaterialSpec::name, any, "-", "bodies refer to it"),
                      group("bulk_viscosity", &MaterialSpec::bulk_viscosity,
                            "artificial viscous pressure where the volume shrinks, against ringing behind shocks; default none"),
                      alternative("law", &MaterialSpec::law, "constitutive law; its parameters are keys of the same mapping")};
  }
};

/// A body fills either a cell group or a shape.
struct BodySpec {
  std::string name, material;
  std::string region;
  std::optional<Shape> shape;
  std::optional<Index> particles_per_cell;  ///< has a value in every scene that was read
  std::optional<bool> f_bar;
  std::vector<std::string> velocity;
  Where where;
  static constexpr auto fields()
  {
    return std::tuple{
        required("name", &BodySpec::name, any, "-", "name in messages and output"),
        required("material", &BodySpec::material, any, "-", "name of a material"),
        optional("region", &BodySpec::region, any, "-", "the body fills this cell group of the mesh"),
        optional("shape", &BodySpec::shape, any, "-", "the body fills this shape: particles whose centre lies in it"),
        optional("particles_per_cell", &BodySpec::particles_per_cell, positive, "-",
                 "symmetric points of equal weight; 2-D: 1, 3, 4, 6, 12, 16, 25; 3-D: 1, 4, 8, 10, 14, ...; default by accuracy: 3, 4, 12 "
                 "in 2-D and 4, 4, 14 in 3-D"),
        optional("f_bar", &BodySpec::f_bar, any, "-",
                 "against locking: the law sees the volume ratio averaged over the cells around nodes; default true under von_mises and "
                 "johnson_cook, whose flow keeps the volume, false otherwise"),
        optional("velocity", &BodySpec::velocity, any, "m/s",
                 "initial velocity, one number or formula of x, y, z per dimension, such as \"0.1 * sin(pi * x / 50)\"")};
  }
  void check(std::vector<std::string>& problems) const;
};

struct GravitySpec {
  static constexpr std::string_view name = "gravity";
  std::vector<Real> acceleration;
  Table table;
  Where where;
  static constexpr auto fields()
  {
    return std::tuple{required("acceleration", &GravitySpec::acceleration, any, "m/s^2", "one number per dimension"),
                      optional("table", &GravitySpec::table, any, "-", "factor in time: list of [time, factor]")};
  }
};

enum class PlaceOf : std::uint8_t { now, start };
constexpr std::array<std::string_view, 2> words(PlaceOf) { return {"now", "start"}; }

/// Force per mass by formulas of place and time.
struct BodyForceSpec {
  static constexpr std::string_view name = "body_force";
  std::vector<std::string> acceleration;
  PlaceOf place = PlaceOf::now;
  Where where;
  static constexpr auto fields()
  {
    return std::tuple{
        required("acceleration", &BodyForceSpec::acceleration, any, "m/s^2",
                 "force per mass: one number or formula of x, y, z and the time t per dimension, such as \"3 * sin(pi * x) * cos(8 * t)\""),
        optional_choice("place", &BodyForceSpec::place,
                        "x, y, z of a particle are where it is now or where it was at the start (for manufactured solutions)")};
  }
};

enum class Carrier : std::uint8_t { particles, mesh };
constexpr std::array<std::string_view, 2> words(Carrier) { return {"particles", "mesh"}; }

/// Force per area on a facet group: exactly one of traction and pressure.
struct TractionSpec {
  static constexpr std::string_view name = "traction";
  std::string on;
  std::vector<Real> traction;
  std::optional<Real> pressure;
  Carrier carried_by = Carrier::particles;
  Table table;
  Where where;
  static constexpr auto fields()
  {
    return std::tuple{
        required("on", &TractionSpec::on, any, "-", "facet group"),
        optional("traction", &TractionSpec::traction, any, "Pa", "force per initial area, fixed direction, one number per dimension"),
        optional("pressure", &TractionSpec::pressure, any, "Pa", "pressure normal to the surface as it deforms, positive pushes"),
        optional_choice(
            "carried_by", &TractionSpec::carried_by,
            "particles: the first layer of particles behind the facets carries the load and takes it along; mesh: the facets keep it"),
        optional("table", &TractionSpec::table, any, "-", "factor in time: list of [time, factor]")};
  }
  void check(std::vector<std::string>& problems) const;
};

using LoadSpec = std::variant<GravitySpec, BodyForceSpec, TractionSpec>;

struct FixedSpec {
  static constexpr std::string_view name = "fixed";
  std::string on;
  Where where;
  static constexpr auto fields() { return std::tuple{required("on", &FixedSpec::on, any, "-", "node, facet or cell group held at rest")}; }
};

struct RollerSpec {
  static constexpr std::string_view name = "roller";
  std::string on;
  Where where;
  static constexpr auto fields()
  {
    return std::tuple{required("on", &RollerSpec::on, any, "-", "facet group without normal motion; sliding is free")};
  }
};

struct VelocitySpec {
  static constexpr std::string_view name = "velocity";
  std::string on;
  std::vector<Real> velocity;
  Table table;
  Where where;
  static constexpr auto fields()
  {
    return std::tuple{required("on", &VelocitySpec::on, any, "-", "node, facet or cell group moved"),
                      required("velocity", &VelocitySpec::velocity, any, "m/s", "one number per dimension"),
                      optional("table", &VelocitySpec::table, any, "-", "factor in time: list of [time, factor]")};
  }
};

struct FrictionSpec {
  static constexpr std::string_view name = "friction";
  std::string on;
  Real coefficient{};
  Where where;
  static constexpr auto fields()
  {
    return std::tuple{required("on", &FrictionSpec::on, any, "-", "facet group that acts as a wall: no penetration, free separation"),
                      required("coefficient", &FrictionSpec::coefficient, non_negative, "-",
                               "Coulomb friction coefficient, tangent of the wall friction angle")};
  }
};

using BoundarySpec = std::variant<FixedSpec, RollerSpec, VelocitySpec, FrictionSpec>;

/// Stress at the start: vertical stress from the weight above, horizontal stress k0 times it.
struct K0Spec {
  Real k0{};
  static constexpr auto fields() { return std::tuple{required("k0", &K0Spec::k0, non_negative, "-", "horizontal over vertical stress")}; }
};

/// Finds the state at rest under the loads: gravity ramp and local damping until the unbalanced force is small.
struct GeostaticSpec {
  static constexpr std::string_view name = "geostatic";
  Real duration{}, ramp = 0, damping = 0.7, residual = 1e-3;
  bool elastic = true, reset_displacement = true;
  std::optional<K0Spec> initial_stress;
  Where where;
  static constexpr auto fields()
  {
    return std::tuple{
        required("duration", &GeostaticSpec::duration, positive, "s", "the stage fails if the residual is not reached by then"),
        optional("ramp", &GeostaticSpec::ramp, non_negative, "s", "gravity and loads grow linearly over this time"),
        optional("damping", &GeostaticSpec::damping, from_to_below(0, 1), "-",
                 "local damping: share of the nodal force that opposes the motion"),
        optional("residual", &GeostaticSpec::residual, positive, "-",
                 "done when the unbalanced nodal force is below this share of the total load"),
        optional("elastic", &GeostaticSpec::elastic, any, "-", "suspend yielding during the stage"),
        optional("reset_displacement", &GeostaticSpec::reset_displacement, any, "-",
                 "displacement of later stages counts from the end of this one"),
        group("initial_stress", &GeostaticSpec::initial_stress, "K0 state to start from, for laws that can carry a prestress")};
  }
  void check(std::vector<std::string>& problems) const;
};

struct RunSpec {
  static constexpr std::string_view name = "run";
  Real duration{}, damping = 0;
  Where where;
  static constexpr auto fields()
  {
    return std::tuple{required("duration", &RunSpec::duration, positive, "s", "length of the stage"),
                      optional("damping", &RunSpec::damping, from_to_below(0, 1), "-", "local damping; 0 for anything that flows")};
  }
};

using StageSpec = std::variant<GeostaticSpec, RunSpec>;

struct ParticleOutputSpec {
  Real every{};
  std::vector<std::string> fields_wanted{"velocity", "displacement", "stress"};
  Where where;
  static constexpr auto fields()
  {
    return std::tuple{
        required("every", &ParticleOutputSpec::every, positive, "s", "time between files"),
        optional("fields", &ParticleOutputSpec::fields_wanted, any, "-",
                 "velocity, displacement, stress, pressure, von_mises, volume, mass, cell, body, F, velocity_gradient, and any "
                 "history variable of a law")};
  }
};

struct MeshOutputSpec {
  Real every{};
  std::vector<std::string> fields_wanted{"mass", "velocity"};
  Where where;
  static constexpr auto fields()
  {
    return std::tuple{required("every", &MeshOutputSpec::every, positive, "s", "time between files"),
                      optional("fields", &MeshOutputSpec::fields_wanted, any, "-", "nodal mass, velocity, force, reaction")};
  }
};

/// Follows the particle that is nearest to a place at the start.
struct PointSpec {
  std::string name;
  std::vector<Real> at;
  std::string body;
  Where where;
  static constexpr auto fields()
  {
    return std::tuple{required("name", &PointSpec::name, any, "-", "prefix of its columns"),
                      required("at", &PointSpec::at, any, "m", "place at the start; the nearest particle is followed"),
                      optional("body", &PointSpec::body, any, "-", "only particles of this body; default any")};
  }
};

enum class Direction : std::uint8_t { x_plus, x_minus, y_plus, y_minus, z_plus, z_minus };
constexpr std::array<std::string_view, 6> words(Direction) { return {"+x", "-x", "+y", "-y", "+z", "-z"}; }

/// How far the mass reaches: run-out, crest height.
struct FrontSpec {
  std::string name;
  Direction direction{};
  Real mass_share = 0.99;
  std::string body;
  Where where;
  static constexpr auto fields()
  {
    return std::tuple{required("name", &FrontSpec::name, any, "-", "name of the column"),
                      required_choice("direction", &FrontSpec::direction, "along which the mass is measured"),
                      optional("mass_share", &FrontSpec::mass_share, within(0, 1), "-",
                               "coordinate below which this share of the mass lies; 1 is the outermost particle"),
                      optional("body", &FrontSpec::body, any, "-", "only this body; default all")};
  }
};

struct HistoryOutputSpec {
  Real every{};
  std::vector<PointSpec> points;
  std::vector<FrontSpec> fronts;
  Where where;
  static constexpr auto fields()
  {
    return std::tuple{required("every", &HistoryOutputSpec::every, positive, "s",
                               "time between rows; energies, momenta, mass, residual and reactions are always there"),
                      optional_list("points", &HistoryOutputSpec::points,
                                    "material points whose position, displacement, velocity and stress are written"),
                      optional_list("fronts", &HistoryOutputSpec::fronts, "extents of the mass")};
  }
};

/// What `talus render` draws unless told otherwise.
struct PictureSpec {
  std::string field = "displacement";
  std::vector<Real> range, view{0.4, -1, 0.5}, up;
  bool mesh = true;
  static constexpr auto fields()
  {
    return std::tuple{
        optional("field", &PictureSpec::field, any, "-", "particle field that colours the particles; vectors by their length"),
        optional("range", &PictureSpec::range, any, "-", "[low, high] of the colour map; default the range of the last frame"),
        optional("view", &PictureSpec::view, any, "-", "3-D: direction from the scene to the camera"),
        optional("up", &PictureSpec::up, any, "-", "3-D: direction that points up in the picture; default against gravity"),
        optional("mesh", &PictureSpec::mesh, any, "-", "draw the outline of the mesh")};
  }
  void check(std::vector<std::string>& problems) const;
};

struct OutputSpec {
  std::optional<ParticleOutputSpec> particles;
  std::optional<MeshOutputSpec> mesh;
  std::optional<HistoryOutputSpec> history;
  PictureSpec picture;
  static constexpr auto fields()
  {
    return std::tuple{group("particles", &OutputSpec::particles, "particle files (.vtp) for ParaView, with a .pvd series"),
                      group("mesh", &OutputSpec::mesh, "mesh files (.vtu) with nodal fields"),
                      group("history", &OutputSpec::history, "history.csv"),
                      optional("picture", &OutputSpec::picture, any, "-", "how talus render draws the run")};
  }
};

enum class OnExit : std::uint8_t { stop, remove };
constexpr std::array<std::string_view, 2> words(OnExit) { return {"stop", "delete"}; }

enum class Accuracy : std::uint8_t { draft, standard, fine };
constexpr std::array<std::string_view, 3> words(Accuracy) { return {"draft", "standard", "fine"}; }

struct Scene {
  std::string file;  ///< path as given, for messages; directory of relative paths
  std::string text;  ///< the file, for the echo in the summary
  std::string title;
  Index dimension{};
  Accuracy accuracy = Accuracy::standard;
  MeshSpec mesh;
  std::string kernel = "umls";
  TimeSpec time;
  TransferSpec transfer;
  std::vector<MaterialSpec> materials;
  std::vector<BodySpec> bodies;
  std::vector<LoadSpec> loads;
  std::vector<BoundarySpec> boundaries;
  std::vector<StageSpec> stages;
  OutputSpec outputs;
  OnExit on_exit = OnExit::stop;
  Index threads = 0;
  Where where;
  static constexpr auto fields()
  {
    return std::tuple{
        required("title", &Scene::title, any, "-", "one line"),
        required("dimension", &Scene::dimension, within(2, 3), "-", "2 (plane strain, unit thickness) or 3"),
        optional_choice(
            "accuracy", &Scene::accuracy,
            "draft: cells twice as large as the mesh block says, few particles, long steps; fine: half as large, many particles; "
            "particles_per_cell and cfl are kept where they are given, and so are meshes from files"),
        group("mesh", &Scene::mesh, "the background mesh"),
        optional("kernel", &Scene::kernel, any, "-", "how particles see nodes"),
        optional("time", &Scene::time, any, "-", "end and step"),
        optional("transfer", &Scene::transfer, any, "-", "how particles and nodes exchange momentum"),
        required_list("materials", &Scene::materials, "constitutive laws with their constants"),
        required_list("bodies", &Scene::bodies, "what is made of particles"),
        optional_list("loads", &Scene::loads, "forces"),
        optional_list("boundaries", &Scene::boundaries, "conditions on the mesh"),
        optional_list("stages", &Scene::stages, "phases of the analysis in order; default one run until time.end"),
        optional("outputs", &Scene::outputs, any, "-", "what is written"),
        optional_choice("on_exit", &Scene::on_exit,
                        "what happens to a particle that leaves the mesh: stop the run, or delete it and keep account of its mass"),
        optional("threads", &Scene::threads, non_negative, "-", "threads to use; 0 means all, --threads wins")};
  }
};

}  // namespace talus
