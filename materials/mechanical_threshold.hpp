#pragma once
// Metals whose strength is that of barriers which dislocations pass by thermal activation: the mechanical threshold stress.
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "core/type_list.hpp"
#include "materials/parts/law.hpp"
#include "materials/parts/metal.hpp"

namespace talus {

/// Barriers within the crystal that do not change with strain: the friction of the lattice, solute atoms.
struct IntrinsicBarrier {
  Real threshold{}, activation_energy{}, activation_rate{}, activation_p{}, activation_q{};
  static constexpr auto fields()
  {
    using Barrier = IntrinsicBarrier;
    return std::tuple{
        required("threshold", &Barrier::threshold, positive, "Pa", "sigma_i, the stress that passes them at 0 K"),
        required("activation_energy", &Barrier::activation_energy, positive, "-", "g_0i, over mu b^3"),
        required("activation_rate", &Barrier::activation_rate, positive, "1/s", "plastic strain rate from which on heat is no help"),
        required("activation_p", &Barrier::activation_p, positive, "-", "p_i, of the shape of the barrier"),
        required("activation_q", &Barrier::activation_q, positive, "-", "q_i, of the shape of the barrier")};
  }
};

/// Parameters and formulas that the two variants of the law have in common.  Formulas and numbers: docs/reference/materials.md.
struct ThresholdMetal : Metal {
  Real athermal_stress{};
  Real shear_at_zero_kelvin{}, shear_loss{}, shear_temperature{}, boltzmann_over_burgers_cubed{};
  Real activation_energy{}, activation_rate{}, activation_p{}, activation_q{};
  Real hardening_modulus{}, hardening_by_log_rate = 0, hardening_by_root_rate = 0, hardening_by_temperature = 0, hardening_shape{};
  Real saturation_stress{}, saturation_energy{}, saturation_rate{}, initial_threshold = 0;
  Real initial_temperature{};
  std::optional<IntrinsicBarrier> intrinsic;

  /// S = [1 - (k T / (g_0 mu b^3) ln(rate_0 / rate))^(1/q)]^(1/p), the share of a threshold that is left at a rate and a temperature.
  struct Barrier {
    Real energy_inverse, log_rate, p_inverse, q_inverse;
  };
  struct Constants : MetalConstants {
    Barrier evolving, intrinsic;      ///< the second is of no meaning without a threshold
    Real intrinsic_threshold;         ///< sigma_i [Pa], or 0
    Real log_saturation_rate;         ///< [ln 1/s]
    Real tanh_shape, inverse_cosh_2;  ///< tanh(a) and 1 / cosh(a)^2 of the shape a of hardening
  };
  Constants constants() const noexcept;
  void check(std::vector<std::string>& problems) const;
  /// Divides the strength by a factor at every threshold, rate and temperature; the pressure stays.
  void divide_strength(Real factor) noexcept;

  /// The strength [Pa of Cauchy stress] where sigma_e is `threshold_ratio` times saturation_stress, at a plastic strain rate [1/s] and a
  /// temperature [K].
  Real flow_stress(Real threshold_ratio, Real plastic_rate, Real temperature) const noexcept;
  /// The strength without the help of heat [Pa]: that at rates from activation_rate on.
  Real threshold(Real threshold_ratio, Real temperature) const noexcept;

 protected:
  /// The temperature in a history [K]; that of the parameters if the history has none.
  template <class T>
  T started(const T& temperature) const noexcept
  {
    return where(temperature > 0, temperature, initial_temperature);
  }
  /// The history of a particle or of several.  The energy stays zero in the variant that does not store it.
  template <class T>
  struct Memory {
    Sym3Of<T> elastic_left;
    T plastic_strain, plastic_work, temperature, threshold_ratio, energy;
    bool keeps_energy;
  };
  /// Returns nothing, and changes no history, if the law has no solution in some lane.
  template <class T>
  std::optional<Mat3Of<T>> update(const IncrementOf<T>& in, Memory<T>& memory, const Constants& c) const noexcept;
};

/// The mechanical threshold stress of Follansbee & Kocks on logarithmic elasticity, with the return by backward Euler.  The Cauchy stress
/// yields where
///     sqrt(3 J2) = sigma_a + (S_i sigma_i + S_e sigma_e) mu(T) / mu_0,    d sigma_e / dp = theta_0 (1 - tanh(a X) / tanh(a)),
/// with X = sigma_e over its saturation at the rate and the temperature.  Within a step sigma_e follows the integral of its equation at the
/// rate and the temperature of the end of the step, which has a closed form.  Plastic work heats the particle within the same solution, by
/// the trapezoidal rule.  A step that would flow by less than 1e-12 is elastic.
template <bool with_energy>
struct MechanicalThresholdOf : ThresholdMetal {
  static constexpr std::string_view name = "mechanical_threshold";
  static constexpr bool isochoric = true;
  static constexpr std::string_view summary =
      "Metal under impact: strength of barriers that dislocations pass by thermal activation, with a threshold that evolves, adiabatic "
      "heating, Mie-Grueneisen pressure (Follansbee & Kocks 1988).";
  static constexpr auto fields()
  {
    using Law = MechanicalThresholdOf;
    return std::tuple_cat(
        elastic_metal_fields<Law>(),
        std::tuple{
            required<Law, Real>("athermal_stress", &Law::athermal_stress, non_negative, "Pa",
                                "sigma_a, strength that heat and rate do not change: grain boundaries"),
            required<Law, Real>("shear_at_zero_kelvin", &Law::shear_at_zero_kelvin, positive, "Pa", "mu_0; mu(T) scales the strength only"),
            required<Law, Real>("shear_loss", &Law::shear_loss, non_negative, "Pa", "D of mu(T) = mu_0 - D / (exp(T_0 / T) - 1)"),
            required<Law, Real>("shear_temperature", &Law::shear_temperature, positive, "K", "T_0 of mu(T)"),
            required<Law, Real>("boltzmann_over_burgers_cubed", &Law::boltzmann_over_burgers_cubed, positive, "Pa/K",
                                "k / b^3, Boltzmann's constant over the cube of the Burgers vector"),
            group<Law, std::optional<IntrinsicBarrier>>("intrinsic", &Law::intrinsic,
                                                        "barriers that strain does not change; without it none"),
            required<Law, Real>("activation_energy", &Law::activation_energy, positive, "-",
                                "g_0e of the barriers that strain makes, over mu b^3"),
            required<Law, Real>("activation_rate", &Law::activation_rate, positive, "1/s",
                                "plastic strain rate from which on heat is no help"),
            required<Law, Real>("activation_p", &Law::activation_p, positive, "-", "p_e, of the shape of the barrier"),
            required<Law, Real>("activation_q", &Law::activation_q, positive, "-", "q_e, of the shape of the barrier"),
            required<Law, Real>("hardening_modulus", &Law::hardening_modulus, positive, "Pa", "a_0, slope of sigma_e at its beginning"),
            optional<Law, Real>("hardening_by_log_rate", &Law::hardening_by_log_rate, non_negative, "Pa",
                                "a_1, times the logarithm of the rate in 1/s"),
            optional<Law, Real>("hardening_by_root_rate", &Law::hardening_by_root_rate, non_negative, "Pa s^0.5",
                                "a_2, times the root of the rate"),
            optional<Law, Real>("hardening_by_temperature", &Law::hardening_by_temperature, non_negative, "Pa/K",
                                "a_3, what the slope loses by temperature"),
            required<Law, Real>("hardening_shape", &Law::hardening_shape, between(0, 10), "-",
                                "a of the hardening 1 - tanh(a X) / tanh(a)"),
            required<Law, Real>("saturation_stress", &Law::saturation_stress, positive, "Pa", "sigma_es0, where sigma_e saturates at 0 K"),
            required<Law, Real>("saturation_energy", &Law::saturation_energy, positive, "-", "g_0es of the saturation, over mu b^3"),
            required<Law, Real>("saturation_rate", &Law::saturation_rate, positive, "1/s", "rate at which sigma_e saturates at sigma_es0"),
            optional<Law, Real>("initial_threshold", &Law::initial_threshold, non_negative, "Pa", "sigma_e at the start: 0 if annealed")},
        heating_fields<Law>(),
        std::tuple{required<Law, Real>("initial_temperature", &Law::initial_temperature, positive, "K", "temperature at the start")},
        conductivity_field<Law>(), mie_gruneisen_field<Law>());
  }

  struct State : EnergyHistory<with_energy>, MetalState {
    Real threshold_ratio = 0;
    static constexpr auto fields()
    {
      return std::tuple_cat(metal_history<State>(),
                            std::tuple{history("threshold_ratio", &State::threshold_ratio, "-",
                                               "sigma_e, the threshold that evolves, over saturation_stress")},
                            energy_history<State>());
    }
  };

  /// The history of a particle at rest, with its temperature and its threshold.
  State initial_state() const noexcept
  {
    State state;
    state.temperature = initial_temperature;
    state.threshold_ratio = initial_threshold / saturation_stress;
    return state;
  }
  template <class T>
  Mat3Of<T> update(const IncrementOf<T>& in, StateOf<T, State>& state, const Constants& c) const noexcept
  {
    Memory<T> memory{.elastic_left = get(state, &State::elastic_left),
                     .plastic_strain = get(state, &State::plastic_strain),
                     .plastic_work = get(state, &State::plastic_work),
                     .temperature = get(state, &State::temperature),
                     .threshold_ratio = get(state, &State::threshold_ratio),
                     .energy = 0,
                     .keeps_energy = with_energy};
    if constexpr (with_energy)
      memory.energy = get(state, &State::internal_energy);
    const std::optional<Mat3Of<T>> stress = ThresholdMetal::update(in, memory, c);
    if (!stress)
      return no_answer_somewhere(*this, in, state, c);
    put(state, &State::elastic_left, memory.elastic_left);
    put(state, &State::plastic_strain, memory.plastic_strain);
    put(state, &State::plastic_work, memory.plastic_work);
    put(state, &State::temperature, memory.temperature);
    put(state, &State::threshold_ratio, memory.threshold_ratio);
    if constexpr (with_energy)
      put(state, &State::internal_energy, memory.energy);
    return *stress;
  }
  /// sqrt(3 J2) minus the strength without the help of heat [Pa]: flow at any rate is below it.
  Real yield(const Mat3& stress, const State& state) const noexcept
  {
    const State& now = state.temperature > 0 ? state : initial_state();
    return von_mises(stress) - threshold(now.threshold_ratio, now.temperature);
  }

  using Kinds = TypeList<MechanicalThresholdOf<false>, MechanicalThresholdOf<true>>;
  /// The variant that stores only the history that the equation of state needs.
  auto kind() const
  {
    using Any = std::variant<MechanicalThresholdOf<false>, MechanicalThresholdOf<true>>;
    const ThresholdMetal& metal = *this;
    return mie_gruneisen ? Any(MechanicalThresholdOf<true>{metal}) : Any(MechanicalThresholdOf<false>{metal});
  }
};
using MechanicalThreshold = MechanicalThresholdOf<true>;

}  // namespace talus
