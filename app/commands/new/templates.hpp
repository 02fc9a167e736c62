#pragma once
// Scenes with places for answers: what `talus new` writes scenes from.
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/setup/expression.hpp"
#include "io/scene/scene_template.hpp"

namespace talus {

/// A file of scenes/templates, as it stood there when the program was built.
struct TemplateText {
  std::string_view name, text;
};
std::span<const TemplateText> shipped_templates();
std::vector<std::string> template_names();

/// The shipped template of that name, or the one in a file.  SceneErrors: there is none, or it cannot be read.
SceneTemplate find_template(const std::string& name_or_file);

/// An answer: a number in one way of writing, or a word.
struct Answer {
  std::string name, text;
};
using Answers = std::vector<Answer>;  ///< in the order of the questions

/// A question with what depends on the answers before it.
struct OpenQuestion {
  const Question* question;
  std::string fallback;
  Range range;
};
/// The next question, or nothing: not all questions are asked always.  SceneErrors with the place in the template: a formula is wrong.
std::optional<OpenQuestion> next_question(const SceneTemplate& from, const Answers& answers);

/// The text as an answer.  std::invalid_argument, in words: it is none.
std::string read_answer(const OpenQuestion& open, const std::string& text);

/// The scene.  SceneErrors with places in the template.
///
/// `{name}` is an answer, `{= formula}` the value of a formula of the answers, `{? formula : text}` the text where the formula is not 0.  Lines
/// that begin with `#if formula`, `#else` and `#end` choose lines.  In formulas a word is what is equal to an answer with this word.
std::string fill_in(const SceneTemplate& from, const Answers& answers);

/// A number as scenes are written: 0.25, 1900, 7.0e7.
std::string scene_number(Real value);

}  // namespace talus
