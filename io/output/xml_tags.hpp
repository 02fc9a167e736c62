#pragma once
// The tags of an XML text in sequence: the part of XML that lists and headers of result files use.
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
  std::vector<std::pair<std::string_view, std::string>> attributes;  ///< values with resolved entities
  std::size_t end = 0;                                               ///< position after the tag

  /// The value of an attribute, or nullptr.
  const std::string* find(std::string_view attribute) const noexcept;
};

/// Reads a text from beginning to end and stores nothing of it.  Declarations (<?xml ... ?>) and comments are skipped.  A document type,
/// which could define entities, does not occur in result files and is refused.
class XmlTags {
 public:
  /// `text` must stay valid.
  explicit XmlTags(std::string_view text) : text_(text) {}

  /// The next tag; nothing at the end of the text.  Throws EnvironmentError, without the name of a file, if the text is not a tag.
  std::optional<XmlTag> next();
  /// The text up to the next tag, without blanks around it, with resolved entities.
  std::string text() const;

 private:
  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace talus
