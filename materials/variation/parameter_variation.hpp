#pragma once
// How a parameter of a law varies in space.
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/fields.hpp"
#include "materials/variation/random_field.hpp"

namespace talus {

enum class Distribution : std::uint8_t { lognormal, normal };
constexpr std::array<std::string_view, 2> enum_names(Distribution) { return {"lognormal", "normal"}; }

/// An entry of the list `variation` of a material.  The value of the law is the mean.
struct ParameterVariation {
  std::string parameter;
  Distribution distribution = Distribution::lognormal;
  Real coefficient_of_variation{};
  std::vector<Real> correlation_length;
  Covariance covariance = Covariance::exponential;
  Index seed = 1;
  std::string correlated_with;
  Real correlation = 0;
  std::string trend;
  std::optional<Real> minimum, maximum;
  SourceLocation where;
  static constexpr auto fields()
  {
    using V = ParameterVariation;
    return std::tuple{
        required("parameter", &V::parameter, any, "-", "key of the law; its value is the mean"),
        optional_choice("distribution", &V::distribution,
                        "lognormal: the logarithm is a Gaussian field, values are positive; normal: the value itself is one"),
        required("coefficient_of_variation", &V::coefficient_of_variation, non_negative, "-", "standard deviation over mean"),
        optional(
            "correlation_length", &V::correlation_length, positive, "m",
            "scale of fluctuation of the Gaussian field (of the logarithm, if lognormal), for all axes or one for each: [40, 4]; needed "
            "unless coefficient_of_variation is 0"),
        optional_choice("covariance", &V::covariance,
                        "correlation at the distance s, in correlation lengths: exponential, exp(-2 s); gaussian, exp(-pi s^2); "
                        "separable_exponential, the product of exp(-2 s) along each axis"),
        optional("seed", &V::seed, non_negative, "-",
                 "another number gives another realisation; the same number, parameter and places give the same on any ranks and threads"),
        optional("correlated_with", &V::correlated_with, any, "-", "parameter of an entry before this one; with correlation"),
        optional("correlation", &V::correlation, within(-1, 1), "-", "of the two Gaussian fields; default 0, independent"),
        optional("trend", &V::trend, any, "-",
                 "formula of x, y, z by which the mean is multiplied, such as \"1 + 0.05 * (10 - y)\": see formulas"),
        optional("minimum", &V::minimum, any, "unit of the parameter", "lower values become this one"),
        optional("maximum", &V::maximum, any, "unit of the parameter", "higher values become this one")};
  }
  void check(std::vector<std::string>& problems) const;
  /// By how much, relative to it, the mean of values at many places is above their geometric mean, where each two are `apart` [m]: half the
  /// variance that their correlation leaves, of the logarithm for lognormal values.
  Real unevenness(const Vec3& apart) const;
  /// Whether both make the same field, wherever they stand in a file.
  bool operator==(const ParameterVariation& other) const;
};

/// The random factors of all entries of a list, of mean 1, without trend and limits.
class VariationFields {
 public:
  explicit VariationFields(std::span<const ParameterVariation> variation);
  /// One factor for each entry.
  void operator()(const Vec3& x, std::span<Real> factors) const noexcept;

 private:
  struct Entry {
    std::optional<RandomField> field;  ///< none without deviation
    Distribution distribution;
    Real deviation;  ///< of the Gaussian variable
    std::optional<std::size_t> with;
    Real correlation;
  };
  std::vector<Entry> entries_;
};

}  // namespace talus
