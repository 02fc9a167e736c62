#pragma once
// A .msh file in memory, read number by number.  Nothing is trusted: every complaint names the line or byte and the scene that asked.
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
  /// Reads the whole file.  Throws SceneErrors at `asked_by` if it is missing, empty or no file.
  MshSource(const std::filesystem::path& file, SourceLocation asked_by);

  /// From here on count(), integer(), tag() and real() read binary numbers, with their bytes reversed or not.
  void become_binary(bool reversed) noexcept
  {
    binary_ = true;
    reversed_ = reversed;
  }
  bool binary() const noexcept { return binary_; }

  /// Opening word of the next section without its dollar sign; nothing at the end of the file.
  std::optional<std::string> next_section();
  /// Throws unless the next word is "$End" + section.
  void close_section(const std::string& section);
  /// Jumps behind the closing word of a section that is of no interest.
  void skip_section(const std::string& section);

  std::int64_t text_integer(std::string_view what);  ///< a whole number in text, in binary files too
  Real text_real(std::string_view what);
  std::string text_quoted(std::string_view what);  ///< "a name in quotes", without them
  void end_line(std::string_view what);            ///< throws unless the line is at its end

  std::int64_t integer(std::string_view what);                                   ///< 4 bytes
  std::int64_t tag(std::string_view what, std::int64_t low, std::int64_t high);  ///< 8 bytes, within [low, high]
  Real real(std::string_view what);                                              ///< 8 bytes, finite
  /// A count (8 bytes), each item of which must take at least so many bytes of what is left of the file.
  std::int64_t count(std::string_view what, std::int64_t bytes_in_text, std::int64_t bytes_in_binary);
  /// Throws unless `count` items can stand in the bytes that are left: nothing is allocated on the word of a broken file.
  void check_count(std::int64_t count, std::string_view what, std::int64_t bytes_in_text, std::int64_t bytes_in_binary) const;

  /// The place last read, with this complaint.
  [[noreturn]] void fail(const std::string& complaint) const;
  /// The file as a whole, with this complaint.
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
  std::size_t at_ = 0, mark_ = 0;  ///< next byte; beginning of what was read last
  bool binary_ = false, reversed_ = false;
};

}  // namespace talus
