// Parses words of the command line to a chart.
#include "io/pictures/render_chart.hpp"
#include "io/pictures/settings/option_parser.hpp"

namespace talus::render {

namespace {

/// Parses an option that may be repeated, with a name and `numbers` numbers; calls take(name, numbers).
template <class Take>
void add_lines(CLI::App& app, const std::string& option, int numbers, Take take)
{
  const CLI::callback_t read = [option, take](const std::vector<std::string>& words) {
    std::vector<Real> values;
    for (std::size_t i = 1; i < words.size(); ++i)
      values.push_back(number<Real>(words[i], option));
    take(words[0], values);
    return true;
  };
  app.add_option(option, read)->type_size(1 + numbers)->trigger_on_parse();
}

void require_sound(CLI::App& app, std::span<const std::string> words)
{
  std::vector<std::string> problems;
  parse_words(app, words, problems);
  require_none(problems);
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
  app.add_option("--curve", chart.curve);
  app.add_flag("--marks", chart.marks);
  app.add_flag("--log", chart.log);
  for (const auto& [option, lines] : {std::pair("--level", &chart.levels), std::pair("--upright", &chart.uprights)})
    add_lines(app, option, 1, [to = lines](const std::string& name, const std::vector<Real>& value) { to->push_back({name, value[0]}); });
  require_sound(app, arguments);
  return chart;
}

Tornado parse_tornado(std::span<const std::string> arguments)
{
  Tornado tornado;
  CLI::App app;
  app.add_option("--x", tornado.x)->required();
  app.add_option("--title", tornado.title);
  app.add_option("--out", tornado.out)->required();
  app.add_option("--base", tornado.base);
  add_lines(app, "--bar", 2, [&](const std::string& name, const std::vector<Real>& ends) {
    tornado.bars.push_back({name, ends[0], ends[1]});
  });
  app.get_option("--bar")->required();
  require_sound(app, arguments);
  return tornado;
}

}  // namespace talus::render
