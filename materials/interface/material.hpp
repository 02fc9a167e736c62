#pragma once
// The material of one body: its law, the options that the body gives it, and what its particles remember.
#include <string>

#include "core/error.hpp"
#include "materials/interface/constitutive_law.hpp"

namespace talus {

/// A value: copies share the law, which does not change, and have histories of their own.  Every index i below counts from 0 inside the body.
class Material {
 public:
  Material() = default;
  /// Particles [begin, end) of the model, at rest.
  Material(std::shared_ptr<const ConstitutiveLaw> law, Index begin, Index end, std::string name, SourceLocation where = {});

  Index begin = 0, end = 0;
  SourceLocation where{};
  std::string name{};
  std::optional<BulkViscosity> viscosity{};
  bool averages_volume = false;  ///< F-bar through nodes
  Index kind = none;             ///< bodies of the same kind are of one material; `none`: the body alone
  Index group = none;            ///< F-bar: bodies of the same group are averaged as one; `none`: the body alone
  HistoryRows history{};

  const ConstitutiveLaw& law() const noexcept { return *law_; }
  Index size() const noexcept { return end - begin; }
  void set_range(const Body& body) noexcept { begin = body.begin, end = body.end; }
  /// Its law, options and name, without particles.
  Material without_particles() const;

  /// Divides the shear strength by `factor` > 0; what particles remember stays.  False, and no change, if the law has none.
  bool weaken(Real factor);
  Real wave_speed(Index i, const Mat3& F) const noexcept { return law_->wave_speed(F, history.row(i)); }
  bool prestress(Index i, const Mat3& stress) noexcept { return law_->prestress(stress, history.row(i)); }

 private:
  std::shared_ptr<const ConstitutiveLaw> law_;
};

/// A body at rest, with the law of the kind that its parameters ask for.
template <Law L>
Material make_material(const L& law, Index begin, Index end, std::string name, SourceLocation where = {})
{
  return {constitutive_law(law), begin, end, std::move(name), std::move(where)};
}

/// Makes it the material of particles [begin, end) at rest.
void begin_anew(Index begin, Index end, Material& material);

/// F_p <- (I + dt L_p) F_p, sigma_p = law(F_p, L_p, history) - (q_p + u_p) I for particles of a body, four at a time.
///
/// A body that averages its volume (`averaged` holds the new ratios, see AveragedBodies) gives its law F and I + dt L with their
/// in-plane volume ratio replaced; F_p itself stays what the motion made it.  q_p is the artificial viscous pressure of a body that
/// has one:  q = rho h |d| (quadratic h |d| + linear c) where the volume shrinks at the rate d = tr L, h the altitude of the cell
/// (von Neumann & Richtmyer 1950; linear term of Landshoff 1955).  u_p is the pore pressure where the particle is now, so
/// that the law sees effective stress; without pore water the law sees total stress.
///
/// The crossing time counts viscosity nu and q by the damping of the wave of one cell: speed = Q + sqrt(Q^2 + c^2) with
/// Q = D nu / h + quadratic h |d| + linear c, exact for a chain of equal cells.
template <int D>
StressSums update_stress(const Material& material, const StressStrip<D>& strip) noexcept;

/// Altitude h [m] / (effective wave speed + |v|) of a particle [s].  `shrinking` is max(-tr L, 0) [1/s].  T is Real or SimdReal.
template <int D, class T>
T crossing_time(const std::optional<Real>& diffusivity, const std::optional<BulkViscosity>& viscosity, const T& h,
                const T& speed_of_particle, const T& wave_speed, const T& shrinking) noexcept
{
  using std::sqrt;
  T damping = 0;
  bool damped = false;
  if (diffusivity) {
    damping += D * *diffusivity / h;
    damped = true;
  }
  if (viscosity) {
    damping += where(shrinking > 0, T(viscosity->quadratic * h * shrinking + viscosity->linear * wave_speed), T(0));
    damped = true;
  }
  const T speed = damped ? T(damping + sqrt(T(damping * damping + wave_speed * wave_speed))) : wave_speed;
  return h / (speed + speed_of_particle);
}

/// Number `component` of a history variable of particle i.
inline Real& history_value(Material& material, const HistoryVariable& variable, Index i, int component = 0) noexcept
{
  return material.history.row(i)[variable.first + component];
}
inline const Real& history_value(const Material& material, const HistoryVariable& variable, Index i, int component = 0) noexcept
{
  return material.history.row(i)[variable.first + component];
}

/// Energy [J] dissipated so far in a particle whose initial volume was `volume0` [m^3]: one with this history, or particle i of a body.  0
/// for a law without "plastic_work".
Real plastic_work(const ConstitutiveLaw& law, const Real* history, Real volume0) noexcept;
Real plastic_work(const Material& material, Index i, Real volume0) noexcept;

/// The group of bodies with which its volume is averaged; `none` as well where the body does not average.
inline Index averages_with(const Material& material) noexcept { return material.averages_volume ? material.group : none; }

}  // namespace talus
