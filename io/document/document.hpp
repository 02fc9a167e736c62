#pragma once
// An input file as a tree of values with their positions.  Only io/scene/reader.cpp depends on the YAML library.
#include <filesystem>
#include <list>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"

namespace talus {

/// A text with values: a file, or one override of the command line.  Not copyable, because the lines point into the text.
struct Source {
  std::string name;                     ///< name shown in messages
  std::string text;                     ///< text with "\n" at line ends and without byte order mark
  std::vector<std::string_view> lines;  ///< of the text
  bool is_file = true;                  ///< false for an override, whose lines and columns are not shown in messages
};

/// The position of a value.  Lines and columns count from one, columns in bytes; zero means unknown.
struct Place {
  const Source* source = nullptr;
  int line = 0, column = 0;
};

/// A value of the file.
struct Node {
  enum class Kind : std::uint8_t {
    empty,       ///< a key without a value
    scalar,      ///< `text`
    list,        ///< `items`
    mapping,     ///< `keys` and, in the same order, `items`
    unreadable,  ///< an error has been recorded already, so readers do not report another one
  };
  struct Key {
    std::string text;
    Place place;
  };
  Kind kind = Kind::empty;
  bool quoted = false;  ///< a scalar in quotes or a block of text, which is never a number
  Place place;
  std::string text{};
  std::vector<Node> items{};
  std::vector<Key> keys{};

  /// The value of a key, by either of its names; nullptr if this is not a mapping or has no such key.
  const Node* find(std::string_view key) const noexcept;
  /// A key as it is written; nullptr if it does not exist.
  const Key* find_key(std::string_view word) const noexcept;
  /// The name of the key that is used here; if neither is, the given one.
  std::string_view word_for(std::string_view key) const noexcept;
};

/// The first character of a text that cannot be printed, such as a line end, which would be invisible in messages, tables and names of
/// columns.
std::string::const_iterator first_control(const std::string& text);

/// A line of a file as messages show it; empty if it is too long.
std::string shown_line(std::string_view line);

/// The path `parent.key`, or `key` at the top level.
std::string path_to(const std::string& parent, std::string_view key);
/// The path `parent[i]`, followed by the name in quotes if the entry has one: `materials[1] "clay"`.
std::string path_to(const std::string& parent, std::size_t i, const Node& entry);

/// An error at a position, with the line of the file.
SceneError problem_at(const Place& place, std::string path, std::string message);

/// A value on one line of YAML, as --set takes it.
std::string in_one_line(const Node& value);

/// Collects errors.  Keeps the first hundred, as a damaged file may have millions.
class Problems {
 public:
  void add(const Place& place, std::string path, std::string message);
  std::size_t size() const noexcept { return list_.size(); }
  const std::vector<SceneError>& list() const noexcept { return list_; }
  /// Throws SceneErrors with all errors, if there are any.
  void throw_if_any() const;

 private:
  std::vector<SceneError> list_;
};

struct Document {
  std::list<Source> sources;  ///< the file, then the overrides; a list, so that addresses stay valid
  Node root;
  Problems problems;  ///< repeated keys, aliases, overrides without a position in the file
};

/// The whole text of a file.  Throws SceneErrors unless it is a text in UTF-8, without tabs in the indentation, of at most 4 MB.
std::string read_text(const std::filesystem::path& file);
/// The text of bytes that were read from `file`, of any size.
std::string plain_text(const std::filesystem::path& file, const std::string& bytes);
std::vector<std::string_view> lines_of(std::string_view text);

/// The position as SourceLocation, with the path of keys to the value.
SourceLocation to_where(const Place& place, std::string path);

/// Replaces or adds the value at a path of keys such as `bodies[0].particles_per_cell`.  Missing mappings on the way are added, list
/// entries are not.  `origin` is the position of the override, for messages.
void set_value(Document& document, std::string_view path, Node value, const Place& origin);

/// Whether a path equals the other one or leads to a value inside it.
bool is_within(std::string_view path, std::string_view outer);

/// A value with its path for messages.
struct Found {
  const Node* node;
  std::string path;
  bool whole = true;  ///< false if a part of the path does not exist
};
/// The value at a path of keys, or the last existing one on the way to it.
Found find_nearest(const Node& root, std::string_view path);

}  // namespace talus
