#pragma once
// Particles of a cell, four at a time, and the nodal values interpolated to them.
#include <span>

#include "core/particles.hpp"
#include "kernels/pack.hpp"
#include "solver/state/cell_order.hpp"

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
void for_each_bunch(std::span<const Index> rows, F&& f, Ask ask = {})
{
  PrefetchRows ahead(rows, ask);
  for (std::size_t begin = 0; begin < rows.size(); begin += pack_size) {
    ahead.until(begin + pack_size);
    f(ParticlePackOf<S>(rows, begin));
  }
}
/// Calls f(pack, x) for the particles of a cell batch, four at a time.
template <class S, int D, class F>
void for_each_placed_bunch(std::span<const Index> run, const Rows<Vec<D>>& places, F&& f)
{
  for_each_bunch<S>(run, [&](const ParticlePackOf<S>& pack) {
    Pack x[D];
    const auto place = pack.load(places);
    for (int d = 0; d < D; ++d)
      x[d] = place[d].of;
    f(pack, std::as_const(x));
  });
}

/// Nodal values interpolated to four particles.
template <int D>
struct Seen {
  Pack v[D], change[D];  ///< sum w v,  sum w change  [m/s]
  Pack L[D][D];          ///< sum v (x) G  [1/s]
};

/// Vectors and tensors of four particles.
template <int D>
using VecOf = Eigen::Matrix<SimdReal, D, 1, Eigen::DontAlign>;
template <int D>
using MatOf = Eigen::Matrix<SimdReal, D, D, Eigen::DontAlign>;
template <int D>
VecOf<D> vector_of(const Pack (&v)[D]) noexcept
{
  VecOf<D> all;
  for (int i = 0; i < D; ++i)
    all[i] = v[i];
  return all;
}
template <int D>
MatOf<D> matrix_of(const Pack (&L)[D][D]) noexcept
{
  MatOf<D> all;
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j)
      all(i, j) = L[i][j];
  return all;
}

}  // namespace talus
