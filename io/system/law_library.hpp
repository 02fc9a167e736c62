#pragma once
// Shared libraries of the user, with laws.
#include <filesystem>
#include <string>
#include <string_view>

namespace talus {

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
  void* handle_;
  std::string digest_;
};

}  // namespace talus
