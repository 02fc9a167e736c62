#pragma once
// One quantity of all particles, stored in double or in single precision.
#include <array>
#include <cstddef>
#include <string_view>
#include <type_traits>
#include <utility>

#include "core/huge_page_allocator.hpp"
#include "core/types.hpp"

namespace talus {

/// The precision in which particle data are stored.  Computations are in double precision in either case.
enum class Precision : std::uint8_t { full, single };
constexpr auto enum_names(Precision) { return std::array<std::string_view, 2>{"double", "single"}; }

namespace detail {
template <class S, class Value>
struct In {
  using type = S;
};
template <class S, int R, int C>
struct In<S, Eigen::Matrix<Real, R, C, Eigen::DontAlign>> {
  using type = Eigen::Matrix<S, R, C, Eigen::DontAlign>;
};
}  // namespace detail
/// The type Value, a Real, vector or tensor, with numbers of type S.
template <class S, class Value>
using In = typename detail::In<S, Value>::type;

/// The value that is subtracted before a row is stored in single precision, so that small differences keep their digits.
enum class Rest : std::uint8_t { zero, identity };

/// A column whose rows are Reals, vectors or tensors.  Rows are read by value and written by set(), always in double; loops over many
/// particles use a ParticlePackOf<S> (core/particle_pack.hpp), which knows the stored type S.
template <class Value, Rest rest = Rest::zero>
class ParticleColumn {
 public:
  template <class S>
  using Row = In<S, Value>;

  std::size_t size() const noexcept { return is_single_ ? single_.size() : full_.size(); }
  bool empty() const noexcept { return size() == 0; }

  // const, so that writing to a copy does not compile
  const Value operator[](std::size_t row) const noexcept  // NOLINT(readability-const-return-type)
  {
    return is_single_ ? widened(single_[row]) : full_[row];
  }
  void set(std::size_t row, const Value& value) noexcept
  {
    if (is_single_)
      single_[row] = narrowed(value);
    else
      full_[row] = value;
  }
  void assign(std::size_t n, const Value& value) { is_single_ ? single_.assign(n, narrowed(value)) : full_.assign(n, value); }
  void resize(std::size_t n)
  {
    visit([&](auto& rows) { rows.resize(n); });
  }

  void push_back(const Value& value) { is_single_ ? single_.push_back(narrowed(value)) : full_.push_back(value); }

  /// Converts the column to this precision; existing rows are rounded.
  void keep_in(Precision precision)
  {
    const bool single = precision == Precision::single;
    if (single == is_single_)
      return;
    if (single)
      single_ = converted(full_, [](const Value& row) { return narrowed(row); });
    else
      full_ = converted(single_, [](const Row<float>& row) { return widened(row); });
    is_single_ = single;
  }
  Precision precision() const noexcept { return is_single_ ? Precision::single : Precision::full; }

  /// Calls f(rows) with the vector that stores the rows.
  template <class F>
  decltype(auto) visit(F&& f)
  {
    return is_single_ ? f(single_) : f(full_);
  }
  template <class F>
  decltype(auto) visit(F&& f) const
  {
    return is_single_ ? f(single_) : f(full_);
  }
  /// The stored rows, for callers that know that they are of type S.
  template <class S>
  Row<S>* rows() noexcept
  {
    if constexpr (std::is_same_v<S, Real>)
      return full_.data();
    else
      return single_.data();
  }
  template <class S>
  const Row<S>* rows() const noexcept
  {
    return const_cast<ParticleColumn*>(this)->rows<S>();
  }

  /// Conversion of a stored row to double, and back.
  static Value widened(const Row<float>& row) noexcept
  {
    if constexpr (std::is_same_v<Value, Real>)
      return row;
    else if constexpr (rest == Rest::identity)
      return Value::Identity() + row.template cast<Real>();
    else
      return row.template cast<Real>();
  }
  static Row<float> narrowed(const Value& row) noexcept
  {
    if constexpr (std::is_same_v<Value, Real>)
      return static_cast<float>(row);
    else if constexpr (rest == Rest::identity)
      return (row - Value::Identity()).template cast<float>();
    else
      return row.template cast<float>();
  }

 private:
  template <class From, class F>
  static auto converted(Rows<From>& from, F&& f)
  {
    Rows<decltype(f(from.front()))> to;
    to.reserve(from.size());
    for (const From& row : from)
      to.push_back(f(row));
    from = {};
    return to;
  }

  Rows<Value> full_;
  Rows<Row<float>> single_;
  bool is_single_ = false;
};

}  // namespace talus
