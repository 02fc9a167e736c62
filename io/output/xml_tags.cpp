#include "io/output/xml_tags.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/error.hpp"

namespace talus {

namespace {

constexpr std::string_view xml_blanks = " \t\r\n";

[[noreturn]] void no_tag(std::size_t at, std::string_view what) { throw EnvironmentError(fmt::format("{} at byte {}", what, at)); }

/// The text with the five entities of XML resolved; other entities stay as they are.
std::string without_entities(std::string_view text)
{
  static constexpr std::array<std::pair<std::string_view, char>, 5> entities{
      {{"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}}};
  std::string plain;
  while (!text.empty()) {
    const auto* const entity = std::find_if(entities.begin(), entities.end(), [&](const auto& e) { return text.starts_with(e.first); });
    plain += entity == entities.end() ? text.front() : entity->second;
    text.remove_prefix(entity == entities.end() ? 1 : entity->first.size());
  }
  return plain;
}

std::string_view without_blanks_around(std::string_view text)
{
  text.remove_prefix(std::min(text.find_first_not_of(xml_blanks), text.size()));
  return text.substr(0, text.find_last_not_of(xml_blanks) + 1);
}

}  // namespace

const std::string* XmlTag::find(std::string_view attribute) const noexcept
{
  const auto found = std::find_if(attributes.begin(), attributes.end(), [&](const auto& one) { return one.first == attribute; });
  return found == attributes.end() ? nullptr : &found->second;
}

std::optional<XmlTag> XmlTags::next()
{
  for (;;) {
    at_ = std::min(text_.find('<', at_), text_.size());
    const std::string_view rest = text_.substr(at_);
    if (rest.empty())
      return std::nullopt;
    const bool is_comment = rest.starts_with("<!--"), is_declaration = rest.starts_with("<?");
    if (!is_comment && !is_declaration)
      break;
    const std::size_t end = is_comment ? rest.find("-->", 4) : rest.find("?>", 2);
    if (end == rest.npos)
      no_tag(at_, is_comment ? "a comment without its end" : "a declaration without its end");
    at_ += end + (is_comment ? 3 : 2);
  }
  const std::size_t begin = at_++;
  XmlTag tag;
  const auto take = [&](std::string_view ends_of_word) {
    const std::string_view word = text_.substr(at_, std::min(text_.find_first_of(ends_of_word, at_), text_.size()) - at_);
    at_ += word.size();
    return word;
  };
  const auto skip_blanks = [&] { at_ = std::min(text_.find_first_not_of(xml_blanks, at_), text_.size()); };
  if (text_.substr(at_).starts_with('/')) {
    tag.kind = XmlTag::Kind::closes;
    ++at_;
  }
  tag.name = take(" \t\r\n/><=\"'!");
  if (tag.name.empty())
    no_tag(begin, "no tag");
  for (skip_blanks(); at_ < text_.size() && text_[at_] != '>'; skip_blanks()) {
    if (text_[at_] == '/' && tag.kind == XmlTag::Kind::opens && text_.substr(at_).starts_with("/>")) {
      tag.kind = XmlTag::Kind::is_empty;
      ++at_;
      break;
    }
    const std::string_view name = take(" \t\r\n/><=\"'");
    skip_blanks();
    if (name.empty() || tag.kind == XmlTag::Kind::closes || at_ >= text_.size() || text_[at_] != '=')
      no_tag(begin, fmt::format("a damaged tag <{}>", tag.name.substr(0, 40)));
    ++at_;
    skip_blanks();
    const char quote = at_ < text_.size() ? text_[at_] : '\0';
    const std::size_t last = quote == '"' || quote == '\'' ? text_.find(quote, at_ + 1) : text_.npos;
    if (last == text_.npos)
      no_tag(begin, fmt::format("a damaged tag <{}>", tag.name.substr(0, 40)));
    tag.attributes.emplace_back(name, without_entities(text_.substr(at_ + 1, last - at_ - 1)));
    at_ = last + 1;
  }
  if (at_ >= text_.size())
    no_tag(begin, fmt::format("a tag <{}> without its end", tag.name.substr(0, 40)));
  tag.end = ++at_;
  return tag;
}

std::string XmlTags::text() const
{
  return without_entities(without_blanks_around(text_.substr(at_, std::min(text_.find('<', at_), text_.size()) - at_)));
}

}  // namespace talus
