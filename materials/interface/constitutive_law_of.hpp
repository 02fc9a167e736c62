#pragma once
// A constitutive law behind the interface, and its stress update of four particles at a time.  Included by the units in which the laws of the
// list are compiled, one unit per law (cmake/TalusLists.cmake), and by tests.
#include <array>
#include <type_traits>
#include <variant>

#include "core/strip_column.hpp"
#include "core/type_list.hpp"
#include "materials/interface/material.hpp"
#include "materials/strength.hpp"
#include "materials/weakly_compressible.hpp"

namespace talus {

namespace detail {
/// The in-plane part of a multiplied by s, in 3-D all of it.
template <int D>
Mat3Of<SimdReal> scaled_in_plane(Mat3Of<SimdReal> a, const SimdReal& s) noexcept
{
  a.topLeftCorner<D, D>() *= s;
  return a;
}

/// StressSums, one particle per lane.
struct StressLanes {
  SimdReal work = 0, crossing = std::numeric_limits<Real>::infinity(), speed = 0;
  StressSums total() const noexcept
  {
    StressSums sums{sum(work.of)};
    for (int lane = 0; lane < pack_size; ++lane)
      sums.crossing = std::min(sums.crossing, crossing[lane]), sums.speed = std::max(sums.speed, speed[lane]);
    return sums;
  }
};

/// a : L, with L in the plane where D is 2.
template <int D>
SimdReal stress_power(const Sym3Of<SimdReal>& a, const MatOf<D>& L) noexcept
{
  SimdReal power = a[0] * L(0, 0) + a[1] * L(1, 1) + a[3] * (L(0, 1) + L(1, 0));
  if constexpr (D == 3)
    power += a[2] * L(2, 2) + a[4] * (L(1, 2) + L(2, 1)) + a[5] * (L(0, 2) + L(2, 0));
  return power;
}

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
    return update_strip(material, strip);
  }
  StressSums update_stress(const Material& material, const StressStrip<3>& strip) const noexcept override
  {
    return update_strip(material, strip);
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
    if constexpr (requires { law_.averaging_length(); })
      return StrainAveraging{.length = law_.averaging_length(),
                             .band = law_.band_width(),
                             .largest = law_.largest_averaged(),
                             .strain = place_in_state<State>(&State::plastic_strain),
                             .mean = place_in_state<State>(&State::mean_plastic_strain),
                             .rate = place_in_state<State>(&State::mean_plastic_rate)};
    else
      return std::nullopt;
  }

 private:
  Real wave_speed(const Mat3& F, const State& state) const noexcept
  {
    if constexpr (requires { law_.wave_speed(F, state, constants_); })
      return law_.wave_speed(F, state, constants_);
    else
      return law_.wave_speed(F, constants_);
  }

  template <int D>
  StressSums update_strip(const Material& material, const StressStrip<D>& strip) const noexcept
  {
    detail::StressLanes lanes;
    for (std::size_t i = 0; i < strip.n; i += pack_size)
      update_pack(material, strip, i, lanes);
    return lanes.total();
  }

  /// Particles i to i + 3 of the strip, or those up to its end.
  template <int D>
  [[gnu::flatten]] void update_pack(const Material& material, const StressStrip<D>& strip, std::size_t i,
                                    detail::StressLanes& sums) const noexcept
  {
    const Real dt = strip.dt;
    const int count = static_cast<int>(std::min<std::size_t>(pack_size, strip.n - i));
    const auto report = [&](int lane, Trouble trouble) { strip.errors->report(strip.id[i + static_cast<std::size_t>(lane)], trouble); };
    const auto rate = strip.L.load(i);
    const Mat3Of<SimdReal> velocity_gradient = embed(rate);
    Mat3Of<SimdReal> F = strip.F.load(i);
    F.template topLeftCorner<D, D>() += SimdReal(dt) * (rate * F.template topLeftCorner<D, D>());
    strip.F.store(i, F);
    const SimdReal J = F.determinant();
    const auto good = J > 0;  // false for NaN
    if (!all_of(good))
      for (int lane = 0; lane < count; ++lane)
        if (!good[lane])
          report(lane, std::isfinite(J[lane]) ? Trouble::inverted : Trouble::not_finite);
    const SimdReal volume_before = strip.volume.load(i), volume = J * strip.volume0.load(i);
    strip.volume.store(i, volume);
    const SimdReal shrinking = max(-SimdReal(rate.trace()), 0);
    const SimdReal h = strip.altitude.load(i);

    const Sym3Of<SimdReal> stored = strip.stress.load(i);
    Mat3Of<SimdReal> F_of_law = F, L_of_law = velocity_gradient, stress_of_law = unpack(stored);
    if (material.averages_volume) {
      const SimdReal to_average = strip.averaged.load(i) / J, ratio = D == 2 ? sqrt(to_average) : pow(to_average, Real{1} / D);
      const SimdReal s = ratio / strip.volume_ratio.load(i);
      strip.volume_ratio.store(i, ratio);
      F_of_law = detail::scaled_in_plane<D>(F, ratio);
      L_of_law = detail::scaled_in_plane<D>(velocity_gradient, s);
      for (int d = 0; d < D; ++d)
        L_of_law(d, d) += (s - 1) / dt;
    }
    StateLanes<State> states{strip.history.first + i, strip.history.stride, count};
    const SimdReal speed_of_waves = wave_speed(F_of_law, states);
    SimdReal q = 0;
    if (material.viscosity) {
      stress_of_law.diagonal().array() += strip.viscous.load(i);
      q = strip.mass.load(i) / volume * h * shrinking *
          (material.viscosity->quadratic * h * shrinking + material.viscosity->linear * speed_of_waves);
      strip.viscous.store(i, q);
    }
    SimdReal u = 0;
    if (strip.pore_after) {
      stress_of_law.diagonal().array() += strip.pore.load(i);
      u = strip.pore_after.load(i);
      strip.pore.store(i, u);
    }
    Mat3Of<SimdReal> after = update({F_of_law, L_of_law, stress_of_law, dt, q, strip.elastic}, states);
    after.diagonal().array() -= q + u;
    const Sym3Of<SimdReal> stress = talus::pack(after);
    const auto answered = isfinite(SimdReal(stress.sum()));
    if (!all_of(answered))
      for (int lane = 0; lane < count; ++lane)
        if (good[lane] && !answered[lane])
          report(lane, Trouble::no_answer);
    strip.stress.store(i, stress);

    const SimdReal work =
        0.5 * dt * (volume_before * detail::stress_power<D>(stored, rate) + volume * detail::stress_power<D>(stress, rate));
    const SimdReal speed = sqrt(SimdReal(strip.v.load(i).squaredNorm()));
    const SimdReal crossing = crossing_time<D>(diffusivity(), material.viscosity, h, speed, speed_of_waves, shrinking);
    const auto sound = good && answered, counts = sound && SimdReal(Pack{0, 1, 2, 3}) < static_cast<Real>(count);
    sums.work += where(counts, work, 0);  // lanes beyond the last particle
    sums.crossing = where(counts, min(sums.crossing, crossing), sums.crossing);
    sums.speed = where(counts, max(sums.speed, speed), sums.speed);
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
