// talus report
#include <fmt/format.h>

#include "app/commands/report/report.hpp"
#include "app/commands/report/report_command.hpp"
#include "app/observers/results.hpp"
#include "core/error.hpp"
#include "io/files/atomic_file.hpp"

namespace talus {

void write_report(const ReportOptions& options)
{
  const RunFolder run = read_run_folder(options.folder);
  PageOptions wishes{options.fields, {}, options.size.value_or(PageOptions{}.megabytes), {}};
  if (options.frames)
    wishes.frames = static_cast<std::size_t>(*options.frames);
  const auto file = options.out.value_or(options.folder / report_file);
  if (file.extension() != ".html")
    throw Error(fmt::format("--out {}: the name of a page ends in .html", file.string()));
  RunSurvey survey;
  std::vector<std::string> notes;
  const std::string page = page_of(run, wishes, page_template(options.page), survey, notes);
  write_whole(file, page);
  fmt::print("{}  {:.1f} MB\n", file.string(), static_cast<Real>(page.size()) / 1e6);
  for (const std::string& note : notes)
    fmt::print("  {}\n", note);
}

}  // namespace talus
