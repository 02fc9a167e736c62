#pragma once
// The blocks `materials`, `bodies` and `initial` of a scene.
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/fields.hpp"
#include "io/scene/scene_start_state.hpp"
#include "io/scene/shape.hpp"
#include "materials/interface/any_law.hpp"
#include "materials/variation/parameter_variation.hpp"
#include "solver/options/reference_options.hpp"
#include "solver/options/resample_options.hpp"

namespace talus {

struct MaterialSpec {
  std::string name;
  std::optional<BulkViscosity> bulk_viscosity;
  AnyLaw law;
  std::vector<ParameterVariation> variation;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{required("name", &MaterialSpec::name, any, "-", "bodies refer to it"),
                      group("bulk_viscosity", &MaterialSpec::bulk_viscosity,
                            "artificial viscous pressure where the volume shrinks, against ringing behind shocks; default none"),
                      optional_list("variation", &MaterialSpec::variation,
                                    "parameters of the law that vary in space as random fields; each particle has the value of the place "
                                    "where it gets the material"),
                      alternative("law", &MaterialSpec::law, "constitutive law; its parameters are keys of the same mapping")};
  }
};

/// A body fills a cell group or a shape, or takes its particles from another run (scene_rules.cpp).
struct BodySpec {
  std::string name, material;
  std::string region;
  std::optional<Shape> shape;
  std::optional<Index> particles_per_cell;  ///< has a value in every body of a scene that was read, if it fills anything
  std::optional<bool> f_bar;
  std::optional<ReferenceOptions> reference;
  std::optional<ResampleOptions> resample;
  std::vector<std::string> velocity;
  std::optional<Real> saturated_density;
  std::optional<StartStateSpec> initial;
  SourceLocation where;
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
                 "against locking: the law sees the volume ratio averaged over the cells around nodes; default true under von_mises, "
                 "johnson_cook and mechanical_threshold, whose flow keeps the volume, false otherwise"),
        group("reference", &BodySpec::reference,
              "the configuration to which weights and gradients belong; default the present one, renewed in each step"),
        group("resample", &BodySpec::resample,
              "particles that shear or expansion draws apart are split, and merged again where they crowd; without it they stay what they "
              "are"),
        optional("velocity", &BodySpec::velocity, any, "m/s",
                 "initial velocity, one number or formula of x, y, z per dimension, such as \"0.1 * sin(pi * x / 50)\": see formulas"),
        optional("saturated_density", &BodySpec::saturated_density, positive, "kg/m^3",
                 "mass density, pores full of water, of the particles that lie below the water table at the start; default that of the "
                 "material"),
        group("initial", &BodySpec::initial,
              "stress and other values that the body starts with, from a table of points: the state of another program")};
  }
  bool fills() const noexcept { return !region.empty() || shape.has_value(); }

  /// Keys of a body whose particles come from another run.  All others say how a body is filled, and would not be used there.
  static constexpr std::array<std::string_view, 5> keys_without_filling{"name", "material", "f_bar", "reference", "resample"};
  /// f(key, whether it is given) for every other key.
  template <class F>
  void for_each_key_of_filling(F&& f) const
  {
    for_each_field<BodySpec>([&](const auto& field) {
      if (std::find(keys_without_filling.begin(), keys_without_filling.end(), field.key) != keys_without_filling.end())
        return;
      const auto& value = this->*field.member;
      if constexpr (requires { value.has_value(); })
        f(field.key, value.has_value());
      else
        f(field.key, !value.empty());
    });
  }
};

/// A body of the scene, and the body of the other run whose particles it takes.
struct TakenSpec {
  std::string body, from;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{required("body", &TakenSpec::body, any, "-", "name of a body of this scene"),
                      optional("from", &TakenSpec::from, any, "-", "name of the body there; default the same name")};
  }
};

/// Bodies that start from the state of another run.
struct InitialSpec {
  std::string from;
  std::vector<TakenSpec> bodies;
  Carried velocity = Carried::keep, displacement = Carried::zero;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{required("from", &InitialSpec::from, any, "-",
                               "folder of a run, whose newest whole checkpoint is taken, or a checkpoint; relative to this file"),
                      optional_list("bodies", &InitialSpec::bodies,
                                    "bodies that take their particles from there, and so give no shape, region, particles_per_cell or "
                                    "velocity; default every body that has one of its name there"),
                      optional_choice("velocity", &InitialSpec::velocity, "keep: particles move on; zero: they begin at rest"),
                      optional_choice("displacement", &InitialSpec::displacement,
                                      "zero: counts from this start; keep: goes on from that of the run there")};
  }
};

}  // namespace talus
