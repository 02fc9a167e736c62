#include "core/word_match.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace talus {

namespace {

/// Optimal string alignment distance (insert, delete, replace, swap neighbours).
std::size_t distance(std::string_view a, std::string_view b)
{
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i)
    d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j)
    d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

constexpr std::size_t longest_word = 80;  // a longer key is not a typing error

}  // namespace

std::optional<std::string> closest_match(std::string_view word, std::span<const std::string> candidates)
{
  if (word.size() > longest_word)
    return std::nullopt;
  const std::string* best = nullptr;
  std::size_t best_distance = 0;
  for (const auto& candidate : candidates) {
    const std::size_t d = distance(word, candidate);
    if (best == nullptr || d < best_distance) {
      best = &candidate;
      best_distance = d;
    }
  }
  if (best == nullptr || best_distance >= best->size() || best_distance > std::max<std::size_t>(1, std::min(word.size(), best->size()) / 3))
    return std::nullopt;
  return *best;
}

std::string or_list(std::span<const std::string> words)
{
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
  return text;
}

std::string suggestion(std::string_view word, std::span<const std::string> candidates)
{
  if (const auto match = closest_match(word, candidates))
    return fmt::format(" — did you mean \"{}\"?", *match);
  if (candidates.empty())
    return {};
  return fmt::format("; known: {}", or_list(candidates));
}

}  // namespace talus
