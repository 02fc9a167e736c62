#pragma once
// Common parts of fluids: pressure from volume, and a rate of deformation that is zero for a rotation.
#include <algorithm>
#include <cmath>
#include <type_traits>

#include "materials/parts/law.hpp"
#include "materials/parts/logarithm.hpp"

namespace talus {

/// The pressure of a nearly incompressible liquid, which fluids inherit.
///     p = K / n (J^-n - 1)       [Cole 1948, Underwater Explosions, eq. 2.17; Monaghan 1994, J. Comput. Phys. 110, 399]
/// K may be far below that of the liquid as long as c = sqrt(K / density) is ten times the largest velocity: then J stays within 1 %.
struct WeaklyCompressible {
  Real density{}, bulk_modulus{}, exponent = 7;
  bool tension = false;

  /// The pressure [Pa] at the volume ratio J, negative in tension; `elastic` switches the limit at zero off.
  template <class T = Real>
  T pressure(const std::type_identity_t<T>& J, bool elastic) const noexcept
  {
    using std::max, std::pow;
    const T p = bulk_modulus / exponent * (pow(J, -exponent) - 1);
    return tension || elastic ? p : max(p, T(0));
  }
  /// The speed of sound sqrt(dp / d density) [m/s], without the limit at zero.
  template <class T = Real>
  T sound_speed(const std::type_identity_t<T>& J) const noexcept
  {
    using std::pow, std::sqrt;
    return sqrt(T(bulk_modulus / density * pow(J, 1 - exponent)));
  }
};

/// The fields of a law that inherits WeaklyCompressible, to be joined with its own by std::tuple_cat.
template <class Law>
constexpr auto fluid_fields()
{
  constexpr auto real = [](Real Law::*member) { return member; };
  constexpr auto flag = [](bool Law::*member) { return member; };
  return std::tuple{required("density", real(&Law::density), positive, "kg/m^3", "mass density at rest"),
                    required("bulk_modulus", real(&Law::bulk_modulus), positive, "Pa",
                             "bulk modulus at rest; may be lowered until the speed of sound is ten times the largest velocity"),
                    optional("exponent", real(&Law::exponent), at_least(1), "-", "exponent of the volume; 7 for water"),
                    optional("tension", flag(&Law::tension), any, "-",
                             "true: the pressure may be negative; false: the fluid opens freely and closes before pressure is felt")};
}

/// The history of a fluid.
struct FluidHistory {
  Real plastic_work = 0;
  static constexpr auto fields()
  {
    return std::tuple{history("plastic_work", &FluidHistory::plastic_work, "J/m^3", "energy dissipated by viscosity per initial volume")};
  }
};

/// The rate of deformation of a step [1/s]: ln(f f^T) / (2 dt) with f = I + dt L, so that it is zero for a finite rotation; sym(L) if dt =
/// 0.
template <class T>
Sym3Of<T> rate_of_deformation(const IncrementOf<T>& in) noexcept
{
  if (!(in.dt > 0))
    return pack(sym(in.L));
  return scale_and_shift(0.5 / in.dt, log1p(push_forward(in.dt * in.L, Sym3Of<T>::Zero())), 0);
}

}  // namespace talus
