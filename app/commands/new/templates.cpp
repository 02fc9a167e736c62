#include "app/commands/new/templates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <stdexcept>

#include "core/word_match.hpp"
#include "io/document/scalars.hpp"
#include "io/scene/reader.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

Node scalar_node(const std::string& text) { return {.kind = Node::Kind::scalar, .place = {}, .text = text}; }

bool is_number(const std::string& text)
{
  Real value = 0;
  return !read_scalar(scalar_node(text), Asked{}, value);
}

Real to_number(const std::string& text)
{
  Real value = 0;
  read_scalar(scalar_node(text), Asked{}, value);
  return value;
}

/// Answers by their names and, so that they can be compared with them, the words of all questions.
std::vector<NamedNumber> values_of(const SceneTemplate& from, const Answers& answers)
{
  std::set<std::string> words;
  for (const Question& question : from.head.questions)
    for (const std::string& choice : question.choices)
      if (!is_number(choice))
        words.insert(choice);
  const auto number_of = [&](const std::string& word) { return static_cast<Real>(std::distance(words.begin(), words.find(word))); };
  std::vector<NamedNumber> values;
  for (const std::string& word : words)
    values.push_back({word, number_of(word)});
  for (const Answer& answer : answers)
    values.push_back({answer.name, words.contains(answer.text) ? number_of(answer.text) : to_number(answer.text)});
  return values;
}

/// The value of a formula of the head.
Real value_at(const SourceLocation& where, const SceneTemplate& from, const Answers& answers, const std::string& formula)
{
  try {
    return evaluate(formula, values_of(from, answers));
  } catch (const std::invalid_argument& e) {
    throw SceneErrors(where, e.what());
  }
}

/// Answers, and behind them what follows from them.
Answers with_terms(const SceneTemplate& from, Answers answers)
{
  for (const Term& term : from.head.terms)
    answers.push_back({term.name, scene_number(value_at(term.where, from, answers, term.is))});
  return answers;
}

/// Lines of a template on their way to a scene.
class Filling {
 public:
  Filling(const SceneTemplate& from, const Answers& answers)
      : from_(from), answers_(with_terms(from, answers)), values_(values_of(from, answers_))
  {}

  std::string operator()()
  {
    std::string text;
    for (const std::string_view line : lines_of(from_.body)) {
      ++line_;
      if (!directive(line) && written())
        text += filled(line, 0) + "\n";
    }
    if (!open_.empty())
      fail(0, "an #if has no #end");
    return text;
  }

 private:
  enum class Branch : std::uint8_t { taken, left_out };

  [[noreturn]] void fail(std::size_t column, const std::string& what) const
  {
    throw SceneErrors(SourceLocation{from_.file, from_.first_line + line_ - 1, static_cast<int>(column) + 1, ""}, what);
  }

  bool written() const
  {
    return std::all_of(open_.begin(), open_.end(), [](Branch branch) { return branch == Branch::taken; });
  }

  Real value(std::string_view formula, std::size_t column) const
  {
    try {
      return evaluate(std::string(formula), values_);
    } catch (const std::invalid_argument& e) {
      fail(column, e.what());
    }
  }

  /// Whether the line is one that chooses lines.  What is left out is not looked at.
  bool directive(std::string_view line)
  {
    constexpr std::string_view begin = "#if ", other = "#else", end = "#end";
    if (line.starts_with(begin)) {
      const bool taken = written() && value(line.substr(begin.size()), begin.size()) != 0;
      open_.push_back(taken ? Branch::taken : Branch::left_out);
      return true;
    }
    if (line != other && line != end)
      return false;
    if (open_.empty())
      fail(0, fmt::format("{} without an #if", line));
    if (line == end)
      open_.pop_back();
    else
      open_.back() = open_.back() == Branch::taken ? Branch::left_out : Branch::taken;
    return true;
  }

  static std::size_t closing_brace(std::string_view text, std::size_t open)
  {
    int depth = 0;
    for (std::size_t i = open; i < text.size(); ++i) {
      depth += text[i] == '{' ? 1 : text[i] == '}' ? -1 : 0;
      if (depth == 0)
        return i;
    }
    return text.npos;
  }

  /// `at`: where the text begins in its line.
  std::string filled(std::string_view text, std::size_t at) const
  {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (text[i] != '{') {
        out += text[i];
        continue;
      }
      const std::size_t end = closing_brace(text, i);
      const std::string_view inner = end == text.npos ? std::string_view() : text.substr(i + 1, end - i - 1);
      const std::optional<std::string> value = placeholder(inner, at + i);
      out += value ? *value : "{";  // otherwise a mapping of YAML
      if (value)
        i = end;
    }
    return out;
  }

  std::optional<std::string> placeholder(std::string_view inner, std::size_t column) const
  {
    if (inner.starts_with('='))
      return scene_number(value(inner.substr(1), column));
    if (inner.starts_with('?')) {
      const std::size_t colon = inner.find(" : ");
      if (colon == inner.npos)
        fail(column, "{? needs a formula, \" : \", and a text");
      return value(inner.substr(1, colon - 1), column) != 0 ? filled(inner.substr(colon + 3), column + colon + 4) : "";
    }
    const auto of_name = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
    if (inner.empty() || !std::all_of(inner.begin(), inner.end(), of_name))
      return std::nullopt;
    const auto found = std::find_if(answers_.begin(), answers_.end(), [&](const Answer& answer) { return answer.name == inner; });
    if (found == answers_.end()) {
      std::vector<std::string> known;
      for (const Answer& answer : answers_)
        known.push_back(answer.name);
      fail(column, fmt::format("no question and no term has the name \"{}\"{}", inner, suggestion(inner, known)));
    }
    return found->text;
  }

  const SceneTemplate& from_;
  Answers answers_;  // and terms
  std::vector<NamedNumber> values_;
  std::vector<Branch> open_;  // of the #if that have no #end yet
  int line_ = 0;              // in the body, from 1
};

}  // namespace

std::vector<std::string> template_names()
{
  std::vector<std::string> names;
  for (const TemplateText& one : shipped_templates())
    names.emplace_back(one.name);
  return names;
}

SceneTemplate find_template(const std::string& name_or_file)
{
  for (const TemplateText& one : shipped_templates())
    if (one.name == name_or_file)
      return read_template(fmt::format("template {}", one.name), std::string(one.text));
  std::error_code unknown;
  if (name_or_file.find_first_of("./") != name_or_file.npos || fs::exists(name_or_file, unknown))
    return read_template(name_or_file, read_text(name_or_file));
  const auto names = template_names();
  const auto near = closest_match(name_or_file, names);
  throw Error(fmt::format("there is no template \"{}\"{}; a template of your own is given by its file", name_or_file,
                          near ? fmt::format(" — did you mean \"{}\"?", *near) : "; there are " + or_list(names)));
}

std::optional<OpenQuestion> next_question(const SceneTemplate& from, const Answers& answers)
{
  const auto& questions = from.head.questions;
  std::size_t next = 0;  // behind the last one with an answer
  for (std::size_t i = 0; i < questions.size(); ++i)
    if (!answers.empty() && questions[i].name == answers.back().name)
      next = i + 1;
  while (next < questions.size() && !questions[next].when.empty() &&
         value_at(questions[next].where, from, answers, questions[next].when) == 0)
    ++next;
  if (next == questions.size())
    return std::nullopt;
  const Question& question = questions[next];
  OpenQuestion open{&question, question.fallback, any};
  const auto number = [&](const std::string& formula) { return value_at(question.where, from, answers, formula); };
  if (question.choices.empty()) {
    constexpr auto digits = 3;  // of a default that is computed
    open.fallback = scene_number(to_number(fmt::format("{:.{}g}", number(question.fallback), digits)));
    open.range = within(number(question.range[0]), number(question.range[1]));
  }
  try {
    read_answer(open, open.fallback);
  } catch (const std::invalid_argument& e) {
    throw SceneErrors(question.where, fmt::format("the default is no answer: {}", e.what()));
  }
  return open;
}

std::string read_answer(const OpenQuestion& open, const std::string& text)
{
  const Question& question = *open.question;
  const Node node = scalar_node(text);
  if (question.choices.empty()) {
    Real value = 0;
    if (const Complaint complaint = read_scalar(node, Asked{open.range, question.unit}, value))
      throw std::invalid_argument(*complaint);
    return scene_number(value);
  }
  if (std::find(question.choices.begin(), question.choices.end(), text) == question.choices.end()) {
    const auto near = closest_match(text, question.choices);
    throw std::invalid_argument(
        fmt::format("\"{}\" is none of {}{}", text, or_list(question.choices), near ? fmt::format(" — did you mean \"{}\"?", *near) : ""));
  }
  return text;
}

std::string fill_in(const SceneTemplate& from, const Answers& answers) { return Filling(from, answers)(); }

std::string scene_number(Real value)
{
  constexpr Real largest_plain = 1e5, smallest_plain = 1e-3;
  if (value == 0)
    return "0";
  if (std::abs(value) < largest_plain && std::abs(value) >= smallest_plain)
    return fmt::format("{:.6g}", value);
  const std::string text = fmt::format("{:.5e}", value);  // 1.20000e+07
  const std::size_t e = text.find('e');
  std::string mantissa = text.substr(0, e);
  mantissa.erase(std::max(mantissa.find_last_not_of('0'), mantissa.find('.') + 1) + 1);
  return fmt::format("{}e{}", mantissa, std::stoi(text.substr(e + 1)));
}

}  // namespace talus
