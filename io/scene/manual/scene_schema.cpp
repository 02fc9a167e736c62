// The JSON Schema of scene files, generated from their field lists.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <concepts>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <tuple>
#include <utility>
#include <variant>

#include "io/document/field_reader.hpp"
#include "io/document/field_words.hpp"
#include "io/document/key_aliases.hpp"
#include "io/output/output_fields.hpp"
#include "io/scene/manual/manual.hpp"
#include "io/scene/scene_rules.hpp"
#include "kernels/kernels.hpp"
#include "materials/interface/law_variant.hpp"

namespace talus {

namespace {

using Json = nlohmann::ordered_json;

template <class T>
concept IsVariant = requires
{
  std::variant_size<T>::value;
};

Json number(std::string_view type, const Range& range)
{
  Json schema{{"type", type}};
  if (std::isfinite(range.low))
    schema[range.low_allowed ? "minimum" : "exclusiveMinimum"] = range.low;
  if (std::isfinite(range.high))
    schema[range.high_allowed ? "maximum" : "exclusiveMaximum"] = range.high;
  return schema;
}

template <class T>
Json schema_of(const Range& range = any);

template <class T>
void add_keys(Json& schema);

Json empty_mapping()
{
  return {{"type", "object"}, {"additionalProperties", false}, {"properties", Json::object()}, {"required", Json::array()}};
}

template <class T>
Json mapping_of()
{
  Json schema = empty_mapping();
  add_keys<T>(schema);
  return schema;
}

template <class T>
constexpr std::string_view summary_of()
{
  if constexpr (requires { T::summary; })
    return T::summary;
  else
    return "";
}

/// A struct that a key can name.  Data that all structs and keys have in common are not templates, so that the code is compiled once.
struct Struct {
  std::string_view name;
  std::string_view summary;
  void (*add_keys)(Json& schema);
};

/// The mapping `base` with the key `name`, which names one of `structs` and so determines the other keys.  Editors then offer and check the
/// keys of the named struct, and those of `base` while it is not named.
Json one_of(const Json& base, const std::string& name, std::string_view meaning, std::span<const Struct> structs)
{
  Json schema = base;
  schema.erase("additionalProperties");
  Json names = Json::array(), summaries = Json::array(), all = Json::array();
  for (const Struct& each : structs) {
    names.push_back(each.name);
    if (!each.summary.empty())
      summaries.push_back(each.summary);
    Json chosen = base;
    chosen["title"] = each.name;  // name of an entry of this kind in editors
    chosen["properties"][name] = {{"const", each.name}, {"description", each.summary.empty() ? meaning : each.summary}};
    chosen["required"].push_back(name);
    each.add_keys(chosen);
    Json is_chosen{{"properties", {{name, {{"const", each.name}}}}}, {"required", {name}}};
    all.push_back({{"if", std::move(is_chosen)}, {"then", std::move(chosen)}});
  }
  Json& word = schema["properties"][name] = {{"description", meaning}, {"enum", std::move(names)}};
  if (summaries.size() == structs.size())
    word["markdownEnumDescriptions"] = std::move(summaries);
  schema["required"].push_back(name);
  schema["allOf"] = std::move(all);
  return schema;
}

template <class... T>
constexpr std::array<Struct, sizeof...(T)> structs_of(std::type_identity<std::variant<T...>>)
{
  return {{{T::name, summary_of<T>(), add_keys<T>}...}};
}

template <class T>
Json schema_of(const Range& range)
{
  if constexpr (std::same_as<T, bool>) {
    return {{"type", "boolean"}};
  } else if constexpr (std::same_as<T, Index>) {
    return number("integer", range);
  } else if constexpr (std::same_as<T, Real>) {
    return number("number", range);
  } else if constexpr (std::same_as<T, std::string>) {
    return {{"type", Json::array({"string", "number"})}};  // YAML reads `name: 12` as a number
  } else if constexpr (std::is_enum_v<T>) {
    return {{"enum", enum_names(T{})}};
  } else if constexpr (std::same_as<T, Table>) {
    return schema_of<std::vector<std::array<Real, 2>>>(range);
  } else if constexpr (requires {
                         typename T::value_type;
                         typename T::iterator;
                       }) {
    Json schema{{"type", "array"}, {"minItems", 1}, {"items", schema_of<typename T::value_type>(range)}};
    if constexpr (requires { std::tuple_size<T>::value; })
      schema["minItems"] = schema["maxItems"] = std::tuple_size_v<T>;
    return schema;
  } else if constexpr (requires(const T& value) { value.has_value(); }) {
    return schema_of<typename T::value_type>(range);
  } else if constexpr (IsVariant<T>) {
    return one_of(empty_mapping(), "type", "what it is: decides the other keys", structs_of(std::type_identity<T>{}));
  } else {
    return mapping_of<T>();
  }
}

template <class Value>
constexpr bool is_optional = requires(const Value& value)
{
  value.has_value();
};

/// The default as an editor inserts it; null without a default or if it is not a scalar.
template <class T>
Json default_value(const T& value, const Range& range)
{
  if constexpr (is_optional<T>)
    return value ? default_value(*value, range) : Json();
  else if constexpr (std::same_as<T, bool>)
    return value;
  else if constexpr (std::is_arithmetic_v<T>)
    return range.holds(static_cast<Real>(value)) ? Json(value) : Json();
  else if constexpr (std::is_enum_v<T> || std::same_as<T, std::string>)
    return default_of(value, range) == "none" ? Json() : Json(default_of(value, range));
  else
    return {};
}

/// The description of a key in a field list, and the schema of its value.
struct Key {
  std::string_view name;
  std::string_view meaning;
  std::string_view unit;
  Range range;
  Need need;
  bool is_mapping;
  std::string fallback;  ///< default as in the manual
  Json inserted;         ///< default as an editor inserts it
  Json schema;
};

/// Adds the description of the manual: "mass density at rest [kg/m^3] (required; range > 0)".
void describe(Key& key)
{
  const bool needed = key.need == Need::required;
  std::vector<std::string> facts;
  if (needed)
    facts.emplace_back("required");
  if (const std::string allowed = to_string(key.range); allowed != "any")
    facts.push_back("range " + allowed);
  if (!key.is_mapping && !needed && key.fallback != "none")
    facts.push_back("default " + key.fallback);
  const bool has_unit = !key.unit.empty() && key.unit != "-" && !key.is_mapping;
  const std::string text = fmt::format("{}{}", key.meaning, has_unit ? fmt::format(" [{}]", key.unit) : "");
  const std::string all_facts = fmt::format("{}", fmt::join(facts, "; "));
  key.schema["description"] = facts.empty() ? text : fmt::format("{} ({})", text, all_facts);
  key.schema["markdownDescription"] = facts.empty() ? text : fmt::format("{}\n\n*{}*", text, all_facts);
  if (!needed && !key.inserted.is_null())
    key.schema["default"] = key.inserted;
}

void insert(Key key, Json& schema)
{
  describe(key);
  const std::string_view other = other_word_for(key.name);
  if (!other.empty())
    schema["properties"][std::string(other)] = key.schema;
  schema["properties"][std::string(key.name)] = std::move(key.schema);
  if (key.need == Need::required && other.empty())
    schema["required"].push_back(key.name);
  else if (key.need == Need::required)
    schema["oneOf"] = {{{"required", {key.name}}}, {{"required", {other}}}};
}

template <class Field, class Value>
void add_key_of(const Field& field, const Value& fallback, std::string_view unit, const Range& range, Need need, Json& schema)
{
  std::string default_text;
  if constexpr (!HasFields<Value>)
    default_text = default_of(fallback, range);
  insert({.name = field.key,
          .meaning = field.meaning,
          .unit = unit,
          .range = range,
          .need = need,
          .is_mapping = HasFields<Value>,
          .fallback = std::move(default_text),
          .inserted = default_value(fallback, range),
          .schema = schema_of<Value>(range)},
         schema);
}

template <class T, class Value>
void add_key(Json& schema, const Parameter<T, Value>& field)
{
  add_key_of(field, T{}.*field.member, field.unit, field.range, field.need, schema);
}
template <class T, class Value>
void add_key(Json& schema, const Choice<T, Value>& field)
{
  add_key_of(field, T{}.*field.member, "", any, field.need, schema);
}
template <class T, class Value>
void add_key(Json& schema, const Group<T, Value>& field)
{
  add_key_of(field, Value{}, "", any, is_optional<Value> ? Need::optional : Need::required, schema);
}
template <class T, class Item>
void add_key(Json& schema, const List<T, Item>& field)
{
  add_key_of(field, std::vector<Item>{}, "", any, field.need, schema);
}
template <class T, class Value>
void add_key(Json& schema, const Alternative<T, Value>& field)
{
  schema = one_of(schema, std::string(field.key), field.meaning, structs_of(std::type_identity<ChoicesOf<Value>>{}));
}

/// Alternatives come last in a field list, because they multiply the keys before them.
template <class T>
void add_keys(Json& schema)
{
  for_each_field<T>([&](const auto& field) { add_key(schema, field); });
}

/// A word and its meaning.
using Words = std::map<std::string, std::string>;

template <class Table>
Words words_of_table(const Table& table)
{
  Words words;
  for_each_quantity(table, [&](const auto& field) { words.emplace(field.name, field.meaning); });
  return words;
}

/// Fields of all particles, and the history variables of all laws.
Words particle_field_words()
{
  Words words = words_of_table(particle_fields());
  for (const LawDescription* law : known_laws())
    for (const HistoryVariable& variable : law->variables)
      words.emplace(variable.key, variable.meaning);
  return words;
}

Json items_of(const Words& words)
{
  Json items{{"enum", Json::array()}, {"markdownEnumDescriptions", Json::array()}};
  for (const auto& [word, meaning] : words) {
    items["enum"].push_back(word);
    items["markdownEnumDescriptions"].push_back(meaning);
  }
  return items;
}

}  // namespace

std::string scene_schema()
{
  Json schema{{"$schema", "http://json-schema.org/draft-07/schema#"}, {"$id", "urn:talus:scene"}, {"title", "Talus scene"}};
  schema.update(mapping_of<Scene>());
  Json& keys = schema["properties"];
  Json& kernel = keys["kernel"];
  kernel["enum"] = kernel_names();
  kernel["markdownEnumDescriptions"] = Json::array();
  for_each_type(Kernels<2>{}, [&]<class K>() { kernel["markdownEnumDescriptions"].push_back(K::summary); });
  Json& outputs = keys["outputs"]["properties"];
  outputs["particles"]["properties"]["fields"]["items"] = items_of(particle_field_words());
  outputs["mesh"]["properties"]["fields"]["items"] = items_of(words_of_table(node_fields()));
  return schema.dump(2) + "\n";
}

}  // namespace talus
