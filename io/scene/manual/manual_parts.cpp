#include "io/scene/manual/manual_parts.hpp"

#include <cctype>
#include <unordered_map>
#include <utility>

#include "core/word_match.hpp"
#include "io/document/key_aliases.hpp"
#include "io/document/value_type.hpp"
#include "io/output/history_columns.hpp"
#include "io/output/output_fields.hpp"
#include "io/scene/manual/markdown_table.hpp"
#include "io/scene/scene.hpp"
#include "kernels/kernels.hpp"
#include "materials/interface/law_variant.hpp"

namespace talus {

namespace {

std::string in_words(std::span<const std::string_view> all)
{
  std::vector<std::string> quoted;
  for (const auto word : all)
    quoted.push_back(code(word));
  return or_list(quoted);
}

class Manual {
 public:
  static std::vector<ManualPart> of(const ValueType& scene)
  {
    Manual manual;
    manual.section(scene, std::string(title_of_scene));
    while (!manual.waiting_.empty()) {
      const auto [type, path] = std::move(manual.waiting_.front());
      manual.waiting_.erase(manual.waiting_.begin());
      const auto later = std::exchange(manual.waiting_, {});
      manual.section(*type, path);  // a type that it mentions follows directly
      manual.waiting_.insert(manual.waiting_.end(), later.begin(), later.end());
    }
    return std::move(manual.parts_);
  }

 private:
  using Kind = ValueType::Kind;

  /// The link to the section of a struct or choice, which is written once, after the section that first mentions it.
  std::string link(const ValueType& type, const std::string& path)
  {
    if (&type == &value_type<SimpleShape>())
      return link(value_type<Shape>(), path);  // equal except for combined shapes, as the meaning of the key says
    const std::string own = &type == &value_type<Shape>()         ? "shape"
                            : &type == &value_type<Box>()         ? "box"
                            : &type == &value_type<SurfaceSpec>() ? "surface"
                                                                  : path;
    const auto [title, is_new] = titles_.emplace(&type, own);
    if (is_new)
      waiting_.emplace_back(&type, own);
    std::string anchor;
    for (const char c : title->second)
      if (c != '.')
        anchor += c;
    return fmt::format("[{}](#{})", title->second, anchor);
  }

  void section(const ValueType& type, const std::string& path)
  {
    if (type.kind == Kind::choice) {
      parts_.push_back({.title = path, .path = path, .text = "One of these, chosen by the key `type`.\n"});
      return add_structs("type", type, path, path);
    }
    const StructType& mapping = *type.structs.front();
    const std::string in_scene = path == title_of_scene ? "" : path;
    ManualPart part{.title = path, .path = in_scene};
    add_rows(mapping, part.rows, in_scene.empty() ? "" : in_scene + ".");
    add_outputs(mapping, part);
    parts_.push_back(std::move(part));
    for (const FieldType& field : mapping.fields)
      if (field.is_alternative)
        add_structs(field.key, *field.type, in_scene, "");
  }

  /// Adds the keys of each struct that a key of a mapping at `path` chooses; `prefix` replaces the choosing word in the names of its own
  /// mappings.
  void add_structs(std::string_view key, const ValueType& type, const std::string& path, const std::string& prefix)
  {
    for (const StructType* one : type.structs) {
      ManualPart part{.title = fmt::format("{}: {}", key, one->name), .path = path, .chosen = std::string(one->name)};
      add_rows(*one, part.rows, (prefix.empty() ? part.chosen : prefix) + ".");
      if (!one->summary.empty())
        part.text = sentence(one->summary) + "\n\n";
      if (&type == &value_type<AnyLaw>())
        add_history(one->name, part);
      parts_.push_back(std::move(part));
    }
  }

  static void add_history(std::string_view law, ManualPart& part)
  {
    ManualOutputs variables{"It keeps, for output:", "history variable, for outputs.particles.fields", {}};
    for (const LawDescription* known : known_laws())
      if (known->name == law)
        for (const HistoryVariable& one : known->variables)
          variables.rows.push_back({{std::string(one.key)}, one.components, std::string(one.unit), std::string(one.meaning)});
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

  static void add_outputs(const StructType& type, ManualPart& part)
  {
    if (&type == &struct_type<ParticleOutputSpec>()) {
      add_fields(particle_fields(), part);
    } else if (&type == &struct_type<MeshOutputSpec>()) {
      add_fields(node_fields(), part);
    } else if (&type == &struct_type<HistoryOutputSpec>()) {
      add_columns("Columns that are always there; in 2-D without those of the third axis, and with angular_momentum_z alone:",
                  run_columns(), "", part);
      add_columns("Columns of every wall:", reaction_columns(), "WALL", part);
      add_columns("Columns where water flows:", flow_columns(), "", part);
      add_columns("Columns where particles are split and merged:", resample_columns(), "", part);
      add_columns("Columns of every contact of bodies that are not tied:", contact_columns(), "FIRST_SECOND", part);
      add_columns("Columns of every cut:", cut_columns(), "GROUP", part);
      add_columns("Columns of each of the bodies:", body_columns(), "BODY", part);
    } else if (&type == &struct_type<PointSpec>()) {
      add_columns("Columns:", point_columns(), "NAME", part);
      add_columns("Columns where water flows:", point_water_columns(), "NAME", part);
    } else if (&type == &struct_type<FrontSpec>()) {
      add_columns("Columns:", front_columns(), "NAME", part);
    } else if (&type == &struct_type<WallSpec>()) {
      add_columns("Columns:", wall_columns(), "WALL", part);
    } else if (&type == &struct_type<MovedSpec>()) {
      add_columns("Columns:", moved_columns(), "NAME", part);
    }
  }

  static std::string sentence(std::string_view text)
  {
    std::string whole(text);
    whole.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(whole.front())));
    return whole.ends_with('.') ? whole : whole + ".";
  }

  void add_rows(const StructType& type, std::vector<ManualRow>& rows, const std::string& prefix)
  {
    for (const FieldType& field : type.fields)
      rows.push_back(row(field, field.member_of(type.defaults), prefix));
  }

  ManualRow row(const FieldType& field, const void* fallback, const std::string& prefix)
  {
    const bool needed = field.need == Need::required;
    return {code(field.key),
            field.is_alternative ? "word" : type_text(*field.type, prefix + std::string(field.key)),
            std::string(field.unit),
            field.is_alternative || field.type->kind == Kind::word ? in_words(words_of(*field.type)) : range_text(field.range),
            needed ? "required" : default_text(*field.type, fallback, field.range),
            meaning_of(field.key, field.meaning)};
  }

  static std::vector<std::string_view> words_of(const ValueType& type)
  {
    std::vector<std::string_view> words(type.words.begin(), type.words.end());
    for (const StructType* one : type.structs)
      words.push_back(one->name);
    return words;
  }

  static std::string meaning_of(std::string_view key, std::string_view meaning)
  {
    const std::string_view other = other_word_for(key);
    return std::string(meaning) + (other.empty() ? "" : fmt::format("; \"{}\" is another word for this key", other));
  }
  static std::string range_text(const Range& range)
  {
    const std::string text = to_string(range);
    return text == "any" ? "" : text;
  }

  /// The type of a value, or of several values, as the table of keys names it.
  std::string type_text(const ValueType& type, const std::string& path, bool several = false)
  {
    const std::string_view s = several ? "s" : "";
    switch (type.kind) {
      case Kind::number: return fmt::format("number{}", s);
      case Kind::whole_number: return fmt::format("whole number{}", s);
      case Kind::boolean: return "true or false";
      case Kind::text: return fmt::format("text{}", s);
      case Kind::word: return fmt::format("word{}", s);
      case Kind::named: return "mapping of numbers";
      case Kind::table: return fmt::format("list{} of [time, value]", s);
      case Kind::list: return fmt::format("list{} of {}", s, type_text(*type.entry, path, true));
      case Kind::optional: return type_text(*type.entry, path, several);
      case Kind::mapping:
      case Kind::choice: break;
    }
    return link(type, path);
  }

  std::unordered_map<const ValueType*, std::string> titles_;
  std::vector<ManualPart> parts_;
  std::vector<std::pair<const ValueType*, std::string>> waiting_;
};

}  // namespace

std::vector<ManualPart> manual_parts() { return Manual::of(value_type<Scene>()); }

std::vector<std::array<std::string_view, 2>> kernel_summaries()
{
  std::vector<std::array<std::string_view, 2>> all;
  for_each_type(Kernels<2>{}, [&]<class K>() { all.push_back({K::name, K::summary}); });
  return all;
}

}  // namespace talus
