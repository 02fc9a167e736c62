#pragma once
// Balances of energy and momentum over a whole run: the balances of the stages joined, so that curves are continuous where a stage begins;
// and the errors of a run according to its balances.
#include <string>
#include <vector>

#include "io/output/run_summary.hpp"
#include "solver/each_particle.hpp"

namespace talus {

/// Energies since the start of the run [J].  Works are positive if done on the bodies; losses are positive.
/// gravity + loads + walls = (kinetic - kinetic_start) + strain + plastic + friction + damping + carried_away + resampled + transfer + defect.
struct EnergyNow {
  Real kinetic_start{}, kinetic{};  ///< kinetic_start: at the start, plus that of bodies that appeared
  Real strain{}, plastic{};         ///< including particles that were removed
  Real friction{}, damping{};       ///< damping: including the motion removed at the end of a geostatic stage
  Real resampled{};                 ///< kinetic energy lost where particles are merged, less what splitting gains
  Real carried_away{};              ///< kinetic energy of particles that left the mesh, failed, or were removed by a stage
  Real gravity{}, loads{}, walls{};
  Real waves{};     ///< energy of incident waves: not a term of the balance, but a scale of it
  Real transfer{};  ///< loss between particles and nodes
  Real defect{};    ///< remainder: what the terms above do not explain
  Real size{};      ///< largest of these terms at any time so far, at least the least energy that is judged; errors are relative to it

  static constexpr auto fields()
  {
    return std::tuple{saved("kinetic_start", &EnergyNow::kinetic_start),
                      saved("kinetic", &EnergyNow::kinetic),
                      saved("strain", &EnergyNow::strain),
                      saved("plastic", &EnergyNow::plastic),
                      saved("friction", &EnergyNow::friction),
                      saved("damping", &EnergyNow::damping),
                      saved("carried_away", &EnergyNow::carried_away),
                      saved("resampled", &EnergyNow::resampled),
                      saved("gravity", &EnergyNow::gravity),
                      saved("loads", &EnergyNow::loads),
                      saved("walls", &EnergyNow::walls),
                      saved("waves", &EnergyNow::waves),
                      saved("transfer", &EnergyNow::transfer),
                      saved("defect", &EnergyNow::defect),
                      saved("size", &EnergyNow::size)};
  }

  Real dissipated() const noexcept { return plastic + friction + damping; }
  Real largest_term() const noexcept;
};

/// |part| relative to a whole; 0 if the whole is 0.
inline Real share(Real part, Real whole) noexcept { return whole > 0 ? std::abs(part) / whole : 0; }

/// Momentum [kg m/s] and angular momentum about the origin [kg m^2/s] since the start of the run.
template <int D>
struct MomentumNow {
  /// given: by loads, boundary conditions and damping, minus that of removed particles; with the sum of absolute values
  ForceAndMoment<D> start, end, given;
  Vec3 forces = Vec3::Zero();  ///< moment of internal forces on the nodes, zero in theory [N m s]
  Vec3 lost = Vec3::Zero();    ///< angular momentum lost between particles and nodes [kg m^2/s]
  static constexpr auto fields()
  {
    return std::tuple{saved("start", &MomentumNow::start), saved("end", &MomentumNow::end), saved("given", &MomentumNow::given),
                      saved("forces", &MomentumNow::forces), saved("lost", &MomentumNow::lost)};
  }

  /// The unexplained momentum over the sum of all momentum at the start and given, and its limit: round-off.
  Real linear_defect() const noexcept;
  static constexpr Real most_linear_defect = 1e-9;
  /// The moment of internal forces, which should be zero, over the sum of all angular momentum at the start and given.
  Real angular_defect() const noexcept;
  /// The angular momentum lost between particles and nodes, relative to the same sum.
  Real angular_loss() const noexcept;
};

/// Records the balances at every event of a run.
template <int D>
class BalanceHistory {
 public:
  void see(const RunView<D>& view, RunEvent event);

  EnergyNow energy(const RunView<D>& view) const;
  MomentumNow<D> momentum(const RunView<D>& view) const;
  static constexpr auto fields()
  {
    return std::tuple{saved("before", &BalanceHistory::before_),
                      saved("kinetic_begin", &BalanceHistory::kinetic_begin_),
                      saved("plastic_begin", &BalanceHistory::plastic_begin_),
                      saved("transfer_before", &BalanceHistory::transfer_before_),
                      saved("kinetic_end", &BalanceHistory::kinetic_end_),
                      saved("plastic_end", &BalanceHistory::plastic_end_),
                      saved("taken_out", &BalanceHistory::taken_out_),
                      saved("taken_out_before", &BalanceHistory::taken_out_before_),
                      saved("stage", &BalanceHistory::stage_),
                      saved("begun", &BalanceHistory::begun_),
                      saved("start", &BalanceHistory::start_)};
  }

 private:
  EnergyLedger before_;  // completed stages; kinetic_start and plastic_start are not used
  Real kinetic_begin_ = 0, plastic_begin_ = 0, transfer_before_ = 0;
  Real kinetic_end_ = 0, plastic_end_ = 0;  // of the previous stage
  Real taken_out_ = 0, taken_out_before_ = 0;
  EnergyLedger stage_;
  bool begun_ = false;
  ForceAndMoment<D> start_;  // momentum at the start of the run
};

extern template struct MomentumNow<2>;
extern template struct MomentumNow<3>;
extern template class BalanceHistory<2>;
extern template class BalanceHistory<3>;

/// Largest accepted energy loss between particles and nodes, relative to the plastic work: the loss acts like a part of the material's
/// resistance, and beyond this limit the result depends on the mesh.
inline constexpr Real most_transfer_loss = 0.1;
/// Largest accepted loss of angular momentum, relative to the sum of all angular momentum at the start and given.
inline constexpr Real most_angular_loss = 0.1;

/// The strain up to which the energy of bodies is not judged: they hardly moved, and errors of the first and the last step are as large as
/// all works together.
inline constexpr Real least_strain_judged = 1e-4;
/// The energy of that strain over the limit below which energy gains are round-off (RunLimits::least_energy, of a strain of 1e-6).
inline constexpr Real least_energy_factor = (least_strain_judged / 1e-6) * (least_strain_judged / 1e-6);

/// Descriptions of balances that do not close, and of transfer losses beyond the limits above.  Empty if there are none.  The loss of
/// energy is judged if one of the terms is more than `least_energy` [J].
std::vector<std::string> failed_accounts(const RunSummary& summary, Real least_energy);

}  // namespace talus
