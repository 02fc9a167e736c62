#pragma once
// The templates of `talus new`: questions, then the text of a scene with places for the answers.
#include <filesystem>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/fields.hpp"

namespace talus {

/// What is asked for before the scene can be written: a number, or one of some words.  Numbers here are formulas of the answers before.
struct Question {
  std::string name, ask, unit = "-", fallback, when;
  std::vector<std::string> range, choices;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{
        required("name", &Question::name, any, "-", "what the text of the scene calls the answer"),
        required("ask", &Question::ask, any, "-", "the question"),
        optional("unit", &Question::unit, any, "-", "of the answer"),
        required("default", &Question::fallback, any, "-", "the answer of who gives none: a formula of the answers before, or a word"),
        optional("when", &Question::when, any, "-", "asked only where this formula of the answers before is not 0"),
        optional("range", &Question::range, any, "-", "[low, high] that a number may have"),
        optional("choices", &Question::choices, any, "-", "words or numbers, of which the answer is one")};
  }
  void check(std::vector<std::string>& problems) const
  {
    if (range.empty() == choices.empty())
      problems.emplace_back("give one of \"range\" and \"choices\"");
    else if (choices.empty() && range.size() != 2)
      problems.emplace_back("\"range\" has two numbers, [low, high]");
  }
};

/// A number that the text of the scene needs in several places.
struct Term {
  std::string name, is;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{required("name", &Term::name, any, "-", "what the text of the scene calls it"),
                      required("is", &Term::is, any, "-", "formula of the answers and of the terms before")};
  }
};

/// The head of the file, up to the line `---`.
struct TemplateHead {
  std::string summary;
  std::vector<Question> questions;
  std::vector<Term> terms;
  static constexpr auto fields()
  {
    return std::tuple{required("summary", &TemplateHead::summary, any, "-", "one line"),
                      required_list("questions", &TemplateHead::questions, "in the order in which they are asked"),
                      optional_list("terms", &TemplateHead::terms, "numbers that follow from the answers")};
  }
};

struct SceneTemplate {
  std::string file;  ///< path as given, for messages
  TemplateHead head;
  std::string body;    ///< the scene, with places for the answers
  int first_line = 1;  ///< of the body in the file
};

}  // namespace talus
