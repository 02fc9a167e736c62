#include "materials/parts/metal.hpp"

#include <cmath>

#include "materials/parts/radial_return.hpp"

namespace talus {

Metal::MetalConstants Metal::metal_constants() const noexcept
{
  const Moduli elastic = moduli();
  MetalConstants c{.bulk = elastic.bulk, .shear = elastic.shear, .heat = heat_fraction / (density * specific_heat), .curve = {}};
  if (mie_gruneisen) {
    c.curve.emplace(*mie_gruneisen, density);
    c.bulk = c.curve->bulk;
  }
  return c;
}

Sym3 Metal::elastic_left_under(const Mat3& stress) const noexcept
{
  const MetalConstants c = metal_constants();
  const Real pressure = -stress.trace() / 3;
  const Real volume_strain = c.curve ? std::log1p(-c.curve->compression_at(pressure)) : -pressure / c.bulk;
  return elastic_left_of(dev(stress), c.shear, volume_strain);
}

template <class T>
T Metal::wave_speed(const Mat3Of<T>& F, const MetalConstants& c) const noexcept
{
  using std::sqrt;
  return sqrt(T(wave_modulus<T>(F.determinant(), c.bulk, c.shear, c.curve) / density));
}
template Real Metal::wave_speed(const Mat3&, const MetalConstants&) const noexcept;
template SimdReal Metal::wave_speed(const Mat3Of<SimdReal>&, const MetalConstants&) const noexcept;

}  // namespace talus
