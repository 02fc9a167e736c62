#pragma once
// What a run's particles say in numbers: run-out, crest, speeds.  Of all particles at all output times, not only of those a page shows.
#include "app/commands/report/report_survey.hpp"
#include "io/page/page.hpp"
#include "io/scene/scene_output.hpp"

namespace talus {

struct MetricTask {
  int dimension = 2;
  Vec3 up;
  bool gravity = true;              ///< without it nothing falls: only extents and motion are told
  std::vector<std::string> bodies;  ///< names
  std::vector<FrontSpec> fronts;    ///< columns of the history
  ReachRule rule;                   ///< by which the survey found what has moved
  HistoryTable runout;              ///< runout.csv, which the run itself has written; may be empty
};

/// `history`: as the run has written it; may be empty.
std::vector<PageMetric> metrics_of(const RunSurvey& survey, const HistoryTable& history, const MetricTask& task);

/// What they were at each output time: crest, fronts of what has moved, height and length of its way, speed, displacement.
struct RunOutTable {
  std::vector<CsvColumn> columns;
  std::vector<std::vector<Real>> values;  ///< NaN where nothing has moved
};
RunOutTable run_out_of(const RunSurvey& survey, const MetricTask& task);

}  // namespace talus
