#include "io/scene/manual.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <functional>
#include <set>
#include <typeindex>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/word_match.hpp"
#include "io/document/field_reader.hpp"
#include "io/document/field_words.hpp"
#include "io/document/key_aliases.hpp"
#include "io/scene/formula_words.hpp"
#include "io/scene/scene.hpp"
#include "kernels/kernels.hpp"

namespace talus {

namespace {

using Row = std::array<std::string, 6>;

/// Columns padded, so that the text reads well as it is; the last one is as long as it likes.
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

const Row head{"key", "type", "unit", "range", "default", "meaning"};

std::string code(std::string_view text) { return fmt::format("`{}`", text); }

/// Not of each kind of field anew: there are some hundred.
Row row_of(std::string_view key, std::string type, std::string_view unit, std::string range, std::string fallback, std::string_view meaning)
{
  return {code(key), std::move(type), std::string(unit), std::move(range), std::move(fallback), std::string(meaning)};
}

std::string in_words(std::span<const std::string_view> all)
{
  std::vector<std::string> quoted;
  for (const auto word : all)
    quoted.push_back(code(word));
  return or_list(quoted);
}

using HistoryRow = std::array<std::string, 3>;

/// A part of the manual, in Markdown: the keys of a mapping, or what a key chooses from.
struct ManualPart {
  std::string title;
  std::string path;                   ///< of the mapping in a scene; of a list for an entry of it
  std::string chosen{};               ///< the word that makes the mapping have these keys: a law, a type
  std::string text{};                 ///< before the keys
  std::vector<Row> rows{};            ///< keys
  std::vector<HistoryRow> history{};  ///< variables of a law
};

std::string to_markdown(const ManualPart& part)
{
  std::string text = fmt::format("\n{} {}\n\n", part.chosen.empty() ? "##" : "###", part.title) + part.text;
  if (!part.rows.empty() || part.text.empty() || !part.chosen.empty())
    text += to_table(head, part.rows);
  if (!part.history.empty())
    text += "\nIt keeps, for output:\n\n" + to_table({"history variable", "unit", "meaning"}, part.history);
  return text;
}

class Manual {
 public:
  static constexpr std::string_view top = "the scene";

  template <HasFields T>
  static std::vector<ManualPart> write()
  {
    Manual manual;
    manual.section<T>(std::string(top));
    while (!manual.waiting_.empty()) {
      const auto next = std::move(manual.waiting_.front());
      manual.waiting_.erase(manual.waiting_.begin());
      const auto later = std::exchange(manual.waiting_, {});
      next();  // what it mentions comes right behind it
      manual.waiting_.insert(manual.waiting_.end(), later.begin(), later.end());
    }
    return std::move(manual.parts_);
  }

 private:
  /// The link to the section of a type, which is written once, after the section that first mentions it.
  template <class T>
  std::string link(const std::string& path)
  {
    if constexpr (std::same_as<T, SimpleShape>)
      return link<Shape>(path);  // the same but for those that are put together, as the meaning of the key says
    const std::string own = std::same_as<T, Shape>         ? "shape"
                            : std::same_as<T, Box>         ? "box"
                            : std::same_as<T, SurfaceSpec> ? "surface"
                                                           : path;
    const auto [title, is_new] = titles_.emplace(std::type_index(typeid(T)), own);
    if (is_new)
      waiting_.push_back([this, own] { section<T>(own); });
    std::string anchor;
    for (const char c : title->second)
      if (c != '.')
        anchor += c;
    return fmt::format("[{}](#{})", title->second, anchor);
  }

  template <HasFields T>
  void section(const std::string& path)
  {
    const std::string in_scene = path == top ? "" : path;
    ManualPart part{.title = path, .path = in_scene};
    add_rows<T>(part.rows, in_scene.empty() ? "" : in_scene + ".");
    parts_.push_back(std::move(part));
    for_each_field<T>([&](const auto& field) { add_alternatives_of(field, in_scene); });
  }
  template <class Variant>
  requires(!HasFields<Variant>) void section(const std::string& path)
  {
    parts_.push_back({.title = path, .path = path, .text = "One of these, chosen by the key `type`.\n"});
    add_each_alternative("type", path, path, std::type_identity<Variant>{});
  }

  /// Keys of a mapping at `path`; `prefix` is what their own mappings are called after, if not after the word that chooses.
  template <class... T>
  void add_each_alternative(std::string_view key, const std::string& path, const std::string& prefix,
                            std::type_identity<std::variant<T...>>)
  {
    (add_alternative<T>(key, path, prefix), ...);
  }
  template <class T>
  void add_alternative(std::string_view key, const std::string& path, const std::string& prefix)
  {
    ManualPart part{.title = fmt::format("{}: {}", key, T::name), .path = path, .chosen = std::string(T::name)};
    add_rows<T>(part.rows, (prefix.empty() ? part.chosen : prefix) + ".");
    if constexpr (requires { T::summary; })
      part.text = sentence(T::summary) + "\n\n";
    if constexpr (requires { typename T::State; })
      for_each_field<typename T::State>([&](const auto& variable) {
        part.history.push_back({code(variable.key), std::string(variable.unit), std::string(variable.meaning)});
      });
    parts_.push_back(std::move(part));
  }

  /// Parts of the structs that a key of a mapping chooses from.
  template <class Field>
  void add_alternatives_of(const Field&, const std::string&)
  {}
  template <class T, class Value>
  void add_alternatives_of(const Alternative<T, Value>& field, const std::string& path)
  {
    add_each_alternative(field.key, path, "", std::type_identity<Value>{});
  }

  static std::string sentence(std::string_view text)
  {
    std::string whole(text);
    whole.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(whole.front())));
    return whole.ends_with('.') ? whole : whole + ".";
  }

  template <HasFields T>
  void add_rows(std::vector<Row>& rows, const std::string& prefix)
  {
    const T defaults{};
    for_each_field<T>([&](const auto& field) { rows.push_back(row(field, defaults, prefix)); });
  }

  template <class T, class Value>
  Row row(const Parameter<T, Value>& field, const std::type_identity_t<T>& defaults, const std::string& prefix)
  {
    return row_of(field.key, type(std::type_identity<Value>{}, path_of(prefix, field.key)), HasFields<Value> ? "" : field.unit,
                  range_of(field.range), need(field.need, default_of(defaults.*field.member, field.range)),
                  meaning_of(field.key, field.meaning));
  }
  template <class T, class Value>
  Row row(const Choice<T, Value>& field, const std::type_identity_t<T>& defaults, const std::string&)
  {
    return row_of(field.key, "word", "-", in_words(enum_names(Value{})), need(field.need, default_of(defaults.*field.member, any)),
                  field.meaning);
  }
  template <class T, class Value>
  Row row(const Group<T, Value>& field, const std::type_identity_t<T>&, const std::string& prefix)
  {
    return row_of(field.key, type(std::type_identity<Value>{}, path_of(prefix, field.key)), "", "", "required", field.meaning);
  }
  template <class T, class Value>
  Row row(const Group<T, std::optional<Value>>& field, const std::type_identity_t<T>&, const std::string& prefix)
  {
    return row_of(field.key, type(std::type_identity<Value>{}, path_of(prefix, field.key)), "", "", "none", field.meaning);
  }
  template <class T, class Item>
  Row row(const List<T, Item>& field, const std::type_identity_t<T>&, const std::string& prefix)
  {
    return row_of(field.key, "list of " + link<Item>(path_of(prefix, field.key)), "", "", need(field.need, "none"), field.meaning);
  }
  template <class T, class... Law>
  Row row(const Alternative<T, std::variant<Law...>>& field, const std::type_identity_t<T>&, const std::string&)
  {
    return row_of(field.key, "word", "-", in_words(std::array<std::string_view, sizeof...(Law)>{Law::name...}), "required", field.meaning);
  }

  static std::string meaning_of(std::string_view key, std::string_view meaning)
  {
    const std::string_view other = other_word_for(key);
    return std::string(meaning) + (other.empty() ? "" : fmt::format("; \"{}\" is another word for this key", other));
  }
  static std::string path_of(const std::string& prefix, std::string_view key) { return prefix + std::string(key); }
  static std::string range_of(const Range& range)
  {
    const std::string text = to_string(range);
    return text == "any" ? "" : text;
  }
  static std::string need(Need needed, const std::string& fallback) { return needed == Need::required ? "required" : fallback; }
  std::string type(std::type_identity<Real>, const std::string&) { return "number"; }
  std::string type(std::type_identity<Index>, const std::string&) { return "whole number"; }
  std::string type(std::type_identity<bool>, const std::string&) { return "true or false"; }
  std::string type(std::type_identity<std::string>, const std::string&) { return "text"; }
  std::string type(std::type_identity<Table>, const std::string&) { return "list of [time, value]"; }
  std::string type(std::type_identity<std::vector<Real>>, const std::string&) { return "list of numbers"; }
  std::string type(std::type_identity<std::vector<Index>>, const std::string&) { return "list of whole numbers"; }
  std::string type(std::type_identity<std::vector<std::string>>, const std::string&) { return "list of texts"; }
  std::string type(std::type_identity<std::vector<std::vector<Real>>>, const std::string&) { return "list of lists of numbers"; }
  std::string type(std::type_identity<std::vector<std::vector<std::vector<Real>>>>, const std::string&)
  {
    return "list of lists of lists of numbers";
  }
  template <class T>
  std::string type(std::type_identity<std::optional<T>>, const std::string& path)
  {
    return type(std::type_identity<T>{}, path);
  }
  template <class T>
  std::string type(std::type_identity<T>, const std::string& path)
  {
    return link<T>(path);
  }

  std::unordered_map<std::type_index, std::string> titles_;
  std::vector<ManualPart> parts_;
  std::vector<std::function<void()>> waiting_;
};

constexpr std::string_view introduction = R"(# Scene files

What a scene file can say. This page is written by `talus manual` out of the lists that also read the file, so it cannot be out of date.

* A scene is a YAML file. Keys may come in any order; a key that is not listed here is an error, and so is one that comes twice.
* Units are SI; angles are in degrees. Stress is positive in tension, pressure in compression.
* Numbers are decimal and finite, without leading zeros and without units: `1.0e6`, `-9.81`. Switches are `true` or `false`.
* A vector has one number per dimension.
* A range holds for every number of a list: `> 0` positive, `[0, 1)` from 0, included, to 1, excluded.
* A table is a list of `[time, value]` with growing times: linear in between, constant outside.
* Paths of files are relative to the scene.
* Anchors, aliases, merge keys and tags of YAML are not read.
* `where` is another word for the key `on`, which programs that read YAML 1.1 (PyYAML) take for the switch `true`.
* `--set key=value` on the command line replaces or adds a value: `--set time.end=2 --set 'bodies[0].particles_per_cell=6'`.
)";

constexpr std::string_view about_formulas =
    R"md(Where a key takes a formula (`velocity` of a body, `acceleration` of a load of type `body_force`), it is written in quotes: `"0.1 * sin(pi * x / 50)"`.

* It may name the place `x`, `y`, `z` [m], the time `t` [s], which is 0 in what begins with the scene, and the constants `pi` and `_e`; a template of `talus new` its own answers instead.
* Operators, the weakest first: `condition ? a : b`, `||`, `&&`, comparisons `==` `!=` `<` `>` `<=` `>=` (1 where they hold, else 0), `+` `-`, `*` `/`, `^`. Powers are taken from the right, and before a sign: `-2^2` is -4.
* Decimals have a point. Nothing can be assigned. A value that is not finite is an error that names the place.
)md";

/// What formulas may use, in Markdown.
std::string formula_manual()
{
  std::vector<std::array<std::string, 2>> rows;
  for (const FormulaFunction& function : formula_functions)
    rows.push_back({code(function.call), std::string(function.meaning)});
  return std::string(about_formulas) + "\n" + to_table({"function", "value"}, rows);
}

/// As `talus manual` says it of a word: of a function, or of formulas as a whole.
std::string manual_of_formula(std::string_view word)
{
  for (const FormulaFunction& function : formula_functions)
    if (word == function.name)
      return fmt::format("{}\n  {}\n  function of formulas; all of them: talus manual formula\n", function.call, function.meaning);
  return word == "formula" || word == "formulas" ? formula_manual() : "";
}

std::vector<std::array<std::string_view, 2>> kernel_summaries()
{
  std::vector<std::array<std::string_view, 2>> all;
  for_each_type(Kernels<2>{}, [&]<class K>() { all.push_back({K::name, K::summary}); });
  return all;
}

}  // namespace

std::string scene_manual()
{
  std::string text(introduction), after_first = "\nKernels:\n\n";
  for (const auto& kernel : kernel_summaries())
    after_first += fmt::format("* `{}`: {}\n", kernel[0], kernel[1]);
  for (const ManualPart& part : Manual::write<Scene>())
    text += to_markdown(part) + std::exchange(after_first, "");
  return text + "\n## formulas\n\n" + formula_manual();
}

namespace {

/// Links and code of Markdown as they are read: "list of [bodies](#bodies)" is a list of bodies.
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

/// "materials[0].cohesion" -> materials, cohesion
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

/// Whether `asked` are words of `chain` in their order, the last ones the same.
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

/// Keys that lead to a mapping, and the word that it was chosen by.
std::vector<std::string> chain_of(const ManualPart& part)
{
  std::vector<std::string> chain = part.path.empty() ? std::vector<std::string>{} : words_of_path(part.path);
  if (!part.chosen.empty())
    chain.push_back(part.chosen);
  return chain;
}

/// What the manual has on a word.
class Entry {
 public:
  Entry(const std::vector<ManualPart>& manual, const std::string& asked) : manual_(manual), asked_(words_of_path(asked))
  {
    for (const ManualPart& part : manual_)
      look_at(part);
    if (keys_.empty() && parts_.empty() && asked_.size() == 1)
      add_keys_that_take(asked_.back());
  }

  /// Empty if it has nothing.
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

  /// A key, once for all mappings in which it means the same.
  struct Key {
    Row row;
    std::vector<std::string> places;
  };

  void look_at(const ManualPart& part)
  {
    auto chain = chain_of(part);
    if (!chain.empty() && leads_to(asked_, chain))
      parts_.push_back(&part);
    chain.emplace_back();
    const auto add_if_asked = [&](const Row& row) {
      chain.back() = without_markup(row.front());
      if (leads_to(asked_, chain))
        add_key(part, row);
    };
    for (const Row& row : part.rows)
      add_if_asked(row);
    for (const HistoryRow& variable : part.history)
      add_if_asked({variable[0], "history variable, for outputs.particles.fields", variable[1], "", "", variable[2]});
  }

  void add_keys_that_take(const std::string& word)
  {
    for (const ManualPart& part : manual_)
      for (const Row& row : part.rows)
        if (row[range].find(code(word)) != std::string::npos)
          add_key(part, row);
  }

  void add_key(const ManualPart& part, const Row& row)
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
      return std::string(Manual::top);
    return part.chosen.empty() ? part.path : fmt::format("{} ({})", part.path, part.title);
  }

  /// "number [m]; > 0; default 3"
  static std::string kind_of(const Row& row)
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
    for (const Row& row : part.rows)
      text += fmt::format("  {:<24} {}\n  {:<24} ({})\n", without_markup(row.front()), row[meaning], "", kind_of(row));
    if (!part.history.empty())
      text += "It keeps, for outputs.particles.fields\n";
    for (const HistoryRow& variable : part.history)
      text += fmt::format("  {:<24} {} [{}]\n", without_markup(variable[0]), variable[2], variable[1]);
    if (const auto inside = inside_of(part); !inside.empty())
      text += fmt::format("Further: talus manual {}\n", fmt::join(inside, " "));
    return text;
  }

  /// What a mapping chooses from, and mappings in it.
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

/// All that can be asked for by one word.
std::vector<std::string> words_of_manual(const std::vector<ManualPart>& manual)
{
  std::set<std::string> words;
  for (const ManualPart& part : manual) {
    const auto chain = chain_of(part);
    words.insert(chain.begin(), chain.end());
    for (const Row& row : part.rows)
      words.insert(without_markup(row.front()));
    for (const HistoryRow& variable : part.history)
      words.insert(without_markup(variable.front()));
  }
  for (const auto& kernel : kernel_summaries())
    words.emplace(kernel.front());
  words.emplace("formula");
  return {words.begin(), words.end()};
}

}  // namespace

std::string manual_of(const std::string& word)
{
  const auto manual = Manual::write<Scene>();
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
