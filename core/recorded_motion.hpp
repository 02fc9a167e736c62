#pragma once
// A recorded motion: velocity over time, from samples of velocity or acceleration, and corrections of its end.
#include <array>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/fields.hpp"
#include "core/types.hpp"

namespace talus {

/// Whether velocities or accelerations were sampled.
enum class RecordUnit : std::uint8_t {
  metres_per_second,
  centimetres_per_second,
  metres_per_second_squared,
  centimetres_per_second_squared,
  g
};
constexpr std::array<std::string_view, 5> enum_names(RecordUnit) { return {"m/s", "cm/s", "m/s^2", "cm/s^2", "g"}; }

enum class Baseline : std::uint8_t { as_recorded, velocity, displacement };
constexpr std::array<std::string_view, 3> enum_names(Baseline) { return {"none", "velocity", "displacement"}; }

/// The key `record` of a boundary condition.
struct RecordOptions {
  std::string file;
  RecordUnit unit{};
  Real scale = 1;
  Baseline baseline = Baseline::as_recorded;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{
        required("file", &RecordOptions::file, any, "-",
                 "text file of two columns, time [s] and value, in one line for each sample; a heading and lines that begin with # are "
                 "passed over"),
        required_choice("unit", &RecordOptions::unit,
                        "of the values: m/s and cm/s are velocities, the others accelerations, which are integrated; g is 9.80665 m/s^2"),
        optional("scale", &RecordOptions::scale, any, "-", "factor of the values"),
        optional_choice("baseline", &RecordOptions::baseline,
                        "what is taken off: none; velocity: a constant acceleration, such that the motion ends at rest; displacement: an "
                        "acceleration that is linear in time, such that it ends at rest where it began")};
  }
};

/// A recorded motion.  Sampled velocities are joined by straight lines; sampled accelerations are joined by straight lines too, and the
/// velocity is their exact integral from zero (a parabola in each interval).  Before the first and after the last sample the velocity is
/// constant.
struct Record {
  std::vector<Real> time;          ///< [s], increasing
  std::vector<Real> velocity;      ///< velocity at these times [m/s]
  std::vector<Real> acceleration;  ///< acceleration at these times [m/s^2]; empty if velocities were sampled

  /// Velocity [m/s].
  Real operator()(Real t) const noexcept;
  Real displacement() const noexcept;  ///< from the first to the last sample [m], exact
  Real peak_velocity() const noexcept;
  Real peak_acceleration() const noexcept;  ///< the steepest line of sampled velocities [m/s^2]
};

/// A record of sampled velocities [m/s] or accelerations [m/s^2].  There is one sample for each time, and at least two.
Record record_of_velocity(std::vector<Real> time, std::vector<Real> velocity);
Record record_of_acceleration(std::vector<Real> time, std::vector<Real> acceleration);

/// Subtracts a straight line through the origin from the velocity (a constant from the acceleration), so that the final velocity is zero.
Record ends_without_velocity(Record record);
/// Subtracts a parabola from the velocity, so that final velocity and displacement are zero.
Record ends_where_it_began(Record record);

}  // namespace talus
