#include "io/scene/manual/manual_parts.hpp"

#include <cctype>
#include <functional>
#include <typeindex>
#include <unordered_map>
#include <utility>

#include "core/word_match.hpp"
#include "io/document/field_reader.hpp"
#include "io/document/field_words.hpp"
#include "io/document/key_aliases.hpp"
#include "io/output/history_columns.hpp"
#include "io/output/output_fields.hpp"
#include "io/scene/manual/markdown_table.hpp"
#include "io/scene/scene.hpp"
#include "kernels/kernels.hpp"
#include "materials/interface/law_variant.hpp"

namespace talus {

namespace {

/// Makes a row; not a template, because there are some hundred kinds of fields.
ManualRow row_of(std::string_view key, std::string type, std::string_view unit, std::string range, std::string fallback,
                 std::string_view meaning)
{
  return {code(key), std::move(type), std::string(unit), std::move(range), std::move(fallback), std::string(meaning)};
}

std::string in_words(std::span<const std::string_view> all)
{
  std::vector<std::string> quoted;
  for (const auto word : all)
    quoted.push_back(code(word));
  return or_list(quoted);
}

class Manual {
 public:
  template <HasFields T>
  static std::vector<ManualPart> write()
  {
    Manual manual;
    manual.section<T>(std::string(title_of_scene));
    while (!manual.waiting_.empty()) {
      const auto next = std::move(manual.waiting_.front());
      manual.waiting_.erase(manual.waiting_.begin());
      const auto later = std::exchange(manual.waiting_, {});
      next();  // a type that it mentions follows directly
      manual.waiting_.insert(manual.waiting_.end(), later.begin(), later.end());
    }
    return std::move(manual.parts_);
  }

 private:
  /// The link to the section of a type, which is written once, after the section that first mentions it.
  template <class T>
  std::string link(const std::string& path)
  {
    if constexpr (std::same_as<T, SimpleShape>)
      return link<Shape>(path);  // equal except for combined shapes, as the meaning of the key says
    const std::string own = std::same_as<T, Shape>         ? "shape"
                            : std::same_as<T, Box>         ? "box"
                            : std::same_as<T, SurfaceSpec> ? "surface"
                                                           : path;
    const auto [title, is_new] = titles_.emplace(std::type_index(typeid(T)), own);
    if (is_new)
      waiting_.push_back([this, own] { section<T>(own); });
    std::string anchor;
    for (const char c : title->second)
      if (c != '.')
        anchor += c;
    return fmt::format("[{}](#{})", title->second, anchor);
  }

  template <HasFields T>
  void section(const std::string& path)
  {
    const std::string in_scene = path == title_of_scene ? "" : path;
    ManualPart part{.title = path, .path = in_scene};
    add_rows<T>(part.rows, in_scene.empty() ? "" : in_scene + ".");
    add_outputs<T>(part);
    parts_.push_back(std::move(part));
    for_each_field<T>([&](const auto& field) { add_alternatives_of(field, in_scene); });
  }
  template <class Variant>
  requires(!HasFields<Variant>) void section(const std::string& path)
  {
    parts_.push_back({.title = path, .path = path, .text = "One of these, chosen by the key `type`.\n"});
    add_each_alternative("type", path, path, std::type_identity<Variant>{});
  }

  /// Adds the keys of a mapping at `path`; `prefix` replaces the choosing word in the names of its own mappings.
  template <class... T>
  void add_each_alternative(std::string_view key, const std::string& path, const std::string& prefix,
                            std::type_identity<std::variant<T...>>)
  {
    (add_alternative<T>(key, path, prefix), ...);
  }
  template <class T>
  void add_alternative(std::string_view key, const std::string& path, const std::string& prefix)
  {
    ManualPart part{.title = fmt::format("{}: {}", key, T::name), .path = path, .chosen = std::string(T::name)};
    add_rows<T>(part.rows, (prefix.empty() ? part.chosen : prefix) + ".");
    if constexpr (requires { T::summary; })
      part.text = sentence(T::summary) + "\n\n";
    if constexpr (requires { typename T::State; })
      add_history<typename T::State>(part);
    parts_.push_back(std::move(part));
  }

  template <class State>
  static void add_history(ManualPart& part)
  {
    ManualOutputs variables{"It keeps, for output:", "history variable, for outputs.particles.fields", {}};
    for_each_field<State>([&]<class Owner, class Value>(const History<Owner, Value>& variable) {
      variables.rows.push_back(
          {{std::string(variable.key)}, components_of_history<Value>, std::string(variable.unit), std::string(variable.meaning)});
    });
    if (!variables.rows.empty())
      part.outputs.push_back(std::move(variables));
  }

  template <class Table>
  static void add_fields(const Table& table, ManualPart& part)
  {
    ManualOutputs fields{"Fields:", fmt::format("field, for {}.fields", part.path), {}};
    for_each_quantity(table, [&](const auto& field) {
      fields.rows.push_back({{std::string(field.name)}, components_of(field.kind), std::string(field.unit), std::string(field.meaning)});
    });
    part.outputs.push_back(std::move(fields));
  }

  /// Adds columns; `owner` stands for the name of their subject.
  template <class Table>
  static void add_columns(std::string heading, const Table& table, std::string_view owner, ManualPart& part)
  {
    ManualOutputs columns{std::move(heading), "column of history.csv", {}};
    for_each_quantity(table, [&](const auto& row) {
      ManualOutput column{{}, 0, std::string(row.unit), std::string(row.meaning)};
      for (const CsvColumn& one : csv_columns(std::tuple{row}, owner, 3))
        column.names.push_back(one.name);
      column.components = static_cast<int>(column.names.size());
      columns.rows.push_back(std::move(column));
    });
    part.outputs.push_back(std::move(columns));
  }

  template <class T>
  static void add_outputs(ManualPart& part)
  {
    if constexpr (std::same_as<T, ParticleOutputSpec>) {
      add_fields(particle_fields(), part);
    } else if constexpr (std::same_as<T, MeshOutputSpec>) {
      add_fields(node_fields(), part);
    } else if constexpr (std::same_as<T, HistoryOutputSpec>) {
      add_columns("Columns that are always there; in 2-D without those of the third axis, and with angular_momentum_z alone:",
                  run_columns(), "", part);
      add_columns("Columns of every wall:", reaction_columns(), "WALL", part);
      add_columns("Columns of each of the bodies:", body_columns(), "BODY", part);
    } else if constexpr (std::same_as<T, PointSpec>) {
      add_columns("Columns:", point_columns(), "NAME", part);
    } else if constexpr (std::same_as<T, FrontSpec>) {
      add_columns("Columns:", front_columns(), "NAME", part);
    } else if constexpr (std::same_as<T, WallSpec>) {
      add_columns("Columns:", wall_columns(), "WALL", part);
    } else if constexpr (std::same_as<T, MovedSpec>) {
      add_columns("Columns:", moved_columns(), "NAME", part);
    }
  }

  /// Adds the parts of the structs that a key of a mapping chooses from.
  template <class Field>
  void add_alternatives_of(const Field&, const std::string&)
  {}
  template <class T, class Value>
  void add_alternatives_of(const Alternative<T, Value>& field, const std::string& path)
  {
    add_each_alternative(field.key, path, "", std::type_identity<ChoicesOf<Value>>{});
  }

  static std::string sentence(std::string_view text)
  {
    std::string whole(text);
    whole.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(whole.front())));
    return whole.ends_with('.') ? whole : whole + ".";
  }

  template <HasFields T>
  void add_rows(std::vector<ManualRow>& rows, const std::string& prefix)
  {
    const T defaults{};
    for_each_field<T>([&](const auto& field) { rows.push_back(row(field, defaults, prefix)); });
  }

  template <class T, class Value>
  ManualRow row(const Parameter<T, Value>& field, const std::type_identity_t<T>& defaults, const std::string& prefix)
  {
    return row_of(field.key, type(std::type_identity<Value>{}, path_of(prefix, field.key)), HasFields<Value> ? "" : field.unit,
                  range_of(field.range), need(field.need, default_of(defaults.*field.member, field.range)),
                  meaning_of(field.key, field.meaning));
  }
  template <class T, class Value>
  ManualRow row(const Choice<T, Value>& field, const std::type_identity_t<T>& defaults, const std::string&)
  {
    return row_of(field.key, "word", "-", in_words(enum_names(Value{})), need(field.need, default_of(defaults.*field.member, any)),
                  field.meaning);
  }
  template <class T, class Value>
  ManualRow row(const Group<T, Value>& field, const std::type_identity_t<T>&, const std::string& prefix)
  {
    return row_of(field.key, type(std::type_identity<Value>{}, path_of(prefix, field.key)), "", "", "required", field.meaning);
  }
  template <class T, class Value>
  ManualRow row(const Group<T, std::optional<Value>>& field, const std::type_identity_t<T>&, const std::string& prefix)
  {
    return row_of(field.key, type(std::type_identity<Value>{}, path_of(prefix, field.key)), "", "", "none", field.meaning);
  }
  template <class T, class Item>
  ManualRow row(const List<T, Item>& field, const std::type_identity_t<T>&, const std::string& prefix)
  {
    return row_of(field.key, "list of " + link<Item>(path_of(prefix, field.key)), "", "", need(field.need, "none"), field.meaning);
  }
  template <class T, class Value>
  ManualRow row(const Alternative<T, Value>& field, const std::type_identity_t<T>&, const std::string&)
  {
    const auto names = []<class... One>(std::type_identity<std::variant<One...>>) {
      return std::array<std::string_view, sizeof...(One)>{One::name...};
    }(std::type_identity<ChoicesOf<Value>>{});
    return row_of(field.key, "word", "-", in_words(names), "required", field.meaning);
  }

  static std::string meaning_of(std::string_view key, std::string_view meaning)
  {
    const std::string_view other = other_word_for(key);
    return std::string(meaning) + (other.empty() ? "" : fmt::format("; \"{}\" is another word for this key", other));
  }
  static std::string path_of(const std::string& prefix, std::string_view key) { return prefix + std::string(key); }
  static std::string range_of(const Range& range)
  {
    const std::string text = to_string(range);
    return text == "any" ? "" : text;
  }
  static std::string need(Need needed, const std::string& fallback) { return needed == Need::required ? "required" : fallback; }
  std::string type(std::type_identity<Real>, const std::string&) { return "number"; }
  std::string type(std::type_identity<Index>, const std::string&) { return "whole number"; }
  std::string type(std::type_identity<bool>, const std::string&) { return "true or false"; }
  std::string type(std::type_identity<std::string>, const std::string&) { return "text"; }
  std::string type(std::type_identity<Table>, const std::string&) { return "list of [time, value]"; }
  std::string type(std::type_identity<std::vector<Real>>, const std::string&) { return "list of numbers"; }
  std::string type(std::type_identity<std::vector<Index>>, const std::string&) { return "list of whole numbers"; }
  std::string type(std::type_identity<std::vector<std::string>>, const std::string&) { return "list of texts"; }
  std::string type(std::type_identity<std::vector<std::vector<Real>>>, const std::string&) { return "list of lists of numbers"; }
  std::string type(std::type_identity<std::vector<std::vector<std::vector<Real>>>>, const std::string&)
  {
    return "list of lists of lists of numbers";
  }
  template <class T>
  std::string type(std::type_identity<std::optional<T>>, const std::string& path)
  {
    return type(std::type_identity<T>{}, path);
  }
  template <class T>
  std::string type(std::type_identity<T>, const std::string& path)
  {
    return link<T>(path);
  }

  std::unordered_map<std::type_index, std::string> titles_;
  std::vector<ManualPart> parts_;
  std::vector<std::function<void()>> waiting_;
};

}  // namespace

std::vector<ManualPart> manual_parts() { return Manual::write<Scene>(); }

std::vector<std::array<std::string_view, 2>> kernel_summaries()
{
  std::vector<std::array<std::string_view, 2>> all;
  for_each_type(Kernels<2>{}, [&]<class K>() { all.push_back({K::name, K::summary}); });
  return all;
}

}  // namespace talus
