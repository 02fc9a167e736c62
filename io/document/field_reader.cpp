#include "io/document/field_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "core/named_numbers.hpp"
#include "core/time_table.hpp"
#include "core/word_match.hpp"
#include "io/document/key_aliases.hpp"

namespace talus {

/// One mapping while it is read.  A key that is not in the field list is an error.  Rules between keys are checked at the end, and only if
/// the keys themselves are correct, so that one mistake gives one message.
class Mapping {
 public:
  Mapping(const Node& node, std::string path, Problems& problems)
      : node_(node), path_(std::move(path)), problems_(problems), before_(problems.size())
  {}

  SourceLocation where() const { return to_where(node_.place, path_); }
  /// The path of a key, with the name that is used in the file.
  std::string path_of(std::string_view key) const { return path_to(path_, node_.word_for(key)); }
  void complain(std::string message) { problems_.add(node_.place, path_, std::move(message)); }

  /// The value of a key, or nullptr; the key counts as known from now on.
  const Node* find(std::string_view key);
  /// The value of a key; a missing key is recorded as an error.
  const Node* find_required(std::string_view key, std::string_view unit);
  /// Disables the check for unknown keys, because the key that determines the valid ones is wrong.
  void accept_any_key() { any_key_ = true; }
  void check_later(std::function<void(std::vector<std::string>&)> check) { checks_.push_back(std::move(check)); }
  void close();

 private:
  const Node& node_;
  std::string path_;
  Problems& problems_;
  std::size_t before_;
  bool any_key_ = false;
  std::vector<std::string> known_;
  std::vector<std::function<void(std::vector<std::string>&)>> checks_;
};

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
                       unit.empty() || unit == "-" ? "" : fmt::format(" [{}]", unit)));
  return value;
}

void Mapping::close()
{
  for (const auto& [key, place] : node_.keys)
    if (!any_key_ && std::find(known_.begin(), known_.end(), key) == known_.end()) {
      const std::string_view removed = removed_choice(path_of(key)), reason = removed.empty() ? advice_on_flow(key) : removed;
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

namespace {

std::string unknown_word(std::string_view what, const std::string& word, const std::vector<std::string>& known)
{
  return fmt::format("unknown {} \"{}\"{}", what, word, suggestion(word, known));
}

}  // namespace

void FieldReader::read(const Node& node, const std::string& path, const Asked& asked, const ValueType& type, void* value)
{
  switch (type.kind) {
    case ValueType::Kind::number: return read_scalar_of<Real>(node, path, asked, value);
    case ValueType::Kind::whole_number: return read_scalar_of<Index>(node, path, asked, value);
    case ValueType::Kind::boolean: return read_scalar_of<bool>(node, path, asked, value);
    case ValueType::Kind::text: return read_scalar_of<std::string>(node, path, asked, value);
    case ValueType::Kind::word: return read_word(node, path, type, value);
    case ValueType::Kind::table: return read_table(node, path, as<Table>(value));
    case ValueType::Kind::named: return read_named(node, path, as<NamedNumbers>(value));
    case ValueType::Kind::list: return read_list(node, path, asked, type, value);
    case ValueType::Kind::optional: type.resize(value, 1); return read(node, path, asked, *type.entry, type.edit_at(value, 0));
    case ValueType::Kind::mapping:
    case ValueType::Kind::choice: return read_mapping(node, path, type, value);
  }
}

template <class T>
void FieldReader::read_scalar_of(const Node& node, const std::string& path, const Asked& asked, void* value)
{
  auto& scalar = as<T>(value);
  if (!is(Node::Kind::scalar, node, path, scalar_name(scalar)))
    return;
  if (auto complaint = read_scalar(node, asked, scalar))
    problems_.add(node.place, path, std::move(*complaint));
}

void FieldReader::read_word(const Node& node, const std::string& path, const ValueType& type, void* value)
{
  if (!is(Node::Kind::scalar, node, path, "a word"))
    return;
  const auto at = std::find(type.words.begin(), type.words.end(), node.text);
  if (at == type.words.end())
    problems_.add(node.place, path, unknown_word("word", node.text, {type.words.begin(), type.words.end()}));
  else
    type.choose(value, static_cast<std::size_t>(at - type.words.begin()));
}

void FieldReader::read_list(const Node& node, const std::string& path, const Asked& asked, const ValueType& type, void* list)
{
  if (!is(Node::Kind::list, node, path, "a list [..., ...]"))
    return;
  const std::size_t size = node.items.size();
  if (type.length != 0 && size != type.length)
    return problems_.add(node.place, path, fmt::format("needs {} values, not {}", type.length, size));
  if (type.length == 0)
    type.resize(list, size);
  if (size == 0)
    problems_.add(node.place, path, "the list is empty");
  for (std::size_t i = 0; i < size; ++i)
    read(node.items[i], path_to(path, i, node.items[i]), asked, *type.entry, type.edit_at(list, i));
}

void FieldReader::read_table(const Node& node, const std::string& path, Table& table)
{
  const std::size_t before = problems_.size();
  read(node, path, table.points);
  for (std::size_t i = 1; i < table.points.size() && problems_.size() == before; ++i)
    if (const Real t0 = table.points[i - 1][0], t1 = table.points[i][0]; !(t1 > t0))
      problems_.add(node.items[i].place, path_to(path, i, node.items[i]), fmt::format("time {} s does not come after {} s", t1, t0));
}

void FieldReader::read_named(const Node& node, const std::string& path, NamedNumbers& numbers)
{
  if (!is(Node::Kind::mapping, node, path, "a mapping {name: number}"))
    return;
  for (std::size_t i = 0; i < node.keys.size(); ++i) {
    NamedNumber& one = numbers.all.emplace_back(NamedNumber{node.keys[i].text, 0});
    read(node.items[i], path_to(path, one.name), one.value);
  }
}

void FieldReader::read_mapping(const Node& node, const std::string& path, const ValueType& type, void* value)
{
  if (!is(Node::Kind::mapping, node, path, "a mapping {key: value}"))
    return;
  Mapping mapping(node, path, problems_);
  if (type.kind == ValueType::Kind::choice)
    read_choice(mapping, "type", type, value);
  else
    read_fields(mapping, *type.structs.front(), value);
  mapping.close();
}

void FieldReader::read_fields(Mapping& mapping, const StructType& type, void* object)
{
  if (type.set_where != nullptr)
    type.set_where(object, mapping.where());
  for (const FieldType& field : type.fields)
    if (field.is_alternative)
      read_choice(mapping, field.key, *field.type, field.member_of(object));
    else
      read_key(mapping, field, field.member_of(object));
  if (type.check != nullptr)
    mapping.check_later([&type, object](std::vector<std::string>& problems) { type.check(object, problems); });
}

void FieldReader::read_key(Mapping& mapping, const FieldType& field, void* value)
{
  const Node* node = field.need == Need::required ? mapping.find_required(field.key, field.unit) : mapping.find(field.key);
  const bool is_none = node != nullptr && field.may_be_empty() && node->kind == Node::Kind::list && node->items.empty();
  if (node != nullptr && !is_none)
    read(*node, mapping.path_of(field.key), {field.range, field.unit}, *field.type, value);
}

/// Reads the struct that `key` names, and its fields from the same mapping.
void FieldReader::read_choice(Mapping& mapping, std::string_view key, const ValueType& type, void* value)
{
  const Node* const node = mapping.find_required(key, "");
  std::string chosen;
  if (node != nullptr)
    read(*node, mapping.path_of(key), chosen);
  const auto at = std::find_if(type.structs.begin(), type.structs.end(), [&](const StructType* one) { return one->name == chosen; });
  if (at != type.structs.end()) {
    type.choose(value, static_cast<std::size_t>(at - type.structs.begin()));
    return read_fields(mapping, **at, type.edit_at(value, 0));
  }
  mapping.accept_any_key();
  if (chosen.empty())
    return;
  std::vector<std::string> known;
  for (const StructType* one : type.structs)
    known.emplace_back(one->name);
  problems_.add(node->place, mapping.path_of(key), unknown_word(key, chosen, known));
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

}  // namespace talus
