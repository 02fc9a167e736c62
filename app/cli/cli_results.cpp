// Commands for the results of a run.
#include "app/cli/cli_checks.hpp"
#include "app/cli/cli_commands.hpp"
#include "app/cli/cli_python.hpp"
#include "io/pictures/settings/option_parser.hpp"

namespace talus {

namespace {

/// Options of talus-render, whose words are passed on unchanged.
template <class S>
void add_words(CLI::App& command, std::vector<std::string>& words)
{
  render::add_options(
      command, S::options(),
      [&words](const auto& option, const std::vector<std::string>& values) {
        words.emplace_back(option.name);
        words.insert(words.end(), values.begin(), values.end());
      },
      render::Offered::to_users);
}

void add_movie(CLI::App& command, MovieOptions& options, const char* help)
{
  CLI::Option* movie = command.add_option("--movie", options.movie, help);
  command.add_option("--fps", options.per_second, "pictures per second of the movie; default 10")
      ->needs(movie)
      ->check(number_within(0.1, 100.0));
  command.add_flag("--keep-frames", options.keep_frames, "leave the pictures of the movie as numbered files in --out")->needs(movie);
}

}  // namespace

void ResultCommands::add_map(CLI::App& app)
{
  CLI::App* map = app.add_subcommand("map", "draw the maps of a run-out over a hillshade of the ground, and its sections");
  map->add_option("folder", map_.folder, "results of a run with outputs.runout")->type_name(folder_value)->required();
  add_words<render::MapSettings>(*map, map_.words);
  add_movie(*map, map_, "a .mp4 or .gif of the thickness, by ffmpeg; needs outputs.runout.frames_every");
  map->callback([this] { draw_maps(map_); });
}

void ResultCommands::add_render(CLI::App& app)
{
  CLI::App* render = app.add_subcommand("render", "draw pictures of a run, or a movie");
  render->add_option("folder", render_.folder, "results of a run")->type_name(folder_value)->required();
  add_words<render::Settings>(*render, render_.words);
  add_movie(*render, render_, "a .mp4 or .gif of all frames, or those of --frames, by ffmpeg");
  render->callback([this] { render_results(render_); });
}

void ResultCommands::add_report(CLI::App& app)
{
  CLI::App* report = app.add_subcommand("report", "make one page for the browser of a run: particles, history, numbers");
  report->add_option("folder", report_.folder, "results of a run, ended or not")->type_name(folder_value)->required();
  report->add_option("--out", report_.out, "a .html; default DIR/report.html");
  report
      ->add_option("--fields", report_.fields, "particle fields, such as plastic_strain,stress:xy; default that of the pictures, then all")
      ->delimiter(',');
  report->add_option("--frames", report_.frames, "so many, evenly spread; default as many as there is room for")
      ->check(number_within(1, most_steps));
  report->add_option("--size", report_.size, "of the page at most [MB]; default 28")->check(number_above_zero());
  report->add_option("--page", report_.page, "page to fill instead of the one that was built with the program");
  report->callback([this] { write_report(report_); });
}

void ResultCommands::add_watch(CLI::App& app)
{
  constexpr int most_port = 65535;
  CLI::App* watch = app.add_subcommand("watch", "follow a run in the terminal and in the browser until it ends");
  watch->add_option("folder", watch_.folder, "where a run leaves its results")->type_name(folder_value)->required();
  watch->add_option("--interval", watch_.interval, "seconds between two reads of the results; default 2")
      ->check(number_within(0.1, 3600.0));
  watch->add_option("--port", watch_.port, "of the page, on this machine only; default any that is free")
      ->check(number_within(0, most_port));
  watch->add_flag("!--no-serve", watch_.serve, "no page, only the terminal");
  watch->add_flag("--once", watch_.once, "look once, serve nothing, end");
  watch->add_option("--page", watch_.page, "page to fill instead of the one that was built with the program");
  watch->callback([this] { status_ = watch_run(watch_); });
}

void ResultCommands::add_surface(CLI::App& app)
{
  CLI::App* surface = app.add_subcommand("surface", "write the surface of bodies for other programs, and say what it encloses");
  surface->add_option("folder", surface_.folder, "results of a run")->type_name(folder_value)->required();
  surface->add_option("--body", surface_.body, "name of the body; default each of them, all in one file");
  add_words<render::SurfaceSettings>(*surface, surface_.words);
  surface->callback([this] { extract_surface(surface_); });
}

void ResultCommands::add_diff(CLI::App& app)
{
  CLI::App* diff = app.add_subcommand("diff", "compare the results of two runs, field by field");
  const OptionsOfPython words(*diff, diff_);
  words.add_file("a", "results of a run")->type_name(folder_value);
  words.add_file("b", "results of another run")->type_name(folder_value);
  words.add("--relative", "allowed difference over the largest value of the field in both runs; default 0")->check(number_not_below_zero());
  words.add("--absolute", "allowed difference, in the unit of each field, besides that; default 0")->check(number_not_below_zero());
  words.add_list("--field", "compare only these fields")->delimiter(',');
  words.add_flag("--last", "compare only the last time that both runs have");
  diff->callback([this] { run_in_package(diff_); });
}

void ResultCommands::add_to(CLI::App& app)
{
  add_render(app);
  add_map(app);
  add_report(app);
  add_watch(app);
  add_surface(app);
  add_diff(app);
}

}  // namespace talus
