// Parses words of the command line to a chart.
#include "io/pictures/render_chart.hpp"
#include "io/pictures/settings/option_parser.hpp"

namespace talus::render {

namespace {

/// Parses an option that may be repeated, with a name and a number.
void add_lines(CLI::App& app, const std::string& option, std::vector<Chart::Level>& lines)
{
  const CLI::callback_t read = [option, &lines](const std::vector<std::string>& words) {
    lines.push_back({words[0], number<Real>(words[1], option)});
    return true;
  };
  app.add_option(option, read)->type_size(2)->trigger_on_parse();
}

}  // namespace

Chart parse_chart(std::span<const std::string> arguments)
{
  Chart chart;
  CLI::App app;
  app.add_option("TABLE", chart.table)->required();
  app.add_option("--x", chart.x)->required();
  app.add_option("--y", chart.y)->required();
  app.add_option("--title", chart.title);
  app.add_option("--out", chart.out)->required();
  add_lines(app, "--level", chart.levels);
  std::vector<std::string> problems;
  parse_words(app, arguments, problems);
  require_none(problems);
  return chart;
}

}  // namespace talus::render
