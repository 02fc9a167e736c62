#pragma once
// Suggestions for misspelt words, and lists of words in English.
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace talus {

/// The candidate nearest to `word` by edit distance (a transposition counts one), if it is near enough to be a typing error.
std::optional<std::string> closest_match(std::string_view word, std::span<const std::string> candidates);

/// A list as text, "a, b or c".
std::string or_list(std::span<const std::string> words);

/// The end of an error message: " — did you mean \"friction\"?", or "; known are a, b or c" if no candidate is near; empty without
/// candidates.
std::string suggestion(std::string_view word, std::span<const std::string> candidates);

}  // namespace talus
