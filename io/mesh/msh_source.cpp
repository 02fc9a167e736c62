#include "io/mesh/msh_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>

#include "io/files/atomic_file.hpp"
#include "io/system/memory.hpp"

namespace talus {

namespace {

constexpr std::string_view blanks = " \t\r\n\v\f";

bool printable(std::string_view text)
{
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

std::string read_file(const std::filesystem::path& file, const SourceLocation& asked_by)
{
  const auto refuse = [&](const std::string& why) { throw SceneErrors(asked_by, fmt::format("mesh file \"{}\" {}", file.string(), why)); };
  if (const auto why = not_ordinary(file))
    refuse(*why);
  std::error_code unknown;
  if (const auto size = std::filesystem::file_size(file, unknown); !unknown)
    if (const std::string many = too_many(static_cast<Real>(size), "bytes", 1); !many.empty())
      refuse(many);
  std::ifstream stream(file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  if (!stream)
    refuse("cannot be read");
  if (bytes.empty())
    refuse("is empty");
  return bytes;
}

}  // namespace

MshSource::MshSource(const std::filesystem::path& file, SourceLocation asked_by)
    : file_(file), asked_by_(std::move(asked_by)), bytes_(read_file(file, asked_by_))
{}

void MshSource::fail(const std::string& complaint) const
{
  const std::string asked = asked_by_.file.empty() ? "" : fmt::format(" (mesh of {})", to_string(asked_by_));
  if (binary_)
    throw SceneErrors(SourceLocation{file_.string(), 0, 0, ""}, fmt::format("byte {}: {}{}", mark_, complaint, asked));
  const std::size_t before = mark_ == 0 ? std::string::npos : bytes_.rfind('\n', mark_ - 1);
  const std::size_t begin = before == std::string::npos ? 0 : before + 1;
  std::string_view line = std::string_view(bytes_).substr(begin);
  line = line.substr(0, line.find_first_of("\r\n"));
  if (line.size() > 120 || !printable(line))
    line = {};
  const auto number = 1 + std::count(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(begin), '\n');
  const SourceLocation where{file_.string(), static_cast<int>(number), static_cast<int>(mark_ - begin) + 1, ""};
  throw SceneErrors({SceneError{where, complaint + asked, std::string(line)}});
}

void MshSource::fail_file(const std::string& complaint) const
{
  const std::string asked = asked_by_.file.empty() ? "" : fmt::format(" (mesh of {})", to_string(asked_by_));
  throw SceneErrors(SourceLocation{file_.string(), 0, 0, ""}, complaint + asked);
}

void MshSource::skip_blank() noexcept { at_ = std::min(bytes_.find_first_not_of(blanks, at_), bytes_.size()); }

std::string MshSource::shown(std::string_view token) const
{
  if (!printable(token))
    return "bytes that are no text";
  return fmt::format("\"{}{}\"", token.substr(0, 40), token.size() > 40 ? "..." : "");
}

std::string_view MshSource::word(std::string_view what)
{
  skip_blank();
  mark_ = at_;
  if (at_ == bytes_.size())
    fail(fmt::format("the file ends where {} should stand", what));
  const std::size_t end = std::min(bytes_.find_first_of(blanks, at_), bytes_.size());
  const std::string_view token = std::string_view(bytes_).substr(at_, end - at_);
  at_ = end;
  return token;
}

std::optional<std::string> MshSource::next_section()
{
  skip_blank();
  mark_ = at_;
  if (at_ == bytes_.size())
    return std::nullopt;
  const std::string_view token = word("a section");
  if (token.size() < 2 || token[0] != '$' || token.starts_with("$End"))
    fail(fmt::format("expected the opening word of a section such as $Nodes, found {}", shown(token)));
  if (!binary_) {
    at_ = std::min(bytes_.find_first_not_of(" \t\r", at_), bytes_.size());
  }
  if (at_ < bytes_.size() && bytes_[at_] == '\n')  // in a binary file exactly this byte and no other white space
    ++at_;
  return std::string(token.substr(1));
}

void MshSource::close_section(const std::string& section)
{
  const std::string_view token = word("$End" + section);
  if (token != "$End" + section)
    fail(fmt::format("expected $End{}, found {}", section, shown(token)));
}

void MshSource::skip_section(const std::string& section)
{
  const std::string closing = "$End" + section;
  const std::size_t found = bytes_.find(closing, at_);
  if (found == std::string::npos)
    fail(fmt::format("section ${} is never closed", section));
  at_ = found;
  close_section(section);
}

std::int64_t MshSource::text_integer(std::string_view what)
{
  const std::string_view token = word(what);
  std::int64_t value{};
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
  if (error != std::errc{} || end != token.data() + token.size())
    fail(fmt::format("expected {}, found {}", what, shown(token)));
  return value;
}

Real MshSource::text_real(std::string_view what)
{
  std::string_view token = word(what);
  if (token.starts_with('+'))
    token.remove_prefix(1);
  Real value{};
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
  // A number too small for a double gives out of range too; it is taken as zero.
  if (error == std::errc::result_out_of_range && token.find("e-") != std::string_view::npos)
    return 0;
  if (error != std::errc{} || end != token.data() + token.size())
    fail(fmt::format("expected {}, found {}", what, shown(token)));
  return value;
}

std::string MshSource::text_quoted(std::string_view what)
{
  at_ = std::min(bytes_.find_first_not_of(" \t", at_), bytes_.size());
  mark_ = at_;
  const std::size_t end = bytes_.find_first_of("\"\n", at_ + 1);
  if (at_ >= bytes_.size() || bytes_[at_] != '"' || end == std::string::npos || bytes_[end] != '"')
    fail(fmt::format("expected {} in quotes", what));
  std::string text = bytes_.substr(at_ + 1, end - at_ - 1);
  if (std::any_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }))
    fail(fmt::format("{} holds bytes that are no text", what));
  at_ = end + 1;
  return text;
}

void MshSource::end_line(std::string_view what)
{
  at_ = std::min(bytes_.find_first_not_of(" \t\r", at_), bytes_.size());
  mark_ = at_;
  if (at_ == bytes_.size() || bytes_[at_] != '\n')
    fail(fmt::format("expected the end of the line after {}", what));
  ++at_;
}

template <class T>
T MshSource::raw(std::string_view what)
{
  mark_ = at_;
  if (bytes_.size() - at_ < sizeof(T))
    fail(fmt::format("the file ends where {} should stand", what));
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), bytes_.data() + at_, sizeof(T));
  if (reversed_)
    std::reverse(bytes.begin(), bytes.end());
  at_ += sizeof(T);
  T value;
  std::memcpy(&value, bytes.data(), sizeof(T));
  return value;
}

std::int64_t MshSource::integer(std::string_view what)
{
  const std::int64_t value = binary_ ? raw<std::int32_t>(what) : text_integer(what);
  if (value < std::numeric_limits<std::int32_t>::min() || value > std::numeric_limits<std::int32_t>::max())
    fail(fmt::format("{} is {}, more than four bytes can hold", what, value));
  return value;
}

std::int64_t MshSource::tag(std::string_view what, std::int64_t low, std::int64_t high)
{
  const std::int64_t value = binary_ ? raw<std::int64_t>(what) : text_integer(what);
  if (value < low || value > high)
    fail(fmt::format("{} is {}, outside [{}, {}]", what, value, low, high));
  return value;
}

Real MshSource::real(std::string_view what)
{
  const Real value = binary_ ? raw<Real>(what) : text_real(what);
  if (!std::isfinite(value))
    fail(fmt::format("{} is {}", what, value));
  return value;
}

std::int64_t MshSource::count(std::string_view what, std::int64_t bytes_in_text, std::int64_t bytes_in_binary)
{
  const std::int64_t value = binary_ ? raw<std::int64_t>(what) : text_integer(what);
  check_count(value, what, bytes_in_text, bytes_in_binary);
  return value;
}

void MshSource::check_count(std::int64_t count, std::string_view what, std::int64_t bytes_in_text, std::int64_t bytes_in_binary) const
{
  if (count < 0)
    fail(fmt::format("{} is {}", what, count));
  if (count > std::numeric_limits<Index>::max())
    fail(fmt::format("{} is {}, more than can be numbered", what, count));
  const auto left = static_cast<std::int64_t>(bytes_.size() - at_);
  // The last item of a text needs no white space after it.
  if (count * (binary_ ? bytes_in_binary : bytes_in_text) > left + 1)
    fail(fmt::format("{} is {}, but only {} bytes are left in the file", what, count, left));
}

}  // namespace talus
