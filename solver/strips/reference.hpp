#pragma once
// Reference configurations: the kernel weighs a particle where it was when its body was last renewed, not where it is.
#include <limits>

#include "core/tensor.hpp"
#include "solver/options/reference_options.hpp"
#include "solver/strips/strip.hpp"

namespace talus {

// A-ULMPM (Su, Xue, Han, Jiang and Aanjaneya 2022, arXiv 2108.00388) with the operators of Talus.  A particle at x has a reference position X,
// and G = dx/dX.  Weights, cells and the affine field belong to X.  With H = dv/dX, of the nodes,
//
//     G <- G + dt H          L = H G^-1          Z_n = sum N_n V sigma G^-T          (x and v as ever)
//
// so that F <- (I + dt L) F keeps F = G F_r to rounding, with F_r that of the reference.  Renewed: X = x, C <- C G^-1, G = I.  Always renewed,
// this is the updated Lagrangian form; never renewed, the total Lagrangian one.  A body is renewed in one piece: beside a part that has been
// renewed and lies apart from its neighbours by a tenth of a cell, a disk loses its spin within twenty turns.

/// V sigma G^-T of particles i to i + 3 [N m].
template <int D>
[[gnu::always_inline]] inline MatOf<D> pulled_back_tension(const StripColumns<D>& columns, std::size_t i) noexcept
{
  const MatOf<D> tension = columns.volume.load(i) * unpack(columns.stress.load(i)).template topLeftCorner<D, D>();
  const MatOf<D> inverse = columns.G.load(i).inverse();
  return tension.lazyProduct(inverse.transpose());
}

/// Multiplies V sigma of particle p by G^-T, if there are references.
template <int D>
void pull_back(const StripColumns<D>& columns, std::size_t p, Mat<D>& tension) noexcept
{
  if (columns.G)
    tension = (tension * columns.G.of(p).inverse().transpose()).eval();
}
/// V sigma of particle p, pulled back to its reference [N m].
template <int D>
Mat<D> tension_of(const StripColumns<D>& columns, std::size_t p) noexcept
{
  Mat<D> tension = columns.volume.of(p) * unpack(columns.stress.of(p)).template topLeftCorner<D, D>();
  pull_back(columns, p, tension);
  return tension;
}

/// L of the first n particles has been taken with respect to reference positions: makes it that of the present ones, and moves G with it.
template <int D>
void follow_motion(const StripColumns<D>& columns, std::size_t n, Real dt) noexcept
{
  columns.G.pad(n), columns.L.pad(n);
  for (std::size_t i = 0; i < n; i += pack_size) {
    const MatOf<D> H = columns.L.load(i), G = columns.G.load(i), inverse = G.inverse();
    columns.L.store(i, H.lazyProduct(inverse));
    columns.G.store(i, G + SimdReal(dt) * H);
  }
}

/// The largest entries of |G^T G - I| / 2 of particles i to i + 3: Green's strain since the reference.
template <int D>
[[gnu::always_inline]] inline SimdReal distortion(const StripColumns<D>& columns, std::size_t i) noexcept
{
  const MatOf<D> G = columns.G.load(i);
  const MatOf<D> twice_strain = MatOf<D>(G.transpose().lazyProduct(G)) - MatOf<D>::Identity();
  SimdReal most(0.0);
  for (int k = 0; k < D * D; ++k)
    most = max(most, abs(twice_strain(k)));
  return SimdReal(0.5) * most;
}

/// What `adaptive` limits: the distortion, or |det G - 1|.
template <int D>
[[gnu::always_inline]] inline SimdReal strain_since(const ReferenceOptions& options, const StripColumns<D>& columns, std::size_t i) noexcept
{
  if (!options.volume_change)
    return distortion(columns, i);
  return abs(columns.G.load(i).determinant() - SimdReal(1.0));
}

/// Whether one of particles [begin, end) of a strip, in a cell of this altitude [m], has strained too much or is too far from its reference.
template <int D>
bool is_due(const ReferenceOptions& options, const StripColumns<D>& columns, std::size_t begin, std::size_t end, Real altitude) noexcept
{
  const Real reach = options.shift ? *options.shift * altitude : std::numeric_limits<Real>::infinity();
  for (std::size_t i = begin; i < end; i += pack_size) {
    const VecOf<D> shift = columns.x.load(i) - columns.reference.load(i);
    const SimdReal::Mask beyond =
        strain_since(options, columns, i) > SimdReal(options.largest_strain()) || shift.squaredNorm() > SimdReal(reach * reach);
    for (std::size_t lane = 0; lane < pack_size && i + lane < end; ++lane)
      if (beyond[static_cast<int>(lane)])
        return true;
  }
  return false;
}

/// Multiplies the altitudes of the first n particles by their least stretch since the reference, or less: by row sums of (G G^T)^-1
/// (Gershgorin).  A wave crosses a cell of the reference in that share of the time.
template <int D>
void shorten(const StripColumns<D>& columns, std::size_t n, Real* altitude) noexcept
{
  for (std::size_t i = 0; i < n; i += pack_size) {
    const MatOf<D> inverse = columns.G.load(i).inverse();
    const MatOf<D> B = inverse.transpose().lazyProduct(inverse);
    SimdReal most(0.0);
    for (int r = 0; r < D; ++r) {
      SimdReal sum = abs(B(r, 0));
      for (int c = 1; c < D; ++c)
        sum += abs(B(r, c));
      most = max(most, sum);
    }
    store_loose(altitude + i, (SimdReal(load_loose(altitude + i)) / sqrt(most)).of);
  }
}

/// Makes the present configuration of the first n particles their reference.
template <int D>
void renew(const StripColumns<D>& columns, std::size_t n) noexcept
{
  for (std::size_t i = 0; i < n; ++i) {
    if (columns.C)
      columns.C.set(i, columns.C.of(i) * columns.G.of(i).inverse());
    columns.G.set(i, Mat<D>::Identity());
    columns.reference.set(i, columns.x.of(i));
  }
}

}  // namespace talus
