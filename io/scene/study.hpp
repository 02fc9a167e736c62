#pragma once
// The file of `talus sweep`: a scene, its varied keys, and the numbers to collect from each case.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/fields.hpp"
#include "io/document/document.hpp"

namespace talus {

/// How values of several keys are combined: grid: each with each of the others; rows: the first with the first, the second with the second;
/// latin: samples of distributions; tornado: one key at a time, with its low and its high value and the middle values of the others.
enum class Combine : std::uint8_t { grid, rows, latin, tornado };
constexpr std::array<std::string_view, 4> enum_names(Combine) { return {"grid", "rows", "latin", "tornado"}; }

/// A text of the file with its position.
struct Written {
  std::string text;
  SceneError at;  ///< position, without a message
  SceneError problem(std::string message) const { return {at.where, std::move(message), at.source_line}; }
};

/// A key of the scene as in --set, and its values.
struct Varied {
  std::string key;
  std::vector<Written> values;  ///< latin: the samples; tornado: middle, low, high
};

/// Maps of the cases, from which the frequency of exceeding a value is computed.
struct ExceedSpec {
  std::string map;
  Real above = 0;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{required("map", &ExceedSpec::map, any, "-", "name of a map of outputs.runout, such as thickness_max"),
                      required("above", &ExceedSpec::above, any, "-", "in the unit of the map")};
  }
};

struct Study {
  std::string file;  ///< path as given
  Written scene;     ///< path of the scene, relative to the study
  std::vector<Varied> vary;
  Combine combine = Combine::grid;
  std::vector<Written> collect;  ///< names of numbers; empty: the default ones
  std::vector<ExceedSpec> exceed;
};

/// A value of each key, in the order of Study::vary.
using StudyCase = std::vector<Written>;

/// The cases.  Grid: the last key varies fastest.  Tornado: all keys in the middle, then the low and the high case of each key.
std::vector<StudyCase> cases_of(const Study& study);

/// "key=value" for each key, as in --set.
std::vector<std::string> changes_of(const Study& study, const StudyCase& values);

/// The path of the scene relative to the present folder.
std::filesystem::path scene_of(const Study& study);

/// The contents of the file before it is checked as a whole.
struct StudySpec {
  std::string scene;
  Node vary;
  Combine combine = Combine::grid;
  std::optional<Index> samples, seed;
  std::vector<std::string> collect;
  std::vector<ExceedSpec> exceed;
  static constexpr auto fields()
  {
    return std::tuple{
        required("scene", &StudySpec::scene, any, "-", "file of the scene, relative to this file"),
        required("vary", &StudySpec::vary, any, "-",
                 "keys of the scene, each with a list of values; for latin and tornado with a distribution"),
        optional_choice(
            "combine", &StudySpec::combine,
            "grid: each value with each; rows: the first with the first, and so on; latin: samples of distributions; tornado: low "
            "and high of one key at a time"),
        optional("samples", &StudySpec::samples, at_least(2), "-", "latin: so many cases"),
        optional("seed", &StudySpec::seed, non_negative, "-", "latin: another one gives other samples; default 1"),
        optional("collect", &StudySpec::collect, any, "-", "numbers of summary.json and history.csv for the table"),
        optional_list("exceed", &StudySpec::exceed, "maps of the cases: which share of them exceeds a value, place by place")};
  }
};

/// The study in `file`, whose tree is `root`; errors are added to `problems`.
Study study_of(const std::filesystem::path& file, const Node& root, const StudySpec& spec, Problems& problems);

}  // namespace talus
