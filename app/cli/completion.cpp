#include "app/cli/completion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>

namespace talus {

namespace {

/// The possible values of an option, from the words in its help.
struct ValueWords {
  std::vector<std::string> choices, patterns;
  bool folder = false, files = false;
};

ValueWords value_words(const std::string& value)
{
  ValueWords words;
  const std::size_t open = value.find('{'), close = value.find('}');
  for (std::size_t at = open; at < close && close != value.npos; at = value.find(',', at + 1))
    words.choices.push_back(value.substr(at + 1, std::min(value.find(',', at + 1), close) - at - 1));
  for (std::size_t at = value.find("*."); at != value.npos; at = value.find("*.", at + 1))
    words.patterns.push_back(value.substr(at, value.find(' ', at) - at));
  words.folder = value.find("FOLDER") != value.npos;
  words.files = words.choices.empty() && value.starts_with("TEXT");
  return words;
}

/// One word for any of these shells.
std::string in_single_quotes(std::string_view text)
{
  std::string out = "'";
  for (const char c : text)
    out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::vector<std::string> option_names(const CommandWords& command)
{
  std::vector<std::string> names;
  for (const OptionWords& option : command.options)
    names.insert(names.end(), option.names.begin(), option.names.end());
  return names;
}

/// Words in their places, taken together: the first may be the only one.
ValueWords words_in_place(const CommandWords& command)
{
  ValueWords all;
  for (const OptionWords& option : command.options)
    if (option.names.empty()) {
      const ValueWords words = value_words(option.value);
      all.choices.insert(all.choices.end(), words.choices.begin(), words.choices.end());
      all.patterns.insert(all.patterns.end(), words.patterns.begin(), words.patterns.end());
      all.folder = all.folder || words.folder, all.files = all.files || words.files;
    }
  return all;
}

/// The lines that offer such values to bash.
std::string bash_offer(const ValueWords& words)
{
  std::vector<std::string> sources;
  if (!words.choices.empty())
    sources.push_back(fmt::format("compgen -W {} -- \"$word\"", in_single_quotes(fmt::format("{}", fmt::join(words.choices, " ")))));
  for (const std::string& pattern : words.patterns)
    sources.push_back(fmt::format("compgen -f -X '!{}' -- \"$word\"", pattern));
  if (words.files)
    sources.emplace_back("compgen -f -- \"$word\"");
  else if (words.folder || !words.patterns.empty())
    sources.emplace_back("compgen -d -- \"$word\"");
  if (sources.empty())
    return "return";
  const bool files = words.files || words.folder || !words.patterns.empty();
  return fmt::format("mapfile -t COMPREPLY < <({}){}; return", fmt::join(sources, "; "), files ? "; compopt -o filenames" : "");
}

std::string bash_script(const std::vector<CommandWords>& commands)
{
  std::vector<std::string> names;
  std::string values, options, places;
  for (const CommandWords& command : commands) {
    names.push_back(command.name);
    for (const OptionWords& option : command.options)
      for (const std::string& name : option.names)
        if (!option.value.empty())
          values += fmt::format("    \"{} {}\") {} ;;\n", command.name, name, bash_offer(value_words(option.value)));
    options += fmt::format("      {}) mapfile -t COMPREPLY < <(compgen -W '{}' -- \"$word\") ;;\n", command.name,
                           fmt::join(option_names(command), " "));
    places += fmt::format("    {}) {} ;;\n", command.name, bash_offer(words_in_place(command)));
  }
  return fmt::format(R"sh(# Completion of talus in bash; to switch it on: eval "$(talus completion bash)"
_talus()
{{
  local word="${{COMP_WORDS[COMP_CWORD]}}" before="${{COMP_WORDS[COMP_CWORD - 1]}}" command="${{COMP_WORDS[1]}}"
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    mapfile -t COMPREPLY < <(compgen -W '{}' -- "$word")
    return
  fi
  case "$command $before" in
{}  esac
  if [[ "$word" == -* ]]; then
    case "$command" in
{}    esac
    return
  fi
  case "$command" in
{}  esac
}}
complete -F _talus talus
)sh",
                     fmt::join(names, " "), values, options, places);
}

/// Text for _arguments of zsh, with escaped brackets and colons.
std::string zsh_text(std::string_view text)
{
  std::string out;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':')
      out += '\\';
    out += c;
  }
  return out;
}

std::string zsh_action(const ValueWords& words)
{
  if (!words.choices.empty())
    return fmt::format("({})", fmt::join(words.choices, " "));
  if (!words.patterns.empty())
    return fmt::format("_files -g \"{}\"", fmt::join(words.patterns, " "));
  return words.folder ? "_directories" : words.files ? "_files" : " ";
}

std::string zsh_script(const std::vector<CommandWords>& commands)
{
  std::string names, cases;
  for (const CommandWords& command : commands) {
    names += fmt::format("    {}\n", in_single_quotes(fmt::format("{}:{}", command.name, command.help)));
    cases += fmt::format("    {}) _arguments", command.name);
    for (const OptionWords& option : command.options)
      for (const std::string& name : option.names) {
        const std::string help = fmt::format("{}[{}]", name, zsh_text(option.help));
        const std::string value = option.value.empty() ? "" : fmt::format(":value:{}", zsh_action(value_words(option.value)));
        cases += " \\\n      " + in_single_quotes("*" + help + value);
      }
    cases += fmt::format(" \\\n      {} ;;\n", in_single_quotes(fmt::format("*:word:{}", zsh_action(words_in_place(command)))));
  }
  return fmt::format(R"sh(#compdef talus
# Completion of talus in zsh; to switch it on, behind compinit: eval "$(talus completion zsh)"
_talus()
{{
  local -a commands
  commands=(
{}  )
  if (( CURRENT == 2 )); then
    _describe command commands
    return
  fi
  local command=$words[2]
  shift words
  (( CURRENT-- ))
  case $command in
{}  esac
}}
compdef _talus talus
)sh",
                     names, cases);
}

std::string fish_script(const std::vector<CommandWords>& commands)
{
  std::string text = "# Completion of talus in fish; to switch it on: talus completion fish | source\ncomplete -c talus -f\n";
  for (const CommandWords& command : commands) {
    text += fmt::format("complete -c talus -n __fish_use_subcommand -a {} -d {}\n", command.name, in_single_quotes(command.help));
    const std::string here = fmt::format("complete -c talus -n '__fish_seen_subcommand_from {}'", command.name);
    const auto offer = [](const ValueWords& words) {
      std::string offered;
      if (!words.choices.empty())
        offered += fmt::format(" -a '{}'", fmt::join(words.choices, " "));
      if (!words.patterns.empty() || words.files)
        offered += " -F";
      else if (words.folder)
        offered += " -a '(__fish_complete_directories)'";
      return offered;
    };
    for (const OptionWords& option : command.options)
      for (const std::string& name : option.names) {
        const bool is_long = name.starts_with("--");
        text += fmt::format("{} {} {}{}{} -d {}\n", here, is_long ? "-l" : "-s", name.substr(is_long ? 2 : 1),
                            option.value.empty() ? "" : " -r", option.value.empty() ? "" : offer(value_words(option.value)),
                            in_single_quotes(option.help));
      }
    if (const std::string words = offer(words_in_place(command)); !words.empty())
      text += here + words + "\n";
  }
  return text;
}

}  // namespace

std::vector<std::string> completion_shells() { return {"bash", "zsh", "fish"}; }

std::string completion_script(const std::string& shell, const std::vector<CommandWords>& commands)
{
  return shell == "bash" ? bash_script(commands) : shell == "zsh" ? zsh_script(commands) : fish_script(commands);
}

}  // namespace talus
