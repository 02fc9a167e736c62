#pragma once
// Particles four at a time: rows of the columns in the lanes of packs.
#include <span>

#include "core/particles.hpp"
#include "core/simd.hpp"

namespace talus {

/// Up to four particles, one per lane.
struct ParticlePack {
  std::size_t p[pack_size];  ///< rows; the last one is repeated if there are fewer than four
  int count;
  const Index* listed;  ///< address of the first of these rows in their list; CellOrder derives positions from it

  /// The pack of up to four of `rows` from `begin` on.
  ParticlePack(std::span<const Index> rows, std::size_t begin) noexcept
      : count(static_cast<int>(std::min<std::size_t>(pack_size, rows.size() - begin))), listed(rows.data() + begin)
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
  template <class Value>
  [[gnu::always_inline]] With<SimdReal, Value> load(const ParticleColumn<Value>& column) const noexcept
  {
    constexpr int n = ParticleColumn<Value>::components;
    With<SimdReal, Value> all;
    const auto take = [&](int c, const Pack& of) __attribute__((always_inline)) { component(all, c) = of; };
    load_rows<n>({column.row_at(p[0]), column.row_at(p[1]), column.row_at(p[2]), column.row_at(p[3])}, take);
    return all;
  }
  template <class Value>
  [[gnu::always_inline]] void store(const With<SimdReal, Value>& value, ParticleColumn<Value>& column) const noexcept
  {
    constexpr int n = ParticleColumn<Value>::components;
    const auto give = [&](int c) __attribute__((always_inline)) { return component(value, c).of; };
    store_rows<n>(give, {column.row_at(p[0]), column.row_at(p[1]), column.row_at(p[2]), column.row_at(p[3])}, count);
  }
  [[gnu::always_inline]] SimdReal load(std::span<const Real> column) const noexcept
  {
    return lanes([&](std::size_t row) { return column[row]; });
  }
  /// The entry of one lane.
  template <class Value>
  [[gnu::always_inline]] Value of(int lane, const ParticleColumn<Value>& column) const noexcept
  {
    return column[p[lane]];
  }

 private:
  [[gnu::always_inline]] static auto& component(auto& one, int) noexcept { return one; }
  template <class T, int R, int C>
  [[gnu::always_inline]] static T& component(Eigen::Matrix<T, R, C, Eigen::DontAlign>& all, int c) noexcept
  {
    return all(c);
  }
  template <class T, int R, int C>
  [[gnu::always_inline]] static const T& component(const Eigen::Matrix<T, R, C, Eigen::DontAlign>& all, int c) noexcept
  {
    return all(c);
  }
};

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

/// Prefetches the rows of a particle in some columns.  The end of a row that does not fill a cache line is prefetched with the next row.
template <class... Values>
[[gnu::always_inline]] inline void prefetch_row(std::size_t p, const ParticleColumn<Values>&... columns) noexcept
{
  constexpr int numbers_in_line = 64 / sizeof(Real);
  const auto lines = [p](const auto& column) {
    for (int c = 0; c < std::decay_t<decltype(column)>::components; c += numbers_in_line)
      __builtin_prefetch(column.row_at(p) + c);
  };
  (lines(columns), ...);
}

/// Calls f(pack) for all rows, four at a time.
template <class F>
void for_each_pack(std::span<const Index> rows, F&& f)
{
  for (std::size_t begin = 0; begin < rows.size(); begin += pack_size)
    f(ParticlePack(rows, begin));
}
/// Vectors and tensors of four particles.
template <int D>
using VecOf = Eigen::Matrix<SimdReal, D, 1, Eigen::DontAlign>;
template <int D>
using MatOf = Eigen::Matrix<SimdReal, D, D, Eigen::DontAlign>;

}  // namespace talus
