#pragma once
// The columns of the particles: numbers, vectors or tensors, one row per particle, stored so that packs of particles load without transposing.
#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "core/huge_page_allocator.hpp"
#include "core/types.hpp"

namespace talus {

/// The number of rows in a group.
inline constexpr std::size_t rows_in_group = 16;

namespace detail {
template <class T, class Value>
struct With {
  using type = T;
  static constexpr int size = 1;
};
template <class T, int R, int C>
struct With<T, Eigen::Matrix<Real, R, C, Eigen::DontAlign>> {
  using type = Eigen::Matrix<T, R, C, Eigen::DontAlign>;
  static constexpr int size = R * C;
};
}  // namespace detail
/// The type Value, a Real, vector or tensor, with numbers of type T.
template <class T, class Value>
using With = typename detail::With<T, Value>::type;

/// One row per particle, in groups of 16 rows.  A group holds its rows component by component: 16 first numbers, then 16 second ones and so
/// on (an array of structs of arrays).  So neighbouring rows of a group lie side by side in each component, and all numbers of a group in
/// one stretch of memory.  New rows are zero.
template <class Value>
class ParticleColumn {
 public:
  using Number = Real;
  static constexpr int components = detail::With<Real, Value>::size;

  std::size_t size() const noexcept { return size_; }
  bool empty() const noexcept { return size_ == 0; }
  void resize(std::size_t n)
  {
    const std::size_t before = size_;
    numbers_.resize((n + rows_in_group - 1) / rows_in_group * rows_in_group * components);
    size_ = n;
    for (std::size_t row = n; row < before && row % rows_in_group != 0; ++row)  // rows that come back later are new ones
      for (int c = 0; c < components; ++c)
        *lane(row, c) = 0;
  }

  // const, so that writing to a copy does not compile
  const Value operator[](std::size_t row) const noexcept  // NOLINT(readability-const-return-type)
  {
    if constexpr (components == 1) {
      return *lane(row, 0);
    } else {
      Value value;
      for (int c = 0; c < components; ++c)
        value(c) = *lane(row, c);
      return value;
    }
  }
  void set(std::size_t row, const Value& value) noexcept
  {
    if constexpr (components == 1)
      *lane(row, 0) = value;
    else
      for (int c = 0; c < components; ++c)
        *lane(row, c) = value(c);
  }
  void assign(std::size_t n, const Value& value)
  {
    resize(n);
    for (std::size_t row = 0; row < n; ++row)
      set(row, value);
  }
  void push_back(const Value& value)
  {
    resize(size_ + 1);
    set(size_ - 1, value);
  }
  /// All rows.
  std::vector<Value> values() const
  {
    std::vector<Value> all;
    for (std::size_t row = 0; row < size_; ++row)
      all.push_back((*this)[row]);
    return all;
  }

  /// The address of a component of a row; those of the following rows of the group follow.
  Real* lane(std::size_t row, int c) noexcept { return numbers_.data() + place(row, c); }
  const Real* lane(std::size_t row, int c) const noexcept { return numbers_.data() + place(row, c); }

 private:
  static std::size_t place(std::size_t row, int c) noexcept
  {
    return (row / rows_in_group * components + static_cast<std::size_t>(c)) * rows_in_group + row % rows_in_group;
  }

  Rows<Real> numbers_;
  std::size_t size_ = 0;
};

// The same functions for columns and for arrays of single numbers.

/// The type of the numbers of a column, and how many a row has.
template <class Column>
struct RowsOf {
  using Number = typename Column::Number;
  static constexpr int components = Column::components;
};
template <class N, class Allocator>
struct RowsOf<std::vector<N, Allocator>> {
  using Number = N;
  static constexpr int components = 1;
};
template <class Column>
inline constexpr std::size_t row_bytes = sizeof(typename RowsOf<Column>::Number) * RowsOf<Column>::components;
/// The memory of the rows of a column [B].
template <class Column>
std::size_t bytes_of(const Column& column) noexcept
{
  return column.size() * row_bytes<Column>;
}

/// The address of the first number of a row; the others follow at a distance of rows_in_group numbers.
template <class Value>
const Real* numbers_of(const ParticleColumn<Value>& rows, std::size_t row) noexcept
{
  return rows.lane(row, 0);
}
template <class N, class Allocator>
const N* numbers_of(const std::vector<N, Allocator>& rows, std::size_t row) noexcept
{
  return rows.data() + row;
}
template <class Column>
auto* numbers_of(Column& rows, std::size_t row) noexcept
{
  return const_cast<typename RowsOf<Column>::Number*>(numbers_of(std::as_const(rows), row));
}

/// Copies row `from` of a column to row `to` of the same or another one.
template <class Column>
void copy_row(const Column& source, std::size_t from, Column& column, std::size_t to) noexcept
{
  const auto* const numbers = numbers_of(source, from);
  auto* const copy = numbers_of(column, to);
  for (std::size_t c = 0; c < RowsOf<Column>::components; ++c)
    copy[c * rows_in_group] = numbers[c * rows_in_group];
}
/// Copies the numbers of a row, one after the other, to an address, and back.
template <class Column>
void save_row(const Column& column, std::size_t row, std::byte* to) noexcept
{
  const auto* const numbers = numbers_of(column, row);
  for (std::size_t c = 0; c < RowsOf<Column>::components; ++c)
    std::memcpy(to + c * sizeof(*numbers), numbers + c * rows_in_group, sizeof(*numbers));
}
template <class Column>
void load_row(const std::byte* from, Column& column, std::size_t row) noexcept
{
  auto* const numbers = numbers_of(column, row);
  for (std::size_t c = 0; c < RowsOf<Column>::components; ++c)
    std::memcpy(numbers + c * rows_in_group, from + c * sizeof(*numbers), sizeof(*numbers));
}

}  // namespace talus
