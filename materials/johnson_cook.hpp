#pragma once
// Metals under impact: strength depending on plastic strain, rate and temperature, heating, failure, equation of state.
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "core/type_list.hpp"
#include "materials/parts/elasticity.hpp"
#include "materials/parts/equation_of_state.hpp"
#include "materials/parts/law.hpp"
#include "materials/parts/power_near.hpp"

namespace talus {

/// The plastic strain at fracture, [d1 + d2 exp(d3 t)] [1 + d4 ln(rate*)] [1 + d5 T*], where t is the mean stress over the von Mises
/// stress, positive in tension; at least 1e-6.  [Johnson & Cook 1985, Eng. Fract. Mech. 21, 31]
struct JohnsonCookDamage {
  Real d1{}, d2{}, d3{}, d4{}, d5{};
  static constexpr auto fields()
  {
    using Damage = JohnsonCookDamage;
    return std::tuple{
        required("d1", &Damage::d1, any, "-", "plastic strain at fracture under high tension"),
        required("d2", &Damage::d2, non_negative, "-", "what is added where the mean stress is zero"),
        required("d3", &Damage::d3, any, "-", "exponent of mean stress over von Mises stress, tension positive: zero or below"),
        required("d4", &Damage::d4, any, "-", "gain by the logarithm of the plastic rate over reference_rate"),
        required("d5", &Damage::d5, any, "-", "gain from room to melting temperature")};
  }
  void check(std::vector<std::string>& problems) const;

  /// `triaxiality` is mean stress / von Mises stress, `relative_rate` the plastic rate over the reference (counted as 1 below it),
  /// `homologous` 0 at room and 1 at melting temperature.
  template <class T = Real>
  T fracture_strain(const std::type_identity_t<T>& triaxiality, const std::type_identity_t<T>& relative_rate,
                    const std::type_identity_t<T>& homologous) const noexcept;
};

/// Parameters and formulas that the four variants of the law have in common.  Formulas and numbers: docs/reference/materials.md.
struct JohnsonCookMetal : Elasticity {
  Real density{}, yield_stress{}, hardening_coefficient{}, hardening_exponent{}, rate_coefficient{}, reference_rate = 1, thermal_exponent{};
  Real room_temperature{}, melting_temperature{}, specific_heat{}, heat_fraction = 0.9;
  std::optional<Real> initial_temperature, conductivity;
  std::optional<JohnsonCookDamage> damage;
  std::optional<MieGruneisen> mie_gruneisen;

  struct Constants {
    Real bulk, shear;                     ///< Pa; the bulk modulus is used where there is no equation of state
    Real heat;                            ///< heat_fraction / (density specific_heat) [K m^3/J]
    Real range_inverse;                   ///< 1 / (melting - room temperature) [1/K]
    Real rate_inverse;                    ///< 1 / reference_rate [s]
    BinomialSeries hardening, softening;  ///< powers of plastic strain and of homologous temperature
    std::optional<MieGruneisenCurve> curve;
  };
  Constants constants() const noexcept;
  void check(std::vector<std::string>& problems) const;
  /// Divides the strength by a factor at every plastic strain, rate and temperature; fracture strain and pressure stay.
  void divide_strength(Real factor) noexcept
  {
    yield_stress /= factor;
    hardening_coefficient /= factor;
  }

  /// The strength [Pa of Cauchy stress] at a plastic strain [-], plastic strain rate [1/s] and temperature [K].
  Real flow_stress(Real plastic_strain, Real plastic_rate, Real temperature) const noexcept;
  template <class T>
  T wave_speed(const Mat3Of<T>& F, const Constants& c) const noexcept;
  /// The diffusivity of heat [m^2/s].
  Real diffusivity(const Constants&) const noexcept { return conductivity ? *conductivity / (density * specific_heat) : 0; }

 protected:
  /// The temperature in a history [K]; that of the parameters if the history has none.
  template <class T>
  T started(const T& temperature) const noexcept
  {
    return where(temperature > 0, temperature, initial_temperature.value_or(room_temperature));
  }
  /// The history of a particle or of several.  Values that a variant does not store stay zero.
  template <class T>
  struct Memory {
    Sym3Of<T> elastic_left;
    T plastic_strain, plastic_work, temperature, damage, energy;
    bool keeps_damage, keeps_energy;
  };
  /// Returns nothing, and changes no history, if the law has no solution in some lane.
  template <class T>
  std::optional<Mat3Of<T>> update(const IncrementOf<T>& in, Memory<T>& memory, const Constants& c) const noexcept;
  void prestress(const Mat3& stress, Sym3& elastic_left) const noexcept;
};

template <bool with_damage>
struct DamageHistory {
  Real damage = 0;
};
template <>
struct DamageHistory<false> {};
template <bool with_energy>
struct EnergyHistory {
  Real internal_energy = 0;
};
template <>
struct EnergyHistory<false> {};

/// The strength of Johnson & Cook on logarithmic elasticity, with the return by backward Euler.  The Cauchy stress yields where
///     sqrt(3 J2) = (A + B p^n) (1 + C ln(max(rate / reference_rate, 1))) (1 - T*^m)
/// with the plastic strain p, the rate of the step and T* = (T - T_room) / (T_melt - T_room) within [0, 1].  Plastic work heats the
/// particle within the same solution, by the trapezoidal rule.  The history contains what the optional groups need: `with_damage`,
/// `with_energy`.
template <bool with_damage, bool with_energy>
struct JohnsonCookOf : JohnsonCookMetal {
  static constexpr std::string_view name = "johnson_cook";
  static constexpr bool isochoric = true;
  static constexpr std::string_view summary =
      "Metal under impact: strength by plastic strain, rate and temperature, adiabatic heating, fracture, Mie-Grueneisen pressure (Johnson "
      "& Cook 1983, 1985).";
  static constexpr auto fields()
  {
    using Law = JohnsonCookOf;
    return std::tuple_cat(
        std::tuple{required<Law, Real>("density", &Law::density, positive, "kg/m^3", "mass density at rest")}, elastic_fields<Law>(),
        std::tuple{
            required<Law, Real>("yield_stress", &Law::yield_stress, positive, "Pa", "A, strength at first yield"),
            required<Law, Real>("hardening_coefficient", &Law::hardening_coefficient, non_negative, "Pa", "B, gain at plastic strain 1"),
            required<Law, Real>("hardening_exponent", &Law::hardening_exponent, positive, "-", "n"),
            required<Law, Real>("rate_coefficient", &Law::rate_coefficient, non_negative, "-", "C, gain by the logarithm of the rate"),
            optional<Law, Real>("reference_rate", &Law::reference_rate, positive, "1/s",
                                "plastic strain rate below which rate is of no effect"),
            required<Law, Real>("thermal_exponent", &Law::thermal_exponent, positive, "-", "m"),
            required<Law, Real>("room_temperature", &Law::room_temperature, positive, "K", "up to here temperature is of no effect"),
            required<Law, Real>("melting_temperature", &Law::melting_temperature, positive, "K", "from here on there is no strength"),
            required<Law, Real>("specific_heat", &Law::specific_heat, positive, "J/(kg K)", "heat by mass and temperature"),
            optional<Law, Real>("heat_fraction", &Law::heat_fraction, within(0, 1), "-", "share of the plastic work that heats"),
            optional<Law, std::optional<Real>>("initial_temperature", &Law::initial_temperature, positive, "K",
                                               "temperature at the start; without it room_temperature"),
            optional<Law, std::optional<Real>>("conductivity", &Law::conductivity, positive, "W/(m K)",
                                               "thermal conductivity; without it no heat flows between particles"),
            group<Law, std::optional<JohnsonCookDamage>>("damage", &Law::damage, "fracture; without it the metal never fails"),
            group<Law, std::optional<MieGruneisen>>("mie_gruneisen", &Law::mie_gruneisen,
                                                    "pressure of strong compression, instead of the bulk modulus")});
  }

  struct State : DamageHistory<with_damage>, EnergyHistory<with_energy> {
    Sym3 elastic_left = Sym3::Zero();
    Real plastic_strain = 0, plastic_work = 0;
    Real temperature = 0;  ///< 0 before the first step: then that of the parameters
    static constexpr auto fields()
    {
      return std::tuple_cat(
          std::tuple{
              history("elastic_left", &State::elastic_left, "-", "elastic left Cauchy-Green tensor minus identity: xx, yy, zz, xy, yz, xz"),
              history("plastic_strain", &State::plastic_strain, "-", "p, accumulated plastic strain, integral of sqrt(2/3 e:e)"),
              history("plastic_work", &State::plastic_work, "J/m^3", "dissipated energy per initial volume"),
              history("temperature", &State::temperature, "K", "of the particle: its start and what plastic work has heated")},
          damage_field(), energy_field());
    }

   private:
    static constexpr auto damage_field()
    {
      if constexpr (with_damage)
        return std::tuple{history<State, Real>("damage", &State::damage, "-", "share of the life until fracture; failed at 1")};
      else
        return std::tuple{};
    }
    static constexpr auto energy_field()
    {
      if constexpr (with_energy)
        return std::tuple{history<State, Real>("internal_energy", &State::internal_energy, "J/m^3",
                                               "work of stress and artificial viscosity per initial volume")};
      else
        return std::tuple{};
    }
  };

  /// The history of a particle at rest, with its temperature.
  State initial_state() const noexcept
  {
    State state;
    state.temperature = started(Real{0});
    return state;
  }
  template <class T>
  Mat3Of<T> update(const IncrementOf<T>& in, StateOf<T, State>& state, const Constants& c) const noexcept
  {
    Memory<T> memory{.elastic_left = get(state, &State::elastic_left),
                     .plastic_strain = get(state, &State::plastic_strain),
                     .plastic_work = get(state, &State::plastic_work),
                     .temperature = get(state, &State::temperature),
                     .damage = 0,
                     .energy = 0,
                     .keeps_damage = with_damage,
                     .keeps_energy = with_energy};
    if constexpr (with_damage)
      memory.damage = get(state, &State::damage);
    if constexpr (with_energy)
      memory.energy = get(state, &State::internal_energy);
    const std::optional<Mat3Of<T>> stress = JohnsonCookMetal::update(in, memory, c);
    if (!stress)
      return no_answer_somewhere(*this, in, state, c);
    put(state, &State::elastic_left, memory.elastic_left);
    put(state, &State::plastic_strain, memory.plastic_strain);
    put(state, &State::plastic_work, memory.plastic_work);
    put(state, &State::temperature, memory.temperature);
    if constexpr (with_damage)
      put(state, &State::damage, memory.damage);
    if constexpr (with_energy)
      put(state, &State::internal_energy, memory.energy);
    return *stress;
  }
  void prestress(const Mat3& stress, State& state) const noexcept { JohnsonCookMetal::prestress(stress, state.elastic_left); }
  /// sqrt(3 J2) minus the strength at rates up to the reference rate [Pa]; zero after failure.  In fast flow it is positive by the effect
  /// of the rate.
  Real yield(const Mat3& stress, const State& state) const noexcept
  {
    if constexpr (with_damage)
      if (state.damage >= 1)
        return von_mises(stress);
    return von_mises(stress) - flow_stress(state.plastic_strain, 0, started(state.temperature));
  }

  using Kinds = TypeList<JohnsonCookOf<false, false>, JohnsonCookOf<true, false>, JohnsonCookOf<false, true>, JohnsonCookOf<true, true>>;
  /// The variant that stores only the history that the optional groups need.
  auto kind() const
  {
    using Any =
        std::variant<JohnsonCookOf<false, false>, JohnsonCookOf<true, false>, JohnsonCookOf<false, true>, JohnsonCookOf<true, true>>;
    const JohnsonCookMetal& metal = *this;
    if (damage)
      return mie_gruneisen ? Any(JohnsonCookOf<true, true>{metal}) : Any(JohnsonCookOf<true, false>{metal});
    return mie_gruneisen ? Any(JohnsonCookOf<false, true>{metal}) : Any(JohnsonCookOf<false, false>{metal});
  }
};
using JohnsonCook = JohnsonCookOf<true, true>;

}  // namespace talus
