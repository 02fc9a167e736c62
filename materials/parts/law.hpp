#pragma once
// What a constitutive law is: a small value that knows no mesh, no kernel and no dimension.
#include <array>
#include <concepts>
#include <cstring>
#include <limits>
#include <string_view>
#include <tuple>

#include "core/fields.hpp"
#include "core/simd.hpp"
#include "core/tensor.hpp"

namespace talus {

/// The input of a law for one step of one particle, or of several at once where T is SimdReal.
template <class T>
struct IncrementOf {
  const Mat3Of<T>& F;       ///< deformation gradient at the end of the step, relative to the stress-free start [-]
  const Mat3Of<T>& L;       ///< velocity gradient of the step [1/s]; F = (I + dt L) F_old
  const Mat3Of<T>& stress;  ///< Cauchy stress at its beginning [Pa], tension positive
  Real dt;                  ///< [s]
  T viscous;                ///< artificial viscous pressure of the step [Pa], not in `stress`; it works on what keeps internal energy
  bool elastic;             ///< true in a stage that suspends yielding: answer elastically, leave hardening variables alone
  /// Plastic strain at which the strength softens, constant in the step; without it that of the history, which grows in the step.  See
  /// softening_length.hpp.
  const T* softened_at = nullptr;
  Real time = 0;  ///< at the end of the step [s]
};
using Increment = IncrementOf<Real>;

/// Artificial viscous pressure against the ringing behind shocks, for any law.  The defaults leave less than 1 % of overshoot under the
/// kernel umls, whose waves are three cells long; finite elements are content with 0.06 and 1.5, which leave 12 % here.
struct BulkViscosity {
  Real linear = 0.5, quadratic = 2;
  static constexpr auto fields()
  {
    return std::tuple{
        optional("linear", &BulkViscosity::linear, non_negative, "-", "times density, cell size, wave speed and rate of volume"),
        optional("quadratic", &BulkViscosity::quadratic, non_negative, "-", "times density and (cell size times rate of volume)^2")};
  }
};

/// History of a law that has none.
struct NoHistory {
  static constexpr auto fields() { return std::tuple{}; }
};

/// Numbers of a history.
template <class State>
inline constexpr int numbers_of_state = std::is_empty_v<State> ? 0 : static_cast<int>(sizeof(State) / sizeof(Real));

/// The history of several particles, one per lane.  Lanes beyond `count` repeat the last particle.
template <class State>
struct StateLanes {
  Real* first;         ///< number k of the history stands, for all lanes side by side, at first + k * stride
  std::size_t stride;  ///< at least pack_size
  int count;

  Real* number(int k) const noexcept { return first + static_cast<std::size_t>(k) * stride; }
  State of(int lane) const noexcept
  {
    State one{};
    if constexpr (numbers > 0) {
      std::array<Real, numbers> all;
      for (std::size_t k = 0; k < numbers; ++k)
        all[k] = number(static_cast<int>(k))[lane];
      std::memcpy(static_cast<void*>(&one), all.data(), sizeof(all));
    }
    return one;
  }
  void set(int lane, const State& one) const noexcept
  {
    if constexpr (numbers > 0) {
      std::array<Real, numbers> all;
      std::memcpy(all.data(), static_cast<const void*>(&one), sizeof(all));
      for (std::size_t k = 0; k < numbers; ++k)
        number(static_cast<int>(k))[lane] = all[k];
    }
  }

 private:
  static constexpr std::size_t numbers = numbers_of_state<State>;
};
/// What a law for T changes.
template <class T, class State>
using StateOf = std::conditional_t<std::is_same_v<T, SimdReal>, StateLanes<State>, State>;

/// The place of a variable among the numbers of a history.
template <class State, class Value, class Owner>
int place_in_state(Value Owner::*member) noexcept
{
  const State state{};
  const auto bytes = reinterpret_cast<const std::byte*>(&(state.*member)) - reinterpret_cast<const std::byte*>(&state);
  return static_cast<int>(bytes / static_cast<std::ptrdiff_t>(sizeof(Real)));
}

/// Numbers of a history, one of which is averaged over a length: itself, its mean and the rate of the mean.
template <class State>
struct AveragedHistory {
  Real State::*local;
  Real State::*mean;
  Real State::*rate;
};

/// One variable of a history, for a law that is written once for Real and SimdReal.
template <class State, class Owner>
Real get(const State& state, Real Owner::*member) noexcept
{
  return state.*member;
}
template <class State, class Owner>
Sym3 get(const State& state, Sym3 Owner::*member) noexcept
{
  return state.*member;
}
template <class State, class Owner>
SimdReal get(const StateLanes<State>& lanes, Real Owner::*member) noexcept
{
  return load_loose(lanes.number(place_in_state<State>(member)));
}
template <class State, class Owner>
Sym3Of<SimdReal> get(const StateLanes<State>& lanes, Sym3 Owner::*member) noexcept
{
  Sym3Of<SimdReal> all;
  for (int k = 0; k < 6; ++k)
    all[k] = load_loose(lanes.number(place_in_state<State>(member) + k));
  return all;
}
template <class State, class Owner, class Value>
void put(State& state, Value Owner::*member, const Value& value) noexcept
{
  state.*member = value;
}
template <class State, class Owner>
void put(StateLanes<State>& lanes, Real Owner::*member, const SimdReal& value) noexcept
{
  store_loose(lanes.number(place_in_state<State>(member)), value.of);
}
template <class State, class Owner>
void put(StateLanes<State>& lanes, Sym3 Owner::*member, const Sym3Of<SimdReal>& value) noexcept
{
  for (int k = 0; k < 6; ++k)
    store_loose(lanes.number(place_in_state<State>(member) + k), value[k].of);
}

/// A law.  `constants` is what follows from the parameters alone, worked out once per body.  `update` returns the Cauchy stress [Pa] at the
/// end of the step and changes the history; it never throws, prints or allocates, and answers NaN where it has no answer (for instance
/// det F <= 0).  `wave_speed` [m/s] is an upper bound of the speed of sound in the state F.  Optional members, found by `requires`:
///   void check(std::vector<std::string>& problems) const            rules between parameters, in words
///   State initial_state() const                                     history of a particle at rest, where zero is not it
///   void prestress(const Mat3& stress, State&) const noexcept       history that makes `stress` the stress at F = I (K0 start)
///   Real yield(const Mat3& stress, const State&) const noexcept     <= 0 on or inside the yield surface [Pa]
///   static constexpr bool overstress = true                         yield() is that of slow loading: stresses of flow are above it
///   Real wave_speed(const Mat3& F, const State&, const Constants&) const noexcept   the bound where the history decides; told before the step
///   Real diffusivity(const Constants&) const noexcept               largest diffusivity, of momentum or heat [m^2/s]: bounds the step
///   void divide_strength(Real factor) noexcept                      parameters whose shear strength is that over the factor
///   using Kinds = TypeList<...>;  std::variant<...> kind() const    laws to be run instead, where the parameters decide which history
///                                                                   there is; the law itself is the kind that has all of it, or
///   using Widest = ...                                              that kind is this one
///   static constexpr bool isochoric = true                          plastic flow keeps the volume: its bodies average it by default
///   static constexpr bool objective = false                         it answers a superposed rotation with stress (see is_objective)
///   update and wave_speed for several particles at once             written once as templates over T = Real and T = SimdReal; the history
///                                                                   is a StateOf<T, State>, read by get() and written by put()
/// A history variable with key "plastic_work" [J/m^3 of initial volume] is taken up by the energy audit.
// clang-format off
template <class L>
concept Law = requires(const L law, const Increment& in, typename L::State& state, const typename L::Constants& constants) {
  { L::name } -> std::convertible_to<std::string_view>;
  { L::summary } -> std::convertible_to<std::string_view>;  // one sentence with the source, for the manual
  L::fields();
  L::State::fields();
  { law.density } -> std::convertible_to<Real>;  // kg/m^3 at rest
  { law.constants() } noexcept -> std::same_as<typename L::Constants>;
  { law.update(in, state, constants) } noexcept -> std::same_as<Mat3>;
  { law.wave_speed(in.F, constants) } noexcept -> std::same_as<Real>;
};

/// Whether the wave speed depends on the history.
template <class L, class T>
concept WaveSpeedOfHistory = requires(const L law, const Mat3Of<T>& F, const StateOf<T, typename L::State>& state, const typename L::Constants& constants) {
  { law.wave_speed(F, state, constants) } noexcept -> std::same_as<T>;
};
/// A law that computes several particles at once.
template <class L>
concept LawInLanes = requires(const L law, const IncrementOf<SimdReal>& in, StateLanes<typename L::State>& state, const typename L::Constants& constants) {
  { law.update(in, state, constants) } noexcept -> std::same_as<Mat3Of<SimdReal>>;
  requires WaveSpeedOfHistory<L, SimdReal> || requires { { law.wave_speed(in.F, constants) } noexcept -> std::same_as<SimdReal>; };
};
// clang-format on

/// What a law answers where it has no answer.
template <class T = Real>
Mat3Of<T> no_answer() noexcept
{
  return Mat3Of<T>::Constant(std::numeric_limits<Real>::quiet_NaN());
}

/// The stresses of several particles computed one after the other.  Lanes beyond `count` are zero.
template <class L>
Mat3Of<SimdReal> update_one_by_one(const L& law, const IncrementOf<SimdReal>& in, const StateLanes<typename L::State>& states,
                                   const typename L::Constants& constants) noexcept
{
  Mat3Of<SimdReal> stress = Mat3Of<SimdReal>::Zero();
  for (int lane = 0; lane < states.count; ++lane) {
    const Mat3 F = lane_of(in.F, lane), rate = lane_of(in.L, lane), before = lane_of(in.stress, lane);
    typename L::State state = states.of(lane);
    const Real softened_at = in.softened_at != nullptr ? (*in.softened_at)[lane] : 0;
    const Mat3 after =
        law.update(Increment{F, rate, before, in.dt, in.viscous[lane], in.elastic, in.softened_at != nullptr ? &softened_at : nullptr},
                   state, constants);
    states.set(lane, state);
    for (Index k = 0; k < 9; ++k)
      stress(k).set(lane, after(k));
  }
  return stress;
}

/// What a law answers where some lane has no answer: to the others it must, so it is asked one lane at a time.
template <class L>
Mat3 no_answer_somewhere(const L&, const Increment&, const typename L::State&, const typename L::Constants&) noexcept
{
  return no_answer();
}
template <class L>
Mat3Of<SimdReal> no_answer_somewhere(const L& law, const IncrementOf<SimdReal>& in, const StateLanes<typename L::State>& states,
                                     const typename L::Constants& constants) noexcept
{
  return update_one_by_one(law, in, states, constants);
}

/// True if the law says that its flow keeps the volume, which locks simplices.
template <class L>
constexpr bool is_isochoric() noexcept
{
  if constexpr (requires { L::isochoric; })
    return L::isochoric;
  else
    return false;
}

/// True unless the law says that it is not: the contract tests prove the claim, and its opposite, for every law.
template <class L>
constexpr bool is_objective() noexcept
{
  if constexpr (requires { L::objective; })
    return L::objective;
  else
    return true;
}

}  // namespace talus
