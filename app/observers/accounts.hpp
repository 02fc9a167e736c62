#pragma once
// Energy and momentum over a whole run: the ledgers of the stages joined, so that no curve jumps where a stage begins.
#include "solver/run_view.hpp"

namespace talus {

/// Energies since the start of the run [J].  Works are signed as done on the bodies; losses are positive.
/// gravity + loads + walls = (kinetic - kinetic_start) + strain + plastic + friction + damping + carried_away + transfer + defect.
struct EnergyNow {
  Real kinetic_start{}, kinetic{};  ///< kinetic_start: at the start, and what bodies brought that appeared
  Real strain{}, plastic{};         ///< of particles that are gone too
  Real friction{}, damping{};       ///< damping: with the motion that is taken out at the end of a geostatic stage
  Real carried_away{};              ///< kinetic energy of what left the mesh, failed, or was taken away by a stage
  Real gravity{}, loads{}, walls{};
  Real waves{};     ///< that waves brought to the walls: no term of the balance, but what is small beside it is small
  Real transfer{};  ///< lost between particles and nodes
  Real defect{};    ///< what the terms above leave unexplained
  Real size{};      ///< largest of these terms at any time up to now, and not less than what is judged: errors are measured by it

  static constexpr auto fields()
  {
    return std::tuple{saved("kinetic_start", &EnergyNow::kinetic_start),
                      saved("kinetic", &EnergyNow::kinetic),
                      saved("strain", &EnergyNow::strain),
                      saved("plastic", &EnergyNow::plastic),
                      saved("friction", &EnergyNow::friction),
                      saved("damping", &EnergyNow::damping),
                      saved("carried_away", &EnergyNow::carried_away),
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

/// |part| of a whole; 0 of nothing.
inline Real share(Real part, Real whole) noexcept { return whole > 0 ? std::abs(part) / whole : 0; }

/// Momentum and its moment about the origin since the start of the run [kg m/s], [kg m^2/s].
template <int D>
struct MomentumNow {
  ForceAndMoment<D> start, end, given;  ///< given: by loads, walls, damping, and taken by what left; their moduli added up
  Vec3 forces = Vec3::Zero();           ///< moment of internal forces on the nodes, of which a body knows none [N m s]
  Vec3 lost = Vec3::Zero();             ///< moment of momentum that particles and nodes lost between them [kg m^2/s]
  static constexpr auto fields()
  {
    return std::tuple{saved("start", &MomentumNow::start), saved("end", &MomentumNow::end),
                      saved("given", &MomentumNow::given), saved("forces", &MomentumNow::forces),
                      saved("lost", &MomentumNow::lost),   saved("most_linear_defect", &MomentumNow::most_linear_defect)};
  }

  /// What cannot be explained, over all momentum there was and was given: round-off, of the precision in which particles are kept.
  Real linear_defect() const noexcept;
  Real most_linear_defect = 1e-9;
  /// Moment of internal forces, which should be none, over all moment there was and was given.
  Real angular_defect() const noexcept;
  /// What particles and nodes lost between them, over the same.
  Real angular_loss() const noexcept;
};

/// Told of every moment of a run.
template <int D>
class BalanceHistory {
 public:
  void see(const RunView<D>& view, RunEvent moment);

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
  EnergyLedger before_;  // stages that are over, their kinetic_start and plastic_start unused
  Real kinetic_begin_ = 0, plastic_begin_ = 0, transfer_before_ = 0;
  Real kinetic_end_ = 0, plastic_end_ = 0;  // of the stage before
  Real taken_out_ = 0, taken_out_before_ = 0;
  EnergyLedger stage_;
  bool begun_ = false;
  ForceAndMoment<D> start_;  // momentum at the start of the run
};

extern template struct MomentumNow<2>;
extern template struct MomentumNow<3>;
extern template class BalanceHistory<2>;
extern template class BalanceHistory<3>;

}  // namespace talus
