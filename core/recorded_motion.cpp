#include "core/recorded_motion.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace talus {

namespace {

/// Velocities [m/s] at the ends of the intervals, integrated from zero.
std::vector<Real> integral(const std::vector<Real>& time, const std::vector<Real>& acceleration)
{
  std::vector<Real> velocity(time.size(), 0);
  for (std::size_t k = 1; k < time.size(); ++k)
    velocity[k] = velocity[k - 1] + 0.5 * (acceleration[k - 1] + acceleration[k]) * (time[k] - time[k - 1]);
  return velocity;
}

/// Subtracts a T s + b T s^2 from the velocity, with s from 0 to 1 over the duration T.
Record without(Record record, Real a, Real b)
{
  const Real begin = record.time.front(), duration = record.time.back() - begin;
  for (std::size_t k = 0; k < record.time.size(); ++k) {
    const Real s = (record.time[k] - begin) / duration;
    if (record.acceleration.empty())
      record.velocity[k] -= duration * (a * s + b * s * s);
    else
      record.acceleration[k] -= a + 2 * b * s;
  }
  if (!record.acceleration.empty())
    record.velocity = integral(record.time, record.acceleration);
  return record;
}

/// A record with the times of the given one whose only motion is that of a and b.
Record alone(const Record& record, Real a, Real b)
{
  Record still = record;
  still.velocity.assign(record.time.size(), 0);
  still.acceleration.assign(record.acceleration.size(), 0);
  return without(std::move(still), -a, -b);
}

}  // namespace

Real Record::operator()(Real t) const noexcept
{
  if (t <= time.front())
    return velocity.front();
  if (t >= time.back())
    return velocity.back();
  const auto k = static_cast<std::size_t>(std::upper_bound(time.begin(), time.end(), t) - time.begin()) - 1;
  const Real span = time[k + 1] - time[k], s = t - time[k];
  if (acceleration.empty())
    return velocity[k] + (velocity[k + 1] - velocity[k]) * s / span;
  return velocity[k] + s * (acceleration[k] + 0.5 * (acceleration[k + 1] - acceleration[k]) * s / span);
}

Real Record::displacement() const noexcept
{
  Real sum = 0;
  for (std::size_t k = 1; k < time.size(); ++k) {
    const Real span = time[k] - time[k - 1];
    sum += acceleration.empty() ? 0.5 * span * (velocity[k - 1] + velocity[k])
                                : span * (velocity[k - 1] + span * (2 * acceleration[k - 1] + acceleration[k]) / 6);
  }
  return sum;
}

Real Record::peak_velocity() const noexcept
{
  Real peak = 0;  // within an interval of sampled accelerations the peak is where the acceleration is zero
  for (std::size_t k = 0; k < time.size(); ++k) {
    peak = std::max(peak, std::abs(velocity[k]));
    if (k > 0 && !acceleration.empty() && acceleration[k - 1] * acceleration[k] < 0) {
      const Real share = acceleration[k - 1] / (acceleration[k - 1] - acceleration[k]);
      peak = std::max(peak, std::abs((*this)(time[k - 1] + share * (time[k] - time[k - 1]))));
    }
  }
  return peak;
}

Real Record::peak_acceleration() const noexcept
{
  Real peak = 0;
  for (const Real a : acceleration)
    peak = std::max(peak, std::abs(a));
  for (std::size_t k = 1; acceleration.empty() && k < time.size(); ++k)
    peak = std::max(peak, std::abs((velocity[k] - velocity[k - 1]) / (time[k] - time[k - 1])));
  return peak;
}

Record record_of_velocity(std::vector<Real> time, std::vector<Real> velocity)
{
  assert(time.size() == velocity.size() && time.size() >= 2);
  return {std::move(time), std::move(velocity), {}};
}

Record record_of_acceleration(std::vector<Real> time, std::vector<Real> acceleration)
{
  assert(time.size() == acceleration.size() && time.size() >= 2);
  std::vector<Real> velocity = integral(time, acceleration);
  return {std::move(time), std::move(velocity), std::move(acceleration)};
}

Record ends_without_velocity(Record record)
{
  const Real a = record.velocity.back() / (record.time.back() - record.time.front());
  return without(std::move(record), a, 0);
}

Record ends_where_it_began(Record record)
{
  // The velocity and displacement at the end of a unit of a and of b, from the samples: two equations for a and b.
  const Record first = alone(record, 1, 0), second = alone(record, 0, 1);
  const Real v1 = first.velocity.back(), v2 = second.velocity.back(), u1 = first.displacement(), u2 = second.displacement();
  const Real v = record.velocity.back(), u = record.displacement(), det = v1 * u2 - v2 * u1;
  return without(std::move(record), (v * u2 - v2 * u) / det, (v1 * u - v * u1) / det);
}

}  // namespace talus
