#include "app/commands/report/report_fields.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
#include "core/word_match.hpp"

namespace talus {

namespace {

/// Whether a field is useful as colours; position and id are not.
bool is_shown(const StoredField& field) { return field.name != "position" && field.name != "body"; }

std::vector<std::string> names_of_fields(const StoredParticles& particles)
{
  std::vector<std::string> names;
  for (const StoredField& field : particles.fields)
    if (field.name != "position")
      names.push_back(field.name);
  return names;
}

}  // namespace

std::string words_of(const ViewedField& field) { return field.component.empty() ? field.name : field.name + ':' + field.component; }

std::vector<ViewedField> fields_to_show(const StoredParticles& particles, const std::vector<std::string>& asked,
                                        const std::string& of_picture)
{
  std::vector<ViewedField> shown;
  const auto add = [&](const ViewedField& field) {
    const auto same = [&](const ViewedField& other) { return words_of(other) == words_of(field); };
    if (std::none_of(shown.begin(), shown.end(), same))
      shown.push_back(field);
  };
  for (const std::string& text : asked) {
    const auto field = ViewedField::of(text);
    const StoredField* there = stored_field(particles, field.name);
    if (there == nullptr)
      throw Error(
          fmt::format("--fields: the particles have no field \"{}\"{}", field.name, suggestion(field.name, names_of_fields(particles))));
    field.component_of(there->components);
    add(field);
  }
  if (!asked.empty())
    return shown;
  const auto first = ViewedField::of(of_picture);
  if (stored_field(particles, first.name) != nullptr)
    add(first);
  for (const StoredField& field : particles.fields)
    if (is_shown(field))
      add({field.name});
  return shown;
}

}  // namespace talus
