#pragma once
// Shared libraries of the user, with laws.
#include <filesystem>
#include <string>
#include <string_view>

namespace talus {

/// 16 digits that change with a file of the user with a law.  Throws Error, with the reason in words, if there is no such file.
std::string digest_of_law_file(const std::filesystem::path& file);

/// A library that was opened.  It is never closed, since what it has registered may be called at the end of the program.
class LawLibrary {
 public:
  /// Opens a file.  Throws Error with the reason in words.
  explicit LawLibrary(const std::filesystem::path& file);

  /// The function of a name.  Throws Error, with what was probably meant, if there is none.
  void* function(const std::string& symbol) const;
  /// 16 digits that change with the file.
  const std::string& digest() const noexcept { return digest_; }

 private:
  std::string digest_;
  void* handle_;
};

}  // namespace talus
