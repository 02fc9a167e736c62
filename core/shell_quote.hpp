#pragma once
// Words of commands that messages tell to type.
#include <filesystem>
#include <string>

namespace talus {

/// As a shell takes it for one word.
std::string shell_word(const std::filesystem::path& word);

}  // namespace talus
