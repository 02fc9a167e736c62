#pragma once
// What the particles of a body remember for their law: rows of numbers, whatever the law calls them.
#include <algorithm>
#include <span>
#include <string_view>

#include "core/huge_page_allocator.hpp"
#include "core/types.hpp"

namespace talus {

/// One history variable of a law and where its numbers stand in the row of a particle.
struct HistoryVariable {
  std::string_view key, unit, meaning;
  int first = 0;       ///< its first number
  int components = 1;  ///< 1, or 6 of a symmetric tensor
};

/// One row per particle, all of `width` numbers.  A law without history variables has rows of width 0.
class HistoryRows {
 public:
  explicit HistoryRows(int width = 0) : width_(width) {}

  int width() const noexcept { return width_; }
  Index size() const noexcept { return size_; }
  std::size_t row_bytes() const noexcept { return static_cast<std::size_t>(width_) * sizeof(Real); }
  std::size_t bytes() const noexcept { return numbers_.size() * sizeof(Real); }
  Real* row(Index i) noexcept { return numbers_.data() + offset(i); }
  const Real* row(Index i) const noexcept { return numbers_.data() + offset(i); }
  std::span<std::byte> bytes_of_row(Index i) noexcept { return std::as_writable_bytes(std::span(row(i), offset(1))); }
  std::span<const std::byte> bytes_of_row(Index i) const noexcept { return std::as_bytes(std::span(row(i), offset(1))); }

  /// New rows are zero.
  void resize(Index n)
  {
    size_ = n;
    numbers_.resize(offset(n));
  }
  void copy_row(Index from, Index to) noexcept { std::copy_n(row(from), width_, row(to)); }
  /// Adds rows of the same width at the end.
  void append(const HistoryRows& more)
  {
    numbers_.insert(numbers_.end(), more.numbers_.begin(), more.numbers_.end());
    size_ += more.size_;
  }

 private:
  std::size_t offset(Index i) const noexcept { return static_cast<std::size_t>(i) * static_cast<std::size_t>(width_); }

  int width_;
  Index size_ = 0;
  Rows<Real> numbers_;
};

}  // namespace talus
