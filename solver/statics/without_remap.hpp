#pragma once
// Particles whose strain follows the nodes of a trial.
#include "solver/options/transfer_options.hpp"

namespace talus {

/// While it lives, particles take their strain from the velocities of the nodes themselves, which are those of a trial.
class WithoutRemap {
 public:
  explicit WithoutRemap(TransferOptions& options) : options_(options), before_(options)
  {
    options_.scheme = Scheme::flip;
    options_.musl = false;
    options_.pic_damping_time = options_.pic_damping_crossings = options_.pic_damping_fall_times = std::nullopt;
  }
  WithoutRemap(const WithoutRemap&) = delete;
  WithoutRemap& operator=(const WithoutRemap&) = delete;
  ~WithoutRemap() { options_ = before_; }

 private:
  TransferOptions& options_;
  TransferOptions before_;
};

}  // namespace talus
