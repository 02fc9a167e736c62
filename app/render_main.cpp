// talus-render: pictures in a process of their own, because VTK ends the process when there is no display.
#include <fmt/format.h>

#include <cstdio>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "io/render.hpp"
#include "io/render_chart.hpp"

// Exit codes as those of talus: 0 done, 1 unforeseen, 2 wrong arguments, 3 wrong environment.
int main(int argc, char** argv)
{
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  try {
    if (arguments.size() == 1 && arguments.front() == "--help") {
      fmt::print("{}\n", talus::render::usage());
      return 0;
    }
    const auto announce = [](const std::filesystem::path& picture) {
      fmt::print("picture: {}\n", picture.string());  // io/launch_render.cpp looks for these lines
      std::fflush(stdout);
    };
    if (!arguments.empty() && arguments.front() == "chart") {
      const auto chart = talus::render::parse_chart(std::span(arguments).subspan(1));
      talus::render::draw(chart);
      announce(chart.out);
      return 0;
    }
    talus::render::make_pictures(talus::render::parse(arguments), announce);
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
