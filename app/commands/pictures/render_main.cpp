// talus-render: pictures and surfaces in a separate process, because VTK ends the process if there is no display.
#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "io/pictures/maps/render_map.hpp"
#include "io/pictures/render.hpp"
#include "io/pictures/render_chart.hpp"
#include "io/pictures/render_surface.hpp"

namespace {

using namespace talus;

/// Prints a file and lines about it in the format that io/pictures/settings/launch_render.cpp parses.
void announce(const std::filesystem::path& file, const std::string& said = "")
{
  fmt::print("file: {}\n", file.string());
  std::istringstream lines(said);
  for (std::string line; std::getline(lines, line);)
    fmt::print("said: {}\n", line);
  std::fflush(stdout);
}

void draw_chart(std::span<const std::string> words)
{
  const auto chart = render::parse_chart(words);
  render::draw(chart);
  announce(chart.out);
}

void write_surfaces(std::span<const std::string> words)
{
  std::vector<std::string> problems;
  const auto settings = render::parse_surface(words, problems);
  render::require_none(problems);
  render::make_surfaces(settings, announce);
}

void draw_maps(std::span<const std::string> words)
{
  std::vector<std::string> problems;
  const auto settings = render::parse_maps(words, problems);
  render::require_none(problems);
  render::draw_maps(settings, [](const std::filesystem::path& picture) { announce(picture); });
}

void draw_pictures(std::span<const std::string> words)
{
  std::vector<std::string> problems;
  const auto settings = render::parse_picture(words, problems);
  render::require_none(problems);
  render::make_pictures(settings, [](const std::filesystem::path& picture) { announce(picture); });
}

}  // namespace

// Exit codes as those of talus: 0 done, 1 unexpected error, 2 wrong arguments, 3 wrong environment.
int main(int argc, char** argv)
{
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  std::signal(SIGXFSZ, SIG_IGN);  // a file beyond the size limit is an error of the write
  try {
    if (arguments.size() == 1 && arguments.front() == "--help") {
      fmt::print("{}", render::usage());
      return 0;
    }
    if (!arguments.empty() && arguments.front() == "chart")
      draw_chart(std::span(arguments).subspan(1));
    else if (!arguments.empty() && arguments.front() == "surface")
      write_surfaces(std::span(arguments).subspan(1));
    else if (!arguments.empty() && arguments.front() == "map")
      draw_maps(std::span(arguments).subspan(1));
    else
      draw_pictures(arguments);
    return 0;
  } catch (const talus::EnvironmentError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 3;
  } catch (const talus::Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
