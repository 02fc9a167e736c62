#pragma once
// An input file as a tree of values that know their place: what is left of YAML outside io/scene/reader.cpp.
#include <filesystem>
#include <list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"

namespace talus {

/// A text that values come from: a file, or one override of the command line.  Not copied: the lines point into the text.
struct Source {
  std::string name;                     ///< as messages show it
  std::string text;                     ///< lines ended by "\n", no byte order mark
  std::vector<std::string_view> lines;  ///< of the text
  bool is_file = true;                  ///< otherwise lines and columns mean nothing to the reader of a message
};

/// Where a value stands.  Lines and columns count from one, columns in bytes; zero means unknown.
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
    unreadable,  ///< a problem has been noted already: readers keep silent
  };
  struct Key {
    std::string text;
    Place place;
  };
  Kind kind = Kind::empty;
  bool quoted = false;  ///< a scalar in quotes, or a block of text: never a number
  Place place;
  std::string text{};
  std::vector<Node> items{};
  std::vector<Key> keys{};

  /// The value of a key, by either of its words, or nothing if this is no mapping or has no such key.
  const Node* find(std::string_view key) const noexcept;
  /// A key as it is written; nullptr: there is none.
  const Key* find_key(std::string_view word) const noexcept;
  /// The word for the key that stands here; where neither does, that which is given.
  std::string_view word_for(std::string_view key) const noexcept;
};

/// The first character of a text that does not print, such as a line end: it would stand in messages, tables and names of columns, where
/// nobody sees it.
std::string::const_iterator first_control(const std::string& text);

/// A line of a file as messages show it: nothing if it is too long to help.
std::string shown_line(std::string_view line);

/// `parent.key`, or `key` at the top.
std::string path_to(const std::string& parent, std::string_view key);
/// `parent[i]`, followed by the name in quotes if the entry has one: `materials[1] "clay"`.
std::string path_to(const std::string& parent, std::size_t i, const Node& entry);

/// What is wrong at a place, with the line that stands there.
SceneError problem_at(const Place& place, std::string path, std::string message);

/// A value in one line of YAML, as --set takes it.
std::string in_one_line(const Node& value);

/// Collects what is wrong.  Keeps the first hundred: more would help nobody, and a damaged file has millions.
class Problems {
 public:
  void add(const Place& place, std::string path, std::string message);
  std::size_t size() const noexcept { return list_.size(); }
  const std::vector<SceneError>& list() const noexcept { return list_; }
  /// Throws SceneErrors with all of them, if there are any.
  void throw_if_any() const;

 private:
  std::vector<SceneError> list_;
};

struct Document {
  std::list<Source> sources;  ///< the file, then the overrides; addresses stay
  Node root;
  Problems problems;  ///< doubled keys, aliases, overrides that fit nowhere
};

/// The whole text of a file; throws SceneErrors unless it is a text in UTF-8, without tabs in the indentation, of at most 4 MB.
std::string read_text(const std::filesystem::path& file);
/// The same of bytes that were in `file`, however many.
std::string plain_text(const std::filesystem::path& file, const std::string& bytes);
std::vector<std::string_view> lines_of(std::string_view text);

/// The place in words of the error messages, with the path of keys to the value.
SourceLocation to_where(const Place& place, std::string path);

/// Replaces or adds the value at a path of keys such as `bodies[0].particles_per_cell`; mappings that are missing on the way are
/// made, entries of lists are not.  `origin` is the place of the override, for messages.
void set_value(Document& document, std::string_view path, Node value, const Place& origin);

/// True if a path is the other one or leads to something inside it.
bool is_within(std::string_view path, std::string_view outer);

/// A value and its path as messages show it.
struct Found {
  const Node* node;
  std::string path;
  bool whole = true;  ///< otherwise something of the path is not there
};
/// The value at a path of keys, or the last one on the way to it that exists.
Found find_nearest(const Node& root, std::string_view path);

}  // namespace talus
