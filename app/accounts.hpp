#pragma once
// Energy and momentum over a whole run: the ledgers of the stages joined, so that no curve jumps where a stage begins.
#include "app/frame.hpp"

namespace talus {

/// Energies since the start of the run [J].  Works are signed as done on the bodies; losses are positive.
/// gravity + loads + walls = (kinetic - kinetic_start) + strain + plastic + friction + damping + transfer + defect.
struct EnergyNow {
  Real kinetic_start{}, kinetic{}, strain{}, plastic{};
  Real friction{}, damping{};  ///< damping: with the motion that is taken out at the end of a geostatic stage
  Real gravity{}, loads{}, walls{};
  Real transfer{};  ///< lost between particles and nodes
  Real defect{};    ///< what the terms above leave unexplained

  static constexpr auto fields()
  {
    return std::tuple{kept("kinetic_start", &EnergyNow::kinetic_start),
                      kept("kinetic", &EnergyNow::kinetic),
                      kept("strain", &EnergyNow::strain),
                      kept("plastic", &EnergyNow::plastic),
                      kept("friction", &EnergyNow::friction),
                      kept("damping", &EnergyNow::damping),
                      kept("gravity", &EnergyNow::gravity),
                      kept("loads", &EnergyNow::loads),
                      kept("walls", &EnergyNow::walls),
                      kept("transfer", &EnergyNow::transfer),
                      kept("defect", &EnergyNow::defect)};
  }

  Real dissipated() const noexcept { return plastic + friction + damping; }
  Real largest_term() const noexcept;
};

/// Told of every moment of a run.
template <int D>
class Accounts {
 public:
  void see(const Frame<D>& frame, Moment moment);

  EnergyNow energy(const Frame<D>& frame) const;
  Vec<D> momentum_start() const noexcept { return momentum_start_; }
  /// Momentum that gravity, loads and walls gave [kg m/s].
  Vec<D> impulse(const Frame<D>& frame) const;
  /// What a momentum error is small against: sum of m|v| at the start plus the moduli of all impulses [kg m/s].
  Real momentum_scale(const Frame<D>& frame) const;
  /// Damping takes momentum and nobody counts it.
  bool momentum_closes() const noexcept { return !damped_; }
  static constexpr auto fields()
  {
    return std::tuple{kept("before", &Accounts::before_),
                      kept("kinetic_begin", &Accounts::kinetic_begin_),
                      kept("plastic_begin", &Accounts::plastic_begin_),
                      kept("transfer_before", &Accounts::transfer_before_),
                      kept("kinetic_end", &Accounts::kinetic_end_),
                      kept("taken_out", &Accounts::taken_out_),
                      kept("taken_out_before", &Accounts::taken_out_before_),
                      kept("stage", &Accounts::stage_),
                      kept("begun", &Accounts::begun_),
                      kept("damped", &Accounts::damped_),
                      kept("momentum_start", &Accounts::momentum_start_),
                      kept("loads_impulse", &Accounts::loads_impulse_),
                      kept("momentum_at_start", &Accounts::momentum_at_start_),
                      kept("loads_impulse_size", &Accounts::loads_impulse_size_)};
  }

 private:
  EnergyLedger before_;  // stages that are over, their kinetic_start and plastic_start unused
  Real kinetic_begin_ = 0, plastic_begin_ = 0, transfer_before_ = 0;
  Real kinetic_end_ = 0, taken_out_ = 0, taken_out_before_ = 0;
  EnergyLedger stage_;
  bool begun_ = false, damped_ = false;
  Vec<D> momentum_start_ = Vec<D>::Zero(), loads_impulse_ = Vec<D>::Zero();
  Real momentum_at_start_ = 0, loads_impulse_size_ = 0;
};

extern template class Accounts<2>;
extern template class Accounts<3>;

}  // namespace talus
