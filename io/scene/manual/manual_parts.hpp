#pragma once
// The manual in parts: one for each mapping of a scene and each word that one chooses from, out of the field lists that also read the file.
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace talus {

/// Of a key: itself, type, unit, range, default, meaning; in Markdown.
using ManualRow = std::array<std::string, 6>;

/// What a run writes: a history variable of a law, an output field, columns of history.csv.
struct ManualOutput {
  std::vector<std::string> names;  ///< of columns one for each component
  int components;
  std::string unit, meaning;
};
struct ManualOutputs {
  std::string heading, kind;  ///< "Fields:", "field, for outputs.mesh.fields"
  std::vector<ManualOutput> rows;
};

/// The keys of a mapping, or what a key chooses from.
struct ManualPart {
  std::string title;
  std::string path;                      ///< of the mapping in a scene; of a list for an entry of it
  std::string chosen{};                  ///< the word that makes the mapping have these keys: a law, a type
  std::string text{};                    ///< before the keys
  std::vector<ManualRow> rows{};         ///< keys
  std::vector<ManualOutputs> outputs{};  ///< what there is to write
};

/// What the mapping that is the whole scene is called.
inline constexpr std::string_view title_of_scene = "the scene";

std::vector<ManualPart> manual_parts();

/// Name and summary of every kernel.
std::vector<std::array<std::string_view, 2>> kernel_summaries();

}  // namespace talus
