#pragma once
// Quoting of words in the commands that messages suggest.
#include <filesystem>
#include <string>

namespace talus {

/// The word, quoted so that a shell takes it as one word.
std::string shell_word(const std::filesystem::path& word);

}  // namespace talus
