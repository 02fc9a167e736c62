#pragma once
// A velocity over time, given by a table or a record, for a moving boundary or an incident wave.
#include <optional>
#include <string>
#include <vector>

#include "core/recorded_motion.hpp"
#include "core/time_table.hpp"
#include "core/types.hpp"

namespace talus {

/// Keys of the conditions that have a motion; each condition describes them in its own words.
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
  Vec<D> velocity = Vec<D>::Zero();  ///< velocity [m/s], multiplied by the value of the table or the record
  Table table = {};
  std::optional<Record> record = {};  ///< used instead of the table

  /// The velocity [m/s] at the time `since` [s] after the beginning of the motion.
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
