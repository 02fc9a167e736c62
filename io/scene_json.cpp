// JSON Schema of scene files, out of their field lists.
#include <cmath>
#include <concepts>
#include <nlohmann/json.hpp>
#include <tuple>
#include <utility>
#include <variant>

#include "io/field_reader.hpp"
#include "io/manual.hpp"
#include "io/scene_rules.hpp"

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

/// One schema per struct: the mapping `base` with the key that names the struct, and the keys of the struct.
template <class... T>
Json one_of(const Json& base, std::string_view key, std::type_identity<std::variant<T...>>)
{
  Json all = Json::array();
  const auto add = [&]<class Chosen>(std::type_identity<Chosen>) {
    Json schema = base;
    schema["properties"][std::string(key)] = {{"const", Chosen::name}};
    schema["required"].push_back(key);
    add_keys<Chosen>(schema);
    all.push_back(std::move(schema));
  };
  (add(std::type_identity<T>{}), ...);
  return {{"oneOf", std::move(all)}};
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
    return one_of(empty_mapping(), "type", std::type_identity<T>{});
  } else {
    return mapping_of<T>();
  }
}

template <class Field, class Value>
Json described(const Field& field, std::type_identity<Value>, const Range& range, std::string_view unit)
{
  Json schema = schema_of<Value>(range);
  schema["description"] = std::string(field.meaning) + (unit.empty() || unit == "-" ? "" : " [" + std::string(unit) + "]");
  return schema;
}

template <class Value>
constexpr bool is_optional = requires(const Value& value)
{
  value.has_value();
};

/// The schema of a key, and whether it must be there.
template <class T, class Value>
std::pair<Json, bool> key_of(const Parameter<T, Value>& field)
{
  return {described(field, std::type_identity<Value>{}, field.range, field.unit), field.need == Need::required};
}
template <class T, class Value>
std::pair<Json, bool> key_of(const Choice<T, Value>& field)
{
  return {described(field, std::type_identity<Value>{}, any, ""), field.need == Need::required};
}
template <class T, class Value>
std::pair<Json, bool> key_of(const Group<T, Value>& field)
{
  return {described(field, std::type_identity<Value>{}, any, ""), !is_optional<Value>};
}
template <class T, class Item>
std::pair<Json, bool> key_of(const List<T, Item>& field)
{
  return {described(field, std::type_identity<std::vector<Item>>{}, any, ""), field.need == Need::required};
}

template <class Field>
void add_key(Json& schema, const Field& field)
{
  const auto [key, needed] = key_of(field);
  schema["properties"][std::string(field.key)] = key;
  if (needed)
    schema["required"].push_back(field.key);
}
template <class T, class Value>
void add_key(Json& schema, const Alternative<T, Value>& field)
{
  schema = one_of(schema, field.key, std::type_identity<Value>{});
}

/// Alternatives come last in a field list: they multiply what was there before.
template <class T>
void add_keys(Json& schema)
{
  for_each_field<T>([&](const auto& field) { add_key(schema, field); });
}

}  // namespace

std::string scene_schema()
{
  Json schema = mapping_of<Scene>();
  schema["properties"]["kernel"]["enum"] = kernel_names();
  schema["$schema"] = "http://json-schema.org/draft-07/schema#";
  schema["title"] = "Talus scene";
  return schema.dump(2) + "\n";
}

}  // namespace talus
