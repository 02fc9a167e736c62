#pragma once
// Gaussian random fields whose value depends on the seed and the place alone.
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/tensor.hpp"

namespace talus {

/// Correlation of two points at the distance r, where each axis is scaled by its correlation length t (scale of fluctuation, Vanmarcke 1983:
/// the integral of the correlation along a line from -infinity to infinity).  With s = sqrt(sum (r_i / t_i)^2):
///   exponential            exp(-2 s)                       as in Fenton & Griffiths 2008, "Risk assessment in geotechnical engineering"
///   gaussian               exp(-pi s^2)
///   separable_exponential  exp(-2 sum |r_i| / t_i)
enum class Covariance : std::uint8_t { exponential, gaussian, separable_exponential };
constexpr std::array<std::string_view, 3> enum_names(Covariance) { return {"exponential", "gaussian", "separable_exponential"}; }

/// A field of mean 0 and variance 1: g(x) = sqrt(2 / N) sum cos(k_i . x + p_i), with wave vectors k_i drawn from the spectral density of the
/// covariance and uniform phases p_i (Shinozuka 1971, J. Acoust. Soc. Am. 49, 357; Mantoglou & Wilson 1982, Water Resour. Res. 18, 1379).
/// Mean and covariance over the seeds are exact for every N; the distribution at a point is Gaussian but for terms of order 1/N.
/// Coordinates count in 3-D; those of a plane have z = 0 and, by the same formula, the covariance of the plane.
class RandomField {
 public:
  static constexpr int waves = 1000;

  /// The same seed with another `stream` is an independent field.  Lengths in [m].
  RandomField(Covariance covariance, const Vec3& lengths, std::uint64_t seed, std::string_view stream);

  Real operator()(const Vec3& x) const noexcept;
  /// The correlation of the values at two places that are `apart` [m].
  static Real correlation(Covariance covariance, const Vec3& lengths, const Vec3& apart) noexcept;

 private:
  struct Wave {
    Vec3 k;  ///< [1/m]
    Real phase;
  };
  std::vector<Wave> waves_;
};

}  // namespace talus
