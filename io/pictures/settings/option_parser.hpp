#pragma once
// Options of pictures as rows of a table, and their use with CLI11: for `talus render` and similar commands, and for talus-render.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <charconv>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/word_match.hpp"
#include "io/pictures/settings/picture_settings.hpp"

namespace talus::render {

/// Converts a word to a value.  Throws Error if it is not a finite number.
template <class T>
T number(const std::string& word, const std::string& option)
{
  T value{};
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (code != std::errc{} || end != word.data() + word.size() || !(value - value == T{}))
    throw Error(fmt::format("{}: \"{}\" is not a number", option, word));
  return value;
}

enum class Offered : std::uint8_t { to_users, all };

/// Adds options to a command.  take(option, words) is called for the options that were given, in the order of the table.
template <class S, class Take>
void add_options(CLI::App& command, std::span<const Option<S>> options, Take take, Offered offered = Offered::all)
{
  for (const Option<S>& option : options) {
    if (option.internal && offered == Offered::to_users)
      continue;
    const std::string name(option.name), help(option.help);
    const auto taken = [take, &option](const std::vector<std::string>& words) {
      take(option, words);
      return true;
    };
    if (option.most == 0)
      command.add_flag_callback(
          name, [taken] { taken({}); }, help);
    else if (CLI::Option* const added = command.add_option(name, CLI::callback_t(taken), help)->type_name(std::string(option.values));
             option.repeated)
      added->type_size(option.most)->trigger_on_parse();
    else
      added->expected(option.least, option.most)->allow_extra_args(!option.internal);  // too many words are told; a title is one word
  }
}

/// Parses the words with CLI11.  Unknown words and options, and errors of CLI11, are added to `problems`.
inline void parse_words(CLI::App& app, std::span<const std::string> words, std::vector<std::string>& problems)
{
  app.allow_extras();
  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::ParseError& error) {
    problems.emplace_back(error.what());
  }
  std::vector<std::string> known;
  for (const CLI::Option* option : app.get_options([](const CLI::Option* o) { return !o->get_lnames().empty(); }))
    known.push_back("--" + option->get_lnames().front());
  bool of_unknown = false;
  for (const std::string& word : app.remaining()) {
    if (word.starts_with("-"))
      problems.push_back(fmt::format("unknown option {}{}", word, suggestion(word, known)));
    else if (!of_unknown)
      problems.push_back(fmt::format("{} is one word too many", word));
    of_unknown = of_unknown || word.starts_with("-");
  }
}

}  // namespace talus::render
