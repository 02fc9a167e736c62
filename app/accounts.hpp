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
