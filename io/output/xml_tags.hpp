#pragma once
// The tags of an XML text one after the other: as much of XML as the lists and the heads of result files have.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace talus {

struct XmlTag {
  enum class Kind : std::uint8_t { opens, closes, is_empty };  ///< <a>, </a>, <a/>
  Kind kind = Kind::opens;
  std::string_view name;
  std::vector<std::pair<std::string_view, std::string>> attributes;  ///< values with their entities resolved
  std::size_t end = 0;                                               ///< position behind the tag

  /// The value of an attribute, or nothing.
  const std::string* find(std::string_view attribute) const noexcept;
};

/// Reads a text from its beginning to its end and keeps nothing of it.  Declarations (<?xml ... ?>) and comments are passed over.  A document
/// type, which could define entities of its own, is not XML of result files and refused.
class XmlTags {
 public:
  /// `text` has to stay.
  explicit XmlTags(std::string_view text) : text_(text) {}

  /// The next tag; nothing at the end of the text.  EnvironmentError, without the name of a file: what stands there is no tag.
  std::optional<XmlTag> next();
  /// The text from here to the next tag, without blanks around it, its entities resolved.
  std::string text() const;

 private:
  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace talus
