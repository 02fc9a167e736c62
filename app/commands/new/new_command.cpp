// talus new
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <stdexcept>

#include "app/commands/new/new_command.hpp"
#include "app/commands/new/templates.hpp"
#include "core/shell_quote.hpp"
#include "core/word_match.hpp"
#include "io/files/atomic_file.hpp"
#include "io/scene/reader.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

std::string in_unit(const std::string& unit) { return unit == "-" ? "" : " " + unit; }

/// "[m], 1 to 200, default 10"
std::string allowed(const OpenQuestion& open)
{
  const Question& question = *open.question;
  const std::string of_number = fmt::format("{} to {}{}", open.range.low, open.range.high, in_unit(question.unit));
  return fmt::format("{}; Enter takes {}", question.choices.empty() ? of_number : or_list(question.choices), open.fallback);
}

/// Something that is asked before all else, as a question of a template is.
Question which_template()
{
  Question question;
  question.name = "template";
  question.ask = "Which template?";
  question.fallback = "slope";
  question.choices = template_names();
  return question;
}

/// Asks until the answer is one.  At the end of the input the default is taken, for this question and all that follow.
class Conversation {
 public:
  std::string ask(const OpenQuestion& open)
  {
    std::string line;
    while (!ended_) {
      fmt::print("{}\n  ({}) > ", open.question->ask, allowed(open));
      std::fflush(stdout);
      if (!std::getline(std::cin, line)) {
        ended_ = true;
        fmt::print("\nEnd of input: this and all further questions take their defaults.\n");
        break;
      }
      line.erase(0, std::min(line.find_first_not_of(" \t"), line.size()));
      line.erase(line.find_last_not_of(" \t\r") + 1);
      if (line.empty())
        break;
      try {
        return read_answer(open, line);
      } catch (const std::invalid_argument& e) {
        fmt::print("  {}\n", e.what());
      }
    }
    return read_answer(open, open.fallback);
  }

 private:
  bool ended_ = false;
};

void list_templates()
{
  for (const TemplateText& one : shipped_templates())
    fmt::print("{:<8}  {}\n", one.name, find_template(std::string(one.name)).head.summary);
  fmt::print("what one asks: talus new TEMPLATE --list\n");
}

/// With the defaults of the first answers, and the words that choose other questions.
void list_questions(const SceneTemplate& from)
{
  fmt::print("{}\n", from.head.summary);
  for (const Question& question : from.head.questions) {
    const std::string values = question.choices.empty()
                                   ? fmt::format("{} to {}{}", question.range[0], question.range[1], in_unit(question.unit))
                                   : or_list(question.choices);
    fmt::print("  {:<20} {}\n  {:<20} {}; default {}{}\n", question.name, question.ask, "", values, question.fallback,
               question.when.empty() ? "" : fmt::format("; only if {}", question.when));
  }
}

/// What --set says, by the names of questions.  SceneErrors: all that name none.
Answers given_answers(const SceneTemplate& from, const std::vector<std::string>& set)
{
  std::vector<std::string> known;
  for (const Question& question : from.head.questions)
    known.push_back(question.name);
  Answers given;
  std::vector<SceneError> problems;
  for (const std::string& text : set) {
    const std::size_t equals = text.find('=');
    const std::string name = text.substr(0, equals);
    const SourceLocation where{"--set " + text, 0, 0, ""};
    if (equals == text.npos)
      problems.push_back({where, "write it as name=value", ""});
    else if (std::find(known.begin(), known.end(), name) == known.end())
      problems.push_back({where, fmt::format("{} asks for no \"{}\"{}", from.file, name, suggestion(name, known)), ""});
    else
      given.push_back({name, text.substr(equals + 1)});
  }
  if (!problems.empty())
    throw SceneErrors(std::move(problems));
  return given;
}

/// Answers of the command line and, for what they do not say, defaults.  SceneErrors with all that are wrong.
Answers take_given(const SceneTemplate& from, const std::vector<std::string>& set)
{
  const Answers given = given_answers(from, set);
  std::vector<SceneError> problems;
  Answers answers;
  while (const auto open = next_question(from, answers)) {
    const std::string& name = open->question->name;
    const auto said =
        std::find_if(given.rbegin(), given.rend(), [&](const Answer& answer) { return answer.name == name; });  // the last counts
    std::string text = open->fallback;
    if (said != given.rend())
      try {
        text = read_answer(*open, said->text);
      } catch (const std::invalid_argument& e) {
        problems.push_back({SourceLocation{fmt::format("--set {}={}", name, said->text), 0, 0, ""}, e.what(), ""});
      }
    answers.push_back({name, read_answer(*open, problems.empty() ? text : open->fallback)});
  }
  for (const Answer& one : given)
    if (std::none_of(answers.begin(), answers.end(), [&](const Answer& answer) { return answer.name == one.name; }))
      problems.push_back(
          {SourceLocation{fmt::format("--set {}={}", one.name, one.text), 0, 0, ""}, "with the other answers nothing asks for this", ""});
  if (!problems.empty())
    throw SceneErrors(std::move(problems));
  return answers;
}

Answers ask_all(const SceneTemplate& from, Conversation& conversation)
{
  Answers answers;
  while (const auto open = next_question(from, answers))
    answers.push_back({open->question->name, conversation.ask(*open)});
  return answers;
}

std::string head_of(const SceneTemplate& from, const std::string& name, const Answers& answers)
{
  std::string text = "# yaml-language-server: $schema=talus.schema.json\n";
  text += fmt::format("# {}\n#\n# Made by `talus new`. The same scene again, or with other answers:\n#\n#   talus new {}",
                      from.head.summary, shell_word(name));
  for (const Answer& answer : answers)
    text += fmt::format(" \\\n#     --set {}={}", answer.name, answer.text);
  return text + "\n#\n# For an editor that completes keys and tells what they mean: talus manual --schema > talus.schema.json\n\n";
}

}  // namespace

void new_scene(const NewOptions& options)
{
  if (options.list)
    return options.from ? list_questions(find_template(*options.from)) : list_templates();
  const bool asks = options.set.empty() && ::isatty(STDIN_FILENO) == 1;
  if (!asks && options.set.empty())
    fmt::print(stderr, "note: nothing is asked without a terminal: every answer is its default, or what --set NAME=VALUE says\n");
  Conversation conversation;
  std::optional<std::string> name = options.from;
  if (!name && !asks)
    throw Error(fmt::format("say which template: {}; talus new --list tells what they are", or_list(template_names())));
  if (!name) {
    list_templates();
    const Question which = which_template();
    name = conversation.ask({&which, which.fallback, any});
  }
  const SceneTemplate from = find_template(*name);
  const fs::path out = options.out.value_or(fs::path(*name).stem().string() + ".yaml");
  const auto refuse_to_replace = [&] {
    if (std::error_code unknown; !options.force && fs::exists(fs::symlink_status(out, unknown)))
      throw Error(fmt::format("{} is there already: choose another file with --out, or replace it with --force", out.string()));
  };
  refuse_to_replace();
  const Answers answers = asks ? ask_all(from, conversation) : take_given(from, options.set);
  const std::string text = head_of(from, *name, answers) + fill_in(from, answers);
  read_scene_text(out, text);  // a template that makes no scene leaves no file
  refuse_to_replace();
  write_whole(out, text);
  const std::string scene = shell_word(out), results = shell_word("runs/" + out.stem().string());
  fmt::print("{} is written. Next:\n  talus check {}\n  talus run {} --out {}\n  talus render {}\n", out.string(), scene, scene, results,
             results);
}

}  // namespace talus
