#pragma once
// Snow as in computer graphics: elastic stretches between limits, and moduli that grow by compaction.
#include <Eigen/Eigenvalues>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "materials/parts/elasticity.hpp"
#include "materials/parts/principal_axes.hpp"
#include "materials/parts/radial_return.hpp"

namespace talus {

/// Snow (Stomakhin, Schroeder, Chai, Teran & Selle 2013, "A material point method for snow simulation", ACM TOG 32(4), 102).  F = F_e F_p;
/// the elastic energy is that of Corotated in F_e, with moduli that depend on J_p = det F_p,
///     J stress = h (2 mu (V^2 - V) + lambda J_e (J_e - 1) I),   h = exp(hardening (1 - J_p)),   V^2 = F_e F_e^T,
/// and the eigenvalues of V are clamped to [1 - critical_compression, 1 + critical_stretch]: what is beyond goes to F_p.  J_p is stored as
/// its logarithm.  The law is isotropic, so F_e is needed without its rotation only.
///
/// The plastic work is the work of the stress on the plastic strain less the elastic energy that growing moduli store (it comes back where the
/// snow is unloaded), so that the rest of the work of the stress is the elastic energy.  The limits are a flow rule, but follow from no
/// potential: where one direction reaches its limit while strong loads across it have the other sign, that may be negative.  Such steps count
/// as zero.
struct Snow : Elasticity {
  static constexpr std::string_view name = "snow";
  static constexpr std::string_view summary =
      "Snow: fixed corotated elasticity with clamped stretches and moduli that grow by compaction (Stomakhin et al. 2013).";
  Real density{}, critical_compression = 0.025, critical_stretch = 0.0075, hardening = 10;
  std::optional<Real> hardening_limit;
  static constexpr auto fields()
  {
    return std::tuple_cat(
        std::tuple{required("density", &Snow::density, positive, "kg/m^3", "mass density at rest")}, elastic_fields<Snow>(),
        std::tuple{optional("critical_compression", &Snow::critical_compression, between(0, 1), "-",
                            "1 - the smallest elastic stretch; beyond it the snow is compacted"),
                   optional("critical_stretch", &Snow::critical_stretch, positive, "-",
                            "the largest elastic stretch - 1; beyond it the snow is torn"),
                   optional("hardening", &Snow::hardening, non_negative, "-", "xi: the moduli are multiplied by exp(xi (1 - J_p))"),
                   optional("hardening_limit", &Snow::hardening_limit, at_least(1), "-",
                            "largest factor of the moduli, which bounds the step; without it exp(hardening), which J_p = 0 would reach")});
  }

  struct State {
    Sym3 elastic_left = Sym3::Zero();
    Real plastic_volume = 0, plastic_strain = 0, plastic_work = 0;
    static constexpr auto fields()
    {
      return std::tuple{
          history("elastic_left", &State::elastic_left, "-", "elastic left Cauchy-Green tensor minus identity: xx, yy, zz, xy, yz, xz"),
          history("plastic_volume", &State::plastic_volume, "-", "logarithm of the plastic volume ratio J_p, negative in compaction"),
          history("plastic_strain", &State::plastic_strain, "-", "accumulated deviatoric plastic strain, integral of sqrt(2/3 e:e)"),
          history("plastic_work", &State::plastic_work, "J/m^3", "dissipated energy per initial volume")};
    }
  };

  struct Constants {
    Real shear, lambda;  ///< before hardening [Pa]
    Real low, high;      ///< logarithms of the smallest and the largest elastic stretch
    Real rate, limit;    ///< of hardening [-]
    template <class T>
    T factor(const T& plastic_volume) const noexcept
    {
      using std::exp, std::expm1, std::min;
      return min(exp(T(-rate * expm1(plastic_volume))), T(limit));
    }
  };
  Constants constants() const noexcept
  {
    const Moduli elastic = moduli();
    return {.shear = elastic.shear,
            .lambda = elastic.lambda,
            .low = std::log1p(-critical_compression),
            .high = std::log1p(critical_stretch),
            .rate = hardening,
            .limit = std::min(hardening_limit.value_or(std::numeric_limits<Real>::max()), std::exp(hardening))};
  }

  template <class T>
  Mat3Of<T> update(const IncrementOf<T>& in, StateOf<T, State>& state, const Constants& c) const noexcept
  {
    const T J = in.F.determinant();
    const ElasticTrial<T> trial(in, get(state, &State::elastic_left));
    if (!all_of(J > 0 && trial.is_finite()))
      return no_answer_somewhere(*this, in, state, c);
    Sym3Of<T> left = trial.left, strain = add_diagonal(trial.shear_strain, T(trial.volume_strain / 3));
    T volume = trial.volume_strain, factor = c.factor(get(state, &State::plastic_volume));
    if (!in.elastic)
      clamp(trial, left, strain, volume, factor, state, c);
    put(state, &State::elastic_left, left);
    const Mat3Of<T> W = unpack(expm1(strain));  // V - I
    const Sym3Of<T> square = pack(Mat3Of<T>(W + W * W));
    return unpack(scale_and_shift(2 * c.shear * factor / J, square, factor * of_volume(volume, c) / J));
  }

  /// As Corotated::wave_speed, of snow that is neither compacted nor torn.
  Real wave_speed(const Mat3& F, const Constants& c) const noexcept
  {
    return speed(largest_eigenvalue_bound(Mat3(F * F.transpose())), Real(F.determinant()), Real(1), c);
  }
  /// With the stretches of the history.  The factor of hardening counts at least 1: loose snow may come back to it within few steps.
  template <class T>
  T wave_speed(const Mat3Of<T>&, const StateOf<T, State>& state, const Constants& c) const noexcept
  {
    using std::max, std::sqrt;
    const Mat3Of<T> stretches = unpack(add_diagonal(get(state, &State::elastic_left), T(1)));
    const T factor = max(c.factor(get(state, &State::plastic_volume)), T(1));
    return speed(largest_eigenvalue_bound(stretches), T(sqrt(max(stretches.determinant(), T(0)))), factor, c);
  }

  /// How far the stretches are beyond their limits, times 2 mu before hardening [Pa].
  Real yield(const Mat3&, const State& state) const noexcept
  {
    const Vec3 beyond = Eigen::SelfAdjointEigenSolver<Mat3>(unpack(log1p(state.elastic_left))).eigenvalues() / 2;
    return 2 * constants().shear * std::max(std::expm1(beyond[2]) - critical_stretch, -critical_compression - std::expm1(beyond[0]));
  }

  /// Sets the history so that the stress at F = I is `stress` [Pa].  A stress beyond the limits of the stretches compacts the snow until the
  /// moduli are large enough, at most by nine tenths.
  void prestress(const Mat3& stress, State& state) const noexcept
  {
    const Constants c = constants();
    const Eigen::SelfAdjointEigenSolver<Mat3> axes(stress);
    const Vec3 principal = axes.eigenvalues();
    const auto fits = [&](const Vec3& stretch) { return stretch[0] >= std::expm1(c.low) && stretch[2] <= std::expm1(c.high); };
    Vec3 stretch = stretches_under(principal / c.factor(state.plastic_volume), c);
    if (!fits(stretch) && hardening > 0) {
      Real loose = state.plastic_volume, dense = std::log(std::max(1 - std::log(c.limit) / hardening, Real{0.1}));
      constexpr int halvings = 50;
      for (int i = 0; i < halvings && dense < loose; ++i) {
        const Real middle = 0.5 * (loose + dense);
        (fits(stretches_under(principal / c.factor(middle), c)) ? dense : loose) = middle;
      }
      state.plastic_volume = std::min(state.plastic_volume, dense);
      stretch = stretches_under(principal / c.factor(state.plastic_volume), c);
    }
    const Vec3 squares = stretch.array() * (stretch.array() + 2);
    state.elastic_left = pack(axes.eigenvectors() * squares.asDiagonal() * axes.eigenvectors().transpose());
  }

 private:
  template <class T>
  T speed(const T& stretch, const T& volume_ratio, const T& factor, const Constants& c) const noexcept
  {
    using std::sqrt;
    return sqrt(T(factor * (2 * c.shear * stretch + std::max(c.lambda, Real{0}) * volume_ratio * volume_ratio) / density));
  }
  /// lambda J_e (J_e - 1) [Pa].
  template <class T>
  static T of_volume(const T& volume_strain, const Constants& c) noexcept
  {
    using std::expm1;
    const T more = expm1(volume_strain);
    return c.lambda * (1 + more) * more;
  }

  /// Moves what is beyond the limits from the elastic to the plastic strain.
  template <class T>
  static void clamp(const ElasticTrial<T>& trial, Sym3Of<T>& left, Sym3Of<T>& strain, T& volume, T& factor, StateOf<T, State>& state,
                    const Constants& c) noexcept
  {
    using std::expm1, std::max, std::min, std::sqrt;
    constexpr Real digits = 1e-6;  // the rough extremes have at least these
    const T mean = trial.volume_strain / 3, size = std::sqrt(0.75) * trial.shear;
    const ShearDirection<T> direction(trial.shear_strain, size);
    const std::array<T, 2> rough = direction.rough_extremes();
    if (!any_of(mean + rough[0] + digits * size > c.high || mean + rough[1] - digits * size < c.low))
      return;
    const PrincipalAxes<T> axes = direction.axes();
    Vec3Of<T> kept, plastic;
    for (int i = 0; i < 3; ++i) {
      const T full = mean + axes.values[i];
      kept[i] = min(max(full, T(c.low)), T(c.high));
      plastic[i] = full - kept[i];
    }
    const auto flows = plastic.squaredNorm() > 0;
    if (!any_of(flows))
      return;
    const T plastic_volume = get(state, &State::plastic_volume) + where(flows, plastic.sum(), T(0));
    volume = where(flows, kept.sum(), volume);
    strain = where<T>(flows, axes.tensor(kept), strain);
    left = where<T>(flows, talus::expm1(scale_and_shift(2, strain, 0)), left);
    const T before = factor;
    factor = where(flows, c.factor(plastic_volume), factor);
    T work = 0, energy = 0.5 * c.lambda * expm1(volume) * expm1(volume);
    for (int i = 0; i < 3; ++i) {
      const T more = expm1(kept[i]);
      work += (2 * c.shear * (1 + more) * more + of_volume(volume, c)) * plastic[i];
      energy += c.shear * more * more;
    }
    const T lost = max(T(factor * work - (factor - before) * energy), T(0));
    const T third = plastic.sum() / 3;
    const T sheared = sqrt(T((2.0 / 3) * max(T(plastic.squaredNorm() - 3 * third * third), T(0))));
    put(state, &State::plastic_volume, plastic_volume);
    put(state, &State::plastic_strain, T(get(state, &State::plastic_strain) + where(flows, sheared, T(0))));
    put(state, &State::plastic_work, T(get(state, &State::plastic_work) + where(flows, lost, T(0))));
  }

  /// Principal stretches minus one under principal Kirchhoff stresses over the factor of hardening [Pa], by Newton's method for J_e.
  static Vec3 stretches_under(const Vec3& stress, const Constants& c) noexcept
  {
    Vec3 stretch = Vec3::Zero();
    Real J = 1;
    constexpr int enough = 20;  // quadratic, from 1
    for (int i = 0; i < enough; ++i) {
      Real slope = 0;
      for (int k = 0; k < 3; ++k) {
        const Real t = (stress[k] - c.lambda * J * (J - 1)) / (2 * c.shear), root = std::sqrt(std::max(1 + 4 * t, Real{1e-4}));
        stretch[k] = (root * root - 1) / (2 * (1 + root));
        slope += c.lambda * (2 * J - 1) / (2 * c.shear * root * (1 + stretch[k]));
      }
      const Real product = (1 + stretch[0]) * (1 + stretch[1]) * (1 + stretch[2]);
      J = std::clamp(J + (product - J) / (1 + product * slope), Real{0.5}, Real{2});
    }
    return stretch;
  }
};

}  // namespace talus
