#pragma once
// A motion that was recorded: a velocity in time, from samples of itself or of its acceleration, and what is left at its end.
#include <array>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/fields.hpp"
#include "core/types.hpp"

namespace talus {

/// The unit tells whether velocities or accelerations were sampled.
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
