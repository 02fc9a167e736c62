// Words of the command line to a chart.
#include <fmt/format.h>

#include "core/error.hpp"
#include "core/option_words.hpp"
#include "io/pictures/render_chart.hpp"
#include "io/pictures/settings/picture_settings.hpp"

namespace talus::render {

Chart parse_chart(std::span<const std::string> arguments)
{
  Chart chart;
  OptionWords words(arguments);
  while (!words.empty()) {
    const std::string word = words.next("");
    const auto line = [&] {
      std::string name = words.next(word);
      return Chart::Level{std::move(name), number<Real>(words.next(word), word)};
    };
    if (word == "--x")
      chart.x = words.next(word);
    else if (word == "--y")
      chart.y = words.next(word);
    else if (word == "--title")
      chart.title = words.next(word);
    else if (word == "--out")
      chart.out = words.next(word);
    else if (word == "--curve")
      chart.curve = words.next(word);
    else if (word == "--marks")
      chart.marks = true;
    else if (word == "--log")
      chart.log = true;
    else if (word == "--level")
      chart.levels.push_back(line());
    else if (word == "--upright")
      chart.uprights.push_back(line());
    else if (!word.starts_with("--") && chart.table.empty())
      chart.table = word;
    else
      throw Error(fmt::format("unknown option {}\n{}", word, usage()));
  }
  if (chart.table.empty() || chart.x.empty() || chart.y.empty() || chart.out.empty())
    throw Error("a chart needs a table, --x, --y and --out\n" + usage());
  return chart;
}

Tornado parse_tornado(std::span<const std::string> arguments)
{
  Tornado tornado;
  OptionWords words(arguments);
  while (!words.empty()) {
    const std::string word = words.next("");
    if (word == "--x")
      tornado.x = words.next(word);
    else if (word == "--title")
      tornado.title = words.next(word);
    else if (word == "--out")
      tornado.out = words.next(word);
    else if (word == "--base")
      tornado.base = number<Real>(words.next(word), word);
    else if (word == "--bar") {
      std::string name = words.next(word);
      const Real low = number<Real>(words.next(word), word), high = number<Real>(words.next(word), word);
      tornado.bars.push_back({std::move(name), low, high});
    } else
      throw Error(fmt::format("unknown option {}\n{}", word, usage()));
  }
  if (tornado.bars.empty() || tornado.x.empty() || tornado.out.empty())
    throw Error("a tornado needs --bar, --x and --out\n" + usage());
  return tornado;
}

}  // namespace talus::render
