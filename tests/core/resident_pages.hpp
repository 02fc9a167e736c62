#pragma once
// The pages of an array that the system has given memory to.
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace talus {

struct Pages {
  std::size_t resident, all;
};

template <class Array>
Pages pages_of(const Array& array)
{
  const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
  const auto begin = reinterpret_cast<std::uintptr_t>(array.data()) / page * page;
  const auto bytes = reinterpret_cast<std::uintptr_t>(array.data() + array.size()) - begin;
  std::vector<unsigned char> there((bytes + page - 1) / page);
  if (::mincore(reinterpret_cast<void*>(begin), bytes, there.data()) != 0)
    return {0, 0};
  return {static_cast<std::size_t>(std::count_if(there.begin(), there.end(), [](unsigned char flags) { return (flags & 1) != 0; })),
          there.size()};
}

}  // namespace talus
