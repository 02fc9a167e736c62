#include "io/manual.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <concepts>
#include <functional>
#include <typeindex>
#include <unordered_map>
#include <utility>
#include <vector>

#include "io/field_reader.hpp"
#include "io/scene.hpp"
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

std::string in_words(std::span<const std::string_view> all)
{
  std::vector<std::string> quoted;
  for (const auto word : all)
    quoted.push_back(code(word));
  return or_list(quoted);
}

template <class T>
concept IsList = requires(const T& list)
{
  list.begin();
}
&&!std::same_as<T, std::string>;

/// The default of an optional key.  A number out of its range and an empty text stand for "not given".
template <class T>
std::string default_of(const T& value, const Range& range)
{
  if constexpr (std::same_as<T, bool>) {
    return value ? "true" : "false";
  } else if constexpr (std::is_arithmetic_v<T>) {
    return range.holds(value) ? fmt::format("{}", value) : "none";
  } else if constexpr (std::same_as<T, std::string>) {
    return value.empty() ? "none" : value;
  } else if constexpr (std::is_enum_v<T>) {
    return std::string(words(value)[static_cast<std::size_t>(value)]);
  } else if constexpr (IsList<T>) {
    std::vector<std::string> items;
    for (const auto& item : value)
      items.push_back(default_of(item, range));
    return items.empty() ? "none" : fmt::format("[{}]", fmt::join(items, ", "));
  } else if constexpr (requires { value.has_value(); }) {
    return value ? default_of(*value, range) : "none";
  } else {
    return HasFields<T> ? "see there" : "none";
  }
}

class Manual {
 public:
  static constexpr std::string_view top = "the scene";

  template <HasFields T>
  std::string write(const std::string& title)
  {
    std::string text = section<T>(title, 2) + kernels();
    while (!waiting_.empty()) {
      const auto next = std::move(waiting_.front());
      waiting_.erase(waiting_.begin());
      const auto later = std::exchange(waiting_, {});
      text += next();  // what it mentions comes right behind it
      waiting_.insert(waiting_.end(), later.begin(), later.end());
    }
    return text;
  }

 private:
  static std::string kernels()
  {
    std::string text = "\nKernels:\n\n";
    for_each_type(Kernels<2>{}, [&]<class K>() { text += fmt::format("* `{}`: {}\n", K::name, K::summary); });
    return text;
  }

  static std::string heading(int level, std::string_view title)
  {
    return fmt::format("\n{} {}\n\n", std::string(static_cast<std::size_t>(level), '#'), title);
  }

  /// The link to the section of a type, which is written once, after the section that first mentions it.
  template <class T>
  std::string link(const std::string& path)
  {
    const std::string own = std::same_as<T, Shape> ? "shape" : std::same_as<T, Box> ? "box" : path;
    const auto [title, is_new] = titles_.emplace(std::type_index(typeid(T)), own);
    if (is_new)
      waiting_.push_back([this, own] { return section<T>(own, 2); });
    std::string anchor;
    for (const char c : title->second)
      if (c != '.')
        anchor += c;
    return fmt::format("[{}](#{})", title->second, anchor);
  }

  template <HasFields T>
  std::string section(const std::string& path, int level)
  {
    std::vector<Row> rows;
    add_rows<T>(rows, path == top ? "" : path + ".");
    return heading(level, path) + to_table(head, rows) + alternatives<T>();
  }
  template <class Variant>
  requires(!HasFields<Variant>) std::string section(const std::string& path, int level)
  {
    return heading(level, path) + "One of these, chosen by the key `type`.\n" +
           each_alternative("type", path, std::type_identity<Variant>{});
  }

  template <class... T>
  std::string each_alternative(std::string_view key, const std::string& path, std::type_identity<std::variant<T...>>)
  {
    return (alternative_section<T>(key, path) + ...);
  }
  template <class T>
  std::string alternative_section(std::string_view key, const std::string& path)
  {
    std::vector<Row> rows;
    add_rows<T>(rows, (path.empty() ? std::string(T::name) : path) + ".");
    std::string text = heading(3, fmt::format("{}: {}", key, T::name));
    if constexpr (requires { T::summary; })
      text += sentence(T::summary) + "\n\n";
    text += to_table(head, rows);
    if constexpr (requires { typename T::State; })
      text += history<typename T::State>();
    return text;
  }
  template <class State>
  std::string history()
  {
    std::vector<std::array<std::string, 3>> rows;
    for_each_field<State>([&](const auto& variable) {
      rows.push_back({code(variable.key), std::string(variable.unit), std::string(variable.meaning)});
    });
    return rows.empty() ? "" : "\nIt keeps, for output:\n\n" + to_table({"history variable", "unit", "meaning"}, rows);
  }

  static std::string sentence(std::string_view text)
  {
    std::string whole(text);
    whole.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(whole.front())));
    return whole.ends_with('.') ? whole : whole + ".";
  }

  /// Sections of the structs that a key of T chooses from.
  template <HasFields T>
  std::string alternatives()
  {
    std::string text;
    for_each_field<T>([&](const auto& field) { text += alternatives_of(field); });
    return text;
  }
  template <class Field>
  std::string alternatives_of(const Field&)
  {
    return "";
  }
  template <class T, class Value>
  std::string alternatives_of(const Alternative<T, Value>& field)
  {
    return each_alternative(field.key, "", std::type_identity<Value>{});
  }

  template <HasFields T>
  void add_rows(std::vector<Row>& rows, const std::string& prefix)
  {
    const T defaults{};
    for_each_field<T>([&](const auto& field) { rows.push_back(row(field, defaults, prefix)); });
  }

  template <class T, class Value>
  Row row(const Parameter<T, Value>& field, const T& defaults, const std::string& prefix)
  {
    return {code(field.key),
            type(std::type_identity<Value>{}, prefix + std::string(field.key)),
            HasFields<Value> ? "" : std::string(field.unit),
            to_string(field.range) == "any" ? "" : to_string(field.range),
            need(field.need, default_of(defaults.*field.member, field.range)),
            std::string(field.meaning)};
  }
  template <class T, class Value>
  Row row(const Choice<T, Value>& field, const T& defaults, const std::string&)
  {
    return {code(field.key),           "word", "-", in_words(words(Value{})), need(field.need, default_of(defaults.*field.member, any)),
            std::string(field.meaning)};
  }
  template <class T, class Value>
  Row row(const Group<T, Value>& field, const T&, const std::string& prefix)
  {
    return {code(field.key),           type(std::type_identity<Value>{}, prefix + std::string(field.key)), "", "", "required",
            std::string(field.meaning)};
  }
  template <class T, class Value>
  Row row(const Group<T, std::optional<Value>>& field, const T&, const std::string& prefix)
  {
    return {code(field.key),           type(std::type_identity<Value>{}, prefix + std::string(field.key)), "", "", "none",
            std::string(field.meaning)};
  }
  template <class T, class Item>
  Row row(const List<T, Item>& field, const T&, const std::string& prefix)
  {
    return {code(field.key),           "list of " + link<Item>(prefix + std::string(field.key)), "", "", need(field.need, "none"),
            std::string(field.meaning)};
  }
  template <class T, class... Law>
  Row row(const Alternative<T, std::variant<Law...>>& field, const T&, const std::string&)
  {
    return {code(field.key),           "word", "-", in_words(std::array<std::string_view, sizeof...(Law)>{Law::name...}), "required",
            std::string(field.meaning)};
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
  std::vector<std::function<std::string()>> waiting_;
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
* `--set key=value` on the command line replaces or adds a value: `--set time.end=2 --set 'bodies[0].particles_per_cell=6'`.
)";

}  // namespace

std::string scene_manual() { return std::string(introduction) + Manual().write<Scene>(std::string(Manual::top)); }

}  // namespace talus
