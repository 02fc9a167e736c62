#include "io/document/value_type.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "io/document/make_value_type.hpp"

namespace talus {

template const ValueType& value_type<std::string>();
template const ValueType& value_type<std::vector<std::array<Real, 2>>>();
template const ValueType& value_type<std::vector<Node>>();

void detail::add_field(StructType& type, FieldType row, const ValueType& value, const void* member)
{
  row.type = &value;
  row.offset = static_cast<const std::byte*>(member) - static_cast<const std::byte*>(type.defaults);
  type.fields.push_back(row);
}

std::string default_text(const ValueType& type, const void* value, const Range& range)
{
  const auto number_or_none = [&](const auto& number) {
    return range.holds(static_cast<Real>(number)) ? fmt::format("{}", number) : std::string("none");
  };
  switch (type.kind) {
    case ValueType::Kind::number: return number_or_none(as<Real>(value));
    case ValueType::Kind::whole_number: return number_or_none(as<Index>(value));
    case ValueType::Kind::boolean: return as<bool>(value) ? "true" : "false";
    case ValueType::Kind::text: return as<std::string>(value).empty() ? "none" : as<std::string>(value);
    case ValueType::Kind::word: return std::string(type.words[type.chosen(value)]);
    case ValueType::Kind::mapping: return "see there";
    case ValueType::Kind::optional: return type.size(value) == 0 ? "none" : default_text(*type.entry, type.at(value, 0), range);
    case ValueType::Kind::list: {
      std::vector<std::string> entries;
      for (std::size_t i = 0; i < type.size(value); ++i)
        entries.push_back(default_text(*type.entry, type.at(value, i), range));
      return entries.empty() ? "none" : fmt::format("[{}]", fmt::join(entries, ", "));
    }
    case ValueType::Kind::table:
    case ValueType::Kind::choice:
    case ValueType::Kind::named: break;
  }
  return "none";
}

}  // namespace talus
