#pragma once
// The words of a command line, taken one by one.
#include <charconv>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/types.hpp"

namespace talus::render {

/// Error: the word is not a finite number.
template <class T>
T number(const std::string& word, const std::string& option)
{
  T value{};
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (code != std::errc{} || end != word.data() + word.size() || !(value - value == T{}))
    throw Error(fmt::format("{}: \"{}\" is not a number", option, word));
  return value;
}

class OptionWords {
 public:
  explicit OptionWords(std::span<const std::string> words) : words_(words) {}
  bool empty() const noexcept { return words_.empty(); }
  /// Error: there is none.
  std::string next(const std::string& wanted)
  {
    if (words_.empty())
      throw Error(fmt::format("{} needs another word", wanted));
    const std::string word = words_.front();
    words_ = words_.subspan(1);
    return word;
  }
  /// Those up to the next option.
  std::vector<std::string> values()
  {
    std::vector<std::string> list;
    while (!words_.empty() && !words_.front().starts_with("--"))
      list.push_back(next(""));
    return list;
  }

 private:
  std::span<const std::string> words_;
};

}  // namespace talus::render
