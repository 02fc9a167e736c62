#include "io/document/document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <system_error>

#include "io/document/key_aliases.hpp"

namespace talus {

namespace {

constexpr std::size_t most_problems = 100;
constexpr std::size_t longest_shown_line = 200;

bool continues_character(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

/// The number of characters.  Columns of messages count characters, so that the caret is below the right one.
int count_characters(std::string_view text)
{
  return static_cast<int>(std::count_if(text.begin(), text.end(), [](char c) { return !continues_character(c); }));
}

}  // namespace

const Node::Key* Node::find_key(std::string_view word) const noexcept
{
  const auto at = std::find_if(keys.begin(), keys.end(), [&](const Key& k) { return k.text == word; });
  return at == keys.end() ? nullptr : &*at;
}

std::string_view Node::word_for(std::string_view key) const noexcept
{
  const std::string_view other = other_word_for(key);
  return !other.empty() && find_key(key) == nullptr && find_key(other) != nullptr ? other : key;
}

const Node* Node::find(std::string_view key) const noexcept
{
  const Key* const there = find_key(word_for(key));
  return there == nullptr ? nullptr : &items[static_cast<std::size_t>(there - keys.data())];
}

std::string::const_iterator first_control(const std::string& text)
{
  return std::find_if(text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; });
}

std::string shown_line(std::string_view line)
{
  std::string shown(line.size() <= longest_shown_line ? line : "");
  std::replace(shown.begin(), shown.end(), '\t', ' ');  // a tab would shift the caret
  return shown;
}

std::string path_to(const std::string& parent, std::string_view key)
{
  return parent.empty() ? std::string(key) : fmt::format("{}.{}", parent, key);
}

std::string path_to(const std::string& parent, std::size_t i, const Node& entry)
{
  const Node* name = entry.find("name");
  const bool shown = name != nullptr && name->kind == Node::Kind::scalar && first_control(name->text) == name->text.end();
  return shown ? fmt::format("{}[{}] \"{}\"", parent, i, name->text) : fmt::format("{}[{}]", parent, i);
}

bool is_within(std::string_view path, std::string_view outer)
{
  if (!path.starts_with(outer))
    return false;
  return outer.empty() || path.size() == outer.size() || path[outer.size()] == '.' || path[outer.size()] == '[';
}

SourceLocation to_where(const Place& place, std::string path)
{
  SourceLocation where{place.source == nullptr ? "" : place.source->name, place.line, place.column, std::move(path)};
  const auto line = static_cast<std::size_t>(place.line);
  if (place.source != nullptr && line > 0 && line <= place.source->lines.size() && place.column > 0)
    where.column = 1 + count_characters(place.source->lines[line - 1].substr(0, static_cast<std::size_t>(place.column - 1)));
  return where;
}

SceneError problem_at(const Place& place, std::string path, std::string message)
{
  std::string source_line;
  const auto line = static_cast<std::size_t>(place.line);
  if (place.source != nullptr && line > 0 && line <= place.source->lines.size())
    source_line = shown_line(place.source->lines[line - 1]);
  return {to_where(place, std::move(path)), std::move(message), std::move(source_line)};
}

namespace {

/// The text in double quotes, in which any character can be written.
std::string quoted_text(std::string_view text)
{
  std::string out = "\"";
  for (const char c : text)
    if (const auto code = static_cast<unsigned char>(c); code < 0x20 || code == 0x7f)
      out += fmt::format("\\x{:02x}", code);
    else
      out += c == '"' || c == '\\' ? std::string{'\\', c} : std::string(1, c);
  return out + '"';
}

/// The value on one line.  `inside` brackets more characters have a meaning and need quotes.
std::string one_line_of(const Node& value, bool inside)
{
  std::vector<std::string> items;
  for (const Node& item : value.items)
    items.push_back(one_line_of(item, true));
  switch (value.kind) {
    case Node::Kind::list: return fmt::format("[{}]", fmt::join(items, ", "));
    case Node::Kind::mapping:
      for (std::size_t i = 0; i < items.size(); ++i)
        items[i] = fmt::format("{}: {}", quoted_text(value.keys[i].text), items[i]);
      return fmt::format("{{{}}}", fmt::join(items, ", "));
    default: return value.quoted || (inside && value.text.find_first_of(",[]{}") != value.text.npos) ? quoted_text(value.text) : value.text;
  }
}

}  // namespace

std::string in_one_line(const Node& value) { return one_line_of(value, false); }

void Problems::add(const Place& place, std::string path, std::string message)
{
  if (list_.size() > most_problems)
    return;
  if (list_.size() == most_problems)
    message = "more errors follow; these are enough for now";
  list_.push_back(problem_at(place, std::move(path), std::move(message)));
}

void Problems::throw_if_any() const
{
  if (!list_.empty())
    throw SceneErrors(list_);
}

namespace {

/// One step of a path: a key of a mapping or the index of a list entry.
struct Step {
  std::string_view key;
  std::optional<std::size_t> number;
};

/// The steps of a path such as "a.b[2].c"; nothing if it is not a valid path.
std::optional<std::vector<Step>> steps_of(std::string_view path)
{
  std::vector<Step> steps;
  bool expects_key = true;
  while (!path.empty()) {
    if (path.front() == '[') {
      std::size_t number = 0;
      const auto [end, error] = std::from_chars(path.data() + 1, path.data() + path.size(), number);
      if (expects_key || error != std::errc() || end == path.data() + path.size() || *end != ']')
        return std::nullopt;
      steps.push_back({{}, number});
      path.remove_prefix(static_cast<std::size_t>(end - path.data()) + 1);
    } else if (path.front() == '.' && !expects_key) {
      path.remove_prefix(1);
      expects_key = true;
    } else if (expects_key) {
      const std::string_view key = path.substr(0, path.find_first_of(".["));
      if (key.empty())
        return std::nullopt;
      steps.push_back({key, std::nullopt});
      path.remove_prefix(key.size());
      expects_key = false;
    } else {
      return std::nullopt;
    }
  }
  return expects_key ? std::nullopt : std::optional(std::move(steps));
}

/// The path extended by a step; `in` is the value that contains the step, `node` the value that it leads to.
std::string extended(const std::string& path, const Step& step, const Node& in, const Node& node)
{
  return step.number ? path_to(path, *step.number, node) : path_to(path, in.word_for(step.key));
}

}  // namespace

void set_value(Document& document, std::string_view path, Node value, const Place& origin)
{
  const auto steps = steps_of(path);
  if (!steps)
    return document.problems.add(origin, "", fmt::format("\"{}\" is no path of keys such as time.end or bodies[0].material", path));
  Node* node = &document.root;
  std::string shown;
  for (const Step& step : *steps) {
    if (step.number && (node->kind != Node::Kind::list || *step.number >= node->items.size()))
      return document.problems.add(origin, shown,
                                   node->kind == Node::Kind::list ? fmt::format("there is no [{}]: the list has {} entries, counted from 0",
                                                                                *step.number, node->items.size())
                                                                  : fmt::format("there is no [{}]: it is not a list", *step.number));
    if (!step.number && node->kind == Node::Kind::empty)
      *node = Node{.kind = Node::Kind::mapping, .place = origin};
    if (!step.number && node->kind != Node::Kind::mapping)
      return document.problems.add(origin, shown, fmt::format("there is no key \"{}\": it is not a mapping", step.key));
    if (!step.number && node->find(step.key) == nullptr) {
      node->keys.push_back({std::string(step.key), origin});
      node->items.push_back({.place = origin});
    }
    const Node& in = *node;
    node = step.number ? &node->items[*step.number] : const_cast<Node*>(node->find(step.key));
    shown = extended(shown, step, in, *node);
  }
  *node = std::move(value);
}

Found find_nearest(const Node& root, std::string_view path)
{
  Found found{&root, ""};
  const auto steps = steps_of(path);
  for (const Step& step : steps ? *steps : std::vector<Step>{}) {
    const bool has_entry = step.number && found.node->kind == Node::Kind::list && *step.number < found.node->items.size();
    const Node* next = has_entry ? &found.node->items[*step.number] : step.number ? nullptr : found.node->find(step.key);
    if (next == nullptr) {
      found.whole = false;
      break;
    }
    found = {next, extended(found.path, step, *found.node, *next)};
  }
  return found;
}

}  // namespace talus
