#pragma once
// Whether two runs, or a run that was stopped and one that was not, have come to the same bits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <set>

#include "core/error.hpp"
#include "io/checkpoint/array_file.hpp"
#include "io/files/atomic_file.hpp"

namespace talus {

inline std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder, const std::string& extension)
{
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == extension)
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

/// f(path) for all that a file holds; unless `really_all`, clocks on the wall and places on the disk left out.
template <class F>
void for_each_entry(const ArrayReader& file, const std::string& group, F&& f, bool really_all = false)
{
  static const std::set<std::string> of_the_day{"timings", "output_seconds", "last_output", "files", "elsewhere", "scene_file"};
  for (const std::string& name : file.names(group)) {
    const std::string path = group.empty() ? name : group + "/" + name;
    if (!really_all && of_the_day.contains(name))
      continue;
    bool is_group = true;
    try {
      is_group = !file.names(path).empty();
    } catch (const EnvironmentError&) {
      is_group = false;
    }
    if (is_group)
      for_each_entry(file, path, f, really_all);
    else
      f(path);
  }
}

template <class T>
bool same_values(const ArrayReader& a, const ArrayReader& b, const std::string& path, bool& known)
{
  for (const int columns : {1, 2, 3, 4, 6, 9}) {
    std::vector<T> x;
    try {
      x = a.read<T>(path, columns);
    } catch (const EnvironmentError&) {
      continue;
    }
    known = true;
    const auto y = b.read<T>(path, columns);
    return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(T)) == 0;
  }
  return true;
}

/// `without`: a group or array that may differ.
inline void expect_same_state(const std::filesystem::path& one, const std::filesystem::path& other, const std::string& without = "none")
{
  const ArrayReader a(one), b(other);
  int compared = 0;
  for_each_entry(a, "", [&](const std::string& path) {
    if (path.starts_with(without))
      return;
    bool known = false;
    const bool same = same_values<double>(a, b, path, known) && same_values<float>(a, b, path, known) &&
                      same_values<std::int32_t>(a, b, path, known) && same_values<std::int64_t>(a, b, path, known) &&
                      same_values<std::uint8_t>(a, b, path, known);
    EXPECT_TRUE(same) << path << " of " << one << " and " << other;
    if (!known) {
      EXPECT_EQ(a.text(path), b.text(path)) << path;
    }
    ++compared;
  });
  EXPECT_GT(compared, 60);
}

/// The same files with the same bytes.
inline void expect_same_files_in(const std::filesystem::path& one, const std::filesystem::path& other)
{
  std::set<std::string> names[2];
  for (const auto& [folder, seen] : {std::pair(one, &names[0]), std::pair(other, &names[1])})
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      seen->insert(entry.path().filename().string());
  ASSERT_EQ(names[0], names[1]) << one << " and " << other;
  for (const std::string& name : names[0])
    EXPECT_TRUE(read_whole(one / name) == read_whole(other / name)) << name << " of " << one << " and " << other;
}

/// Folders of results: the same files with the same bytes, but for the summary, which tells the time of day.
inline void expect_same_results(const std::filesystem::path& one, const std::filesystem::path& other)
{
  for (const std::string folder : {"maps", "sections"})
    if (std::filesystem::exists(one / folder))
      expect_same_files_in(one / folder, other / folder);
  for (const auto& entry : std::filesystem::directory_iterator(one))
    if (const auto name = entry.path().filename(); entry.is_regular_file() && name != "summary.json") {
      EXPECT_TRUE(read_whole(entry.path()) == read_whole(other / name)) << name << " of " << one << " and " << other;
    }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(one), {}), std::distance(std::filesystem::directory_iterator(other), {}))
      << one << " and " << other << " have not the same files";
  const auto last = files_in(one / "checkpoints", ".h5").back();
  expect_same_state(last, other / "checkpoints" / last.filename());
}

}  // namespace talus
