#pragma once
// The stress update of a law whose parameters vary: each particle has a law of its own.  Included by the units in which the laws are compiled, and by
// tests.
#include <fmt/format.h>

#include <cstddef>
#include <optional>
#include <type_traits>

#include "materials/interface/constitutive_law_of.hpp"
#include "materials/interface/varied_law.hpp"

namespace talus {

/// A parameter of L that is a number, and where it stands in L.
struct PlaceOfNumber {
  LawNumber number;
  Range range;
  std::size_t offset;  ///< [bytes]
};

template <class L>
Real& number_at(L& law, std::size_t offset) noexcept
{
  return *reinterpret_cast<Real*>(reinterpret_cast<std::byte*>(&law) + offset);
}

/// All that are given.
template <class L>
std::vector<PlaceOfNumber> numbers_of(const L& law)
{
  std::vector<PlaceOfNumber> all;
  const auto add = [&](std::string_view key, std::string_view unit, const Range& range, const Real& value) {
    const auto offset = reinterpret_cast<const std::byte*>(&value) - reinterpret_cast<const std::byte*>(&law);
    all.push_back({{key, unit, value}, range, static_cast<std::size_t>(offset)});
  };
  for_each_field<L>([&]<class Field>(const Field& field) {
    const auto& member = law.*field.member;
    using Value = std::remove_cvref_t<decltype(member)>;
    if constexpr (std::is_same_v<Value, Real>)
      add(field.key, field.unit, field.range, member);
    else if constexpr (std::is_same_v<Value, std::optional<Real>>)
      if (member)
        add(field.key, field.unit, field.range, *member);
  });
  return all;
}

/// L is the kind of the law that its parameters ask for.
template <class L>
class VariedLawOf final : public VariedLaw {
 public:
  using State = typename L::State;

  /// The law of one particle.
  struct OfParticle {
    L law;
    typename L::Constants constants;

    explicit OfParticle(const L& of) noexcept : law(of), constants(of.constants()) {}
    Real wave_speed(const Mat3& F, const State& state) const noexcept
    {
      if constexpr (requires { law.wave_speed(F, state, constants); })
        return law.wave_speed(F, state, constants);
      else
        return law.wave_speed(F, constants);
    }
  };
  /// The laws of several particles, one per lane.  Nothing is inlined, so that a law is compiled once for all dimensions.
  class OfParticles {
   public:
    [[gnu::noinline]] OfParticles(const VariedLawOf& of, const StateLanes<State>& states) noexcept
    {
      for (int lane = 0; lane < states.count; ++lane)
        lanes_[static_cast<std::size_t>(lane)].emplace(of.of_particle(states.number(width) + lane, states.stride));
    }
    [[gnu::noinline]] SimdReal wave_speed(const Mat3Of<SimdReal>& F, const StateLanes<State>& states) const noexcept
    {
      SimdReal speed = 1;
      for (int lane = 0; lane < states.count; ++lane)
        speed.set(lane, lanes_[static_cast<std::size_t>(lane)]->wave_speed(lane_of(F, lane), states.of(lane)));
      return speed;
    }
    [[gnu::noinline]] Mat3Of<SimdReal> update(const IncrementOf<SimdReal>& in, StateLanes<State>& states) const noexcept
    {
      Mat3Of<SimdReal> stress = Mat3Of<SimdReal>::Zero();
      for (int lane = 0; lane < states.count; ++lane) {
        const OfParticle& particle = *lanes_[static_cast<std::size_t>(lane)];
        const Mat3 F = lane_of(in.F, lane), rate = lane_of(in.L, lane), before = lane_of(in.stress, lane);
        State state = states.of(lane);
        const Increment one{F, rate, before, in.dt, in.viscous[lane], in.elastic, nullptr, in.time};
        const Mat3 after = particle.law.update(one, state, particle.constants);
        states.set(lane, state);
        for (Index k = 0; k < 9; ++k)
          stress(k).set(lane, after(k));
      }
      return stress;
    }

   private:
    std::array<std::optional<OfParticle>, pack_size> lanes_;
  };

  VariedLawOf(const L& law, const LawDescription& description, const std::vector<PlaceOfNumber>& varied,
              std::vector<ParameterVariation> variation)
      : VariedLaw(description, numbers(varied), std::move(variation)), mean_(law), places_(varied)
  {}

  Real density() const noexcept override { return mean_.parameters().density; }
  void initial_history(Real* history) const noexcept override
  {
    mean_.initial_history(history);
    std::fill_n(history + width, places_.size(), Real{1});
  }

  Mat3 update(const Increment& step, Real* history) const noexcept override
  {
    const L law = of_particle(history + width, 1);
    return law.update(step, ConstitutiveLawOf<L>::state_of(history), law.constants());
  }
  /// What answers for the particles of several lanes: their laws and the constants of these, worked out once per step.
  OfParticles of_particles(const StateLanes<State>& states) const noexcept { return OfParticles(*this, states); }
  StressSums update_stress(const Material& material, const StressStrip<2>& strip) const noexcept override
  {
    return detail::update_strip(*this, material, strip);
  }
  StressSums update_stress(const Material& material, const StressStrip<3>& strip) const noexcept override
  {
    return detail::update_strip(*this, material, strip);
  }

  Real wave_speed(const Mat3& F) const noexcept override { return mean_.wave_speed(F); }
  Real wave_speed(const Mat3& F, const Real* history) const noexcept override
  {
    return OfParticle(of_particle(history + width, 1)).wave_speed(F, ConstitutiveLawOf<L>::state_of(history));
  }
  std::optional<Real> diffusivity() const noexcept override { return mean_.diffusivity(); }

  bool prestress(const Mat3& stress, Real* history) const noexcept override
  {
    if constexpr (has_prestress<L>)
      of_particle(history + width, 1).prestress(stress, ConstitutiveLawOf<L>::state_of(history));
    return has_prestress<L>;
  }
  std::shared_ptr<const ConstitutiveLaw> weakened(Real factor) const override
  {
    if constexpr (HasStrength<L>) {
      auto weaker = std::make_shared<VariedLawOf>(mean_.parameters(), description(), places_,
                                                  std::vector<ParameterVariation>(variation().begin(), variation().end()));
      weaker->divided_by_ = divided_by_ * factor;
      return weaker;
    } else {
      return nullptr;
    }
  }
  std::optional<Real> shear_modulus() const noexcept override { return mean_.shear_modulus(); }
  std::optional<Real> shear_modulus(const Real* history) const noexcept override
  {
    if constexpr (requires(const typename L::Constants& constants) { constants.shear; })
      return of_particle(history + width, 1).constants().shear;
    else
      return std::nullopt;
  }
  std::optional<HeatConduction> heat() const noexcept override { return mean_.heat(); }
  std::optional<StrainAveraging> strain_averaging() const noexcept override { return mean_.strain_averaging(); }

  std::string problem(const Real* history) const override
  {
    L law = with_factors(history + width, 1);
    for (const PlaceOfNumber& place : places_)
      if (const Real value = number_at(law, place.offset); !place.range.holds(value))
        return fmt::format("{} is {:.6g}{}{}, but must be {}", place.number.key, value, place.number.unit == "-" ? "" : " ",
                           place.number.unit == "-" ? "" : place.number.unit, to_string(place.range));
    std::vector<std::string> problems;
    if constexpr (requires { law.check(problems); })
      law.check(problems);
    return problems.empty() ? std::string() : problems.front();
  }

 private:
  static constexpr int width = numbers_of_state<State>;

  static std::vector<LawNumber> numbers(const std::vector<PlaceOfNumber>& places)
  {
    std::vector<LawNumber> all;
    for (const PlaceOfNumber& place : places)
      all.push_back(place.number);
    return all;
  }

  /// Factor k stands at factors[k * stride].
  L with_factors(const Real* factors, std::size_t stride) const noexcept
  {
    L law = mean_.parameters();
    for (std::size_t k = 0; k < places_.size(); ++k)
      number_at(law, places_[k].offset) *= factors[k * stride];
    return law;
  }
  L of_particle(const Real* factors, std::size_t stride) const noexcept
  {
    L law = with_factors(factors, stride);
    if (divided_by_ != 1)
      divide_strength(law, divided_by_);
    return law;
  }
  ConstitutiveLawOf<L> mean_;
  std::vector<PlaceOfNumber> places_;
  Real divided_by_ = 1;  ///< the strength, after the factors
};

template <class L>
std::shared_ptr<const VariedLaw> varied_law_of(const L& law, const std::vector<ParameterVariation>& variation)
{
  const auto make = [&]<class Kind>(const Kind& kind) -> std::shared_ptr<const VariedLaw> {
    std::vector<PlaceOfNumber> varied;
    std::vector<LawNumber> numbers;
    for (const ParameterVariation& one : variation)
      for (const PlaceOfNumber& place : numbers_of(kind))
        if (place.number.key == one.parameter)
          varied.push_back(place), numbers.push_back(place.number);
    return std::make_shared<const VariedLawOf<Kind>>(kind, description_with_factors(kind_description<Kind>(), numbers), varied, variation);
  };
  if constexpr (requires { law.kind(); })
    return std::visit(make, law.kind());
  else
    return make(law);
}

}  // namespace talus
