#pragma once
// From the text of a scalar to a number, a switch or a word: strict, and with a reason when it is refused.
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "core/fields.hpp"
#include "core/word_match.hpp"
#include "io/document/document.hpp"

namespace talus {

/// What is wrong with a value, in words; nothing if it is right.
using Complaint = std::optional<std::string>;

/// What a field list asks of a value, besides its type.
struct Asked {
  Range range = any;
  std::string_view unit = "-";
};

/// What the value is called in messages: "a number".
constexpr std::string_view scalar_name(Real) { return "a number"; }
constexpr std::string_view scalar_name(Index) { return "a whole number"; }
constexpr std::string_view scalar_name(bool) { return "true or false"; }
inline std::string_view scalar_name(const std::string&) { return "a text"; }
template <class Enum>
requires std::is_enum_v<Enum>
constexpr std::string_view scalar_name(Enum) { return "a word"; }

/// Decimal, finite, no leading zeros, no quotes, inside the range.  `value` is written only when nothing is wrong.
Complaint read_scalar(const Node& node, const Asked& asked, Real& value);
Complaint read_scalar(const Node& node, const Asked& asked, Index& value);
/// true or false, spelt like that.
Complaint read_scalar(const Node& node, const Asked& asked, bool& value);
/// Any text that is not empty.
Complaint read_scalar(const Node& node, const Asked& asked, std::string& value);

/// One of the words of an enum.
template <class Enum>
requires std::is_enum_v<Enum> Complaint read_scalar(const Node& node, const Asked&, Enum& value)
{
  const auto known = enum_names(Enum{});
  const auto at = std::find(known.begin(), known.end(), node.text);
  if (at == known.end())
    return "unknown word \"" + node.text + "\"" + suggestion(node.text, std::vector<std::string>(known.begin(), known.end()));
  value = static_cast<Enum>(at - known.begin());
  return std::nullopt;
}

}  // namespace talus
