#pragma once
// Arrays of many particles in large pages of memory: a step goes through dozens of arrays at once, more than a processor keeps the
// addresses of in pages of 4 kB.
#include <sys/mman.h>

#include <cstdlib>
#include <new>
#include <vector>

namespace talus {

/// Asks for large pages where an array fills some.  Where the system grants none it is as any other allocator.
template <class T>
struct LargePages {
  using value_type = T;

  LargePages() = default;
  template <class U>
  LargePages(const LargePages<U>&) noexcept  // NOLINT(google-explicit-constructor): as the standard wants it
  {}
  T* allocate(std::size_t n)
  {
    constexpr std::size_t page = std::size_t{2} << 20, worth = 4 * page;
    const std::size_t bytes = n * sizeof(T);
    const bool large = bytes >= worth;
    void* const memory = large ? std::aligned_alloc(page, (bytes + page - 1) / page * page) : std::malloc(bytes);
    if (memory == nullptr)
      throw std::bad_alloc();
    if (large)
      madvise(memory, bytes, MADV_HUGEPAGE);  // a wish: nothing depends on the answer
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t) noexcept { std::free(memory); }
  friend bool operator==(const LargePages&, const LargePages&) noexcept { return true; }
};

/// One row a particle.
template <class T>
using Rows = std::vector<T, LargePages<T>>;

}  // namespace talus
