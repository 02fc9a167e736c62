#include "materials/variation/random_field.hpp"

#include <cmath>
#include <numbers>
#include <random>

namespace talus {

namespace {

/// Random numbers that are equal on all platforms: std::mt19937_64 is, the distributions of the standard library differ between libraries.
class FieldNumbers {
 public:
  /// FNV-1a of the stream (Fowler, Noll & Vo), mixed with the seed as in SplitMix64, so that neighbouring seeds give unrelated numbers.
  FieldNumbers(std::uint64_t seed, std::string_view stream)
  {
    std::uint64_t state = 0xcbf29ce484222325;
    for (const char letter : stream)
      state = (state ^ static_cast<unsigned char>(letter)) * 0x100000001b3;
    state += (seed + 1) * 0x9e3779b97f4a7c15;
    state = (state ^ (state >> 30)) * 0xbf58476d1ce4e5b9;
    state = (state ^ (state >> 27)) * 0x94d049bb133111eb;
    random_.seed(state ^ (state >> 31));
  }
  /// In (0, 1).
  Real uniform() { return (static_cast<Real>(random_() >> 12) + 0.5) * 0x1p-52; }
  /// Of mean 0 and variance 1 (Box & Muller 1958).
  Real normal()
  {
    const Real radius = std::sqrt(-2 * std::log(uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }
  /// Of density 1 / (pi (1 + x^2)), whose characteristic function is exp(-|t|).
  Real cauchy() { return std::tan(std::numbers::pi * (uniform() - 0.5)); }

 private:
  std::mt19937_64 random_;
};

/// A wave vector, of lengths 1.
Vec3 wave_vector(Covariance covariance, FieldNumbers& random)
{
  const auto draw = [&](auto&& one) {
    Vec3 k;
    for (int d = 0; d < 3; ++d)
      k[d] = one();
    return k;
  };
  switch (covariance) {
    case Covariance::exponential: {  // t-distribution with one degree of freedom, characteristic function exp(-|t|)
      const Vec3 z = draw([&] { return random.normal(); });
      return 2 * z / std::abs(random.normal());
    }
    case Covariance::gaussian: return std::sqrt(2 * std::numbers::pi) * draw([&] { return random.normal(); });
    case Covariance::separable_exponential: return 2 * draw([&] { return random.cauchy(); });
  }
  return Vec3::Zero();
}

}  // namespace

RandomField::RandomField(Covariance covariance, const Vec3& lengths, std::uint64_t seed, std::string_view stream)
{
  FieldNumbers random(seed, stream);
  for (int i = 0; i < waves; ++i) {
    const Vec3 k = wave_vector(covariance, random).cwiseQuotient(lengths);
    waves_.push_back({k, 2 * std::numbers::pi * random.uniform()});
  }
}

Real RandomField::operator()(const Vec3& x) const noexcept
{
  Real sum = 0;
  for (const Wave& wave : waves_)
    sum += std::cos(wave.k.dot(x) + wave.phase);
  return std::sqrt(Real{2} / waves) * sum;
}

Real RandomField::correlation(Covariance covariance, const Vec3& lengths, const Vec3& apart) noexcept
{
  const Vec3 scaled = apart.cwiseQuotient(lengths);
  switch (covariance) {
    case Covariance::exponential: return std::exp(-2 * scaled.norm());
    case Covariance::gaussian: return std::exp(-std::numbers::pi * scaled.squaredNorm());
    case Covariance::separable_exponential: return std::exp(-2 * scaled.cwiseAbs().sum());
  }
  return 0;
}

}  // namespace talus
