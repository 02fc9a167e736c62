// The only code that uses the YAML library: the parser's events become a tree of located values, and unsupported features of YAML are
// refused.
#include "io/scene/reader.hpp"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <optional>
#include <sstream>
#include <unordered_map>

#include "io/document/document.hpp"
#include "io/document/document_json.hpp"
#include "io/document/field_reader.hpp"
#include "io/scene/accuracy.hpp"
#include "io/scene/law_libraries.hpp"
#include "io/scene/scene_rules.hpp"
#include "materials/interface/law_variant.hpp"

namespace talus {

namespace {

constexpr std::size_t deepest_nesting = 40;

/// Thrown for a document that cannot be parsed further.
struct Unparsable {
  Place place;
  std::string message;
};

class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(const Source& source, Problems& problems) : source_(source), problems_(problems) {}
  Node take() { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { add({.place = place(mark)}); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override
  {
    if (open_.empty() || !open_.back().key || open_.back().key_is_right)
      problems_.add(place(mark), path(), "aliases are not read: write the value out");
    add({.kind = Node::Kind::unreadable, .place = place(mark)});
  }
  void OnAnchor(const YAML::Mark& mark, const std::string& name) override
  {
    problems_.add(place(mark), path(), fmt::format("anchors such as &{} are not read", name));
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t, const std::string& text) override
  {
    refuse_tag(mark, tag);
    if (tag == "!")
      check_closed(mark);
    add({.kind = Node::Kind::scalar, .quoted = tag == "!", .place = place(mark), .text = text});
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t, YAML::EmitterStyle::value) override
  {
    open(mark, tag, Node::Kind::list);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t, YAML::EmitterStyle::value) override
  {
    open(mark, tag, Node::Kind::mapping);
  }
  void OnMapEnd() override { close(); }

 private:
  /// A list or mapping whose end has not been read yet.
  struct Open {
    Node node;
    std::unordered_map<std::string, Place> seen;  ///< keys of the mapping
    std::optional<Node::Key> key;                 ///< key of the next value
    bool key_is_right = true;                     ///< if false, the value is dropped
  };

  /// The position of a mark, which counts from zero; the text of an override has no lines of its own.
  Place place(const YAML::Mark& mark) const
  {
    return !source_.is_file || mark.is_null() ? Place{&source_} : Place{&source_, mark.line + 1, mark.column + 1};
  }

  /// The path of the next value.
  std::string path() const
  {
    std::string text;
    for (std::size_t i = 0; i < open_.size(); ++i) {
      const Open& level = open_[i];
      if (level.node.kind == Node::Kind::list)
        text = path_to(text, level.node.items.size(), i + 1 < open_.size() ? open_[i + 1].node : Node{});
      else if (level.key)
        text = path_to(text, level.key->text);
    }
    return text;
  }

  void refuse_tag(const YAML::Mark& mark, const std::string& tag)
  {
    if (!tag.empty() && tag != "?" && tag != "!")
      problems_.add(place(mark), path(), fmt::format("tags such as {} are not read", tag));
  }

  /// The parser takes the end of the file for a closing quote.
  void check_closed(const YAML::Mark& mark) const
  {
    const std::string_view first = source_.lines.at(static_cast<std::size_t>(mark.line)).substr(static_cast<std::size_t>(mark.column));
    const char quote = first.empty() ? ' ' : first.front();
    if (quote != '"' && quote != '\'')
      return;
    const std::string& text = source_.text;
    auto at = static_cast<std::size_t>(first.data() - text.data()) + 1;
    while (at < text.size() && text[at] != quote)
      at += quote == '"' && text[at] == '\\' ? 2 : 1;
    if (at >= text.size())
      throw Unparsable{place(mark), fmt::format("the quote {} is not closed", quote)};
  }

  void open(const YAML::Mark& mark, const std::string& tag, Node::Kind kind)
  {
    refuse_tag(mark, tag);
    if (open_.size() == deepest_nesting)
      throw Unparsable{place(mark), fmt::format("more than {} lists and mappings inside each other", deepest_nesting)};
    open_.push_back({Node{.kind = kind, .place = place(mark)}, {}, {}});
  }

  void close()
  {
    Node done = std::move(open_.back().node);
    open_.pop_back();
    add(std::move(done));
  }

  /// Adds a complete value: the root, an entry of a list, a key, or the value of the previous key.
  void add(Node value)
  {
    if (open_.empty()) {
      root_ = std::move(value);
    } else if (Open& top = open_.back(); top.node.kind == Node::Kind::list) {
      top.node.items.push_back(std::move(value));
    } else if (!top.key) {
      add_key(top, value);
    } else {
      if (value.kind == Node::Kind::empty)
        value.place = top.key->place;  // the parser gives the position of the next item
      if (top.key_is_right) {
        top.node.keys.push_back(std::move(*top.key));
        top.node.items.push_back(std::move(value));
      }
      top.key.reset();
    }
  }

  void add_key(Open& mapping, const Node& key)
  {
    const std::string parent = path();
    mapping.key = {key.text, key.place};
    mapping.key_is_right = false;
    if (key.kind != Node::Kind::scalar)
      return problems_.add(key.place, parent, "a key must be a single word");
    if (key.text == "<<")
      return problems_.add(key.place, parent, "merge keys (<<) are not read: write the keys out");
    const auto [first, is_new] = mapping.seen.emplace(key.text, key.place);
    if (!is_new)
      return problems_.add(key.place, parent,
                           first->second.line == 0 ? fmt::format("duplicate key \"{}\"", key.text)
                                                   : fmt::format("duplicate key \"{}\", first on line {}", key.text, first->second.line));
    mapping.key_is_right = true;
  }

  const Source& source_;
  Problems& problems_;
  std::vector<Open> open_;
  Node root_;
};

/// The parser's message, with the usual cause.
std::string explained(const std::string& message)
{
  static constexpr std::array<std::array<std::string_view, 2>, 6> reasons{{
      {"illegal EOF in scalar", "a quote is not closed"},
      {"illegal map value", "a text with a colon in it needs quotes"},
      {"end of sequence flow not found", "a bracket [ is not closed or a comma is missing"},
      {"end of map flow not found", "a brace { is not closed or a comma is missing"},
      {"end of map not found", "the indentation does not fit the lines above"},
      {"end of sequence not found", "the indentation does not fit the lines above"},
  }};
  for (const auto& [known, reason] : reasons)
    if (message == known)
      return fmt::format("{}; {}", message, reason);
  return message;
}

/// The tree of one YAML document.  Throws Unparsable.
Node parse(const Source& source, Problems& problems)
{
  TreeBuilder builder(source, problems);
  try {
    std::istringstream stream(source.text);
    YAML::Parser parser(stream);
    if (!parser.HandleNextDocument(builder))
      return {.place = {&source}};
    Node root = builder.take();
    TreeBuilder second(source, problems);
    if (parser.HandleNextDocument(second))
      throw Unparsable{second.take().place, "a second document begins here: one file holds one scene"};
    return root;
  } catch (const YAML::Exception& e) {
    const bool placed = !e.mark.is_null() && source.is_file;
    throw Unparsable{placed ? Place{&source, e.mark.line + 1, e.mark.column + 1} : Place{&source}, "this is not YAML: " + explained(e.msg)};
  }
}

void apply_override(Document& document, const std::string& text)
{
  const std::size_t equals = text.find('=');
  const std::string value = equals == text.npos ? "" : text.substr(equals + 1);
  Source& source = document.sources.emplace_back();
  source.name = "--set " + text;
  source.text = value;
  source.lines = lines_of(source.text);
  source.is_file = false;
  const Place place{&source};
  if (equals == text.npos)
    return document.problems.add(place, "", "write it as key=value");
  try {
    Node node = parse(source, document.problems);
    node.place = place;
    set_value(document, std::string_view(text).substr(0, equals), std::move(node), place);
  } catch (const Unparsable& e) {
    document.problems.add(place, "", e.message);
  }
}

Document read_document(const std::filesystem::path& file, std::string text, std::span<const std::string> overrides)
{
  Document document;
  Source& source = document.sources.emplace_back();
  source.name = file.string();
  source.text = std::move(text);
  source.lines = lines_of(source.text);
  try {
    document.root = parse(source, document.problems);
  } catch (const Unparsable& e) {
    document.problems.add(e.place, "", e.message);
    document.problems.throw_if_any();
  }
  if (document.root.kind == Node::Kind::empty) {
    document.problems.add({&source}, "", "the file is empty");
    document.problems.throw_if_any();
  }
  for (const std::string& override_text : overrides)
    apply_override(document, override_text);
  return document;
}

/// The length of a value at the beginning of a text that ends on its first line; 0 if it continues on the next line.
std::size_t length_in_line(const Node& node, std::string_view text)
{
  if (node.kind == Node::Kind::scalar && !node.quoted)
    return text.starts_with(node.text) ? node.text.size() : 0;
  int depth = 0;
  char quote = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quote != 0)
      quote = c == quote ? '\0' : quote;
    else if (c == '"' || c == '\'')
      quote = c;
    else if (c == '[' || c == '{')
      ++depth;
    else if (c == ']' || c == '}')
      --depth;
    if (quote == 0 && depth == 0)
      return i == 0 ? 0 : i + 1;  // the first letter of a plain text is not a bracket
  }
  return 0;
}

/// Records broken rules at the values that they concern, unless these values have errors already.
void add_findings(Document& document, const std::vector<Finding>& findings)
{
  const std::vector<SceneError> before = document.problems.list();
  for (const auto& [path, message] : findings) {
    const Found found = find_nearest(document.root, path);
    const bool known = std::any_of(before.begin(), before.end(), [&](const SceneError& p) { return is_within(p.where.path, found.path); });
    if (!known)
      document.problems.add(found.node->place, found.path, message);
  }
}

void open_libraries(Document& document, const std::filesystem::path& file, Scene& scene)
{
  std::vector<const LawDescription*> opened;
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    AnyLaw& law = scene.materials[i].law;
    if (law.is_open())
      continue;
    add_findings(document, open_library(file, fmt::format("materials[{}]", i), law, opened));
    if (law.is_open())
      opened.push_back(&law.description());
  }
}

}  // namespace

Scene read_scene(const std::filesystem::path& file, std::span<const std::string> overrides, Libraries libraries)
{
  return read_scene_text(file, read_text(file), overrides, libraries);
}

Scene read_scene_text(const std::filesystem::path& file, const std::string& text, std::span<const std::string> overrides,
                      Libraries libraries)
{
  Document document = read_document(file, plain_text(file, text), overrides);
  Scene scene;
  FieldReader(document.problems).read(document.root, "", scene);
  if (libraries == Libraries::opened)
    open_libraries(document, file, scene);
  add_findings(document, broken_rules(scene));
  document.problems.throw_if_any();
  settle_accuracy(scene);
  scene.file = file.string();
  scene.text = std::move(document.sources.front().text);
  scene.overrides.assign(overrides.begin(), overrides.end());
  return scene;
}

std::string keys_as_json(const std::filesystem::path& file, std::span<const std::string> overrides)
{
  const Document document = read_document(file, read_text(file), overrides);
  document.problems.throw_if_any();
  return in_json(document.root);
}

std::string with_values(const std::filesystem::path& file, std::string text, std::span<const std::string> overrides)
{
  std::vector<SceneError> problems;
  for (const std::string& given : overrides) {
    const auto complain = [&](std::string message) {
      problems.push_back({SourceLocation{"--set " + given, 0, 0, ""}, std::move(message), ""});
    };
    const std::size_t equals = given.find('=');
    if (equals == given.npos) {
      complain("write it as key=value");
      continue;
    }
    const Document document = read_document(file, text, {});
    const std::string path = given.substr(0, equals);
    const Found found = find_nearest(document.root, path);
    const Place& place = found.node->place;
    if (!found.whole) {
      complain(fmt::format("{} has no {}: write it into the new file", file.string(), path));
      continue;
    }
    const std::string_view line = document.sources.front().lines[static_cast<std::size_t>(place.line) - 1];
    const auto begin = static_cast<std::size_t>(place.column) - 1;
    if (const std::size_t length = length_in_line(*found.node, line.substr(begin)); length > 0)
      text.replace(static_cast<std::size_t>(line.data() - document.sources.front().text.data()) + begin, length, given.substr(equals + 1));
    else
      complain(fmt::format("{} stands on several lines: change it in the new file", found.path));
  }
  if (!problems.empty())
    throw SceneErrors(std::move(problems));
  return text;
}

PointTest read_point_path(const std::filesystem::path& file, std::span<const std::string> overrides)
{
  Document document = read_document(file, read_text(file), overrides);
  PointTest test;
  FieldReader(document.problems).read(document.root, "", test);
  add_findings(document, open_library(file, "material", test.material.law));
  document.problems.throw_if_any();
  return test;
}

}  // namespace talus
