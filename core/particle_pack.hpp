#pragma once
// Particles four at a time: rows of the columns in the lanes of packs.
#include <span>

#include "core/particles.hpp"
#include "core/simd.hpp"

namespace talus {

/// Up to four particles, one per lane; their columns are stored in numbers of type S.
template <class S>
struct ParticlePackOf {
  std::size_t p[pack_size];  ///< rows; the last one is repeated if there are fewer than four
  int count;

  /// The pack of up to four of `rows` from `begin` on.
  ParticlePackOf(std::span<const Index> rows, std::size_t begin) noexcept
      : count(static_cast<int>(std::min<std::size_t>(pack_size, rows.size() - begin)))
  {
    for (std::size_t lane = 0; lane < pack_size; ++lane)
      p[lane] = static_cast<std::size_t>(rows[std::min(begin + lane, rows.size() - 1)]);
  }
  /// Calls f(p) for every lane.
  template <class F>
  Pack lanes(F&& f) const noexcept
  {
    return Pack{f(p[0]), f(p[1]), f(p[2]), f(p[3])};
  }

  /// The entries of a column for these particles: numbers, vectors or tensors.
  template <class Value, Rest rest>
  [[gnu::always_inline]] auto load(const ParticleColumn<Value, rest>& column) const noexcept
  {
    auto all = load(column.template rows<S>());
    if constexpr (rest == Rest::identity && std::is_same_v<S, float>)
      for (int i = 0; i < all.rows(); ++i)
        all(i, i) += 1;
    return all;
  }
  template <class Value, Rest rest>
  [[gnu::always_inline]] void store(const In<SimdReal, Value>& value, ParticleColumn<Value, rest>& column) const noexcept
  {
    if constexpr (rest == Rest::identity && std::is_same_v<S, float>)
      store(In<SimdReal, Value>(value - In<SimdReal, Value>::Identity()), column.template rows<S>());
    else
      store(value, column.template rows<S>());
  }
  template <class Row, class Allocator>
  [[gnu::always_inline]] auto load(const std::vector<Row, Allocator>& column) const noexcept
  {
    return load(column.data());
  }
  template <class Row>
  [[gnu::always_inline]] auto load(std::span<const Row> column) const noexcept
  {
    return load(column.data());
  }
  template <class Row, class Allocator>
  [[gnu::always_inline]] void store(const In<SimdReal, Row>& value, std::vector<Row, Allocator>& column) const noexcept
  {
    store(value, column.data());
  }
  /// The entry of one lane.
  template <class Value>
  [[gnu::always_inline]] Value of(int lane, const ParticleColumn<Value>& column) const noexcept
  {
    const auto& row = column.template rows<S>()[p[lane]];
    if constexpr (std::is_same_v<S, Real>)
      return row;
    else
      return ParticleColumn<Value>::widened(row);
  }

 private:
  template <class N>
  requires std::is_arithmetic_v<N>
  [[gnu::always_inline]] SimdReal load(const N* rows) const noexcept
  {
    return lanes([&](std::size_t row) { return static_cast<Real>(rows[row]); });
  }
  template <class N, int R, int C>
  [[gnu::always_inline]] Eigen::Matrix<SimdReal, R, C, Eigen::DontAlign> load(
      const Eigen::Matrix<N, R, C, Eigen::DontAlign>* rows) const noexcept
  {
    Eigen::Matrix<SimdReal, R, C, Eigen::DontAlign> all;
    Pack of[R * C];
    load_rows<R * C>({rows[p[0]].data(), rows[p[1]].data(), rows[p[2]].data(), rows[p[3]].data()}, of);
    for (int k = 0; k < R * C; ++k)
      all(k) = of[k];
    return all;
  }
  template <class N>
  requires std::is_arithmetic_v<N>
  [[gnu::always_inline]] void store(const SimdReal& value, N* rows) const noexcept
  {
    for (int lane = 0; lane < count; ++lane)
      rows[p[lane]] = static_cast<N>(value[lane]);
  }
  template <class N, int R, int C>
  [[gnu::always_inline]] void store(const Eigen::Matrix<SimdReal, R, C, Eigen::DontAlign>& value,
                                    Eigen::Matrix<N, R, C, Eigen::DontAlign>* rows) const noexcept
  {
    Pack of[R * C];
    for (int k = 0; k < R * C; ++k)
      of[k] = value(k).of;
    store_rows<R * C>(of, {rows[p[0]].data(), rows[p[1]].data(), rows[p[2]].data(), rows[p[3]].data()}, count);
  }
};
using ParticlePack = ParticlePackOf<Real>;

/// Calls f(S()) with the number type in which the particles are stored.
template <int D, class F>
decltype(auto) in_numbers_of(const Particles<D>& particles, F&& f)
{
  if (particles.precision() == Precision::single)
    return f(float());
  return f(Real());
}

/// Calls ask(p) once for each of `rows`, well before it is used, so that the memory can be prefetched.
template <class Ask>
class PrefetchRows {
 public:
  PrefetchRows(std::span<const Index> rows, Ask ask) : rows_(rows), ask_(std::move(ask)) {}
  /// Prefetches before the rows before `end` are used.
  void until(std::size_t end)
  {
    for (const std::size_t last = std::min(end + distance, rows_.size()); asked_ < last; ++asked_)
      ask_(static_cast<std::size_t>(rows_[asked_]));
  }

 private:
  static constexpr std::size_t distance = 32;
  std::span<const Index> rows_;
  Ask ask_;
  std::size_t asked_ = 0;
};
struct AskForNothing {
  void operator()(std::size_t) const noexcept {}
};

/// Prefetches the rows of a particle in some columns.
template <class S>
struct Prefetch {
  template <class... Columns>
  [[gnu::always_inline]] static void row(std::size_t p, const Columns&... columns) noexcept
  {
    (lines(first(columns) + p), ...);
  }

 private:
  template <class Value, Rest rest>
  static const auto* first(const ParticleColumn<Value, rest>& column) noexcept
  {
    return column.template rows<S>();
  }
  template <class Row, class Allocator>
  static const Row* first(const std::vector<Row, Allocator>& column) noexcept
  {
    return column.data();
  }
  /// The end of a row that does not fill a cache line is prefetched with the next row.
  template <class Row>
  static void lines(const Row* row) noexcept
  {
    constexpr std::size_t line = 64;
    for (std::size_t at = 0; at < sizeof(Row); at += line)
      __builtin_prefetch(reinterpret_cast<const char*>(row) + at);
  }
};

/// Calls f(pack) for all rows, four at a time, and ask(p) for each row before it is used.
template <class S = Real, class F, class Ask = AskForNothing>
void for_each_pack(std::span<const Index> rows, F&& f, Ask ask = {})
{
  PrefetchRows ahead(rows, ask);
  for (std::size_t begin = 0; begin < rows.size(); begin += pack_size) {
    ahead.until(begin + pack_size);
    f(ParticlePackOf<S>(rows, begin));
  }
}
/// Vectors and tensors of four particles.
template <int D>
using VecOf = Eigen::Matrix<SimdReal, D, 1, Eigen::DontAlign>;
template <int D>
using MatOf = Eigen::Matrix<SimdReal, D, D, Eigen::DontAlign>;

}  // namespace talus
