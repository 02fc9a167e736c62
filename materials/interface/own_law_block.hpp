#pragma once
// The arrays of a block of particles for a law behind talus_law.h.
#include <cstdint>
#include <span>
#include <vector>

#include "core/strip_column.hpp"
#include "materials/interface/talus_law.h"
#include "materials/parts/law.hpp"
#include "materials/parts/logarithm.hpp"

namespace talus {

/// Memory for a block of particles, which grows.
class OwnLawBlock {
 public:
  /// Prepares for `stride` particles, whole packs; with rotation and strain for laws of TALUS_LAW_STRAIN.
  void open(std::size_t stride, bool with_strain)
  {
    stride_ = stride;
    if (id_.size() < stride_)
      numbers_.resize(rows * stride_), id_.resize(stride_);
    with_strain_ = with_strain;
  }
  std::size_t stride() const noexcept { return stride_; }
  StripColumn<Mat3> F_old() noexcept { return {row(0), stride_}; }
  StripColumn<Mat3> F() noexcept { return {row(9), stride_}; }
  StripColumn<Mat3> L() noexcept { return {row(18), stride_}; }
  StripColumn<Mat3> rotation() noexcept { return {row(27), stride_}; }
  StripColumn<Sym3> strain() noexcept { return {row(36), stride_}; }
  StripColumn<Sym3> stress() noexcept { return {row(42), stride_}; }
  StripColumn<Real> bulk() noexcept { return {row(48), stride_}; }
  StripColumn<Real> shear() noexcept { return {row(49), stride_}; }
  StripColumn<Real> size() noexcept { return {row(50), stride_}; }
  StripColumn<Vec3> position() noexcept { return {row(51), stride_}; }
  std::int64_t* id() noexcept { return id_.data(); }

  /// A step of four particles.
  struct Step {
    Mat3Of<SimdReal> F_old, F, L, stress;  ///< as in Increment
    Real dt;
  };
  /// That of particles i to i + 3.  A particle that is inverted stands still there.  `history`, and the first numbers of the tensors in it that
  /// turn with the material; without strain nothing turns.
  void set_step(std::size_t i, Step step, const StripColumn<Real>& history, std::span<const int> turning) noexcept
  {
    const auto good = step.F.determinant() > 0 && step.F_old.determinant() > 0;
    if (!all_of(good))
      for (int k = 0; k < 9; ++k) {
        const Real unit = k % 4 == 0 ? 1 : 0;
        step.F_old(k) = where(good, step.F_old(k), unit), step.F(k) = where(good, step.F(k), unit), step.L(k) = where(good, step.L(k), 0);
      }
    put(F_old(), i, step.F_old), put(F(), i, step.F), put(L(), i, step.L);
    if (!with_strain_)
      return stress().store(i, pack(step.stress));
    const Mat3Of<SimdReal> H = SimdReal(step.dt) * step.L;
    const Sym3Of<SimdReal> increment = scale_and_shift(0.5, log1p(push_forward(H, Sym3Of<SimdReal>::Zero())), 0);
    const Mat3Of<SimdReal> R = unpack(add_diagonal(expm1(scale_and_shift(-1, increment, 0)), 1)) * (Mat3Of<SimdReal>::Identity() + H);
    strain().store(i, increment), put(rotation(), i, R);
    stress().store(i, pack(sym(R * step.stress * R.transpose())));
    for (const int first : turning) {
      const StripColumn<Sym3> tensor{history.component(first) + i, history.stride};
      tensor.store(0, pack(sym(R * unpack(tensor.load(0)) * R.transpose())));
    }
  }

  /// What the law reads and writes; the caller adds what is not an array.
  talus_law_block arrays(std::size_t n, const StripColumn<Real>& history) noexcept
  {
    talus_law_block block{};
    block.n = static_cast<std::int32_t>(n), block.stride = static_cast<std::ptrdiff_t>(stride_);
    block.id = id_.data(), block.position = position().first, block.size = size().first;
    block.F_old = F_old().first, block.F = F().first, block.L = L().first;
    block.rotation = with_strain_ ? rotation().first : nullptr, block.strain = with_strain_ ? strain().first : nullptr;
    block.stress = stress().first, block.history = history.first;
    block.bulk = bulk().first, block.shear = shear().first;
    return block;
  }

 private:
  static constexpr std::size_t rows = 54;
  /// Row by row, where matrices are stored by columns.
  static void put(const StripColumn<Mat3>& column, std::size_t i, const Mat3Of<SimdReal>& a) noexcept { column.store(i, a.transpose()); }
  Real* row(std::size_t number) noexcept { return numbers_.data() + number * stride_; }

  std::size_t stride_ = 0;
  bool with_strain_ = false;
  std::vector<Real> numbers_;
  std::vector<std::int64_t> id_;
};

}  // namespace talus
