#pragma once
// What a scene consists of, as JSON for programs that make runs of it: talus check --json.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/types.hpp"

namespace talus {

/// The law of a body in a stage.
struct FactsOfLaw {
  std::string material, law;
  bool has_strength = false;
  Real strength_divided_by = 1;             ///< by `weaken` of this stage and earlier ones
  std::vector<std::string> variables = {};  ///< scalar history variables
};

struct FactsOfBody {
  std::string name;
  SourceLocation where;
  std::vector<std::optional<FactsOfLaw>> stages;  ///< for each stage; nothing where the body is absent
  // Only with a mesh:
  std::int64_t particles = 0;
  Real lowest = 0, highest = 0;  ///< positions of its particles along `up` [m]
  Real wave_speed = 0;           ///< of its undeformed material [m/s]
};

struct FactsOfMesh {
  std::int64_t cells = 0, nodes = 0;
  std::string digest;
};

struct SceneFacts {
  std::string file, title, digest, keys;  ///< `keys`: all keys of the scene with their changes, as JSON
  std::vector<std::string> overrides, warnings;
  int dimension = 0;
  Real gravity = 0;             ///< magnitude [m/s^2]
  std::array<Real, 3> up = {};  ///< unit vector
  struct Stage {
    std::string name, type;
  };
  std::vector<Stage> stages;
  std::vector<FactsOfBody> bodies;
  std::vector<SourceLocation> blocks;  ///< places of the blocks `mesh` and, if it is there, `initial`
  std::optional<FactsOfMesh> mesh;     ///< nothing if it was not made
};

std::string to_json(const SceneFacts& facts);

}  // namespace talus
