#pragma once
// Metals under impact: strength depending on plastic strain, rate and temperature, heating, failure, equation of state.
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "core/type_list.hpp"
#include "materials/parts/law.hpp"
#include "materials/parts/metal.hpp"
#include "materials/parts/power_near.hpp"

namespace talus {

/// The plastic strain at fracture, [d1 + d2 exp(d3 t)] [1 + d4 ln(rate*)] [1 + d5 T*], where t is the mean stress over the von Mises
/// stress, positive in tension; at least 1e-6.  [Johnson & Cook 1985, Eng. Fract. Mech. 21, 31]
struct JohnsonCookDamage {
  Real d1{}, d2{}, d3{}, d4{}, d5{};
  std::optional<Real> softening_length{};
  static constexpr auto fields()
  {
    using Damage = JohnsonCookDamage;
    return std::tuple{
        required("d1", &Damage::d1, any, "-", "plastic strain at fracture under high tension"),
        required("d2", &Damage::d2, non_negative, "-", "what is added where the mean stress is zero"),
        required("d3", &Damage::d3, any, "-", "exponent of mean stress over von Mises stress, tension positive: zero or below"),
        required("d4", &Damage::d4, any, "-", "gain by the logarithm of the plastic rate over reference_rate"),
        required("d5", &Damage::d5, any, "-", "gain from room to melting temperature"),
        optional("softening_length", &Damage::softening_length, positive, "m",
                 "over which damage is averaged; without it the work of a crack is that of one row of cells")};
  }
  void check(std::vector<std::string>& problems) const;

  /// `triaxiality` is mean stress / von Mises stress, `relative_rate` the plastic rate over the reference (counted as 1 below it),
  /// `homologous` 0 at room and 1 at melting temperature.
  template <class T = Real>
  T fracture_strain(const std::type_identity_t<T>& triaxiality, const std::type_identity_t<T>& relative_rate,
                    const std::type_identity_t<T>& homologous) const noexcept;
};

/// Which damage a variant keeps: none, that of the particle, or also its mean over the softening length.
enum class DamageKept : std::uint8_t { no, local, averaged };

/// Parameters and formulas that the six variants of the law have in common.  Formulas and numbers: docs/reference/materials.md.
struct JohnsonCookMetal : Metal {
  Real yield_stress{}, hardening_coefficient{}, hardening_exponent{}, rate_coefficient{}, reference_rate = 1, thermal_exponent{};
  Real room_temperature{}, melting_temperature{};
  std::optional<Real> initial_temperature;
  std::optional<JohnsonCookDamage> damage;

  struct Constants : MetalConstants {
    Real range_inverse;                   ///< 1 / (melting - room temperature) [1/K]
    Real rate_inverse;                    ///< 1 / reference_rate [s]
    BinomialSeries hardening, softening;  ///< powers of plastic strain and of homologous temperature
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
    T plastic_strain, plastic_work, temperature, damage, local_damage, mean_damage, energy;
    DamageKept kept;
    bool keeps_energy;
  };
  /// Returns nothing, and changes no history, if the law has no solution in some lane.
  template <class T>
  std::optional<Mat3Of<T>> update(const IncrementOf<T>& in, Memory<T>& memory, const Constants& c) const noexcept;
};

template <DamageKept kept>
struct DamageHistory {};
template <>
struct DamageHistory<DamageKept::local> {
  Real damage = 0;
};
template <>
struct DamageHistory<DamageKept::averaged> {
  Real damage = 0, local_damage = 0, mean_damage = 0, mean_damage_rate = 0;
};

/// The strength of Johnson & Cook on logarithmic elasticity, with the return by backward Euler.  The Cauchy stress yields where
///     sqrt(3 J2) = (A + B p^n) (1 + C ln(max(rate / reference_rate, 1))) (1 - T*^m)
/// with the plastic strain p, the rate of the step and T* = (T - T_room) / (T_melt - T_room) within [0, 1].  Plastic work heats the
/// particle within the same solution, by the trapezoidal rule.  The history contains what the optional groups need.
///
/// With a softening length a the particle does not fail where the sum D of its own plastic strain over its fracture strain is 1, but where
/// the mean M of  M - a^2 lap M = D  is (Peerlings et al. 1996, IJNME 39, 3391): the work of a crack is then that of a layer 2 a wide, however
/// small the cells.  M is found by the solver (solver/stress/average_strain.hpp).  Derivation: docs/theory/laws.md.
template <DamageKept kept, bool with_energy>
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
        elastic_metal_fields<Law>(),
        std::tuple{
            required<Law, Real>("yield_stress", &Law::yield_stress, positive, "Pa", "A, strength at first yield"),
            required<Law, Real>("hardening_coefficient", &Law::hardening_coefficient, non_negative, "Pa", "B, gain at plastic strain 1"),
            required<Law, Real>("hardening_exponent", &Law::hardening_exponent, positive, "-", "n"),
            required<Law, Real>("rate_coefficient", &Law::rate_coefficient, non_negative, "-", "C, gain by the logarithm of the rate"),
            optional<Law, Real>("reference_rate", &Law::reference_rate, positive, "1/s",
                                "plastic strain rate below which rate is of no effect"),
            required<Law, Real>("thermal_exponent", &Law::thermal_exponent, positive, "-", "m"),
            required<Law, Real>("room_temperature", &Law::room_temperature, positive, "K", "up to here temperature is of no effect"),
            required<Law, Real>("melting_temperature", &Law::melting_temperature, positive, "K", "from here on there is no strength")},
        heating_fields<Law>(),
        std::tuple{optional<Law, std::optional<Real>>("initial_temperature", &Law::initial_temperature, positive, "K",
                                                      "temperature at the start; without it room_temperature")},
        conductivity_field<Law>(),
        std::tuple{group<Law, std::optional<JohnsonCookDamage>>("damage", &Law::damage, "fracture; without it the metal never fails")},
        mie_gruneisen_field<Law>());
  }

  struct State : DamageHistory<kept>, EnergyHistory<with_energy>, MetalState {
    static constexpr auto fields() { return std::tuple_cat(metal_history<State>(), damage_field(), energy_history<State>()); }

   private:
    static constexpr auto damage_field()
    {
      if constexpr (kept == DamageKept::no) {
        return std::tuple{};
      } else {
        const auto damage = history<State, Real>("damage", &State::damage, "-", "share of the life until fracture; failed at 1");
        if constexpr (kept == DamageKept::local)
          return std::tuple{damage};
        else
          return std::tuple{
              damage, history<State, Real>("local_damage", &State::local_damage, "-", "plastic strain over fracture strain, summed up"),
              history<State, Real>("mean_damage", &State::mean_damage, "-", "local_damage averaged over the softening length"),
              history<State, Real>("mean_damage_rate", &State::mean_damage_rate, "1/s", "rate of mean_damage")};
      }
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
                     .local_damage = 0,
                     .mean_damage = 0,
                     .energy = 0,
                     .kept = kept,
                     .keeps_energy = with_energy};
    if constexpr (kept != DamageKept::no)
      memory.damage = get(state, &State::damage);
    if constexpr (kept == DamageKept::averaged) {
      memory.local_damage = get(state, &State::local_damage);
      memory.mean_damage = get(state, &State::mean_damage);
    }
    if constexpr (with_energy)
      memory.energy = get(state, &State::internal_energy);
    const std::optional<Mat3Of<T>> stress = JohnsonCookMetal::update(in, memory, c);
    if (!stress)
      return no_answer_somewhere(*this, in, state, c);
    put(state, &State::elastic_left, memory.elastic_left);
    put(state, &State::plastic_strain, memory.plastic_strain);
    put(state, &State::plastic_work, memory.plastic_work);
    put(state, &State::temperature, memory.temperature);
    if constexpr (kept != DamageKept::no)
      put(state, &State::damage, memory.damage);
    if constexpr (kept == DamageKept::averaged)
      put(state, &State::local_damage, memory.local_damage);
    if constexpr (with_energy)
      put(state, &State::internal_energy, memory.energy);
    return *stress;
  }
  /// sqrt(3 J2) minus the strength at rates up to the reference rate [Pa]; zero after failure.  In fast flow it is positive by the effect
  /// of the rate.
  Real yield(const Mat3& stress, const State& state) const noexcept
  {
    if constexpr (kept != DamageKept::no)
      if (state.damage >= 1)
        return von_mises(stress);
    return von_mises(stress) - flow_stress(state.plastic_strain, 0, started(state.temperature));
  }

  /// The length a of the average [m].
  Real averaging_length() const noexcept requires(kept == DamageKept::averaged) { return *damage->softening_length; }
  /// The width of the layer whose slip at fracture, while it flows evenly, is that of a crack [m].
  Real band_width() const noexcept requires(kept == DamageKept::averaged) { return 2 * averaging_length(); }
  /// Damage counts without bound: what fails does not flow any more, and flow in a single row of cells must come to 2 a over their size.
  Real largest_averaged() const noexcept requires(kept == DamageKept::averaged) { return std::numeric_limits<Real>::infinity(); }
  static constexpr AveragedHistory<State> averaged_history() noexcept requires(kept == DamageKept::averaged)
  {
    return {&State::local_damage, &State::mean_damage, &State::mean_damage_rate};
  }

  template <DamageKept some>
  using Kind = JohnsonCookOf<some, false>;
  template <DamageKept some>
  using EnergeticKind = JohnsonCookOf<some, true>;
  using Kinds = TypeList<Kind<DamageKept::no>, Kind<DamageKept::local>, Kind<DamageKept::averaged>, EnergeticKind<DamageKept::no>,
                         EnergeticKind<DamageKept::local>, EnergeticKind<DamageKept::averaged>>;
  using Widest = EnergeticKind<DamageKept::averaged>;
  /// The variant that stores only the history that the optional groups need.
  auto kind() const
  {
    using Any = variant_of<Kinds, std::type_identity_t>;
    const JohnsonCookMetal& metal = *this;
    const auto with = [&]<DamageKept some>() { return mie_gruneisen ? Any(EnergeticKind<some>{metal}) : Any(Kind<some>{metal}); };
    if (!damage)
      return with.template operator()<DamageKept::no>();
    return damage->softening_length ? with.template operator()<DamageKept::averaged>() : with.template operator()<DamageKept::local>();
  }
};
using JohnsonCook = JohnsonCookOf<DamageKept::local, true>;

}  // namespace talus
