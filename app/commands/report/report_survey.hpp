#pragma once
// What is known of each frame of a run's particles after all of them have been looked at once, one frame at a time.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/commands/report/report_fields.hpp"
#include "app/observers/runout_distance.hpp"

namespace talus {

struct ValueRange {
  Real low, high;  ///< finite
};

/// Of the particles that have moved, as the rule says: from where they were when displacements were last reset, or in the first frame where
/// displacements were not written.
struct MovedMass {
  std::int64_t count = 0;
  Vec3 low, high;       ///< of where they are [m]
  Real height, length;  ///< from the crown to the front, down and on the level [m]
};

/// Of one body, or of all.
struct MassSurvey {
  std::int64_t count = 0;
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  ///< [m]
  Real crest = 0;                                ///< highest point, along `up` [m]
  std::optional<Real> speed, displacement;       ///< largest [m/s], [m]
  std::optional<MovedMass> moved;
};

struct FrameSurvey {
  Real time;  ///< s
  std::filesystem::path file;
  std::string state;  ///< size and time of the file: another one has been written since where they differ
  std::int64_t count = 0;
  std::vector<std::optional<ValueRange>> fields;  ///< nothing where no value is finite, or the field is not there
  std::vector<MassSurvey> masses;                 ///< of all bodies, then of each where there are several
};

/// What does not change while a run goes on.
struct SurveyTask {
  Vec3 up;
  std::size_t bodies = 1;
  std::vector<std::string> fields;  ///< asked for
  std::string of_picture;
  ReachRule rule;
  std::vector<bool> runs_out;  ///< whether a body counts in what all of them do
  std::vector<Real> mass;      ///< of each body at the start [kg]; empty where it is not known
};

struct RunSurvey {
  bool begun = false;  ///< what follows is known from the first frame
  std::vector<ViewedField> fields;
  std::vector<std::string> labels, units;  ///< of these
  std::vector<int> components;             ///< of these
  std::vector<FrameSurvey> frames;
  std::vector<std::string> left_out;  ///< frames that could not be read, in words
  std::vector<std::int64_t> ids;      ///< of the first frame
  std::vector<Real> places;           ///< there, 3 numbers a particle [m]
  std::vector<Real> masses;           ///< of these [kg], or in another unit that is the same for all
};

/// Looks at the frames that particles.pvd of a run names and that are not known yet; one that cannot be read is left out.  Error: see
/// fields_to_show().
void look_over(const std::filesystem::path& folder, const SurveyTask& task, RunSurvey& survey);

/// Low and high of a field over all frames.
ValueRange range_over_frames(const RunSurvey& survey, std::size_t field);

/// Size and time of change of a file, as one word; empty if it is not there.
std::string state_of(const std::filesystem::path& file);

}  // namespace talus
