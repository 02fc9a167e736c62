#pragma once
// The parts of the manual: one for each mapping of a scene and each word that chooses a mapping, generated from the field lists that also
// read the file.
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace talus {

/// A row of the table of keys: key, type, unit, range, default, meaning; in Markdown.
using ManualRow = std::array<std::string, 6>;

/// An output of a run: a history variable of a law, an output field, or columns of history.csv.
struct ManualOutput {
  std::vector<std::string> names;  ///< one name for each component
  int components;
  std::string unit, meaning;
};
struct ManualOutputs {
  std::string heading, kind;  ///< for example "Fields:" and "field, for outputs.mesh.fields"
  std::vector<ManualOutput> rows;
};

/// The keys of a mapping, or the choices of a key.
struct ManualPart {
  std::string title;
  std::string path;                      ///< path of the mapping in a scene; for a list, of its entries
  std::string chosen{};                  ///< the word that chooses these keys: a law, a type
  std::string text{};                    ///< text before the keys
  std::vector<ManualRow> rows{};         ///< table of keys
  std::vector<ManualOutputs> outputs{};  ///< outputs
};

/// The name of the mapping that is the whole scene.
inline constexpr std::string_view title_of_scene = "the scene";

std::vector<ManualPart> manual_parts();

/// The name and summary of every kernel.
std::vector<std::array<std::string_view, 2>> kernel_summaries();

}  // namespace talus
