#pragma once
// A velocity in time, given by a table or a record: what moves a boundary, or comes up to it as a wave.
#include <optional>
#include <string>
#include <vector>

#include "core/recorded_motion.hpp"
#include "core/time_table.hpp"
#include "core/types.hpp"

namespace talus {

/// Keys of the conditions that have a motion; each of them describes these in its own words.
struct MotionOptions {
  std::vector<Real> velocity;
  Table table;
  std::optional<RecordOptions> record;

  void check_motion(std::vector<std::string>& problems) const
  {
    if (!table.points.empty() && record)
      problems.emplace_back("only one of table and record may be given");
  }
};

template <int D>
struct PrescribedMotion {
  Vec<D> velocity = Vec<D>::Zero();  ///< [m/s], times the value of the table or the record
  Table table = {};
  std::optional<Record> record = {};  ///< in the place of the table

  /// The velocity [m/s] after that time [s].
  Vec<D> operator()(Real since) const noexcept { return (record ? (*record)(since) : table(since)) * velocity; }
  /// The largest speed [m/s] at any time.
  Real peak_speed() const { return velocity.norm() * (record ? record->peak_velocity() : table.largest_magnitude()); }
};

template <int D>
PrescribedMotion<D> motion_of(const MotionOptions& options, const std::optional<Record>& record)
{
  PrescribedMotion<D> motion{.table = options.table, .record = record};
  if (!options.velocity.empty())
    motion.velocity = Eigen::Map<const Vec<D>>(options.velocity.data());
  return motion;
}

}  // namespace talus
