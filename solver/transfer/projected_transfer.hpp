#pragma once
// Transfer between the particles of a cell and the linear shape functions of its vertices, for a kernel with node operators: four particles
// at a time.
#include "kernels/linear.hpp"
#include "solver/state/interpolated.hpp"
#include "solver/transfer/projected_nodes.hpp"

namespace talus {

/// Barycentric coordinates of four particles at x [m] in a cell, one vertex per pack.
template <int D>
[[gnu::always_inline]] inline void barycentric_coordinates(const Real (&slope)[D][pack_size], const Vec<D>& centroid, const Pack (&x)[D],
                                                           Pack (&of)[D + 1]) noexcept
{
  for (int a = 0; a <= D; ++a) {
    of[a] = broadcast(1.0 / (D + 1));
    for (int d = 0; d < D; ++d)
      of[a] += slope[d][a] * (x[d] - centroid[d]);
  }
}

/// Barycentric coordinates of four particles, one vertex per pack; zero in lanes beyond `count`.
template <int D>
struct CornerWeights {
  Pack of[D + 1];
};
template <int D>
[[gnu::always_inline]] inline CornerWeights<D> shares_of(const Real (&slope)[D][pack_size], const Vec<D>& centroid, const Pack (&x)[D],
                                                         int count) noexcept
{
  Pack there{};
  for (int lane = 0; lane < count; ++lane)
    there[lane] = 1;
  CornerWeights<D> shares;
  barycentric_coordinates<D>(slope, centroid, x, shares.of);
  for (Pack& share : shares.of)
    share *= there;
  return shares;
}

/// Sums over the particles of a cell batch, on each vertex of their cell, of up to `most` quantities times the shape function.
template <int D, int most>
struct CornerSums {
  alignas(64) Real of[D + 1][padded(most)];

  void clear() noexcept { std::fill_n(of[0], (D + 1) * padded(most), 0.0); }
  /// Adds the first n quantities of four particles, one per lane, and overwrites them.  They are transposed to packs of four quantities of
  /// one particle, so that the sums stay in registers and no sum across lanes is needed at the end.
  template <int n>
  [[gnu::always_inline]] inline void add(const CornerWeights<D>& shares, Pack (&quantities)[padded(n)]) noexcept
  {
    constexpr int packs = padded(n) / pack_size;
    for (int k = 0; k < packs; ++k) {
      Pack* const four = quantities + k * pack_size;
      transpose(four[0], four[1], four[2], four[3]);
    }
    for (int a = 0; a <= D; ++a) {
      Pack sums[packs];
      for (int k = 0; k < packs; ++k)
        sums[k] = load(of[a] + k * pack_size);
      for (int lane = 0; lane < pack_size; ++lane) {
        const Pack share = broadcast(shares.of[a][lane]);
        for (int k = 0; k < packs; ++k)
          sums[k] += share * quantities[k * pack_size + lane];
      }
      for (int k = 0; k < packs; ++k)
        store(of[a] + k * pack_size, sums[k]);
    }
  }
};

/// V sigma of four particles [N m].
template <int D>
[[gnu::always_inline]] inline void tension_of(const Particles<D>& particles, const ParticlePack& pack, Pack* to) noexcept
{
  const Pack volume = pack.load(particles.volume).of;
  const Sym3Of<SimdReal> stress = pack.load(particles.stress);
  for (int i = 0; i < D; ++i)
    for (int j = i; j < D; ++j)
      to[Symmetric<D>::place(i, j)] = volume * stress[Symmetric<3>::place(i, j)].of;
}

/// The contributions of the particles of a cell batch, in this order: momentum, m A if `affine`, mass and V sigma if `forces`, load if
/// `loaded`.
template <int D, bool affine, bool loaded, bool forces>
struct Deposit {
  static constexpr int field = D, mass = field + (affine ? D * D : 0), tension = mass + (forces ? 1 : 0),
                       load = tension + (forces ? Symmetric<D>::size : 0), size = load + (loaded ? D : 0);
};
template <int D>
using HatSums = CornerSums<D, Deposit<D, true, true, true>::size>;

/// Adds a pack, with the momentum about the origin of the cell: m (v - A x), where x is the position, relative to the origin, of the centre
/// of the particles' weights.
template <bool affine, bool loaded, bool forces, int D>
[[gnu::always_inline]] inline void deposit(const Particles<D>& particles, const ParticlePack& pack, const ParticleColumn<Mat<D>>& fields,
                                           const Pack (&x)[D], const CornerWeights<D>& shares, HatSums<D>& sums) noexcept
{
  using Of = Deposit<D, affine, loaded, forces>;
  Pack quantities[padded(Of::size)]{};
  const Pack m = pack.load(particles.mass).of;
  const VecOf<D> v = pack.load(particles.v);
  for (int i = 0; i < D; ++i)
    quantities[i] = v[i].of;
  if constexpr (affine) {
    const MatOf<D> A = pack.load(fields);
    for (int j = 0; j < D; ++j)
      for (int i = 0; i < D; ++i) {
        quantities[i] -= A(i, j).of * x[j];
        quantities[Of::field + j * D + i] = m * A(i, j).of;
      }
  }
  for (int i = 0; i < D; ++i)
    quantities[i] *= m;
  if constexpr (forces) {
    quantities[Of::mass] = m;
    tension_of(particles, pack, quantities + Of::tension);
  }
  if constexpr (loaded) {
    const VecOf<D> f = pack.load(particles.applied);
    for (int i = 0; i < D; ++i)
      quantities[Of::load + i] = f[i].of;
  }
  sums.template add<Of::size>(shares, quantities);
}

/// to[i] += from[i] for n numbers at any addresses.
template <int n>
[[gnu::always_inline]] inline void add_numbers(const Real* from, Real* to) noexcept
{
  int i = 0;
  for (; i + pack_size <= n; i += pack_size)
    store_loose(to + i, load_loose(to + i) + load_loose(from + i));
  for (; i < n; ++i)
    to[i] += from[i];
}

/// Adds the sums of a cell batch to the rows of its block.  `arms`: centres of the linear shape functions relative to the origin of the
/// cell [m].
template <bool affine, bool loaded, bool forces, int D, int most>
void add_to(const CornerSums<D, most>& sums, const std::array<Vec<D>, D + 1>& arms, std::span<ProjectedNodeSum<D>> rows,
            std::span<const std::uint16_t> slots, float lightest) noexcept
{
  using Of = Deposit<D, affine, loaded, forces>;
  for (std::size_t a = 0; a <= D; ++a) {
    ProjectedNodeSum<D>& row = rows[slots[a]];
    const Real* const of = sums.of[a];
    row.lightest = std::min(row.lightest, lightest);
    row.momentum += Eigen::Map<const Vec<D>>(of);
    if constexpr (affine) {
      add_numbers<D * D>(of + Of::field, row.affine.data());
      for (int j = 0; j < D; ++j)
        for (int i = 0; i < D; ++i)
          row.momentum[i] += of[Of::field + j * D + i] * arms[a][j];
    }
    if constexpr (forces) {
      row.mass += of[Of::mass];
      add_numbers<Symmetric<D>::size>(of + Of::tension, row.tension.entry);
    }
    if constexpr (loaded)
      row.force += Eigen::Map<const Vec<D>>(of + Of::load);
  }
}

/// Values of the linear shape functions of a cell interpolated to four particles.
template <bool with_change, int D>
[[gnu::always_inline]] inline void see_velocity(const std::array<ProjectedNodeMotion<D>, D + 1>& projected, const CornerWeights<D>& shares,
                                                Interpolated<D>& seen) noexcept
{
  for (int i = 0; i < D; ++i) {
    seen.v[i] = seen.change[i] = Pack{};
    for (int a = 0; a <= D; ++a) {
      seen.v[i] += shares.of[a] * projected[static_cast<std::size_t>(a)].v[i];
      if constexpr (with_change)
        seen.change[i] += shares.of[a] * projected[static_cast<std::size_t>(a)].change[i];
    }
  }
}
template <int D>
[[gnu::always_inline]] inline void see_gradient(const std::array<ProjectedNodeMotion<D>, D + 1>& projected, const CornerWeights<D>& shares,
                                                Interpolated<D>& seen) noexcept
{
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j) {
      seen.L[i][j] = Pack{};
      for (int a = 0; a <= D; ++a)
        seen.L[i][j] += shares.of[a] * projected[static_cast<std::size_t>(a)].L(i, j);
    }
}

/// The motion of the linear shape functions of a cell.
template <int D>
std::array<ProjectedNodeMotion<D>, D + 1> motions_of(const std::vector<ProjectedNodeMotion<D>>& projected,
                                                     std::span<const Index> nodes) noexcept
{
  std::array<ProjectedNodeMotion<D>, D + 1> here;
  for (std::size_t a = 0; a <= D; ++a)
    here[a] = projected[static_cast<std::size_t>(nodes[a])];
  return here;
}

/// The open cell, the barycentric coordinates of its particles, and the sums of a cell batch.  Lives on the stack of a thread.
template <int D, Kernel<D> K>
class ProjectedTransfer {
 public:
  using Sum = ProjectedNodeSum<D>;
  using Motion = ProjectedNodeMotion<D>;
  static constexpr bool has_apic = false;

  explicit ProjectedTransfer(const K& kernel) : kernel_(kernel) {}
  void enter(const Mesh<D>& mesh, Index c) noexcept
  {
    kernel_.open(mesh, c, cell_);
    for (std::size_t a = 0; a <= D; ++a)
      arms_[a] = kernel_.node_operators().centre(cell_.nodes[a]) - cell_.origin;
  }
  void place(const ParticlePack& pack, const Pack (&x)[D]) noexcept { shares_ = shares_of<D>(cell_.dw, cell_.origin, x, pack.count); }

  void clear() noexcept { sums_.clear(); }
  template <bool affine, bool loaded, bool forces>
  void deposit(const Particles<D>& particles, const ParticlePack& pack, const Pack (&)[D], const ParticleColumn<Mat<D>>& fields) noexcept
  {
    Pack x[D]{};  // sum B c: values are read and passed on about the same position
    for (int a = 0; a <= D; ++a)
      for (int d = 0; d < D; ++d)
        x[d] += shares_.of[a] * arms_[static_cast<std::size_t>(a)][d];
    talus::deposit<affine, loaded, forces>(particles, pack, fields, x, shares_, sums_);
  }
  template <bool affine, bool loaded, bool forces>
  void add_to(std::span<ProjectedNodeSum<D>> rows, std::span<const std::uint16_t> slots, float lightest) const noexcept
  {
    talus::add_to<affine, loaded, forces>(sums_, arms_, rows, slots, lightest);
  }

  void read(const std::vector<ProjectedNodeMotion<D>>& projected) noexcept { motion_ = motions_of(projected, cell_.nodes); }
  template <bool with_change, bool with_gradient>
  Interpolated<D> see(const ParticlePack&) const noexcept
  {
    Interpolated<D> seen;
    see_velocity<with_change>(motion_, shares_, seen);
    if constexpr (with_gradient)
      see_gradient(motion_, shares_, seen);
    return seen;
  }

 private:
  const K& kernel_;
  typename K::Cell cell_;
  std::array<Vec<D>, D + 1> arms_;  ///< centres of the linear shape functions relative to the origin [m]
  CornerWeights<D> shares_;
  HatSums<D> sums_;
  std::array<ProjectedNodeMotion<D>, D + 1> motion_;
};

}  // namespace talus
