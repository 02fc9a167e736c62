// Words of the command line to settings.  By hand: the ordinary user types `talus render`, which has checked them already.
#include <fmt/format.h>
#include <Eigen/Geometry>

#include <charconv>

#include "core/error.hpp"
#include "core/words.hpp"
#include "io/render.hpp"
#include "io/render_chart.hpp"

namespace talus::render {

namespace {

constexpr int smallest = 200, largest = 10000;  // pixels

template <class T>
T number(const std::string& word, const std::string& option)
{
  T value{};
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (code != std::errc{} || end != word.data() + word.size() || !(value - value == T{}))
    throw Error(fmt::format("{}: \"{}\" is not a number", option, word));
  return value;
}

/// Takes the words of an option one by one.
class Words {
 public:
  explicit Words(std::span<const std::string> words) : words_(words) {}
  bool empty() const noexcept { return words_.empty(); }
  std::string next(const std::string& wanted)
  {
    if (words_.empty())
      throw Error(fmt::format("{} needs another word", wanted));
    const std::string word = words_.front();
    words_ = words_.subspan(1);
    return word;
  }
  Vec3 vector(const std::string& option)
  {
    Vec3 v;
    for (int d = 0; d < 3; ++d)
      v[d] = number<Real>(next(option), option);
    return v;
  }

 private:
  std::span<const std::string> words_;
};

std::array<int, 2> picture_size(const std::string& word)
{
  const auto cross = word.find('x');
  if (cross == std::string::npos)
    throw Error(fmt::format("--size: \"{}\" should look like 1280x720", word));
  const std::array<int, 2> size{number<int>(word.substr(0, cross), "--size"), number<int>(word.substr(cross + 1), "--size")};
  for (const int pixels : size)
    if (pixels < smallest || pixels > largest)
      throw Error(fmt::format("--size: {} is outside {} to {} pixels", pixels, smallest, largest));
  return size;
}

std::variant<Which, std::size_t> frames(const std::string& word)
{
  if (word == "first")
    return Which::first;
  if (word == "last")
    return Which::last;
  if (word == "all")
    return Which::all;
  return number<std::size_t>(word, "--frames");
}

void read_option(Settings& s, const std::string& option, Words& words)
{
  if (option == "--field")
    s.field = words.next(option);
  else if (option == "--range") {
    const Real low = number<Real>(words.next(option), option), high = number<Real>(words.next(option), option);
    if (!(low < high))
      throw Error(fmt::format("--range: {} is not below {}", low, high));
    s.range = {low, high};
  } else if (option == "--frames")
    s.frames = frames(words.next(option));
  else if (option == "--size")
    s.size = picture_size(words.next(option));
  else if (option == "--view")
    s.view = words.vector(option);
  else if (option == "--up")
    s.up = words.vector(option);
  else if (option == "--out")
    s.out = words.next(option);
  else if (option == "--title")
    s.title = words.next(option);
  else if (option == "--radius")
    s.radius = number<Real>(words.next(option), option);
  else if (option == "--no-mesh")
    s.mesh = false;
  else
    throw Error(fmt::format("unknown option {}{}", option,
                            suggestion(option, std::vector<std::string>{"--field", "--range", "--frames", "--size", "--view", "--up",
                                                                        "--out", "--title", "--radius", "--no-mesh"})));
}

void check(const Settings& s)
{
  if (s.folder.empty())
    throw Error("the folder of a run is missing\n" + usage());
  if (s.radius && !(*s.radius > 0))
    throw Error("--radius must be positive");
  const Real sine = s.view.cross(s.up).norm();
  if (!(sine > 1e-6 * s.view.norm() * s.up.norm()))  // about a ten-thousandth of a degree: no horizontal direction is left
    throw Error("--view and --up must not be parallel or zero");
}

}  // namespace

std::string usage()
{
  return "usage: talus-render DIR [--field NAME[:component]] [--range LOW HIGH] [--frames first|last|all|N] [--size 1280x720]\n"
         "                    [--view X Y Z] [--up X Y Z] [--out FILE.png|DIR] [--title TEXT] [--radius R] [--no-mesh]\n"
         "       talus-render chart TABLE.csv --x COLUMN --y COLUMN [--level NAME VALUE]... [--title TEXT] --out FILE.png\n"
         "Draws the particles of DIR/particles.pvd, or a curve of a table.  Needs a display; `talus render` brings one.";
}

Settings parse(std::span<const std::string> arguments)
{
  Settings settings;
  Words words(arguments);
  while (!words.empty()) {
    const std::string word = words.next("");
    if (word.starts_with("--"))
      read_option(settings, word, words);
    else if (settings.folder.empty())
      settings.folder = word;
    else
      throw Error(fmt::format("one folder at a time: {} and {}", settings.folder.string(), word));
  }
  check(settings);
  return settings;
}

Chart parse_chart(std::span<const std::string> arguments)
{
  Chart chart;
  Words words(arguments);
  while (!words.empty()) {
    const std::string word = words.next("");
    if (word == "--x")
      chart.x = words.next(word);
    else if (word == "--y")
      chart.y = words.next(word);
    else if (word == "--title")
      chart.title = words.next(word);
    else if (word == "--out")
      chart.out = words.next(word);
    else if (word == "--level") {
      std::string name = words.next(word);
      chart.levels.push_back({std::move(name), number<Real>(words.next(word), word)});
    } else if (!word.starts_with("--") && chart.table.empty())
      chart.table = word;
    else
      throw Error(fmt::format("unknown option {}\n{}", word, usage()));
  }
  if (chart.table.empty() || chart.x.empty() || chart.y.empty() || chart.out.empty())
    throw Error("a chart needs a table, --x, --y and --out\n" + usage());
  return chart;
}

}  // namespace talus::render
