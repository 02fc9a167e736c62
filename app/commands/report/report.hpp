#pragma once
// Command talus report: the report of a run as an HTML page.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/commands/report/report_survey.hpp"
#include "core/types.hpp"
#include "io/output/summary_json.hpp"
#include "io/page/page.hpp"
#include "io/scene/scene.hpp"

namespace talus {

struct PageOptions {
  std::vector<std::string> fields;    ///< empty: the field of the pictures, then all
  std::optional<std::size_t> frames;  ///< number of frames; default: as many as fit
  Real megabytes = 28;                ///< largest size of the whole file [MB]
  std::optional<Real> live;           ///< seconds between requests for updates
  std::size_t history_rows = 4000;    ///< approximate limit of the rows of the history
};

/// Whether and how a run has ended.
enum class RunState : std::uint8_t { at_work, done, failed, stopped, killed };

/// The contents of a results folder other than the outputs.
struct RunFolder {
  std::filesystem::path path;
  SummaryBack summary;
  Scene scene;  ///< including changes by --set
  RunState state = RunState::done;
};
/// Throws Error if the folder does not exist or has no results of a run; SceneErrors or EnvironmentError if its scene or summary cannot be
/// read.
RunFolder read_run_folder(const std::filesystem::path& folder);
/// The state of a run, without reading the scene again.
RunState state_of_run(const std::filesystem::path& folder, const SummaryBack& summary);

/// The page of a run from the template `text`.  `survey`: data from an earlier call, which are updated.  `notes` receives descriptions of
/// what the page leaves out.  Throws Error for requested items that do not exist or do not fit, EnvironmentError.
std::string page_of(const RunFolder& run, const PageOptions& wishes, const std::filesystem::path& template_file, RunSurvey& survey,
                    std::vector<std::string>& notes);

/// The template of pages: `given`, or report.html beside this program, which the build makes if it can download the libraries of the page.
/// Throws EnvironmentError with instructions if it is missing.
std::filesystem::path page_template(const std::optional<std::filesystem::path>& given);

/// The line of a scene that a warning concerns: the one it names ("slope.yaml:12:5: ..."), or that of the key it names ("watch.speed").
std::optional<int> line_of_warning(const std::string& warning, const std::string& scene_file, const std::string& scene_text);

struct ReportOptions {
  std::filesystem::path folder;
  std::optional<std::filesystem::path> out;   ///< default DIR/report.html
  std::optional<std::filesystem::path> page;  ///< template; default: the one beside the program
  std::vector<std::string> fields;            ///< empty: the field of the pictures, then all that were written
  std::optional<int> frames;                  ///< number of frames
  std::optional<Real> size;                   ///< largest size of the page [MB]
};
/// Makes a page for the browser from a results folder, also of a run that has not ended, and prints what it leaves out.  Throws Error if
/// there is no run or a requested item is missing; EnvironmentError.
void write_report(const ReportOptions& options);

}  // namespace talus
