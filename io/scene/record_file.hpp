#pragma once
// Recorded motions: the key `record` of a boundary, and the text file of samples that it names.
#include <array>
#include <filesystem>
#include <string>

#include "core/error.hpp"
#include "core/fields.hpp"
#include "core/recorded_motion.hpp"

namespace talus {

/// The unit says whether velocities or accelerations were sampled.
enum class RecordUnit : std::uint8_t {
  metres_per_second,
  centimetres_per_second,
  metres_per_second_squared,
  centimetres_per_second_squared,
  g
};
constexpr std::array<std::string_view, 5> enum_names(RecordUnit) { return {"m/s", "cm/s", "m/s^2", "cm/s^2", "g"}; }

enum class Baseline : std::uint8_t { saved, velocity, displacement };
constexpr std::array<std::string_view, 3> enum_names(Baseline) { return {"none", "velocity", "displacement"}; }

struct RecordSpec {
  std::string file;
  RecordUnit unit{};
  Real scale = 1;
  Baseline baseline = Baseline::saved;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{
        required("file", &RecordSpec::file, any, "-",
                 "text file of two columns, time [s] and value, in one line for each sample; a heading and lines that begin with # are "
                 "passed over"),
        required_choice("unit", &RecordSpec::unit,
                        "of the values: m/s and cm/s are velocities, the others accelerations, which are integrated; g is 9.80665 m/s^2"),
        optional("scale", &RecordSpec::scale, any, "-", "factor of the values"),
        optional_choice("baseline", &RecordSpec::baseline,
                        "what is taken off: none; velocity: a constant acceleration, such that the motion ends at rest; displacement: an "
                        "acceleration that is linear in time, such that it ends at rest where it began")};
  }
};

/// The motion in [m/s].  SceneErrors with file, line and column of all that is wrong in the file: not two numbers in a line, times that do
/// not grow, fewer than two samples.
Record read_record(const std::filesystem::path& file, const RecordSpec& spec);

/// How long and how strong it is, and what is left of it at its end, in a line.
std::string describe(const RecordSpec& spec, const Record& record);

}  // namespace talus
