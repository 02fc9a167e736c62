#pragma once
// What laws of metals under impact share: density, elasticity, heat, equation of state, and the history of flow that heats.
#include <optional>
#include <string_view>
#include <tuple>

#include "materials/parts/elasticity.hpp"
#include "materials/parts/equation_of_state.hpp"
#include "materials/parts/law.hpp"

namespace talus {

/// A metal on logarithmic elasticity that plastic work heats.  Its constants begin with MetalConstants.
struct Metal : Elasticity {
  Real density{}, specific_heat{}, heat_fraction = 0.9;
  std::optional<Real> conductivity;
  std::optional<MieGruneisen> mie_gruneisen;

  struct MetalConstants {
    Real bulk, shear;  ///< Pa; the bulk modulus is used where there is no equation of state
    Real heat;         ///< heat_fraction / (density specific_heat) [K m^3/J]
    std::optional<MieGruneisenCurve> curve;
  };
  /// An upper bound of the speed of sound [m/s].
  template <class T>
  T wave_speed(const Mat3Of<T>& F, const MetalConstants& c) const noexcept;
  /// The diffusivity of heat [m^2/s].
  Real diffusivity(const MetalConstants&) const noexcept { return conductivity ? *conductivity / (density * specific_heat) : 0; }
  /// Sets the elastic strain in the history for which the Cauchy stress at F = I is `stress` [Pa].
  template <class State>
  void prestress(const Mat3& stress, State& state) const noexcept
  {
    state.elastic_left = elastic_left_under(stress);
  }

 protected:
  MetalConstants metal_constants() const noexcept;

 private:
  Sym3 elastic_left_under(const Mat3& stress) const noexcept;
};

/// The keys that come first, those of heating, and the groups and keys that come last, to be joined with those of a law by std::tuple_cat.
template <class Law>
constexpr auto elastic_metal_fields()
{
  return std::tuple_cat(std::tuple{required<Law, Real>("density", &Law::density, positive, "kg/m^3", "mass density at rest")},
                        elastic_fields<Law>());
}
template <class Law>
constexpr auto heating_fields()
{
  return std::tuple{required<Law, Real>("specific_heat", &Law::specific_heat, positive, "J/(kg K)", "heat by mass and temperature"),
                    optional<Law, Real>("heat_fraction", &Law::heat_fraction, within(0, 1), "-", "share of the plastic work that heats")};
}
template <class Law>
constexpr auto conductivity_field()
{
  return std::tuple{optional<Law, std::optional<Real>>("conductivity", &Law::conductivity, positive, "W/(m K)",
                                                       "thermal conductivity; without it no heat flows between particles")};
}
template <class Law>
constexpr auto mie_gruneisen_field()
{
  return std::tuple{group<Law, std::optional<MieGruneisen>>("mie_gruneisen", &Law::mie_gruneisen,
                                                            "pressure of strong compression, instead of the bulk modulus")};
}

/// The history of a metal without equation of state.
struct MetalState {
  Sym3 elastic_left = Sym3::Zero();
  Real plastic_strain = 0, plastic_work = 0;
  Real temperature = 0;  ///< 0 before the first step: then that of the parameters
};
/// The fields of a State that inherits MetalState.
template <class State>
constexpr auto metal_history()
{
  return std::tuple{
      history<State, Sym3>("elastic_left", &State::elastic_left, "-",
                           "elastic left Cauchy-Green tensor minus identity: xx, yy, zz, xy, yz, xz"),
      history<State, Real>("plastic_strain", &State::plastic_strain, "-", "p, accumulated plastic strain, integral of sqrt(2/3 e:e)"),
      history<State, Real>("plastic_work", &State::plastic_work, "J/m^3", "dissipated energy per initial volume"),
      history<State, Real>("temperature", &State::temperature, "K", "of the particle: its start and what plastic work has heated")};
}

/// What an equation of state adds to the history.
template <bool with_energy>
struct EnergyHistory {
  Real internal_energy = 0;
};
template <>
struct EnergyHistory<false> {};
/// Its fields, in a State that inherits it: one or none.
template <class State>
constexpr auto energy_history()
{
  if constexpr (requires(State state) { state.internal_energy; })
    return std::tuple{history<State, Real>("internal_energy", &State::internal_energy, "J/m^3",
                                           "work of stress and artificial viscosity per initial volume")};
  else
    return std::tuple{};
}

}  // namespace talus
