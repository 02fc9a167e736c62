#pragma once
// Arrays of many particles in large pages of memory.  A step reads dozens of arrays at once, more than a processor can keep addresses of in
// pages of 4 kB.
#include <sys/mman.h>

#include <cstddef>
#include <new>
#include <vector>

namespace talus {

/// An allocator that requests large pages for arrays that fill at least one.  Where the system grants none it works like any other
/// allocator.
template <class T>
struct LargePages {
  using value_type = T;
  static_assert(alignof(T) <= __STDCPP_DEFAULT_NEW_ALIGNMENT__);
  static constexpr std::size_t page = std::size_t{2} << 20;
  static constexpr bool fills_some(std::size_t n) noexcept { return n * sizeof(T) >= 4 * page; }

  LargePages() = default;
  template <class U>
  LargePages(const LargePages<U>&) noexcept  // NOLINT(google-explicit-constructor): as the standard wants it
  {}
  T* allocate(std::size_t n)
  {
    if (!fills_some(n))
      return static_cast<T*>(::operator new(n * sizeof(T)));
    void* const memory = ::operator new (n * sizeof(T), std::align_val_t{page});
    madvise(memory, n * sizeof(T), MADV_HUGEPAGE);  // a request only: the result does not matter
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t n) noexcept
  {
    if (fills_some(n))
      ::operator delete (memory, std::align_val_t{page});
    else
      ::operator delete(memory);
  }
  friend bool operator==(const LargePages&, const LargePages&) noexcept { return true; }
};

/// An array with one row per particle.
template <class T>
using Rows = std::vector<T, LargePages<T>>;

}  // namespace talus
