#pragma once
// What a constitutive law is: a small value that knows no mesh, no kernel and no dimension.
#include <concepts>
#include <limits>
#include <string_view>
#include <tuple>

#include "core/fields.hpp"
#include "core/tensor.hpp"

namespace talus {

/// What a law is told about one step of one particle.
struct Increment {
  const Mat3& F;       ///< deformation gradient at the end of the step, relative to the stress-free start [-]
  const Mat3& L;       ///< velocity gradient of the step [1/s]; F = (I + dt L) F_old
  const Mat3& stress;  ///< Cauchy stress at its beginning [Pa], tension positive
  Real dt;             ///< [s]
  Real viscous;        ///< artificial viscous pressure of the step [Pa], not in `stress`; it works on what keeps internal energy
  bool elastic;        ///< true in a stage that suspends yielding: answer elastically, leave hardening variables alone
};

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

/// A law.  `constants` is what follows from the parameters alone, worked out once per body.  `update` returns the Cauchy stress [Pa] at the end of the step and changes the history; it never throws, prints or
/// allocates, and answers NaN where it has no answer (for instance det F <= 0).  `wave_speed` [m/s] is an upper bound of the
/// speed of sound in the state F.  Optional members, found by `requires`:
///   void check(std::vector<std::string>& problems) const            rules between parameters, in words
///   State initial_state() const                                     history of a particle at rest, where zero is not it
///   void prestress(const Mat3& stress, State&) const noexcept       history that makes `stress` the stress at F = I (K0 start)
///   Real yield(const Mat3& stress, const State&) const noexcept     <= 0 on or inside the yield surface [Pa]
///   Real wave_speed(const Mat3& F, const State&, const Constants&) const noexcept   the bound where the history decides; told before the step
///   Real diffusivity(const Constants&) const noexcept               largest diffusivity, of momentum or heat [m^2/s]: bounds the step
///   using Kinds = TypeList<...>;  std::variant<...> kind() const    laws to be run instead, where the parameters decide which history
///                                                                   there is; the law itself is the kind that has all of it
///   static constexpr bool isochoric = true                          plastic flow keeps the volume: its bodies average it by default
///   static constexpr bool objective = false                         it answers a superposed rotation with stress (see is_objective)
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
// clang-format on

/// What a law answers where it has no answer.
inline Mat3 no_answer() noexcept { return Mat3::Constant(std::numeric_limits<Real>::quiet_NaN()); }

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
