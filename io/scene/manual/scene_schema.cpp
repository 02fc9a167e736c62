// The JSON Schema of scene files, generated from their field lists.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>

#include "io/document/key_aliases.hpp"
#include "io/document/value_type.hpp"
#include "io/output/output_fields.hpp"
#include "io/scene/manual/manual.hpp"
#include "io/scene/scene_rules.hpp"
#include "kernels/kernels.hpp"
#include "materials/interface/law_variant.hpp"

namespace talus {

namespace {

using Json = nlohmann::ordered_json;
using Kind = ValueType::Kind;

Json number(std::string_view type, const Range& range)
{
  Json schema{{"type", type}};
  if (std::isfinite(range.low))
    schema[range.low_allowed ? "minimum" : "exclusiveMinimum"] = range.low;
  if (std::isfinite(range.high))
    schema[range.high_allowed ? "maximum" : "exclusiveMaximum"] = range.high;
  return schema;
}

void add_keys(const StructType& type, Json& schema);

Json empty_mapping()
{
  return {{"type", "object"}, {"additionalProperties", false}, {"properties", Json::object()}, {"required", Json::array()}};
}

/// The mapping `base` with the key `name`, which names one of `structs` and so determines the other keys.  Editors then offer and check the
/// keys of the named struct, and those of `base` while it is not named.
Json one_of(const Json& base, const std::string& name, std::string_view meaning, std::span<const StructType* const> structs)
{
  Json schema = base;
  schema.erase("additionalProperties");
  Json names = Json::array(), summaries = Json::array(), all = Json::array();
  for (const StructType* each : structs) {
    names.push_back(each->name);
    if (!each->summary.empty())
      summaries.push_back(each->summary);
    Json chosen = base;
    chosen["title"] = each->name;  // name of an entry of this kind in editors
    chosen["properties"][name] = {{"const", each->name}, {"description", each->summary.empty() ? meaning : each->summary}};
    chosen["required"].push_back(name);
    add_keys(*each, chosen);
    Json is_chosen{{"properties", {{name, {{"const", each->name}}}}}, {"required", {name}}};
    all.push_back({{"if", std::move(is_chosen)}, {"then", std::move(chosen)}});
  }
  Json& word = schema["properties"][name] = {{"description", meaning}, {"enum", std::move(names)}};
  if (summaries.size() == structs.size())
    word["markdownEnumDescriptions"] = std::move(summaries);
  schema["required"].push_back(name);
  schema["allOf"] = std::move(all);
  return schema;
}

Json schema_of(const ValueType& type, const Range& range)
{
  switch (type.kind) {
    case Kind::boolean: return {{"type", "boolean"}};
    case Kind::whole_number: return number("integer", range);
    case Kind::number: return number("number", range);
    case Kind::text: return {{"type", Json::array({"string", "number"})}};  // YAML reads `name: 12` as a number
    case Kind::word: return {{"enum", type.words}};
    case Kind::table: return schema_of(value_type<std::vector<std::array<Real, 2>>>(), range);
    case Kind::optional: return schema_of(*type.entry, range);
    case Kind::choice: return one_of(empty_mapping(), "type", "what it is: decides the other keys", type.structs);
    case Kind::named: return {{"type", "object"}, {"additionalProperties", {{"type", "number"}}}};
    case Kind::list: {
      Json schema{{"type", "array"}, {"minItems", 1}, {"items", schema_of(*type.entry, range)}};
      if (type.length != 0)
        schema["minItems"] = schema["maxItems"] = type.length;
      return schema;
    }
    case Kind::mapping: break;
  }
  Json schema = empty_mapping();
  add_keys(*type.structs.front(), schema);
  return schema;
}

/// The default as an editor inserts it; null without a default or if it is not a scalar.
Json inserted_default(const ValueType& type, const void* value, const Range& range)
{
  const std::string text = default_text(type, value, range);
  if (text == "none")
    return {};
  switch (type.kind) {
    case Kind::optional: return inserted_default(*type.entry, type.at(value, 0), range);
    case Kind::boolean: return as<bool>(value);
    case Kind::whole_number: return as<Index>(value);
    case Kind::number: return as<Real>(value);
    case Kind::word:
    case Kind::text: return text;
    default: return {};
  }
}

/// A key with its schema.
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

/// Alternatives come last in a field list, because they multiply the keys before them.
void add_keys(const StructType& type, Json& schema)
{
  for (const FieldType& field : type.fields) {
    const void* const fallback = field.member_of(type.defaults);
    const bool is_mapping = field.type->kind == Kind::mapping;
    if (field.is_alternative)
      schema = one_of(schema, std::string(field.key), field.meaning, field.type->structs);
    else {
      Json of_key = schema_of(*field.type, field.range);
      if (field.may_be_empty())
        of_key.erase("minItems");
      insert({.name = field.key,
              .meaning = field.meaning,
              .unit = field.unit,
              .range = field.range,
              .need = field.need,
              .is_mapping = is_mapping,
              .fallback = is_mapping ? "" : default_text(*field.type, fallback, field.range),
              .inserted = inserted_default(*field.type, fallback, field.range),
              .schema = std::move(of_key)},
             schema);
    }
  }
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
  schema.update(schema_of(value_type<Scene>(), any));
  Json& keys = schema["properties"];
  Json& kernel = keys["kernel"];
  kernel["enum"] = kernel_names();
  kernel["markdownEnumDescriptions"] = Json::array();
  for_each_type(Kernels<2>{}, [&]<class K>() { kernel["markdownEnumDescriptions"].push_back(K::summary); });
  Json& outputs = keys["outputs"]["properties"];
  // Laws of the user have history variables of any name.
  Json of_user{{"properties", {{"law", {{"enum", {LawBySymbol::name, UmatLaw::name}}}}}}, {"required", {"law"}}};
  schema["if"] = {{"properties", {{"materials", {{"contains", std::move(of_user)}}}}}, {"required", {"materials"}}};
  const Json known = items_of(particle_field_words());
  outputs["particles"]["properties"]["fields"]["items"] = {
      {"anyOf", {known, {{"type", "string"}, {"pattern", "^[A-Za-z_][A-Za-z0-9_]*$"}}}}};
  Json& strict = schema["else"]["properties"]["outputs"]["properties"]["particles"]["properties"]["fields"]["items"];
  strict["anyOf"] = {{{"enum", known.at("enum")}}, {{"pattern", "^[a-z0-9_]+_factor$"}}};  // the latter of parameters that vary
  outputs["mesh"]["properties"]["fields"]["items"] = items_of(words_of_table(node_fields()));
  return schema.dump(2) + "\n";
}

}  // namespace talus
