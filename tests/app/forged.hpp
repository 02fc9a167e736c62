#pragma once
// Checkpoints that are whole and that no run has written.
#include <type_traits>

#include "tests/app/same_state.hpp"

namespace talus {

/// Values of type T, if such are there.
template <class T, class Change>
bool copied(const ArrayReader& from, ArrayWriter& to, const std::string& path, Change&& change)
{
  for (const int columns : {1, 2, 3, 4, 6, 9})
    try {
      auto values = from.read<T>(path, columns);
      change(path, values);
      to.write<T>(path, values, columns, from.unit(path));
      return true;
    } catch (const EnvironmentError&) {
    }
  return false;
}

/// The file anew, its checksums right, with what change(path, values) does to its arrays, each a vector of numbers, and to its texts.
template <class Change>
void forge(const std::filesystem::path& file, Change&& change)
{
  std::filesystem::rename(file, file.string() + ".old");
  const ArrayReader from(file.string() + ".old");
  ArrayWriter to(file);
  std::vector<std::string> paths;
  for_each_entry(
      from, "", [&](const std::string& path) { paths.push_back(path); }, true);
  for (const std::string& path : paths)
    if (!(copied<double>(from, to, path, change) || copied<float>(from, to, path, change) || copied<std::int32_t>(from, to, path, change) ||
          copied<std::int64_t>(from, to, path, change) || copied<std::uint8_t>(from, to, path, change))) {
      std::string text = from.text(path);
      change(path, text);
      to.write(path, text);
    }
  to.close();
  std::filesystem::remove(file.string() + ".old");
}

/// One number of an array, or a text.
inline void forge_value(const std::filesystem::path& file, const std::string& at, std::size_t i, double value)
{
  bool found = false;
  forge(file, [&](const std::string& path, auto& values) {
    if constexpr (!std::is_same_v<std::decay_t<decltype(values)>, std::string>)
      if (path == at) {
        values.at(i) = static_cast<std::decay_t<decltype(values[0])>>(value);
        found = true;
      }
  });
  EXPECT_TRUE(found) << at;
}
inline void forge_text(const std::filesystem::path& file, const std::string& at, const std::string& text)
{
  bool found = false;
  forge(file, [&](const std::string& path, auto& values) {
    if constexpr (std::is_same_v<std::decay_t<decltype(values)>, std::string>)
      if (path == at) {
        values = text;
        found = true;
      }
  });
  EXPECT_TRUE(found) << at;
}
/// No rows in that array, or in "all" of those of the particles.
inline void forge_empty(const std::filesystem::path& file, const std::string& which)
{
  bool found = false;
  forge(file, [&](const std::string& path, auto& values) {
    if (path == which || (path.starts_with("particles/") && which == "all")) {
      values.clear();
      found = true;
    }
  });
  EXPECT_TRUE(found) << which;
}

}  // namespace talus
