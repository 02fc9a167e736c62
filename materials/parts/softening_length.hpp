#pragma once
// Softening that does not depend on the mesh: strength follows a plastic strain that is averaged over a length of the material.
#include <limits>
#include <numbers>
#include <optional>
#include <tuple>
#include <variant>

#include "core/type_list.hpp"
#include "materials/parts/law.hpp"

namespace talus {

/// The kind of a law L whose `softening_length` l is given.  With the accumulated plastic strain p of a particle, the strength is that of
///     k = 2 m - p,    m - a^2 lap m = p,    a = 4/3 l
/// instead of that of p.  m is the implicit gradient average of Peerlings et al. 1996 (IJNME 39, 3391); alone it would let the shear band
/// collapse to a line, with weights 2 and -1 it does not (Vermeer & Brinkgreve 1994, "A new effective non-local strain measure for softening
/// plasticity").  While the strength falls linearly, a band is 2 pi l wide, as in the gradient plasticity of Aifantis with the length l.
/// Derivation: docs/theory/laws.md.  m is found by the solver (solver/stress/average_strain.hpp) and constant in the update of a particle.
template <class L>
struct WithSofteningLength : L {
  struct State : L::State {
    Real mean_plastic_strain = 0, mean_plastic_rate = 0;
    static constexpr auto fields()
    {
      return std::tuple_cat(
          L::State::fields(),
          std::tuple{history("mean_plastic_strain", &State::mean_plastic_strain, "-", "plastic strain averaged over the softening length"),
                     history("mean_plastic_rate", &State::mean_plastic_rate, "1/s", "rate of mean_plastic_strain")});
    }
  };

  /// k for a plastic strain and its mean.  The strain counts here as far as it does in the mean: otherwise k would fall, and the strength come
  /// back, where flow goes on.
  template <class T>
  T softened(const T& plastic_strain, const T& mean) const noexcept
  {
    using std::max, std::min;
    return max(T(2 * mean - min(plastic_strain, T(largest_averaged()))), T(0));
  }

  template <class T>
  Mat3Of<T> update(const IncrementOf<T>& in, StateOf<T, State>& state, const typename L::Constants& c) const noexcept
  {
    const T strain = softened<T>(get(state, &State::plastic_strain), get(state, &State::mean_plastic_strain));
    IncrementOf<T> with = in;
    with.softened_at = &strain;
    if constexpr (std::is_same_v<T, Real>) {
      return L::update(with, static_cast<typename L::State&>(state), c);
    } else {
      StateLanes<typename L::State> of_law{state.first, state.stride, state.count};
      return L::update(with, of_law, c);
    }
  }
  Real yield(const Mat3& stress, const State& state) const noexcept
  {
    return L::yield(stress, state, softened(state.plastic_strain, state.mean_plastic_strain));
  }

  static constexpr AveragedHistory<State> averaged_history() noexcept
  {
    return {&State::plastic_strain, &State::mean_plastic_strain, &State::mean_plastic_rate};
  }
  /// The length a of the average [m].
  Real averaging_length() const noexcept { return 4 * *L::softening_length / 3; }
  /// The width of a shear band while the strength falls [m].
  Real band_width() const noexcept { return 2 * std::numbers::pi * *L::softening_length; }
  /// What p counts at most in the average: its value in the middle of a band, 1 + sqrt(2) times k, when the softening ends.  Further flow
  /// softens no more material around the band.
  Real largest_averaged() const noexcept
  {
    return (1 + std::numbers::sqrt2) * L::softening_strain.value_or(std::numeric_limits<Real>::infinity());
  }
};

/// A law, or its kind with a softening length where that is given.
template <class L>
std::variant<L, WithSofteningLength<L>> kind_by_softening_length(const L& law)
{
  if (law.softening_length)
    return WithSofteningLength<L>{law};
  return law;
}

}  // namespace talus
