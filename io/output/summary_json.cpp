#include "io/output/summary_json.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <limits>

#include "core/error.hpp"
#include "io/files/atomic_file.hpp"

namespace talus {

namespace {

using SummaryJson = nlohmann::ordered_json;

constexpr int most_levels = 32;  // most nested levels: the reader is recursive

/// The text of a key, or an empty text.
std::string text_behind(const SummaryJson& json, const char* key)
{
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
}

std::vector<std::string> texts_behind(const SummaryJson& json, const char* key)
{
  const auto found = json.find(key);
  return found != json.end() ? found->get<std::vector<std::string>>() : std::vector<std::string>();
}

/// The number of a key, or zero.
Real number_behind(const SummaryJson& object, const char* key)
{
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? found->get<Real>() : 0;
}

/// The integer of a key, or zero.
std::int64_t count_behind(const SummaryJson& json, const char* key)
{
  const auto found = json.find(key);
  return found != json.end() && found->is_number_integer() ? found->get<std::int64_t>() : 0;
}

/// Splits "kinetic [J]" into "kinetic" and "J".
std::pair<std::string, std::string> name_and_unit(const std::string& key)
{
  const auto open = key.rfind(" [");
  if (open == key.npos || key.back() != ']')
    return {key, ""};
  return {key.substr(0, open), key.substr(open + 2, key.size() - open - 3)};
}

/// Adds all numbers below a value; null is a number that was not finite.
void add_numbers(const SummaryJson& json, const std::string& path, const std::string& unit, std::vector<NamedValue>& numbers)
{
  if (json.is_object()) {
    for (const auto& [key, value] : json.items()) {
      const auto [name, own_unit] = name_and_unit(key);
      add_numbers(value, path.empty() ? name : path + '.' + name, own_unit, numbers);
    }
  } else if (json.is_array()) {
    for (std::size_t i = 0; i < json.size(); ++i)
      add_numbers(json[i], fmt::format("{}[{}]", path, i), unit, numbers);
  } else if (json.is_number() || json.is_null()) {
    numbers.push_back({path, json.is_null() ? std::numeric_limits<Real>::quiet_NaN() : json.get<Real>(), unit});
  }
}

}  // namespace

SummaryBack read_summary(const std::filesystem::path& file)
{
  const std::string text = read_whole(file);
  try {
    const SummaryJson json = SummaryJson::parse(text, [&](int depth, SummaryJson::parse_event_t, const SummaryJson&) {
      if (depth > most_levels)
        throw EnvironmentError(
            fmt::format("{} is not the summary of a run: its values are nested more than {} deep", file.string(), most_levels));
      return true;
    });
    SummaryBack back;
    back.status = text_behind(json, "status");
    back.message = text_behind(json, "message");
    for (const char* part : {"program", "mesh", "stages"})
      json.at(part);
    back.title = text_behind(json, "title");
    back.scene_file = text_behind(json.at("scene"), "file");
    back.overrides = texts_behind(json.at("scene"), "set");
    back.warnings = texts_behind(json, "warnings");
    for (const SummaryJson& body : json.value("bodies", SummaryJson::array()))
      back.bodies.push_back({text_behind(body, "name"), text_behind(body, "material"), text_behind(body, "law"),
                             count_behind(body, "particles"), number_behind(body, "mass [kg]")});
    back.text = text;
    add_numbers(json, "", "", back.numbers);
    return back;
  } catch (const SummaryJson::exception& e) {
    throw EnvironmentError(fmt::format("{} is not the summary of a run: {}", file.string(), e.what()));
  }
}

const NamedValue* find_number(const std::vector<NamedValue>& numbers, std::string_view name)
{
  const NamedValue* found = nullptr;
  const std::string end = fmt::format(".{}", name);
  for (const NamedValue& number : numbers)
    if (number.name == name)
      return &number;
  for (const NamedValue& number : numbers)
    if (number.name.ends_with(end)) {
      if (found != nullptr)
        return nullptr;
      found = &number;
    }
  return found;
}

}  // namespace talus
