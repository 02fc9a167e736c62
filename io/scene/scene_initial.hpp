#pragma once
// The block `initial` of a scene.
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/fields.hpp"

namespace talus {

/// What happens to a quantity of particles that come from another run.
enum class Carried : std::uint8_t { keep, zero };
constexpr std::array<std::string_view, 2> enum_names(Carried) { return {"keep", "zero"}; }

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
