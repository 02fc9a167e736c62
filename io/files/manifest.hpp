#pragma once
// The list of the files that Talus wrote into a folder of results, which tells them from files of the user.  A run that is repeated
// replaces only the files in the list; pictures and runs that go on rename other files.
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace talus {

/// In a folder of results: what Talus keeps there for itself, the list (files.txt) among it.
inline constexpr auto own_folder = ".talus";

/// How far a line of the list binds the file that it names.
enum class Proof : char {
  whole = 'w',   ///< all of it
  begins = 'b',  ///< so many bytes at its beginning: of a file that is rewritten all the time
  grows = 'g'    ///< these, and behind them nothing but rows of numbers: of a table while a run appends to it
};

/// The list of a folder as it is now.
class Manifest {
 public:
  /// Nothing where a folder has no list.  EnvironmentError: it cannot be read.
  static std::optional<Manifest> of(const std::filesystem::path& folder);

  /// Whether the file of that name, relative to the folder, is an ordinary file, is as Talus wrote it, and not one byte of it is another's.
  /// Size and time of modification are asked first; where the time differs, as in a copy, the digest decides.
  bool proves(const std::string& name) const;
  /// Each once.
  std::vector<std::string> names() const;
  /// What the list says of a file, as it stands there.
  std::string lines_of(const std::string& name) const;
  /// All of it.
  std::string text() const;

 private:
  struct Entry {
    Proof proof;
    std::uint64_t digest, bytes;
    std::int64_t modified;  // [ns]
  };
  std::filesystem::path folder_;
  std::map<std::string, std::vector<Entry>, std::less<>> entries_;
};

/// Makes an empty list, unless there is one, and so a folder of results of a folder.  EnvironmentError.
void begin_manifest(const std::filesystem::path& folder);
/// Puts another text in its place, as a whole.
void replace_manifest(const std::filesystem::path& folder, const std::string& text);

/// Notes in the list of its folder that `file` is about to have, or has, the bytes that `content` has now.  Nothing happens where the file is no
/// result in a folder with a list.  A version that was noted before remains one that Talus wrote, so that it does not matter when a run is killed.
/// EnvironmentError names `file`.
void note_result(const std::filesystem::path& file, const std::filesystem::path& content, Proof proof = Proof::whole);

/// What stands in the place of such a file and is not proved to be written by Talus gets another name, `file`.aside, with a warning on standard
/// error.  EnvironmentError: it cannot be renamed.
void set_aside_unless_proved(const std::filesystem::path& file);

/// `file`.aside, or with a number where that is taken.
std::filesystem::path name_aside(const std::filesystem::path& file);

}  // namespace talus
