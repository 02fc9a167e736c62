#pragma once
// Words for messages: the word that was probably meant, and lists in plain English.
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace talus {

/// The candidate nearest to `word` by edit distance (transpositions count one), if near enough to be a slip of the hand.
std::optional<std::string> closest_match(std::string_view word, std::span<const std::string> candidates);

/// "a, b or c"
std::string or_list(std::span<const std::string> words);

/// " — did you mean \"friction\"?" or, when nothing is near, "; known are a, b or c" (empty for no candidates).
std::string suggestion(std::string_view word, std::span<const std::string> candidates);

}  // namespace talus
