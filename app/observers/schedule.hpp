#pragma once
// Repeated times, for outputs.
#include <cmath>
#include <tuple>

#include "core/fields.hpp"

namespace talus {

/// The times 0, every, 2 every, ...; never, if `every` is infinite.
class Schedule {
 public:
  explicit Schedule(Real every) : every_(every) {}
  /// True once for each of these times that has been reached.
  bool due(Real time)
  {
    constexpr Real round_off = 1e-9;
    if (!std::isfinite(every_) || !(time >= next_ * every_ - round_off * every_))
      return false;
    next_ = std::floor(time / every_ + round_off) + 1;
    return true;
  }
  static constexpr auto fields() { return std::tuple{saved("next", &Schedule::next_)}; }

 private:
  Real every_;
  Real next_ = 0;
};

}  // namespace talus
