#pragma once
// The scene: plain typed values, one struct per block of the file.  Their field lists are the user manual.  A struct may have
// `SourceLocation where` (set by the reader to the position of its mapping) and `void check(std::vector<std::string>&) const` (rules
// between its keys, in words).  Rules between blocks are in scene_rules.hpp; rules that need the mesh are checked when the model is built,
// with the same error type.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/fields.hpp"
#include "core/particle_column.hpp"
#include "io/scene/scene_bodies.hpp"
#include "io/scene/scene_contacts.hpp"
#include "io/scene/scene_loads.hpp"
#include "io/scene/scene_mesh.hpp"
#include "io/scene/scene_output.hpp"
#include "io/scene/scene_rigid.hpp"
#include "io/scene/scene_stages.hpp"
#include "kernels/kernel_options.hpp"
#include "mesh/conditions/conditions.hpp"
#include "solver/options/limit_options.hpp"
#include "solver/options/transfer_options.hpp"

namespace talus {

struct TimeSpec {
  Real end = 0;
  std::optional<Real> cfl;  ///< set in every scene that was read
  std::optional<Real> max_step;
  Real min_step = 1e-12;
  SourceLocation where;
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

/// A script in Python that is called during the run.
struct ScriptSpec {
  std::string file;
  Index every = 1;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{required("file", &ScriptSpec::file, any, "-", "script (.py) with functions start, step, history and end"),
                      optional("every", &ScriptSpec::every, at_least(1), "-", "its function step is called after every so many steps")};
  }
};

enum class Accuracy : std::uint8_t { draft, standard, fine };
constexpr std::array<std::string_view, 3> enum_names(Accuracy) { return {"draft", "standard", "fine"}; }

struct Scene {
  std::string file;                    ///< path as given, for messages; relative paths start in its directory
  std::string text;                    ///< text of the file, for the summary
  std::vector<std::string> overrides;  ///< changes by --set
  std::string title;
  Index dimension{};
  Accuracy accuracy = Accuracy::standard;
  MeshSpec mesh;
  std::string kernel = "projected";
  std::optional<UmlsOptions> umls;
  std::optional<ProjectedOptions> projected;
  TimeSpec time;
  TransferOptions transfer;
  std::vector<MaterialSpec> materials;
  std::vector<BodySpec> bodies;
  std::optional<InitialSpec> initial;
  std::optional<WaterSpec> water;
  std::vector<LoadSpec> loads;
  std::vector<ContactSpec> contacts;
  std::vector<CutSpec> cuts;
  std::vector<RigidSpec> rigid;
  std::vector<BoundaryOptions> boundaries;
  std::vector<StageSpec> stages;
  OutputSpec outputs;
  std::optional<ScriptSpec> script;
  OnExit on_exit = OnExit::stop;
  LimitOptions watch;
  Index threads = 0;
  bool strict = false;
  SourceLocation where;
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
        group("umls", &Scene::umls, "choices of the kernel umls"),
        group("projected", &Scene::projected, "choices of the kernel projected"),
        optional("time", &Scene::time, any, "-", "end and step"),
        optional("transfer", &Scene::transfer, any, "-", "how particles and nodes exchange momentum"),
        required_list("materials", &Scene::materials, "constitutive laws with their constants"),
        required_list("bodies", &Scene::bodies, "what is made of particles"),
        group("initial", &Scene::initial, "bodies that begin as another run left them"),
        group("water", &Scene::water, "pore pressure below a water table; default none"),
        optional_list("loads", &Scene::loads, "forces"),
        optional_list("contacts", &Scene::contacts,
                      "bodies that touch, slide and part, each with velocities of its own; without, all bodies stick to each other"),
        optional_list("cuts", &Scene::cuts,
                      "facet groups inside the mesh whose sides slide and part: faults, joints, sheet piles; each has its own nodes there"),
        optional_list("rigid", &Scene::rigid,
                      "bodies that do not deform, free or with a given motion; they touch material, walls and each other"),
        optional_list("boundaries", &Scene::boundaries, "conditions on the mesh"),
        optional_list("stages", &Scene::stages, "phases of the analysis in order; default one run until time.end"),
        optional("outputs", &Scene::outputs, any, "-", "what is written"),
        group("script", &Scene::script, "a script in Python that sees the run between its steps"),
        optional_choice("on_exit", &Scene::on_exit,
                        "what happens to a particle that leaves the mesh: stop the run, or delete it and keep account of its mass"),
        optional("watch", &Scene::watch, any, "-", "what no sound run does, and what becomes of one that does"),
        optional("threads", &Scene::threads, non_negative, "-",
                 "threads to use; 0: as many as pay for the particles, all at most; --threads wins"),
        optional(
            "strict", &Scene::strict, any, "-",
            "a run fails at its end, with its results written and exit code 1, if a balance does not close or transfer_loss is more than "
            "a tenth of the plastic work; without it these are warnings")};
  }
};

/// The names of boundary conditions in outputs and stages: that of the group of the condition; the second one on a group is `<group>_2`,
/// and so on.
std::vector<std::string> wall_names(const std::vector<BoundaryOptions>& boundaries);

/// A unit vector against gravity; nothing where the scene has none.
std::optional<Vec3> against_gravity(const Scene& scene);

/// The same; without gravity y in 2-D and z in 3-D.
Vec3 upright_of(const Scene& scene);

}  // namespace talus
