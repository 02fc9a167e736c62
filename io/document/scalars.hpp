#pragma once
// Strict conversion of the text of a scalar to a number, bool or word, with a reason for each refusal.
#include <optional>
#include <string>

#include "core/fields.hpp"
#include "io/document/document.hpp"

namespace talus {

/// The error of a value, in words; nothing if it is correct.
using Complaint = std::optional<std::string>;

/// The requirements of a field list on a value, besides its type.
struct Asked {
  Range range = any;
  std::string_view unit = "-";
};

/// The name of a type in messages: "a number".
constexpr std::string_view scalar_name(Real) { return "a number"; }
constexpr std::string_view scalar_name(Index) { return "a whole number"; }
constexpr std::string_view scalar_name(bool) { return "true or false"; }
inline std::string_view scalar_name(const std::string&) { return "a text"; }

/// A number: decimal, finite, no leading zeros, no quotes, inside the range.  `value` is written only if there is no error.
Complaint read_scalar(const Node& node, const Asked& asked, Real& value);
Complaint read_scalar(const Node& node, const Asked& asked, Index& value);
/// true or false, in this spelling.
Complaint read_scalar(const Node& node, const Asked& asked, bool& value);
/// Any text that is not empty.
Complaint read_scalar(const Node& node, const Asked& asked, std::string& value);

}  // namespace talus
