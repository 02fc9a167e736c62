#include "app/commands/bench/bench_laws.hpp"

namespace talus {

namespace {

constexpr Real soil_stiffness = 1e7;  // Pa

/// Elastic laws: soft rubber.
template <class L>
void set_parameters(L& law)
{
  law.density = 1000;
  law.youngs_modulus = 1e5;
  law.poisson_ratio = 0.3;
}

template <class L>
void set_soil(L& law)
{
  law.density = 2000;
  law.youngs_modulus = soil_stiffness;
  law.poisson_ratio = 0.3;
  law.friction_angle = 30;
  law.cohesion = 5e3;
}
void set_parameters(DruckerPrager& law)
{
  set_soil(law);
  law.match = ConeMatch::plane_strain;
}
void set_parameters(MohrCoulomb& law) { set_soil(law); }
void set_parameters(ModifiedCamClay& law)
{
  law.density = 1800;
  law.shear_modulus = 4e6;
  law.compression_index = 0.2;
  law.swelling_index = 0.05;
  law.critical_state_slope = 1.1;
  law.preconsolidation_pressure = 1e5;
  law.reference_pressure = 0.05 * soil_stiffness;
}
void set_parameters(MuI& law)  // glass beads, Jop, Forterre & Pouliquen 2006
{
  law.density = 1500;
  law.youngs_modulus = soil_stiffness;
  law.poisson_ratio = 0.3;
  law.static_friction = 0.382;
  law.limiting_friction = 0.644;
  law.inertial_number = 0.279;
  law.grain_diameter = 0.53e-3;
  law.grain_density = 2450;
}
void set_parameters(Newtonian& law)  // water, softened
{
  law.density = 1000;
  law.bulk_modulus = 1e6;
  law.viscosity = 1e-3;
}
void set_parameters(HerschelBulkley& law)
{
  law.density = 1600;
  law.bulk_modulus = 1e6;
  law.yield_stress = 50;
  law.consistency = 4;
  law.flow_index = 0.5;
  law.regularisation = 1;
}
void set_parameters(VonMises& law)  // mild steel
{
  law.density = 7850;
  law.youngs_modulus = 2.1e11;
  law.poisson_ratio = 0.3;
  law.yield_stress = 2.5e8;
  law.hardening_modulus = 1e9;
}
void set_parameters(JohnsonCook& law)  // copper, Johnson & Cook 1983
{
  law.density = 8960;
  law.youngs_modulus = 1.24e11;
  law.poisson_ratio = 0.34;
  law.yield_stress = 9e7;
  law.hardening_coefficient = 2.92e8;
  law.hardening_exponent = 0.31;
  law.rate_coefficient = 0.025;
  law.thermal_exponent = 1.09;
  law.room_temperature = 294;
  law.melting_temperature = 1356;
  law.specific_heat = 383;
}

}  // namespace

AnyLaw bench_law(std::string_view name)
{
  AnyLaw found;
  for_each_type(Laws{}, [&]<class L>() {
    if (L::name != name)
      return;
    L law{};
    set_parameters(law);
    found = law;
  });
  return found;
}

std::vector<std::string> bench_laws()
{
  std::vector<std::string> names;
  for_each_type(Laws{}, [&]<class L>() { names.emplace_back(L::name); });
  return names;
}

}  // namespace talus
