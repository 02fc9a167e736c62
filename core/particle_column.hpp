#pragma once
// The columns of the particles: numbers, vectors or tensors, one row per particle.
#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "core/huge_page_allocator.hpp"
#include "core/types.hpp"

namespace talus {

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

/// One row per particle: the numbers of a row lie side by side, row after row.  New rows are zero.  Packs of four numbers may be loaded from
/// the address of any number: three more numbers are allocated after the last row.
template <class Value>
class ParticleColumn {
 public:
  using Number = Real;
  static constexpr int components = detail::With<Real, Value>::size;

  std::size_t size() const noexcept { return numbers_.empty() ? 0 : (numbers_.size() - spare) / components; }
  bool empty() const noexcept { return size() == 0; }
  void resize(std::size_t n)
  {
    constexpr auto width = static_cast<std::size_t>(components);
    numbers_.resize(n * width + spare);
    std::fill_n(numbers_.end() - spare, spare, 0.0);  // a later resize() turns these numbers into rows, which must be zero
  }

  // const, so that writing to a copy does not compile
  const Value operator[](std::size_t row) const noexcept  // NOLINT(readability-const-return-type)
  {
    if constexpr (components == 1)
      return *row_at(row);
    else
      return Eigen::Map<const Value>(row_at(row));
  }
  void set(std::size_t row, const Value& value) noexcept
  {
    if constexpr (components == 1)
      *row_at(row) = value;
    else
      Eigen::Map<Value>(row_at(row)) = value;
  }
  void assign(std::size_t n, const Value& value)
  {
    resize(n);
    for (std::size_t row = 0; row < n; ++row)
      set(row, value);
  }
  void push_back(const Value& value)
  {
    resize(size() + 1);
    set(size() - 1, value);
  }
  /// All rows.
  std::vector<Value> values() const
  {
    std::vector<Value> all;
    for (std::size_t row = 0; row < size(); ++row)
      all.push_back((*this)[row]);
    return all;
  }

  /// The address of the first number of a row.
  Real* row_at(std::size_t row) noexcept { return numbers_.data() + row * static_cast<std::size_t>(components); }
  const Real* row_at(std::size_t row) const noexcept { return numbers_.data() + row * static_cast<std::size_t>(components); }

 private:
  static constexpr std::size_t spare = 3;  ///< numbers after the last row, so that a pack may be loaded from the last number

  Rows<Real> numbers_;
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

template <class Value>
const Real* numbers_of(const ParticleColumn<Value>& column, std::size_t row) noexcept
{
  return column.row_at(row);
}
template <class N, class Allocator>
const N* numbers_of(const std::vector<N, Allocator>& column, std::size_t row) noexcept
{
  return column.data() + row;
}
template <class Column>
auto* numbers_of(Column& column, std::size_t row) noexcept
{
  return const_cast<typename RowsOf<Column>::Number*>(numbers_of(std::as_const(column), row));
}

/// Copies row `from` of a column to row `to` of the same or another one.
template <class Column>
void copy_row(const Column& source, std::size_t from, Column& column, std::size_t to) noexcept
{
  std::copy_n(numbers_of(source, from), RowsOf<Column>::components, numbers_of(column, to));
}
/// Copies the numbers of a row to an address, and back.
template <class Column>
void save_row(const Column& column, std::size_t row, std::byte* to) noexcept
{
  std::memcpy(to, numbers_of(column, row), row_bytes<Column>);
}
template <class Column>
void load_row(const std::byte* from, Column& column, std::size_t row) noexcept
{
  std::memcpy(numbers_of(column, row), from, row_bytes<Column>);
}

}  // namespace talus
