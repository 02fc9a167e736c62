#pragma once
// A run's folder as a page for the browser.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/commands/report/report_survey.hpp"
#include "io/output/summary_json.hpp"
#include "io/page/page.hpp"
#include "io/scene/scene.hpp"

namespace talus {

struct PageOptions {
  std::vector<std::string> fields;    ///< empty: that of the pictures, then all
  std::optional<std::size_t> frames;  ///< so many; default as many as there is room for
  Real megabytes = 28;                ///< of the whole file, at most
  std::optional<Real> live;           ///< seconds between questions for more
  std::size_t history_rows = 4000;    ///< about, at most
};

/// How a run has ended, or that it has not.
enum class RunState : std::uint8_t { at_work, done, failed, stopped, killed };

/// What is in the folder of a run besides its outputs.
struct RunFolder {
  std::filesystem::path path;
  SummaryBack summary;
  Scene scene;  ///< with what --set changed
  RunState state = RunState::done;
};
/// Error: there is no such folder, or it is none of a run.  SceneErrors, EnvironmentError: its scene, its summary cannot be read.
RunFolder read_run_folder(const std::filesystem::path& folder);
/// The same, without reading the scene again.
RunState state_of_run(const std::filesystem::path& folder, const SummaryBack& summary);

/// The page that `text`, a template, makes of a run.  `survey`: what is known from before, if anything; brought up to date.  `notes`, what
/// the page leaves out, if asked for.  Error for what was asked for and is not there, or does not fit; EnvironmentError.
std::string page_of(const RunFolder& run, const PageOptions& wishes, const std::filesystem::path& template_file, RunSurvey& survey,
                    std::vector<std::string>& notes);

/// The template of pages: `given`, else report.html beside this program, which the build makes there where it can fetch the libraries of the page.
/// EnvironmentError, with what to do, where it could not.
std::filesystem::path page_template(const std::optional<std::filesystem::path>& given);

/// The line of a scene that a warning speaks of: the one it names ("slope.yaml:12:5: ..."), or that of the key it names ("watch.speed").
std::optional<int> line_of_warning(const std::string& warning, const std::string& scene_file, const std::string& scene_text);

}  // namespace talus
