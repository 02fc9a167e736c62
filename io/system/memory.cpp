// Reads /proc and the control groups of Linux, versions 1 and 2.
#include "io/system/memory.hpp"

#include <fmt/format.h>
#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>

namespace talus {

namespace {

namespace fs = std::filesystem;

constexpr Real unlimited = std::numeric_limits<Real>::infinity();

/// The number after a word of a file such as "MemAvailable:"; the first number for an empty word.  Nothing if there is none, as in "max".
std::optional<Real> number_in(const fs::path& file, const std::string& word = "")
{
  std::ifstream stream(file);
  for (std::string found; word.empty() || stream >> found;)
    if (Real number = 0; found == word)
      return stream >> number ? std::optional(number) : std::nullopt;
  return std::nullopt;
}

Real left_on_the_machine(const fs::path& root)
{
  const auto kilobytes = number_in(root / "proc/meminfo", "MemAvailable:");
  return kilobytes ? *kilobytes * 1024 : unlimited;
}

/// Names of files in version 2 of control groups, or in version 1.
struct GroupFiles {
  const char *folder, *limit, *used, *cache;
};

/// The memory left in the group and its parent groups.  Their file caches count as free.
Real left_in_groups(const fs::path& root, const std::string& group, const GroupFiles& files)
{
  Real left = unlimited;
  const fs::path top = root / files.folder;
  for (fs::path inner = top / fs::path(group).relative_path();; inner = inner.parent_path()) {
    if (const auto limit = number_in(inner / files.limit))
      left = std::min(left, *limit - number_in(inner / files.used).value_or(0) + number_in(inner / "memory.stat", files.cache).value_or(0));
    if (inner == top || !inner.has_relative_path())
      return left;
  }
}

/// Parses lines such as "0::/user.slice" (version 2) and "4:memory:/user.slice" (version 1).
Real left_in_groups(const fs::path& root)
{
  Real left = unlimited;
  std::ifstream groups(root / "proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    std::istringstream stream(line);
    std::string number, controllers, group;
    std::getline(std::getline(std::getline(stream, number, ':'), controllers, ':'), group);
    if (controllers.empty())
      left = std::min(left, left_in_groups(root, group, {"sys/fs/cgroup", "memory.max", "memory.current", "inactive_file"}));
    else if (controllers == "memory")
      left = std::min(
          left,
          left_in_groups(root, group, {"sys/fs/cgroup/memory", "memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"}));
  }
  return left;
}

Real left_of_addresses(const fs::path& root)
{
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
    return unlimited;
  const auto pages = number_in(root / "proc/self/statm").value_or(0);
  return static_cast<Real>(limit.rlim_cur) - pages * static_cast<Real>(::sysconf(_SC_PAGESIZE));
}

}  // namespace

Real available_memory(const fs::path& root)
{
  return std::max(Real{0}, std::min({left_on_the_machine(root), left_in_groups(root), left_of_addresses(root)}));
}

/// Not by getrusage, whose value starts with the size of the parent process.
Real peak_memory(const fs::path& root) { return number_in(root / "proc/self/status", "VmHWM:").value_or(0) * 1024; }

void keep_freed_memory() noexcept
{
  constexpr int no_limit = std::numeric_limits<int>::max(), largest_of_heap = 32 << 20;  // the most that glibc accepts
  ::mallopt(M_TRIM_THRESHOLD, no_limit);
  ::mallopt(M_MMAP_THRESHOLD, largest_of_heap);
}

std::string too_many(Real items, const std::string& what, Real bytes)
{
  constexpr Real giga = 1e9;
  const Real needed = items * bytes, there = available_memory();
  if (needed <= there)
    return "";
  return fmt::format("asks for {:.3g} {}, which need at least {:.3g} GB of memory; {:.3g} GB are there", items, what, needed / giga,
                     there / giga);
}

}  // namespace talus
