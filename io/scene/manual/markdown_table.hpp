#pragma once
// Tables of the manual, in Markdown.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace talus {

inline std::string code(std::string_view text) { return fmt::format("`{}`", text); }

/// A table with padded columns, so that the source text is readable; the last column is not padded.
template <std::size_t N>
std::string to_table(const std::array<std::string, N>& head, const std::vector<std::array<std::string, N>>& rows)
{
  std::array<std::size_t, N> width{};
  for (std::size_t c = 0; c + 1 < N; ++c) {
    width[c] = head[c].size();
    for (const auto& row : rows)
      width[c] = std::max(width[c], row[c].size());
  }
  const auto line = [&](const std::array<std::string, N>& cells) {
    std::string text = "|";
    for (std::size_t c = 0; c < N; ++c)
      text += fmt::format(" {:<{}} |", cells[c], width[c]);
    return text + "\n";
  };
  std::array<std::string, N> rule;
  for (std::size_t c = 0; c < N; ++c)
    rule[c] = std::string(std::max<std::size_t>(3, width[c]), '-');
  std::string text = line(head) + line(rule);
  for (const auto& row : rows)
    text += line(row);
  return text;
}

}  // namespace talus
