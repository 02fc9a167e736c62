#include "io/document/field_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "io/document/key_aliases.hpp"

namespace talus {

const Node* Mapping::find(std::string_view key)
{
  known_.emplace_back(key);
  if (const std::string_view other = other_word_for(key); !other.empty()) {
    known_.emplace_back(other);
    if (const Node::Key* one = node_.find_key(key), *two = node_.find_key(other); one != nullptr && two != nullptr)
      problems_.add(two->place, path_, fmt::format("\"{}\" and \"{}\" are two words for the same key: give one of them", key, other));
  }
  return node_.find(key);
}

const Node* Mapping::find_required(std::string_view key, std::string_view unit)
{
  const Node* value = find(key);
  if (value != nullptr)
    return value;
  const auto changed = std::find_if(node_.keys.begin(), node_.keys.end(), [](const Node::Key& there) { return was_on(there.text); });
  if (key == "on" && changed != node_.keys.end()) {
    known_.push_back(changed->text);
    problems_.add(
        changed->place, path_,
        fmt::format("\"{}\" is what a reader of YAML 1.1, such as PyYAML, makes of the key on: write \"where\", which every reader "
                    "leaves as it is, or \"on\"",
                    changed->text));
    return value;
  }
  const std::string_view other = other_word_for(key);
  complain(fmt::format("missing key \"{}\"{}{}", key, other.empty() ? "" : fmt::format(" (or \"{}\")", other),
                       unit == "-" ? "" : fmt::format(" [{}]", unit)));
  return value;
}

void Mapping::close()
{
  for (const auto& [key, place] : node_.keys)
    if (!any_key_ && std::find(known_.begin(), known_.end(), key) == known_.end()) {
      const std::string_view removed = removed_choice(path_of(key)), reason = removed.empty() ? not_computed(key) : removed;
      problems_.add(place, path_,
                    reason.empty() ? fmt::format("unknown key \"{}\"{}", key, suggestion(key, known_))
                                   : fmt::format("unknown key \"{}\": {}", key, reason));
    }
  if (problems_.size() > before_)
    return;
  std::vector<std::string> broken;
  for (const auto& check : checks_)
    check(broken);
  for (auto& rule : broken)
    complain(std::move(rule));
}

void FieldReader::read(const Node& node, const std::string& path, const Asked&, Table& table)
{
  const std::size_t before = problems_.size();
  read(node, path, {}, table.points);
  for (std::size_t i = 1; i < table.points.size() && problems_.size() == before; ++i)
    if (const Real t0 = table.points[i - 1][0], t1 = table.points[i][0]; !(t1 > t0))
      problems_.add(node.items[i].place, path_to(path, i, node.items[i]), fmt::format("time {} s does not come after {} s", t1, t0));
}

void FieldReader::read(const Node& node, const std::string& path, const Asked&, Node& value)
{
  if (is(node.kind == Node::Kind::empty ? Node::Kind::scalar : node.kind, node, path, "a value"))
    value = node;
}

bool FieldReader::is(Node::Kind kind, const Node& node, const std::string& path, std::string_view expected)
{
  if (node.kind == kind)
    return true;
  const auto found = [&] {
    return node.kind == Node::Kind::list ? "a list" : node.kind == Node::Kind::mapping ? "a mapping" : "a single value";
  };
  if (node.kind == Node::Kind::empty)
    problems_.add(node.place, path, fmt::format("the value is missing, expected {}", expected));
  else if (node.kind != Node::Kind::unreadable)
    problems_.add(node.place, path, fmt::format("expected {}, found {}", expected, found()));
  return false;
}

std::string FieldReader::count_message(std::size_t wanted, std::size_t found)
{
  return fmt::format("needs {} values, not {}", wanted, found);
}

std::string FieldReader::unknown_word(std::string_view key, const std::string& word, const std::vector<std::string>& known)
{
  return fmt::format("unknown {} \"{}\"{}", key, word, suggestion(word, known));
}

}  // namespace talus
