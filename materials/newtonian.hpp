#pragma once
// Water, oil and slurry: a weakly compressible fluid of constant viscosity.
#include <string_view>

#include "materials/parts/weakly_compressible.hpp"

namespace talus {

/// stress = -p(J) I + 2 mu dev(D) + zeta tr(D) I.        [Landau & Lifshitz, Fluid Mechanics, section 15]
/// Without tension the mean stress never exceeds zero.  The viscous stress is constant over a step: the method is explicit in the
/// viscosity, which limits the step through diffusivity().
struct Newtonian : WeaklyCompressible {
  static constexpr std::string_view name = "newtonian";
  static constexpr std::string_view summary =
      "Weakly compressible fluid of constant viscosity, stress = -p I + 2 mu dev(D), p = (K / n) (J^-n - 1) (Monaghan 1994).";
  Real viscosity{}, volume_viscosity = 0;
  static constexpr auto fields()
  {
    return std::tuple_cat(
        fluid_fields<Newtonian>(),
        std::tuple{required("viscosity", &Newtonian::viscosity, non_negative, "Pa s", "dynamic viscosity mu; 0 for an inviscid fluid"),
                   optional("volume_viscosity", &Newtonian::volume_viscosity, non_negative, "Pa s",
                            "viscosity zeta against change of volume, apart from that of shear")});
  }
  using State = FluidHistory;
  /// Empty: the law has nothing to compute in advance.
  struct Constants {};
  Constants constants() const noexcept { return {}; }

  template <class T>
  Mat3Of<T> update(const IncrementOf<T>& in, StateOf<T, State>& state, const Constants& c) const noexcept
  {
    using std::min;
    const T J = in.F.determinant();
    if (!all_of(J > 0))
      return no_answer_somewhere(*this, in, state, c);
    const Sym3Of<T> D = rate_of_deformation(in);
    const T growth = trace(D), p = pressure<T>(J, in.elastic);
    T resistance = volume_viscosity * growth;
    if (!(tension || in.elastic))
      resistance = min(resistance, p);
    const Sym3Of<T> shear = add_diagonal(D, -growth / 3);
    const T work = J * in.dt * (2 * viscosity * squared_norm(shear) + resistance * growth);
    put(state, &State::plastic_work, T(get(state, &State::plastic_work) + work));
    return unpack(scale_and_shift(2 * viscosity, shear, resistance - p));
  }
  template <class T>
  T wave_speed(const Mat3Of<T>& F, const Constants&) const noexcept
  {
    return sound_speed<T>(F.determinant());
  }
  /// The diffusivity of a compression wave, (4/3 mu + zeta) / density [m^2/s].
  Real diffusivity(const Constants&) const noexcept { return (4 * viscosity / 3 + volume_viscosity) / density; }
};

}  // namespace talus
