#pragma once
// How particles of a cell reach the nodes where values are the kernel's own and the gradient is that of the hats' operators.
#include "solver/transfer/direct_transfer.hpp"
#include "solver/transfer/projected_transfer.hpp"

namespace talus {

/// Mass, momentum and velocity through the weights of the stencil; tension and velocity gradient through the hats of the cell, whose
/// vertices are the first nodes of the stencil.  The affine moment of a row stays zero: weights carry it with the momentum.
template <int D, Kernel<D> K>
class MixedTransfer {
 public:
  using Sum = ProjectedNodeSum<D>;
  using Motion = ProjectedNodeMotion<D>;
  static constexpr bool has_apic = true;

  explicit MixedTransfer(const K& kernel) : kernel_(kernel) {}
  void enter(const Mesh<D>& mesh, Index c) noexcept { kernel_.open(mesh, c, cell_); }
  template <class S>
  void place(const ParticlePackOf<S>& pack, const Pack (&x)[D]) noexcept
  {
    kernel_.evaluate(cell_, x, pack.count, weights_);
    shares_ = shares_of<D>(cell_.slope, cell_.origin, x, pack.count);
  }

  void clear() noexcept
  {
    sums_.clear(cell_.padded_size);
    tension_.clear();
  }
  template <bool affine, bool loaded, bool forces, class S>
  void deposit(const Particles<D>& particles, const ParticlePackOf<S>& pack, const Pack (&)[D],
               const ParticleColumn<Mat<D>>& fields) noexcept
  {
    talus::deposit<affine, loaded, forces>(particles, pack, fields, cell_, weights_, Tension<D>{}, sums_);
    if constexpr (forces) {
      Pack tension[padded(Symmetric<D>::size)]{};
      tension_of(particles, pack, tension);
      tension_.template add<Symmetric<D>::size>(shares_, tension);
    }
  }
  template <bool affine, bool loaded, bool forces>
  void add_to(std::span<Sum> rows, std::span<const std::uint16_t> slots, float lightest) const noexcept
  {
    sums_.add_to(rows, slots, lightest);
    if constexpr (forces)
      for (std::size_t a = 0; a <= D; ++a)
        for (int k = 0; k < Symmetric<D>::size; ++k)
          rows[slots[a]].tension.entry[k] += tension_.of[a][k];
  }

  void read(const std::vector<Motion>& rows) noexcept
  {
    motion_.read(rows, cell_.nodes, cell_.padded_size);
    hats_ = hats_of(rows, cell_.nodes);
  }
  template <bool with_change, bool with_gradient, class S>
  Seen<D> see(const ParticlePackOf<S>& pack) const noexcept
  {
    Seen<D> seen = talus::see<with_change, false>(motion_, weights_, pack.count);
    if constexpr (with_gradient)
      see_gradient(hats_, shares_, seen);
    return seen;
  }
  Mat<D> apic_field(int lane, const Vec<D>& x, const Mat<D>& L) const noexcept
  {
    return talus::apic_field(cell_, motion_, weights_, lane, x, L);
  }

 private:
  const K& kernel_;
  typename K::Cell cell_;
  Weights<D, K::max_nodes> weights_;
  CornerWeights<D> shares_;
  CellSums<D, K::max_nodes> sums_;
  CornerSums<D, Symmetric<D>::size> tension_;
  CellMotion<D, K::max_nodes> motion_;
  std::array<ProjectedNodeMotion<D>, D + 1> hats_;
};

}  // namespace talus
