// The entry of the manual for one word.
#include <fmt/ranges.h>

#include <set>

#include "core/error.hpp"
#include "core/word_match.hpp"
#include "io/document/key_aliases.hpp"
#include "io/scene/manual/formula_words.hpp"
#include "io/scene/manual/manual.hpp"
#include "io/scene/manual/manual_parts.hpp"
#include "io/scene/manual/markdown_table.hpp"

namespace talus {

namespace {

/// The entry for a function of formulas, or for formulas in general.
std::string manual_of_formula(std::string_view word)
{
  for (const FormulaFunction& function : formula_functions)
    if (word == function.name)
      return fmt::format("{}\n  {}\n  function of formulas; all of them: talus manual formula\n", function.call, function.meaning);
  return word == "formula" || word == "formulas" ? formula_manual() : "";
}

/// Markdown without links and code marks: "list of [bodies](#bodies)" becomes "list of bodies".
std::string without_markup(std::string_view markdown)
{
  std::string text;
  for (std::size_t i = 0; i < markdown.size(); ++i) {
    if (markdown.substr(i).starts_with("](#"))
      i = std::min(markdown.find(')', i), markdown.size() - 1);
    else if (markdown[i] != '`' && (markdown[i] != '[' || markdown.find("](#", i) == markdown.npos))
      text += markdown[i];
  }
  return text;
}

/// Splits "materials[0].cohesion" into materials, cohesion.
std::vector<std::string> words_of_path(std::string_view path)
{
  std::vector<std::string> words(1);
  bool in_brackets = false;
  for (const char c : path) {
    in_brackets = c == '[' || (in_brackets && c != ']');
    if (c == '.')
      words.emplace_back();
    else if (!in_brackets && c != ']')
      words.back() += c;
  }
  return words;
}

/// Whether `asked` are words of `chain` in the same order, with the same last word.
bool leads_to(const std::vector<std::string>& asked, const std::vector<std::string>& chain)
{
  if (asked.back() != chain.back())
    return false;
  auto at = chain.begin();
  for (const std::string& word : asked) {
    at = std::find(at, chain.end(), word);
    if (at == chain.end())
      return false;
    ++at;
  }
  return true;
}

/// The keys that lead to a mapping, and the word that chooses it.
std::vector<std::string> chain_of(const ManualPart& part)
{
  std::vector<std::string> chain = part.path.empty() ? std::vector<std::string>{} : words_of_path(part.path);
  if (!part.chosen.empty())
    chain.push_back(part.chosen);
  return chain;
}

/// The entry for a word.
class Entry {
 public:
  Entry(const std::vector<ManualPart>& manual, const std::string& asked) : manual_(manual), asked_(words_of_path(asked))
  {
    for (const ManualPart& part : manual_)
      look_at(part);
    if (keys_.empty() && parts_.empty() && asked_.size() == 1)
      add_keys_that_take(asked_.back());
  }

  /// The text; empty if the manual does not contain the word.
  std::string text() const
  {
    std::vector<std::string> entries;
    for (const auto& kernel : kernel_summaries())
      if (asked_.size() == 1 && (asked_.back() == kernel[0] || asked_.back() == "kernel"))
        entries.push_back(fmt::format("kernel: {}\n  {}\n", kernel[0], kernel[1]));
    const bool in_full = keys_.size() <= most_in_full;
    std::string lines;
    for (const Key& key : keys_)
      if (in_full)
        entries.push_back(describe(key));
      else
        lines += fmt::format("{} in {}: {}\n", without_markup(key.row.front()), fmt::join(key.places, " and "), key.row[meaning]);
    if (!lines.empty())
      entries.push_back(lines);
    for (const ManualPart* part : parts_)
      entries.push_back(describe(*part));
    return fmt::format("{}", fmt::join(entries, "\n"));
  }

 private:
  static constexpr std::size_t type = 1, unit = 2, range = 3, fallback = 4, meaning = 5;  // columns of a row
  static constexpr std::size_t most_in_full = 4;

  /// A key, listed once for all mappings in which it has the same meaning.
  struct Key {
    ManualRow row;
    std::vector<std::string> places;
  };

  void look_at(const ManualPart& part)
  {
    auto chain = chain_of(part);
    if (!chain.empty() && leads_to(asked_, chain))
      parts_.push_back(&part);
    chain.emplace_back();
    const auto add_if_asked = [&](const ManualRow& row) {
      chain.back() = without_markup(row.front());
      if (leads_to(asked_, chain))
        add_key(part, row);
    };
    for (const ManualRow& row : part.rows)
      add_if_asked(row);
    for (const ManualOutputs& outputs : part.outputs)
      for (const ManualOutput& output : outputs.rows)
        for (const std::string& name : output.names)
          add_if_asked({name, outputs.kind, output.unit, "", "", output.meaning});
  }

  void add_keys_that_take(const std::string& word)
  {
    for (const ManualPart& part : manual_)
      for (const ManualRow& row : part.rows)
        if (row[range].find(code(word)) != std::string::npos)
          add_key(part, row);
  }

  void add_key(const ManualPart& part, const ManualRow& row)
  {
    const auto known = std::find_if(keys_.begin(), keys_.end(), [&](const Key& key) { return key.row == row; });
    if (known != keys_.end())
      known->places.push_back(place_of(part));
    else
      keys_.push_back({row, {place_of(part)}});
  }

  static std::string place_of(const ManualPart& part)
  {
    if (part.path.empty())
      return std::string(title_of_scene);
    return part.chosen.empty() ? part.path : fmt::format("{} ({})", part.path, part.title);
  }

  /// The kind of a value, such as "number [m]; > 0; default 3".
  static std::string kind_of(const ManualRow& row)
  {
    const bool has_unit = !row[unit].empty() && row[unit] != "-";
    std::string text = without_markup(row[type]) + (has_unit ? fmt::format(" [{}]", row[unit]) : "");
    if (!row[range].empty())
      text += "; " + without_markup(row[range]);
    if (!row[fallback].empty())
      text += (row[fallback] == "required" ? "; " : "; default ") + row[fallback];
    return text;
  }

  static std::string describe(const Key& key)
  {
    return fmt::format("{}\n  {}\n  {}\n  in {}\n", without_markup(key.row.front()), key.row[meaning], kind_of(key.row),
                       fmt::join(key.places, ", "));
  }

  std::string describe(const ManualPart& part) const
  {
    std::string text = fmt::format("Keys of {}\n", place_of(part));
    if (!part.text.empty())
      text += fmt::format("  {}\n", without_markup(part.text.substr(0, part.text.find('\n'))));
    for (const ManualRow& row : part.rows)
      text += fmt::format("  {:<24} {}\n  {:<24} ({})\n", without_markup(row.front()), row[meaning], "", kind_of(row));
    for (const ManualOutputs& outputs : part.outputs) {
      text += outputs.heading + "\n";
      for (const ManualOutput& output : outputs.rows)
        text += fmt::format("  {:<24} {} [{}]\n", fmt::join(output.names, " "), output.meaning, output.unit);
    }
    if (const auto inside = inside_of(part); !inside.empty())
      text += fmt::format("Further: talus manual {}\n", fmt::join(inside, " "));
    return text;
  }

  /// The choices of a mapping, and the mappings in it.
  std::vector<std::string> inside_of(const ManualPart& part) const
  {
    std::vector<std::string> inside;
    for (const ManualPart& other : manual_)
      if (part.chosen.empty() && other.path == part.path && !other.chosen.empty())
        inside.push_back(other.chosen);
      else if (part.chosen.empty() && other.chosen.empty() && other.path.starts_with(part.path + "."))
        inside.push_back(other.path);
    return inside;
  }

  const std::vector<ManualPart>& manual_;
  std::vector<std::string> asked_;
  std::vector<Key> keys_;
  std::vector<const ManualPart*> parts_;
};

/// All words that have an entry.
std::vector<std::string> words_of_manual(const std::vector<ManualPart>& manual)
{
  std::set<std::string> words;
  for (const ManualPart& part : manual) {
    const auto chain = chain_of(part);
    words.insert(chain.begin(), chain.end());
    for (const ManualRow& row : part.rows)
      words.insert(without_markup(row.front()));
    for (const ManualOutputs& outputs : part.outputs)
      for (const ManualOutput& output : outputs.rows)
        words.insert(output.names.begin(), output.names.end());
  }
  for (const auto& kernel : kernel_summaries())
    words.emplace(kernel.front());
  words.emplace("formula");
  return {words.begin(), words.end()};
}

}  // namespace

std::string manual_of(const std::string& word)
{
  const auto manual = manual_parts();
  if (std::string text = Entry(manual, word).text(); !text.empty())
    return text;
  if (std::string text = manual_of_formula(word); !text.empty())
    return text;
  const std::string asked = words_of_path(word).back();
  if (const std::string_view other = other_word_for(asked); !other.empty())
    if (std::string text = Entry(manual, word.substr(0, word.size() - asked.size()) + std::string(other)).text(); !text.empty())
      return text;
  const auto near = closest_match(asked, words_of_manual(manual));
  throw Error(fmt::format("the manual knows no \"{}\"{}", word,
                          !near            ? "; talus manual prints all of it"
                          : *near == asked ? fmt::format(": ask for \"{}\" alone", asked)
                                           : fmt::format(" — did you mean \"{}\"?", *near)));
}

}  // namespace talus
