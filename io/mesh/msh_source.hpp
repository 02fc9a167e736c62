#pragma once
// A .msh file in memory, read number by number.  All input is checked; messages name the line or byte and the scene.
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/error.hpp"
#include "core/types.hpp"

namespace talus {

class MshSource {
 public:
  /// Reads the whole file.  Throws SceneErrors at `asked_by` if it is missing, empty or not a file.
  MshSource(const std::filesystem::path& file, SourceLocation asked_by);

  /// From now on count(), integer(), tag() and real() read binary numbers, with bytes in reversed order or not.
  void become_binary(bool reversed) noexcept
  {
    binary_ = true;
    reversed_ = reversed;
  }
  bool binary() const noexcept { return binary_; }

  /// The name of the next section without its dollar sign; nothing at the end of the file.
  std::optional<std::string> next_section();
  /// Throws unless the next word is "$End" + section.
  void close_section(const std::string& section);
  /// Moves to the end of a section that is not needed.
  void skip_section(const std::string& section);

  std::int64_t text_integer(std::string_view what);  ///< an integer in text, also in binary files
  Real text_real(std::string_view what);
  std::string text_quoted(std::string_view what);  ///< a name in quotes, without them
  void end_line(std::string_view what);            ///< throws unless the line is at its end

  std::int64_t integer(std::string_view what);                                   ///< 4 bytes in binary files
  std::int64_t tag(std::string_view what, std::int64_t low, std::int64_t high);  ///< 8 bytes in binary files, within [low, high]
  Real real(std::string_view what);                                              ///< 8 bytes in binary files, finite
  /// A count (8 bytes); each item must take at least the given number of bytes of the remaining file.
  std::int64_t count(std::string_view what, std::int64_t bytes_in_text, std::int64_t bytes_in_binary);
  /// Throws unless `count` items fit into the remaining bytes, so that a damaged count does not allocate memory.
  void check_count(std::int64_t count, std::string_view what, std::int64_t bytes_in_text, std::int64_t bytes_in_binary) const;

  /// Throws an error at the position that was read last.
  [[noreturn]] void fail(const std::string& complaint) const;
  /// Throws an error for the whole file.
  [[noreturn]] void fail_file(const std::string& complaint) const;

 private:
  std::string_view word(std::string_view what);
  std::string shown(std::string_view token) const;
  template <class T>
  T raw(std::string_view what);
  void skip_blank() noexcept;

  std::filesystem::path file_;
  SourceLocation asked_by_;
  std::string bytes_;
  std::size_t at_ = 0, mark_ = 0;  ///< next byte; beginning of the item that was read last
  bool binary_ = false, reversed_ = false;
};

}  // namespace talus
