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
    return std::tuple{kept("kinetic_start", &EnergyNow::kinetic_start),
                      kept("kinetic", &EnergyNow::kinetic),
                      kept("strain", &EnergyNow::strain),
                      kept("plastic", &EnergyNow::plastic),
                      kept("friction", &EnergyNow::friction),
                      kept("damping", &EnergyNow::damping),
                      kept("carried_away", &EnergyNow::carried_away),
                      kept("gravity", &EnergyNow::gravity),
                      kept("loads", &EnergyNow::loads),
                      kept("walls", &EnergyNow::walls),
                      kept("waves", &EnergyNow::waves),
                      kept("transfer", &EnergyNow::transfer),
                      kept("defect", &EnergyNow::defect),
                      kept("size", &EnergyNow::size)};
  }

  Real dissipated() const noexcept { return plastic + friction + damping; }
  Real largest_term() const noexcept;
};

/// |part| of a whole; 0 of nothing.
inline Real share(Real part, Real whole) noexcept { return whole > 0 ? std::abs(part) / whole : 0; }

/// Momentum and its moment about the origin since the start of the run [kg m/s], [kg m^2/s].
template <int D>
struct MomentumNow {
  Push<D> start, end, given;   ///< given: by loads, walls, damping, and taken by what left; their moduli added up
  Vec3 forces = Vec3::Zero();  ///< moment of internal forces on the nodes, of which a body knows none [N m s]
  Vec3 lost = Vec3::Zero();    ///< moment of momentum that particles and nodes lost between them [kg m^2/s]
  static constexpr auto fields()
  {
    return std::tuple{kept("start", &MomentumNow::start), kept("end", &MomentumNow::end),
                      kept("given", &MomentumNow::given), kept("forces", &MomentumNow::forces),
                      kept("lost", &MomentumNow::lost),   kept("most_linear_defect", &MomentumNow::most_linear_defect)};
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
class Accounts {
 public:
  void see(const Frame<D>& frame, Moment moment);

  EnergyNow energy(const Frame<D>& frame) const;
  MomentumNow<D> momentum(const Frame<D>& frame) const;
  static constexpr auto fields()
  {
    return std::tuple{kept("before", &Accounts::before_),
                      kept("kinetic_begin", &Accounts::kinetic_begin_),
                      kept("plastic_begin", &Accounts::plastic_begin_),
                      kept("transfer_before", &Accounts::transfer_before_),
                      kept("kinetic_end", &Accounts::kinetic_end_),
                      kept("plastic_end", &Accounts::plastic_end_),
                      kept("taken_out", &Accounts::taken_out_),
                      kept("taken_out_before", &Accounts::taken_out_before_),
                      kept("stage", &Accounts::stage_),
                      kept("begun", &Accounts::begun_),
                      kept("start", &Accounts::start_)};
  }

 private:
  EnergyLedger before_;  // stages that are over, their kinetic_start and plastic_start unused
  Real kinetic_begin_ = 0, plastic_begin_ = 0, transfer_before_ = 0;
  Real kinetic_end_ = 0, plastic_end_ = 0;  // of the stage before
  Real taken_out_ = 0, taken_out_before_ = 0;
  EnergyLedger stage_;
  bool begun_ = false;
  Push<D> start_;  // momentum at the start of the run
};

extern template struct MomentumNow<2>;
extern template struct MomentumNow<3>;
extern template class Accounts<2>;
extern template class Accounts<3>;

}  // namespace talus
