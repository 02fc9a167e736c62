#pragma once
// A motion that was recorded: a velocity in time, from samples of itself or of its acceleration, and what is left at its end.
#include <vector>

#include "core/types.hpp"

namespace talus {

/// Samples of a velocity are joined by straight lines; where the acceleration was sampled, its samples are, and the velocity is their exact
/// integral from zero on (a parabola in each interval).  Before the first sample and after the last one the velocity stays as it is there.
struct Record {
  std::vector<Real> time;          ///< [s], increasing
  std::vector<Real> velocity;      ///< at these times [m/s]
  std::vector<Real> acceleration;  ///< at these times [m/s^2]; empty where velocities were sampled

  /// Velocity [m/s].
  Real operator()(Real t) const noexcept;
  Real displacement() const noexcept;  ///< from the first sample to the last [m], exactly
  Real peak_velocity() const noexcept;
  Real peak_acceleration() const noexcept;  ///< of velocities: the steepest line
};

/// Of samples of a velocity [m/s] or of an acceleration [m/s^2].  There are as many as times, at least two.
Record record_of_velocity(std::vector<Real> time, std::vector<Real> velocity);
Record record_of_acceleration(std::vector<Real> time, std::vector<Real> acceleration);

/// Takes a straight line through the beginning off the velocity (a constant off the acceleration), such that the motion ends with none.
Record ends_without_velocity(Record record);
/// Takes a parabola off the velocity, such that the motion ends with none and where it began.
Record ends_where_it_began(Record record);

}  // namespace talus
