#pragma once
// Variants of a scene that are checked together, and what was found in each: as JSON, for programs that make many runs.
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/types.hpp"

namespace talus {

struct Variant {
  std::vector<std::string> changes;  ///< as for --set
  std::string built_on;              ///< digest of a mesh with which its model is known to be in order; or empty
};

/// How far a check goes: until scenes are read, until their meshes are made, or until models are built.
enum class CheckDepth : std::uint8_t { scenes, meshes, models };

/// {"check": "models", "quick": false, "variants": [{"set": ["time.end=2"], "built_on": "0123456789abcdef"}]}
struct VariantsAsked {
  CheckDepth depth = CheckDepth::models;
  bool quick = false;
  std::vector<Variant> variants;
};

/// Throws Error with the name of the file if it contains something else.
VariantsAsked read_variants(const std::filesystem::path& file);

struct VariantFound {
  std::string scene_digest, mesh_digest;  ///< as in summary.json; empty if unknown
  std::vector<std::string> fronts;        ///< columns of run-out in the history
  std::int64_t cells = 0, particles = 0;  ///< of a mesh and a model that were made
  Real cell_size = 0;                     ///< (volume of the mesh / cells)^(1/D) [m]
  std::vector<SceneError> errors;
};

/// {"commit": ..., "variants": [{"scene_digest": ..., "mesh_digest": ..., "fronts": [...], "cells": ..., "cell_size [m]": ..., "particles":
/// ..., "errors": [{"file": ..., "line": ..., "column": ..., "key": ..., "text": ..., "source": ...}]}]}, with the variants in their order.
std::string variants_text(const std::string& commit, const std::vector<VariantFound>& found);

}  // namespace talus
