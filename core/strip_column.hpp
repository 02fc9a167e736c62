#pragma once
// Columns of a few particles that stand side by side: each component of a number, vector or tensor is an array of its own, so that a pack
// is loaded from consecutive addresses.
#include <bit>
#include <cstdint>

#include "core/particle_column.hpp"
#include "core/simd.hpp"
#include "core/tensor.hpp"

namespace talus {

/// Vectors and tensors of four particles.
template <int D>
using VecOf = Eigen::Matrix<SimdReal, D, 1, Eigen::DontAlign>;
template <int D>
using MatOf = Eigen::Matrix<SimdReal, D, D, Eigen::DontAlign>;

/// A column of a strip: component c of particle i stands at first[c * stride + i].  Empty where the scene does not have it.
template <class Value>
struct StripColumn {
  static constexpr int components = ParticleColumn<Value>::components;

  Real* first = nullptr;
  std::size_t stride = 0;  ///< room for particles

  explicit operator bool() const noexcept { return first != nullptr; }
  Real* component(int c) const noexcept { return first + static_cast<std::size_t>(c) * stride; }

  /// Particles i to i + 3, one per lane.
  [[gnu::always_inline]] With<SimdReal, Value> load(std::size_t i) const noexcept
  {
    With<SimdReal, Value> all;
    if constexpr (components == 1)
      all = load_loose(first + i);
    else
      for (int c = 0; c < components; ++c)
        all(c) = load_loose(component(c) + i);
    return all;
  }
  [[gnu::always_inline]] void store(std::size_t i, const With<SimdReal, Value>& value) const noexcept
  {
    if constexpr (components == 1)
      store_loose(first + i, value.of);
    else
      for (int c = 0; c < components; ++c)
        store_loose(component(c) + i, value(c).of);
  }
  /// Repeats particle n - 1 behind it, so that the last pack is whole.  A law may choose its formulas by all lanes of a pack.
  void pad(std::size_t n) const noexcept
  {
    for (int c = 0; c < components; ++c)
      for (std::size_t i = n; i % pack_size != 0; ++i)
        component(c)[i] = component(c)[n - 1];
  }
  Value of(std::size_t i) const noexcept
  {
    if constexpr (components == 1) {
      return first[i];
    } else {
      Value one;
      for (int c = 0; c < components; ++c)
        one(c) = component(c)[i];
      return one;
    }
  }
  void set(std::size_t i, const Value& value) const noexcept
  {
    if constexpr (components == 1)
      first[i] = value;
    else
      for (int c = 0; c < components; ++c)
        component(c)[i] = value(c);
  }
};

/// Ids in an array of numbers, which have their bits.
struct StripIds {
  const Real* first = nullptr;
  std::int64_t operator[](std::size_t i) const noexcept { return id_of(first[i]); }
  static std::int64_t id_of(const Real& number) noexcept { return std::bit_cast<std::int64_t>(number); }
};

}  // namespace talus
