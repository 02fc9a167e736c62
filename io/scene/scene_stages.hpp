#pragma once
// The block `stages` of a scene.
#include <algorithm>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/error.hpp"
#include "core/fields.hpp"
#include "core/time_table.hpp"
#include "io/scene/scene_surface.hpp"

namespace talus {

/// A uniform stress in a body [Pa].
struct UniformStressSpec {
  Real xx{}, yy{}, zz{}, xy = 0, yz = 0, xz = 0;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{
        required("xx", &UniformStressSpec::xx, any, "Pa", "normal stress along x; tension is positive, so ground has a negative one"),
        required("yy", &UniformStressSpec::yy, any, "Pa", "normal stress along y"),
        required("zz", &UniformStressSpec::zz, any, "Pa", "normal stress along z; in 2 dimensions that out of the plane"),
        optional("xy", &UniformStressSpec::xy, any, "Pa", "shear stress"),
        optional("yz", &UniformStressSpec::yz, any, "Pa", "shear stress, in 3 dimensions"),
        optional("xz", &UniformStressSpec::xz, any, "Pa", "shear stress, in 3 dimensions")};
  }
};

/// The ratio of horizontal to vertical stress, of effective stresses where the law uses them: a number, by depth, or from the friction of
/// the law.  Alternatively the stress itself.
struct K0Rule {
  std::optional<Real> k0;
  std::vector<std::vector<Real>> k0_table;
  bool from_friction = false;
  Real ocr = 1;
  std::optional<UniformStressSpec> stress;
  int given() const noexcept { return (k0 ? 1 : 0) + (k0_table.empty() ? 0 : 1) + (from_friction ? 1 : 0) + (stress ? 1 : 0); }
  void check_rule(std::vector<std::string>& problems) const;
};

/// The fields of a struct that inherits K0Rule, to be joined with its own by std::tuple_cat.
template <class Spec>
constexpr auto k0_fields()
{
  std::optional<Real> Spec::*const k0 = &Spec::k0;
  std::vector<std::vector<Real>> Spec::*const table = &Spec::k0_table;
  bool Spec::*const from_friction = &Spec::from_friction;
  Real Spec::*const ocr = &Spec::ocr;
  std::optional<UniformStressSpec> Spec::*const stress = &Spec::stress;
  return std::tuple{
      optional("k0", k0, non_negative, "-", "horizontal over vertical stress, of effective stresses where there is water"),
      optional("k0_table", table, non_negative, "m, -",
               "the same by depth below the ground, [[depth, k0], ...]: linear in between, constant outside"),
      optional("from_friction", from_friction, any, "-",
               "the same from the angle of friction phi of the law, (1 - sin phi) ocr^(sin phi) (Jaky; Mayne & Kulhawy), at most passive"),
      optional("ocr", ocr, at_least(1), "-", "overconsolidation ratio, for from_friction"),
      group(
          "stress", stress,
          "instead of a ratio the stress itself, the same everywhere, as deep in the ground or in a test without gravity; effective stress "
          "in drained bodies, to which the pore pressure comes")};
}

/// The ratio of one body that differs from the others.
struct K0OfBody : K0Rule {
  std::string body;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple_cat(std::tuple{required("body", &K0OfBody::body, any, "-", "name of a body")}, k0_fields<K0OfBody>());
  }
  void check(std::vector<std::string>& problems) const;
};

/// The initial stress: vertical stress from the weight above and horizontal stress in a given ratio to it, or a given stress.
struct K0Spec : K0Rule {
  std::vector<K0OfBody> bodies;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple_cat(k0_fields<K0Spec>(), std::tuple{optional_list("bodies", &K0Spec::bodies, "bodies with a ratio of their own")});
  }
  void check(std::vector<std::string>& problems) const;
  /// The rule of a body: its own, or that of all bodies.
  const K0Rule& of(const std::string& body) const noexcept;
};

/// A change of the material of a body.
struct NewMaterialSpec {
  std::string body, material;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{required("body", &NewMaterialSpec::body, any, "-", "name of a body that is there in this stage"),
                      required("material", &NewMaterialSpec::material, any, "-", "name of the material that it has from this stage on")};
  }
};

/// A reduction of shear strength, as a trigger.
struct WeakenSpec {
  std::string body;
  Real factor{};
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{
        optional("body", &WeakenSpec::body, any, "-", "name of a body that is there in this stage; default all whose law has strength"),
        required("factor", &WeakenSpec::factor, positive, "-",
                 "cohesion and tangent of the friction angle are divided by it, from this stage on")};
  }
};

/// Another water table.
struct StageWaterSpec {
  SurfaceSpec table;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{group("table", &StageWaterSpec::table,
                            "the water table from this stage on; cut at the ground, which is that of the bodies of this stage as the scene "
                            "places them")};
  }
};

/// The keys that stages of all types have in common: the name, and the changes before the first step.
struct StageChanges {
  std::string label;  ///< name; empty: that of its type
  std::vector<std::string> appear, vanish;
  std::vector<NewMaterialSpec> change;
  std::vector<WeakenSpec> weaken;
  std::optional<StageWaterSpec> water;
  static constexpr auto fields()
  {
    return std::tuple{
        optional("name", &StageChanges::label, any, "-", "in messages and results, and for during of boundaries; default its type"),
        optional("appear", &StageChanges::appear, any, "-", "bodies that are placed before its first step, and are not there before it"),
        optional("vanish", &StageChanges::vanish, any, "-", "bodies that are taken away before its first step"),
        optional_list("change", &StageChanges::change, "bodies that go on as another material"),
        optional_list("weaken", &StageChanges::weaken, "shear strength that drops"),
        group("water", &StageChanges::water, "another water table, from this stage on; default that of the stage before")};
  }
};

/// A stage that finds equilibrium under the loads: gravity ramp and local damping until the unbalanced force is small.
struct GeostaticSpec : StageChanges {
  static constexpr std::string_view name = "geostatic";
  Real duration{}, ramp = 0, damping = 0.7, residual = 1e-3;
  RampShape ramp_shape = RampShape::linear;
  bool elastic = true, reset_displacement = true;
  std::optional<K0Spec> initial_stress;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple_cat(
        std::tuple{
            required("duration", &GeostaticSpec::duration, positive, "s", "the stage fails if the residual is not reached by then"),
            optional("ramp", &GeostaticSpec::ramp, non_negative, "s", "gravity and loads grow over this time"),
            optional_choice("ramp_shape", &GeostaticSpec::ramp_shape,
                            "how they grow: linear, or smooth, beginning and ending with the rate zero, which leaves less swing where the "
                            "ramp takes one and a half periods or more"),
            optional("damping", &GeostaticSpec::damping, from_to_below(0, 1), "-",
                     "local damping: share of the nodal force that opposes the motion"),
            optional("residual", &GeostaticSpec::residual, positive, "-",
                     "done when the unbalanced nodal force is below this share of the total load and the kinetic energy at most this "
                     "share of the work done, 20 steps in a row"),
            optional("elastic", &GeostaticSpec::elastic, any, "-", "suspend yielding during the stage"),
            optional("reset_displacement", &GeostaticSpec::reset_displacement, any, "-",
                     "displacement of later stages counts from the end of this one"),
            group("initial_stress", &GeostaticSpec::initial_stress,
                  "stress to start from, by K0 or as given, for laws that can carry a prestress; in a later stage of the bodies that "
                  "appear")},
        StageChanges::fields());
  }
  void check(std::vector<std::string>& problems) const;
};

struct RunSpec : StageChanges {
  static constexpr std::string_view name = "run";
  Real duration{}, damping = 0;
  bool hold_pore_pressure = false;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple_cat(
        std::tuple{required("duration", &RunSpec::duration, positive, "s", "length of the stage"),
                   optional("damping", &RunSpec::damping, from_to_below(0, 1), "-", "local damping; 0 for anything that flows"),
                   optional("hold_pore_pressure", &RunSpec::hold_pore_pressure, any, "-",
                            "water that flows stands still and keeps its pressures, as in a geostatic stage")},
        StageChanges::fields());
  }
};

/// A stage that solves for equilibrium under loads that grow in increments: no inertia, no time.
struct StaticSpec : StageChanges {
  static constexpr std::string_view name = "static";
  Real duration = 1, residual = 1e-8, unbalanced = 2e-2;
  int increments = 10, iterations = 50, cuts = 10;
  std::optional<bool> grow;
  bool keep_jump_stress = true, elastic = false, reset_displacement = false;
  std::optional<K0Spec> initial_stress;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple_cat(
        std::tuple{
            optional("increments", &StaticSpec::increments, at_least(1), "-",
                     "in which the loads act; one that is not solved is cut in halves, and the next ones grow again"),
            optional("residual", &StaticSpec::residual, positive, "-",
                     "an increment is solved when the unbalanced nodal forces are below this share of the loads"),
            optional("iterations", &StaticSpec::iterations, at_least(1), "-", "most of Newton's method in an increment"),
            optional("cuts", &StaticSpec::cuts, within(0, 30), "-",
                     "how often an increment that is not solved is cut before the stage fails"),
            optional("unbalanced", &StaticSpec::unbalanced, positive, "-",
                     "the stage fails if at its end a larger share of the loads is out of balance for the steps behind it"),
            optional("keep_jump_stress", &StaticSpec::keep_jump_stress, any, "-",
                     "whether particles and empty cells beside them keep the stress against displacements that the kernel does not see; "
                     "false: it begins anew in each increment, so that ground which does not stand moves on in each"),
            optional("grow", &StaticSpec::grow, any, "-",
                     "whether gravity and loads grow from zero; default true in the first stage if its bodies begin without "
                     "stress, else false: they "
                     "act from its beginning, and tables and prescribed velocities alone change in it"),
            optional("duration", &StaticSpec::duration, positive, "s",
                     "by how much time goes on, for tables, prescribed velocities and outputs; rates are those of this time"),
            optional("elastic", &StaticSpec::elastic, any, "-", "suspend yielding during the stage"),
            optional("reset_displacement", &StaticSpec::reset_displacement, any, "-",
                     "displacement of later stages counts from the end of this one"),
            group("initial_stress", &StaticSpec::initial_stress,
                  "stress to start from, by K0 or as given, for laws that can carry a prestress; in a later stage of the bodies that "
                  "appear")},
        StageChanges::fields());
  }
};

/// A stage that goes through states of equilibrium in time: slow motions, creep.
struct QuasiStaticSpec : StageChanges {
  static constexpr std::string_view name = "quasi_static";
  Real duration{}, residual = 1e-6;
  int increments = 100, iterations = 50, cuts = 10;
  bool elastic = false;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple_cat(
        std::tuple{required("duration", &QuasiStaticSpec::duration, positive, "s", "length of the stage"),
                   optional("increments", &QuasiStaticSpec::increments, at_least(1), "-",
                            "into which it is divided; one that is not solved is cut in halves, and the next ones grow again"),
                   optional("residual", &QuasiStaticSpec::residual, positive, "-",
                            "an increment is solved when the unbalanced nodal forces are below this share of the loads"),
                   optional("iterations", &QuasiStaticSpec::iterations, at_least(1), "-", "most of Newton's method in an increment"),
                   optional("cuts", &QuasiStaticSpec::cuts, within(0, 30), "-",
                            "how often an increment that is not solved is cut before the stage fails"),
                   optional("elastic", &QuasiStaticSpec::elastic, any, "-", "suspend yielding during the stage")},
        StageChanges::fields());
  }
};

using StageSpec = std::variant<GeostaticSpec, RunSpec, StaticSpec, QuasiStaticSpec>;

/// Where the stage says what stress it begins with; nothing where it cannot.
inline const K0Spec* initial_stress_of(const StageSpec& stage)
{
  return std::visit(
      [](const auto& spec) -> const K0Spec* {
        if constexpr (requires { spec.initial_stress; })
          return spec.initial_stress ? &*spec.initial_stress : nullptr;
        else
          return nullptr;
      },
      stage);
}
/// Whether it ends in equilibrium, and does not go on in time.
inline bool seeks_equilibrium(const StageSpec& stage)
{
  return std::holds_alternative<GeostaticSpec>(stage) || std::holds_alternative<StaticSpec>(stage);
}
inline bool is_solved(const StageSpec& stage)
{
  return std::holds_alternative<StaticSpec>(stage) || std::holds_alternative<QuasiStaticSpec>(stage);
}

inline const StageChanges& changes_of(const StageSpec& stage)
{
  return std::visit([](const auto& spec) -> const StageChanges& { return spec; }, stage);
}
inline const SourceLocation& where_of(const StageSpec& stage)
{
  return std::visit([](const auto& spec) -> const SourceLocation& { return spec.where; }, stage);
}
/// The name in messages and results.
inline std::string name_of(const StageSpec& stage)
{
  const std::string& label = changes_of(stage).label;
  return label.empty() ? std::visit([]<class Spec>(const Spec&) { return std::string(Spec::name); }, stage) : label;
}

/// The stages in which a body is present: [from, until).
struct Presence {
  Index from = 0, until = std::numeric_limits<Index>::max();
  bool in(Index stage) const noexcept { return from <= stage && stage < until; }
};
inline Presence presence_of(const std::string& body, std::span<const StageSpec> stages)
{
  Presence presence;
  const auto names = [&](const std::vector<std::string>& list) { return std::find(list.begin(), list.end(), body) != list.end(); };
  for (std::size_t s = stages.size(); s-- > 0;) {
    if (names(changes_of(stages[s]).appear))
      presence.from = static_cast<Index>(s);
    if (names(changes_of(stages[s]).vanish))
      presence.until = static_cast<Index>(s);
  }
  return presence;
}

}  // namespace talus
