#pragma once
// How particles of a cell reach the hats of its vertices, for a kernel with a node part: four particles side by side.
#include "kernels/linear.hpp"
#include "solver/bunch.hpp"
#include "solver/hats.hpp"

namespace talus {

/// Barycentric coordinates of four particles, one vertex per pack; zero in lanes beyond `count`.
template <int D>
struct Shares {
  Pack of[D + 1];
};
template <int D>
[[gnu::always_inline]] inline Shares<D> shares_of(const Real (&slope)[D][pack_size], const Vec<D>& centroid, const Pack (&x)[D],
                                                  int count) noexcept
{
  Pack there{};
  for (int lane = 0; lane < count; ++lane)
    there[lane] = 1;
  Shares<D> shares;
  for (int a = 0; a <= D; ++a) {
    Pack share = broadcast(1.0 / (D + 1));
    for (int d = 0; d < D; ++d)
      share += slope[d][a] * (x[d] - centroid[d]);
    shares.of[a] = share * there;
  }
  return shares;
}

/// V sigma shared among the vertices of the cell, summed over the particles of a run; lanes not yet added.
template <int D>
struct TensionSums {
  Pack of[D + 1][Symmetric<D>::size]{};

  [[gnu::always_inline]] void add(const Particles<D>& particles, const Bunch& bunch, const Shares<D>& shares) noexcept
  {
    const Pack volume = bunch.lanes([&](std::size_t p) { return particles.volume[p]; });
    for (int i = 0; i < D; ++i)
      for (int j = i; j < D; ++j) {
        const Pack T = volume * bunch.lanes([&](std::size_t p) { return particles.stress[p][Symmetric<3>::place(i, j)]; });
        for (int a = 0; a <= D; ++a)
          of[a][Symmetric<D>::place(i, j)] += shares.of[a] * T;
      }
  }
  void add_to(std::span<HatSum<D>> rows, std::span<const std::uint16_t> slots) const noexcept
  {
    for (std::size_t a = 0; a <= D; ++a)
      for (int i = 0; i < D; ++i)
        for (int j = 0; j < D; ++j)
          rows[slots[a]].tension(i, j) += sum(of[a][Symmetric<D>::place(i, j)]);
  }
};

/// Sums of the rest, alike.
template <int D>
struct HatSums {
  Pack mass[D + 1]{}, momentum[D + 1][D]{}, force[D + 1][D]{}, affine[D + 1][D][D]{};

  template <bool affinely, bool loaded, bool forces>
  void add_to(const typename Linear<D>::Cell& cell, std::span<HatSum<D>> rows, std::span<const std::uint16_t> slots,
              float lightest) const noexcept
  {
    for (int a = 0; a <= D; ++a) {
      HatSum<D>& row = rows[slots[static_cast<std::size_t>(a)]];
      row.lightest = std::min(row.lightest, lightest);
      Vec<D> arm;
      for (int d = 0; d < D; ++d)
        arm[d] = cell.x[d][a];
      if constexpr (forces) {
        row.mass += sum(mass[a]);
        row.gross += static_cast<float>(sum(mass[a]));
      }
      Mat<D> K = Mat<D>::Zero();
      for (int i = 0; i < D; ++i) {
        row.momentum[i] += sum(momentum[a][i]);
        if constexpr (loaded)
          row.force[i] += sum(force[a][i]);
        if constexpr (affinely)
          for (int j = 0; j < D; ++j)
            K(i, j) = sum(affine[a][i][j]);
      }
      if constexpr (affinely) {
        row.affine += K;
        row.momentum += K * arm;
      }
    }
  }
};

/// Adds a bunch, momentum about the origin of the cell: m (v - A (x - origin)).
template <bool affinely, bool loaded, bool forces, int D>
[[gnu::always_inline]] inline void deposit(const Particles<D>& particles, const Bunch& bunch, const std::vector<Mat<D>>& fields,
                                           const typename Linear<D>::Cell& cell, const Pack (&x)[D], const Shares<D>& shares,
                                           HatSums<D>& sums) noexcept
{
  const Pack m = bunch.lanes([&](std::size_t p) { return particles.mass[p]; });
  Pack momentum[D], A[D][D];
  for (int i = 0; i < D; ++i) {
    momentum[i] = bunch.lanes([&](std::size_t p) { return particles.v[p][i]; });
    if constexpr (affinely)
      for (int j = 0; j < D; ++j) {
        A[i][j] = bunch.lanes([&](std::size_t p) { return fields[p](i, j); });
        momentum[i] -= A[i][j] * (x[j] - cell.origin[j]);
        A[i][j] *= m;
      }
    momentum[i] *= m;
  }
  for (int a = 0; a <= D; ++a) {
    const Pack B = shares.of[a];
    if constexpr (forces)
      sums.mass[a] += B * m;
    for (int i = 0; i < D; ++i) {
      sums.momentum[a][i] += B * momentum[i];
      if constexpr (affinely)
        for (int j = 0; j < D; ++j)
          sums.affine[a][i][j] += B * A[i][j];
    }
  }
  if constexpr (loaded)
    for (int i = 0; i < D; ++i) {
      const Pack f = bunch.lanes([&](std::size_t p) { return particles.applied[p][i]; });
      for (int a = 0; a <= D; ++a)
        sums.force[a][i] += shares.of[a] * f;
    }
}

/// What four particles see of the hats of their cell.
template <bool with_change, int D>
[[gnu::always_inline]] inline void see_velocity(const std::array<HatMotion<D>, D + 1>& hats, const Shares<D>& shares,
                                                Seen<D>& seen) noexcept
{
  for (int i = 0; i < D; ++i) {
    seen.v[i] = seen.change[i] = Pack{};
    for (int a = 0; a <= D; ++a) {
      seen.v[i] += shares.of[a] * hats[static_cast<std::size_t>(a)].v[i];
      if constexpr (with_change)
        seen.change[i] += shares.of[a] * hats[static_cast<std::size_t>(a)].change[i];
    }
  }
}
template <int D>
[[gnu::always_inline]] inline void see_gradient(const std::array<HatMotion<D>, D + 1>& hats, const Shares<D>& shares,
                                                Seen<D>& seen) noexcept
{
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j) {
      seen.L[i][j] = Pack{};
      for (int a = 0; a <= D; ++a)
        seen.L[i][j] += shares.of[a] * hats[static_cast<std::size_t>(a)].L(i, j);
    }
}

/// The motion of the hats of a cell.
template <int D>
std::array<HatMotion<D>, D + 1> hats_of(const std::vector<HatMotion<D>>& hats, std::span<const Index> nodes) noexcept
{
  std::array<HatMotion<D>, D + 1> here;
  for (std::size_t a = 0; a <= D; ++a)
    here[a] = hats[static_cast<std::size_t>(nodes[a])];
  return here;
}

/// The cell at hand, its particles' barycentric coordinates, and the sums of a run.  Lives on the stack of a thread.
template <int D, Kernel<D> K>
class ThroughHats {
 public:
  using Sum = HatSum<D>;
  using Motion = HatMotion<D>;
  static constexpr bool has_apic = false;

  explicit ThroughHats(const K& kernel) : kernel_(kernel) {}
  void enter(const Mesh<D>& mesh, Index c) noexcept { kernel_.open(mesh, c, cell_); }
  void place(const Bunch& bunch, const Pack (&x)[D]) noexcept { shares_ = shares_of<D>(cell_.dw, cell_.origin, x, bunch.count); }

  void clear() noexcept
  {
    sums_ = {};
    tension_ = {};
  }
  template <bool affine, bool loaded, bool forces>
  void deposit(const Particles<D>& particles, const Bunch& bunch, const Pack (&x)[D], const std::vector<Mat<D>>& fields) noexcept
  {
    talus::deposit<affine, loaded, forces>(particles, bunch, fields, cell_, x, shares_, sums_);
    if constexpr (forces)
      tension_.add(particles, bunch, shares_);
  }
  template <bool affine, bool loaded, bool forces>
  void add_to(std::span<HatSum<D>> rows, std::span<const std::uint16_t> slots, float lightest) const noexcept
  {
    sums_.template add_to<affine, loaded, forces>(cell_, rows, slots, lightest);
    if constexpr (forces)
      tension_.add_to(rows, slots);
  }

  void read(const std::vector<HatMotion<D>>& hats) noexcept { motion_ = hats_of(hats, cell_.nodes); }
  template <bool with_change, bool with_gradient>
  Seen<D> see(const Bunch&) const noexcept
  {
    Seen<D> seen;
    see_velocity<with_change>(motion_, shares_, seen);
    if constexpr (with_gradient)
      see_gradient(motion_, shares_, seen);
    return seen;
  }

 private:
  const K& kernel_;
  typename K::Cell cell_;
  Shares<D> shares_;
  HatSums<D> sums_;
  TensionSums<D> tension_;
  std::array<HatMotion<D>, D + 1> motion_;
};

}  // namespace talus
