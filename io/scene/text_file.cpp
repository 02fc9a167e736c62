// Reads a file as text that can be parsed and shown.
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <system_error>

#include "io/document/document.hpp"

namespace talus {

namespace {

constexpr std::uintmax_t largest_file = 4'000'000;  // in bytes; a table of 100 000 points fits

std::string read_bytes(const std::filesystem::path& file)
{
  const SourceLocation where{file.string(), 0, 0, ""};
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status))
    throw SceneErrors(where, "there is no such file");
  if (std::filesystem::is_directory(status))
    throw SceneErrors(where, "this is a folder, not a file");
  if (!std::filesystem::is_regular_file(status))
    throw SceneErrors(where, "this is not an ordinary file");
  const auto size = std::filesystem::file_size(file, error);
  if (!error && size > largest_file)
    throw SceneErrors(
        where, fmt::format("the file has {:.0f} MB; at most {} MB are read", static_cast<double>(size) / 1e6, largest_file / 1'000'000));
  std::ifstream stream(file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  if (!stream || bytes.size() > largest_file)
    throw SceneErrors(where, fmt::format("the file cannot be read: {}", std::strerror(errno)));
  return bytes;
}

/// The text with "
/// " for "\r
/// " and "\r", without a byte order mark.
std::string with_plain_ends(const std::string& bytes)
{
  std::string text;
  text.reserve(bytes.size());
  for (std::size_t i = bytes.starts_with("\xEF\xBB\xBF") ? 3 : 0; i < bytes.size(); ++i) {
    if (bytes[i] != '\r')
      text += bytes[i];
    else if (i + 1 == bytes.size() || bytes[i + 1] != '\n')
      text += '\n';
  }
  return text;
}

/// The length of the UTF-8 character at the beginning, or zero if it is not valid (RFC 3629: no overlong forms, no surrogates).
std::size_t character_length(std::string_view text)
{
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
  const auto follows = [&](std::size_t i, unsigned low = 0x80, unsigned high = 0xBF) { return byte(i) >= low && byte(i) <= high; };
  const unsigned first = byte(0);
  if (first < 0x80)
    return 1;
  if (first >= 0xC2 && first <= 0xDF)
    return follows(1) ? 2 : 0;
  if (first >= 0xE0 && first <= 0xEF)
    return follows(1, first == 0xE0 ? 0xA0 : 0x80, first == 0xED ? 0x9F : 0xBF) && follows(2) ? 3 : 0;
  if (first >= 0xF0 && first <= 0xF4)
    return follows(1, first == 0xF0 ? 0x90 : 0x80, first == 0xF4 ? 0x8F : 0xBF) && follows(2) && follows(3) ? 4 : 0;
  return 0;
}

/// A character that a text file must not contain, and its position.
struct Flaw {
  std::size_t at;
  std::string message;
  bool printable = false;
};
std::optional<Flaw> flaw_of(std::string_view line)
{
  for (std::size_t i = 0; i < line.size();) {
    const std::size_t length = character_length(line.substr(i));
    if (length == 0)
      return Flaw{i, "this is not UTF-8: save the file as UTF-8 text"};
    const auto code = static_cast<unsigned char>(line[i]);
    if ((code < 0x20 && code != '\t') || code == 0x7F)
      return Flaw{i, fmt::format("control character 0x{:02X}: this is not a text file", code)};
    i += length;
  }
  const std::size_t indentation = std::min(line.find_first_not_of(" \t"), line.size());
  if (const std::size_t tab = line.substr(0, indentation).find('\t'); tab != std::string_view::npos && indentation < line.size())
    return Flaw{tab, "tab in the indentation: use blanks", true};
  return std::nullopt;
}

}  // namespace

std::vector<std::string_view> lines_of(std::string_view text)
{
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

std::string read_text(const std::filesystem::path& file) { return plain_text(file, read_bytes(file)); }

std::string plain_text(const std::filesystem::path& file, const std::string& bytes)
{
  std::string text = with_plain_ends(bytes);
  const Source source{file.string(), {}, lines_of(text)}, unprintable{file.string(), {}, {}};
  Problems problems;
  for (std::size_t i = 0; i < source.lines.size(); ++i)
    if (const auto flaw = flaw_of(source.lines[i])) {
      problems.add({flaw->printable ? &source : &unprintable, static_cast<int>(i) + 1, static_cast<int>(flaw->at) + 1}, "", flaw->message);
      if (!flaw->printable)
        break;
    }
  problems.throw_if_any();
  return text;
}

}  // namespace talus
