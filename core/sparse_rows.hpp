#pragma once
// Arrays of which a run uses a part: the nodes and cells near particles, of a mesh that has much more room.
#include <sys/mman.h>

#include <cstddef>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/huge_page_allocator.hpp"

namespace talus {

/// An allocator of zeroed memory that constructs nothing in a new array: the system gives memory to a page when it is first written, so rows
/// that are never written take none.  Large pages are requested for arrays that fill some, see LargePages.  Rows begin at a multiple of their
/// alignment.
template <class T>
struct ZeroedPages {
  using value_type = T;
  static_assert(std::is_trivially_destructible_v<T>);

  ZeroedPages() = default;
  template <class U>
  ZeroedPages(const ZeroedPages<U>&) noexcept  // NOLINT(google-explicit-constructor): as the standard wants it
  {}
  T* allocate(std::size_t n)
  {
    void* const memory = ::mmap(nullptr, n * sizeof(T), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED)
      throw std::bad_alloc();
    if (LargePages<std::byte>::fills_some(n * sizeof(T)))
      ::madvise(memory, n * sizeof(T), MADV_HUGEPAGE);  // a request only: the result does not matter
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t n) noexcept { ::munmap(memory, n * sizeof(T)); }
  template <class U>
  void construct(U*) noexcept
  {}
  template <class U, class... Arguments>
  void construct(U* at, Arguments&&... arguments)
  {
    ::new (static_cast<void*>(at)) U(std::forward<Arguments>(arguments)...);
  }
  friend bool operator==(const ZeroedPages&, const ZeroedPages&) noexcept { return true; }
};

/// An array with one row per node, cell or so.  The bytes of new rows are zero: T must be such that this is an unused row.
template <class T>
using SparseRows = std::vector<T, ZeroedPages<T>>;

/// The bytes of the rows of arrays, written or not.
template <class... Arrays>
std::size_t bytes_of_all(const Arrays&... arrays) noexcept
{
  return (std::size_t{0} + ... + (arrays.size() * sizeof(arrays[0])));
}

}  // namespace talus
