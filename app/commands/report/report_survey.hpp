#pragma once
// The fields of particles that a page shows, and a survey of all frames of a run.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/observers/runout_distance.hpp"
#include "core/field_component.hpp"
#include "io/output/vtk.hpp"

namespace talus {

/// The fields to show: the requested ones, or else the one of the pictures and then every field that was written.  Throws Error if a field
/// or component does not exist.
std::vector<ViewedField> fields_to_show(const StoredParticles& particles, const std::vector<std::string>& asked,
                                        const std::string& of_picture);

/// The field as the user names it, such as "stress:xy".
std::string words_of(const ViewedField& field);

struct ValueRange {
  Real low, high;  ///< range of finite values
};

/// The particles that have moved according to the rule: relative to their positions at the last reset of displacements, or in the first
/// frame if displacements were not written.
struct MovedMass {
  std::int64_t count = 0;
  Vec3 low, high;       ///< corners of the bounding box of their present positions [m]
  Real height, length;  ///< from the crown to the front, vertical and horizontal [m]
};

/// The survey of one body, or of all.
struct MassSurvey {
  std::int64_t count = 0;
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  ///< corners of the bounding box [m]
  Real crest = 0;                                ///< highest position along `up` [m]
  std::optional<Real> speed, displacement;       ///< largest values [m/s], [m]
  std::optional<MovedMass> moved;
};

struct FrameSurvey {
  Real time;  ///< time of the frame [s]
  std::filesystem::path file;
  std::string state;  ///< size and time of the file, to detect that it was replaced
  std::int64_t count = 0;
  std::vector<std::optional<ValueRange>> fields;  ///< nothing if no value is finite or the field is missing
  std::vector<MassSurvey> masses;                 ///< for all bodies, then for each if there are several
};

/// The constant parameters of a survey.
struct SurveyTask {
  Vec3 up;
  std::size_t bodies = 1;
  std::vector<std::string> fields;  ///< requested fields
  std::string of_picture;
  ReachRule rule;
  std::vector<bool> runs_out;  ///< whether a body is included in the totals
  std::vector<Real> mass;      ///< mass of each body at the start [kg]; empty if unknown
};

struct RunSurvey {
  bool begun = false;  ///< whether the members below are known from the first frame
  std::vector<ViewedField> fields;
  std::vector<std::string> labels, units;  ///< labels and units of the fields
  std::vector<int> components;             ///< components of the fields
  std::vector<FrameSurvey> frames;
  std::vector<std::string> left_out;  ///< descriptions of frames that could not be read
  std::vector<std::int64_t> ids;      ///< ids in the first frame
  std::vector<Real> places;           ///< positions in the first frame, 3 numbers per particle [m]
  std::vector<Real> masses;           ///< masses in the first frame [kg], or in another common unit
};

/// Reads the new frames of particles.pvd; unreadable frames are left out.  Throws Error, see fields_to_show().
void look_over(const std::filesystem::path& folder, const SurveyTask& task, RunSurvey& survey);

/// The range of a field over all frames.
ValueRange range_over_frames(const RunSurvey& survey, std::size_t field);

/// The size and modification time of a file as one word; empty if it does not exist.
std::string state_of(const std::filesystem::path& file);

}  // namespace talus
