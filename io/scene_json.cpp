// JSON Schema of scene files, out of their field lists.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <concepts>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>
#include <utility>
#include <variant>

#include "io/field_reader.hpp"
#include "io/field_words.hpp"
#include "io/key_words.hpp"
#include "io/manual.hpp"
#include "io/scene_rules.hpp"
#include "kernels/kernels.hpp"

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

/// The mapping `base` with the key that names a struct, which decides what other keys there are.  Editors offer, and complain of, those of the
/// struct that is named, and before it is named only those of `base`.
template <class... T>
Json one_of(const Json& base, std::string_view key, std::string_view meaning, std::type_identity<std::variant<T...>>)
{
  const std::string name(key);
  Json schema = base;
  schema.erase("additionalProperties");
  Json& word = schema["properties"][name] = {{"description", meaning}, {"enum", {T::name...}}};
  if ((!summary_of<T>().empty() && ...))
    word["markdownEnumDescriptions"] = {summary_of<T>()...};
  schema["required"].push_back(name);
  schema["allOf"] = Json::array();
  const auto add = [&]<class Chosen>(std::type_identity<Chosen>) {
    constexpr std::string_view summary = summary_of<Chosen>();
    Json chosen = base;
    chosen["title"] = Chosen::name;  // what editors call a whole entry of this kind
    chosen["properties"][name] = {{"const", Chosen::name}, {"description", summary.empty() ? meaning : summary}};
    chosen["required"].push_back(name);
    add_keys<Chosen>(chosen);
    Json is_chosen{{"properties", {{name, {{"const", Chosen::name}}}}}, {"required", {name}}};
    schema["allOf"].push_back({{"if", std::move(is_chosen)}, {"then", std::move(chosen)}});
  };
  (add(std::type_identity<T>{}), ...);
  return schema;
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
    return {{"type", Json::array({"string", "number"})}};  // YAML takes `name: 12` for a number
  } else if constexpr (std::is_enum_v<T>) {
    return {{"enum", words(T{})}};
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
    return one_of(empty_mapping(), "type", "what it is: decides the other keys", std::type_identity<T>{});
  } else {
    return mapping_of<T>();
  }
}

template <class Value>
constexpr bool is_optional = requires(const Value& value)
{
  value.has_value();
};

/// The default as an editor would insert it; null for what has none or is no scalar.
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

/// The schema of a key, and whether it must be there.
struct KeySchema {
  Json schema;
  bool needed;
};

/// With what the manual says of it: "mass density at rest [kg/m^3] (required; range > 0)".
template <class Value>
KeySchema described(const Value& fallback, std::string_view meaning, std::string_view unit, const Range& range, Need need)
{
  const bool needed = need == Need::required;
  Json schema = schema_of<Value>(range);
  std::vector<std::string> facts;
  if (needed)
    facts.emplace_back("required");
  if (const std::string allowed = to_string(range); allowed != "any")
    facts.push_back("range " + allowed);
  if constexpr (!HasFields<Value>)
    if (const std::string value = default_of(fallback, range); !needed && value != "none")
      facts.push_back("default " + value);
  const bool has_unit = !unit.empty() && unit != "-" && !HasFields<Value>;
  const std::string text = fmt::format("{}{}", meaning, has_unit ? fmt::format(" [{}]", unit) : "");
  const std::string all_facts = fmt::format("{}", fmt::join(facts, "; "));
  schema["description"] = facts.empty() ? text : fmt::format("{} ({})", text, all_facts);
  schema["markdownDescription"] = facts.empty() ? text : fmt::format("{}\n\n*{}*", text, all_facts);
  if (const Json value = default_value(fallback, range); !needed && !value.is_null())
    schema["default"] = value;
  return {std::move(schema), needed};
}

template <class T, class Value>
KeySchema key_of(const Parameter<T, Value>& field)
{
  return described(T{}.*field.member, field.meaning, field.unit, field.range, field.need);
}
template <class T, class Value>
KeySchema key_of(const Choice<T, Value>& field)
{
  return described(T{}.*field.member, field.meaning, "", any, field.need);
}
template <class T, class Value>
KeySchema key_of(const Group<T, Value>& field)
{
  return described(Value{}, field.meaning, "", any, is_optional<Value> ? Need::optional : Need::required);
}
template <class T, class Item>
KeySchema key_of(const List<T, Item>& field)
{
  return described(std::vector<Item>{}, field.meaning, "", any, field.need);
}

template <class Field>
void add_key(Json& schema, const Field& field)
{
  auto [key, needed] = key_of(field);
  const std::string_view other = other_word_for(field.key);
  if (!other.empty())
    schema["properties"][std::string(other)] = key;
  schema["properties"][std::string(field.key)] = std::move(key);
  if (needed && other.empty())
    schema["required"].push_back(field.key);
  else if (needed)
    schema["oneOf"] = {{{"required", {field.key}}}, {{"required", {other}}}};
}
template <class T, class Value>
void add_key(Json& schema, const Alternative<T, Value>& field)
{
  schema = one_of(schema, field.key, field.meaning, std::type_identity<Value>{});
}

/// Alternatives come last in a field list: they multiply what was there before.
template <class T>
void add_keys(Json& schema)
{
  for_each_field<T>([&](const auto& field) { add_key(schema, field); });
}

/// Those of all particles, and the history variables of all laws.
std::set<std::string> fields_of_any_law()
{
  std::set<std::string> names(particle_fields.begin(), particle_fields.end());
  for_each_type(Laws{}, [&]<class L>() { for_each_field<typename L::State>([&](const auto& variable) { names.emplace(variable.key); }); });
  return names;
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
  outputs["particles"]["properties"]["fields"]["items"] = {{"enum", fields_of_any_law()}};
  outputs["mesh"]["properties"]["fields"]["items"] = {{"enum", node_fields}};
  return schema.dump(2) + "\n";
}

}  // namespace talus
