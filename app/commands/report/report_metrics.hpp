#pragma once
// Metrics of a run: run-out, crest, speeds.  They are computed from all particles at all output times, not only from those that a page
// shows.
#include "app/commands/report/report_survey.hpp"
#include "io/page/page.hpp"
#include "io/scene/scene_output.hpp"

namespace talus {

struct MetricTask {
  int dimension = 2;
  Vec3 up;
  bool gravity = true;              ///< without gravity only extents and motion are listed
  std::vector<std::string> bodies;  ///< names of bodies
  std::vector<FrontSpec> fronts;    ///< columns of the history
  ReachRule rule;                   ///< rule by which the survey found the moved particles
  HistoryTable runout;              ///< runout.csv of the run; may be empty
};

/// `history`: that of the run; may be empty.
std::vector<PageMetric> metrics_of(const RunSurvey& survey, const HistoryTable& history, const MetricTask& task);

/// The metrics at each output time: crest, fronts of the moved mass, height and length of its path, speed, displacement.
struct RunOutTable {
  std::vector<CsvColumn> columns;
  std::vector<std::vector<Real>> values;  ///< NaN where nothing has moved
};
RunOutTable run_out_of(const RunSurvey& survey, const MetricTask& task);

}  // namespace talus
