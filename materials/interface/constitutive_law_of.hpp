#pragma once
// A constitutive law behind the interface, and its stress update of four particles at a time.  Included by the units in which the laws of the
// list are compiled, one unit per law (cmake/TalusLists.cmake), and by tests.
#include <array>
#include <type_traits>
#include <variant>

#include "core/strip_column.hpp"
#include "core/type_list.hpp"
#include "materials/interface/stress_pack.hpp"
#include "materials/parts/strength.hpp"
#include "materials/parts/weakly_compressible.hpp"

namespace talus {

namespace detail {
/// Where each history variable of a law stands in a row.
template <class State>
auto variables_of()
{
  constexpr std::size_t n = std::tuple_size_v<decltype(State::fields())>;
  std::array<HistoryVariable, n> all{};
  std::size_t number = 0;
  for_each_field<State>([&]<class Owner, class Value>(const History<Owner, Value>& field) {
    static_assert(std::is_same_v<Value, Real> || std::is_same_v<Value, Sym3>);
    all[number++] = {field.key, field.unit, field.meaning, place_in_state<State>(field.member),
                     static_cast<int>(sizeof(Value) / sizeof(Real))};
  });
  return all;
}
/// Particles i to i + 3 of the strip, or those up to its end.  L is final; of_particles() answers for several particles at once.
template <int D, class L>
[[gnu::flatten]] void update_pack(const L& law, const Material& material, const StressStrip<D>& strip, std::size_t i,
                                  StressLanes& sums) noexcept
{
  const MatOf<D> rate = strip.L.load(i);
  const SimdReal volume_before = strip.volume.load(i), shrinking = max(-SimdReal(rate.trace()), 0);
  const Mat3Of<SimdReal> F = move(strip, i, rate);
  const SimdReal J = F.determinant();
  take_volume(strip, i, J);

  const Sym3Of<SimdReal> before = strip.stress.load(i);
  Mat3Of<SimdReal> F_of_law = F, L_of_law = embed(rate), stress_of_law = unpack(before);
  if (material.averages_volume)
    average_volume(strip, i, J, F_of_law, L_of_law);
  StateLanes<typename L::State> states{strip.history.first + i, strip.history.stride, lanes_of(strip, i)};
  const auto& of_particles = law.of_particles(states);
  const SimdReal speed_of_waves = of_particles.wave_speed(F_of_law, states);
  const auto [viscous, pore] = find_pressures(material, strip, i, shrinking, speed_of_waves, stress_of_law);
  Mat3Of<SimdReal> after = of_particles.update({F_of_law, L_of_law, stress_of_law, strip.dt, viscous, strip.elastic}, states);
  after.diagonal().array() -= viscous + pore;

  const Sym3Of<SimdReal> stress = talus::pack(after);
  const auto sound = take_stress(strip, i, J, stress);
  const SimdReal work = work_of(strip, i, rate, before, volume_before, stress);
  count(material, strip, i, sound, work, speed_of_waves, shrinking, law.diffusivity(), sums);
}

template <int D, class L>
StressSums update_strip(const L& law, const Material& material, const StressStrip<D>& strip) noexcept
{
  StressLanes lanes;
  for (std::size_t i = 0; i < strip.n; i += pack_size)
    update_pack(law, material, strip, i, lanes);
  return lanes.total();
}
}  // namespace detail

/// Whether particles of a law can begin with a stress.
template <class L>
inline constexpr bool has_prestress = requires(const L& law, typename L::State& state)
{
  law.prestress(Mat3(), state);
};

/// With the history of this kind of a law.
template <class L>
const LawDescription& kind_description() noexcept
{
  using State = typename L::State;
  static const auto variables = detail::variables_of<State>();
  static const LawDescription description{.name = L::name,
                                          .summary = L::summary,
                                          .variables = variables,
                                          .history_width = numbers_of_state<State>,
                                          .starts_from_stress = has_prestress<L>,
                                          .has_strength = HasStrength<L>,
                                          .is_isochoric = is_isochoric<L>(),
                                          .is_fluid = std::is_base_of_v<WeaklyCompressible, L>};
  return description;
}
template <class L>
const LawDescription& law_description() noexcept
{
  if constexpr (requires { typename L::Widest; })
    return kind_description<typename L::Widest>();
  else
    return kind_description<L>();
}

template <class L>
class ConstitutiveLawOf final : public ConstitutiveLaw {
  static_assert(Law<L>);

 public:
  using State = typename L::State;
  static_assert(std::is_trivially_destructible_v<State> && (std::is_empty_v<State> || sizeof(State) % sizeof(Real) == 0),
                "a history consists of numbers and symmetric tensors");

  explicit ConstitutiveLawOf(const L& law) : ConstitutiveLaw(kind_description<L>()), law_(law), constants_(law.constants()) {}

  const L& parameters() const noexcept { return law_; }
  const typename L::Constants& constants() const noexcept { return constants_; }
  /// The row of a particle as the struct of the law.
  static State& state_of(Real* history) noexcept
  {
    if constexpr (std::is_empty_v<State>) {
      static State nothing;
      return nothing;
    } else {
      return *reinterpret_cast<State*>(history);
    }
  }
  static const State& state_of(const Real* history) noexcept { return state_of(const_cast<Real*>(history)); }

  Real density() const noexcept override { return law_.density; }
  void initial_history(Real* history) const noexcept override
  {
    if constexpr (requires { law_.initial_state(); })
      state_of(history) = law_.initial_state();
    else if constexpr (!std::is_empty_v<State>)
      state_of(history) = {};
  }

  /// What answers for the particles of several lanes: the law itself, the same for all.
  const ConstitutiveLawOf& of_particles(const StateLanes<State>&) const noexcept { return *this; }

  Mat3 update(const Increment& step, Real* history) const noexcept override { return law_.update(step, state_of(history), constants_); }
  /// Of several particles, one per lane; lanes beyond `count` repeat the last one.  Where the law is not written for lanes, one after the
  /// other.
  Mat3Of<SimdReal> update(const IncrementOf<SimdReal>& step, StateLanes<State>& states) const noexcept
  {
    if constexpr (LawInLanes<L>)
      return law_.update(step, states, constants_);
    else
      return update_one_by_one(law_, step, states, constants_);
  }
  StressSums update_stress(const Material& material, const StressStrip<2>& strip) const noexcept override
  {
    return detail::update_strip(*this, material, strip);
  }
  StressSums update_stress(const Material& material, const StressStrip<3>& strip) const noexcept override
  {
    return detail::update_strip(*this, material, strip);
  }

  Real wave_speed(const Mat3& F) const noexcept override { return law_.wave_speed(F, constants_); }
  Real wave_speed(const Mat3& F, const Real* history) const noexcept override { return wave_speed(F, state_of(history)); }
  SimdReal wave_speed(const Mat3Of<SimdReal>& F, const StateLanes<State>& states) const noexcept
  {
    if constexpr (WaveSpeedOfHistory<L, SimdReal>) {
      return law_.wave_speed(F, states, constants_);
    } else if constexpr (LawInLanes<L>) {
      return law_.wave_speed(F, constants_);
    } else {
      SimdReal speed = 1;
      for (int lane = 0; lane < states.count; ++lane)
        speed.set(lane, wave_speed(lane_of(F, lane), states.of(lane)));
      return speed;
    }
  }
  std::optional<Real> diffusivity() const noexcept override
  {
    if constexpr (requires { law_.diffusivity(constants_); })
      return law_.diffusivity(constants_);
    else
      return std::nullopt;
  }

  bool prestress(const Mat3& stress, Real* history) const noexcept override
  {
    if constexpr (has_prestress<L>)
      law_.prestress(stress, state_of(history));
    return has_prestress<L>;
  }
  std::shared_ptr<const ConstitutiveLaw> weakened(Real factor) const override
  {
    L weaker = law_;
    return divide_strength(weaker, factor) ? std::make_shared<const ConstitutiveLawOf>(weaker) : nullptr;
  }
  std::optional<Real> shear_modulus() const noexcept override
  {
    if constexpr (requires { constants_.shear; })
      return constants_.shear;
    else
      return std::nullopt;
  }
  std::optional<HeatConduction> heat() const noexcept override
  {
    if constexpr (requires { law_.conductivity; })
      if (law_.conductivity)
        if (const auto temperature = description().scalar_variable("temperature"))
          return HeatConduction{*law_.conductivity, law_.specific_heat, *temperature};
    return std::nullopt;
  }
  std::optional<StrainAveraging> strain_averaging() const noexcept override
  {
    if constexpr (requires { law_.averaging_length(); }) {
      constexpr AveragedHistory<State> numbers = L::averaged_history();
      return StrainAveraging{.length = law_.averaging_length(),
                             .band = law_.band_width(),
                             .largest = law_.largest_averaged(),
                             .strain = place_in_state<State>(numbers.local),
                             .mean = place_in_state<State>(numbers.mean),
                             .rate = place_in_state<State>(numbers.rate)};
    } else {
      return std::nullopt;
    }
  }

 private:
  Real wave_speed(const Mat3& F, const State& state) const noexcept
  {
    if constexpr (requires { law_.wave_speed(F, state, constants_); })
      return law_.wave_speed(F, state, constants_);
    else
      return law_.wave_speed(F, constants_);
  }

  L law_;
  typename L::Constants constants_;
};

template <class L>
std::shared_ptr<const ConstitutiveLaw> constitutive_law(const L& law)
{
  if constexpr (requires { law.kind(); })
    return std::visit(
        []<class Kind>(const Kind& kind) -> std::shared_ptr<const ConstitutiveLaw> {
          return std::make_shared<const ConstitutiveLawOf<Kind>>(kind);
        },
        law.kind());
  else
    return std::make_shared<const ConstitutiveLawOf<L>>(law);
}

/// The law of a material as the type that it is; nullptr if it is another.
template <class L>
const ConstitutiveLawOf<L>* law_as(const Material& material) noexcept
{
  return dynamic_cast<const ConstitutiveLawOf<L>*>(&material.law());
}
/// What particle i remembers, as the struct of its law.
template <class L>
typename L::State& state_of(Material& material, Index i) noexcept
{
  return ConstitutiveLawOf<L>::state_of(material.history.row(i));
}

}  // namespace talus
