#pragma once
// Metal and undrained clay: shear strength that hardens with plastic strain and its rate, on logarithmic elasticity.
#include <optional>
#include <string_view>

#include "materials/parts/hencky_plastic.hpp"
#include "materials/parts/power_near.hpp"
#include "materials/parts/softening_length.hpp"

namespace talus {

/// Saturating hardening, Q (1 - exp(-b p)).  [Voce 1948, J. Inst. Metals 74, 537]
struct VoceHardening {
  Real saturation{}, exponent{};
  static constexpr auto fields()
  {
    return std::tuple{required("saturation", &VoceHardening::saturation, positive, "Pa", "Q, what is gained at large plastic strain"),
                      required("exponent", &VoceHardening::exponent, positive, "-", "b, the inverse of the plastic strain it takes")};
  }
};

/// Power hardening, K p^n.  [Ludwik 1909]
struct PowerHardening {
  Real coefficient{}, exponent{};
  static constexpr auto fields()
  {
    return std::tuple{required("coefficient", &PowerHardening::coefficient, positive, "Pa", "K, what is gained at plastic strain 1"),
                      required("exponent", &PowerHardening::exponent, positive, "-", "n; below 1 the hardening starts infinitely steep")};
  }
};

/// The rate factor 1 + (plastic rate / D)^(1/q).  [Cowper & Symonds 1957, Brown University TR 28]
struct CowperSymonds {
  Real reference_rate{}, exponent{};
  static constexpr auto fields()
  {
    return std::tuple{required("reference_rate", &CowperSymonds::reference_rate, positive, "1/s", "D, the rate that doubles the strength"),
                      required("exponent", &CowperSymonds::exponent, positive, "-", "q")};
  }
};

/// Von Mises plasticity, associated, with the return by backward Euler.  The Cauchy stress yields where
///     sqrt(3 J2) = (yield_stress + H p + Q (1 - exp(-b p)) + K p^n) (1 + (rate / D)^(1/q))
/// with the accumulated plastic strain p and the rate of the step.  The solution is in closed form if only H is given.  A material that softens
/// has, instead of yield_stress, what is left of it: it falls linearly to residual_stress, as undrained clay does.
struct VonMises : HenckyPlastic {
  static constexpr std::string_view name = "von_mises";
  static constexpr bool isochoric = true;
  static constexpr std::string_view summary =
      "Von Mises plasticity on logarithmic elasticity: linear, saturating (Voce 1948) and power hardening, rate factor of Cowper & Symonds "
      "(1957); yields in Cauchy stress.";
  Real yield_stress{}, hardening_modulus = 0;
  std::optional<VoceHardening> voce;
  std::optional<PowerHardening> power;
  std::optional<CowperSymonds> rate;
  std::optional<Real> residual_stress, softening_strain, softening_length;
  static constexpr auto fields()
  {
    using Law = VonMises;
    return std::tuple_cat(
        std::tuple{required<Law, Real>("density", &Law::density, positive, "kg/m^3", "mass density at rest")}, elastic_fields<Law>(),
        std::tuple{required("yield_stress", &Law::yield_stress, positive, "Pa", "Cauchy stress of first yield in slow uniaxial tension"),
                   optional("hardening_modulus", &Law::hardening_modulus, non_negative, "Pa", "H, linear gain by plastic strain"),
                   group("voce", &Law::voce, "hardening Q (1 - exp(-b p)) that saturates"), group("power", &Law::power, "hardening K p^n"),
                   group("rate", &Law::rate, "factor 1 + (rate / D)^(1/q) on the strength, of the plastic strain rate"),
                   optional("residual_stress", &Law::residual_stress, non_negative, "Pa", "what is left of yield_stress after softening"),
                   optional("softening_strain", &Law::softening_strain, positive, "-",
                            "plastic_strain at which it is reached, linear before; without it nothing softens"),
                   optional("softening_length", &Law::softening_length, positive, "m",
                            "over which the plastic strain is averaged that softens; shear bands are 2 pi times as wide; without it their "
                            "width is that of the cells")});
  }
  /// Appends the violated rules between parameters.
  void check(std::vector<std::string>& problems) const;
  /// Divides the strength by a factor at every plastic strain and rate.
  void divide_strength(Real factor) noexcept;

  struct State {
    Sym3 elastic_left = Sym3::Zero();
    Real plastic_strain = 0, plastic_work = 0;
    static constexpr auto fields()
    {
      return std::tuple{
          history("elastic_left", &State::elastic_left, "-", "elastic left Cauchy-Green tensor minus identity: xx, yy, zz, xy, yz, xz"),
          history("plastic_strain", &State::plastic_strain, "-", "p, accumulated plastic strain, integral of sqrt(2/3 e:e)"),
          history("plastic_work", &State::plastic_work, "J/m^3", "dissipated energy per initial volume")};
    }
  };

  struct Constants {
    Real bulk, shear;      ///< Pa
    bool closed_form;      ///< whether hardening is linear and without rate
    Real rate_inverse;     ///< 1/D [s]; 0 without a rate factor
    Real rate_power;       ///< 1/q
    BinomialSeries power;  ///< of plastic strain, in hardening by a power
    Real lost;             ///< yield_stress - residual_stress [Pa]; 0 without softening
    Real softening;        ///< what is lost by plastic strain until then [Pa]
    /// What softening has taken of the yield stress at a plastic strain [Pa].
    template <class T>
    T lost_at(const T& plastic_strain) const noexcept
    {
      using std::min;
      return min(T(softening * plastic_strain), T(lost));
    }
  };
  Constants constants() const noexcept;

  /// The strength [Pa of Cauchy stress] at a plastic strain [-] and a plastic strain rate [1/s].
  Real flow_stress(Real plastic_strain, Real plastic_rate) const noexcept
  {
    return flow_stress(plastic_strain, plastic_rate, plastic_strain);
  }
  /// The same where softening has come to another plastic strain than hardening.
  Real flow_stress(Real plastic_strain, Real plastic_rate, Real softened_at) const noexcept;

  template <class T>
  Mat3Of<T> update(const IncrementOf<T>& in, StateOf<T, State>& state, const Constants& c) const noexcept;
  /// sqrt(3 J2) minus the strength in slow loading [Pa]; in flow with `rate` it is positive by the effect of the rate.
  Real yield(const Mat3& stress, const State& state) const noexcept;
  /// The same where softening has come to another plastic strain than hardening.
  Real yield(const Mat3& stress, const State& state, Real softened_at) const noexcept;

  using Kinds = TypeList<VonMises, WithSofteningLength<VonMises>>;
  using Widest = WithSofteningLength<VonMises>;
  auto kind() const { return kind_by_softening_length(*this); }
};

}  // namespace talus
