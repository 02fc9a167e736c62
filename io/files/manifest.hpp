#pragma once
// The list of the files that Talus wrote into a results folder, which distinguishes them from files of the user.  A repeated run replaces
// only files of the list; pictures and resumed runs rename other files.
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace talus {

/// The folder in a results folder for files that Talus needs itself, such as the list (files.txt).
inline constexpr auto own_folder = ".talus";

/// The part of a file that a line of the list describes.
enum class Proof : char {
  whole = 'w',   ///< the whole file
  begins = 'b',  ///< the given number of bytes at its beginning: for a file that is rewritten repeatedly
  grows = 'g'    ///< these bytes, followed by rows of numbers only: for a table to which a run appends
};

/// The present list of a folder.
class Manifest {
 public:
  /// Nothing if a folder has no list.  Throws EnvironmentError if it cannot be read.
  static std::optional<Manifest> of(const std::filesystem::path& folder);

  /// Whether the file of that name, relative to the folder, is an ordinary file with exactly the content that Talus wrote.  Size and time
  /// of modification are compared first; if the time differs, as in a copy, the digest decides.
  bool proves(const std::string& name) const;
  /// The names of all files, each once.
  std::vector<std::string> names() const;
  /// The lines of the list for a file.
  std::string lines_of(const std::string& name) const;
  /// The whole list.
  std::string text() const;

 private:
  struct Entry {
    Proof proof;
    std::uint64_t digest, bytes;
    std::int64_t modified;  // time of modification [ns]
  };
  std::filesystem::path folder_;
  std::map<std::string, std::vector<Entry>, std::less<>> entries_;
};

/// Makes an empty list unless there is one, which makes a folder a results folder.  Throws EnvironmentError.
void begin_manifest(const std::filesystem::path& folder);
/// Replaces the list by another text, atomically.
void replace_manifest(const std::filesystem::path& folder, const std::string& text);

/// Records in the list of its folder that `file` has, or is about to have, the bytes that `content` has now.  Does nothing if the file is
/// not a result in a folder with a list.  A version that was recorded before stays valid, so that a run may be killed at any time.  Throws
/// EnvironmentError with the name of `file`.
void note_result(const std::filesystem::path& file, const std::filesystem::path& content, Proof proof = Proof::whole);

/// Renames a file that is in the way and not proved to be written by Talus to `file`.aside, with a warning on standard error.  Throws
/// EnvironmentError if it cannot be renamed.
void set_aside_unless_proved(const std::filesystem::path& file);

/// The name `file`.aside, with a number if that exists.
std::filesystem::path name_aside(const std::filesystem::path& file);

}  // namespace talus
