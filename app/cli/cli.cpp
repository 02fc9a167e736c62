// Every command and its options.
#include "app/cli/cli.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>

#include "app/cli/cli_checks.hpp"
#include "app/cli/completion.hpp"
#include "app/commands/bench/bench_command.hpp"
#include "app/commands/check_command.hpp"
#include "app/commands/diff/diff_command.hpp"
#include "app/commands/drive_command.hpp"
#include "app/commands/fos/fos_command.hpp"
#include "app/commands/info_command.hpp"
#include "app/commands/manual_command.hpp"
#include "app/commands/mesh_command.hpp"
#include "app/commands/new/new_command.hpp"
#include "app/commands/new/templates.hpp"
#include "app/commands/pictures/map_command.hpp"
#include "app/commands/pictures/movie_options.hpp"
#include "app/commands/pictures/render_command.hpp"
#include "app/commands/pictures/surface_command.hpp"
#include "app/commands/report/report_command.hpp"
#include "app/commands/run_command.hpp"
#include "app/commands/suite_command.hpp"
#include "app/commands/sweep/sweep_command.hpp"
#include "app/commands/watch/watch_command.hpp"
#include "core/parallel/communicator.hpp"
#include "core/version.hpp"
#include "core/word_match.hpp"
#include "io/pictures/settings/option_parser.hpp"
#include "materials/laboratory/laboratory.hpp"

namespace talus {

namespace {

constexpr int usage_error = 2, results_differ = 1;
constexpr auto set_help = "change a value of the scene: key=value, such as time.end=2 or bodies[0].particles_per_cell=6";
constexpr int most_steps = 10'000'000;

/// What help shows for values, and what a shell completes (completion.hpp): files by their names, folders, some words.
constexpr auto scene_value = "*.yaml", folder_value = "FOLDER";
std::string one_of(const std::vector<std::string>& words) { return fmt::format("{{{}}}", fmt::join(words, ",")); }

/// What all ranks do together; any other command is the root's.
bool is_shared_by_ranks(const CLI::App& command)
{
  return (command.get_name() == "run" && command.count("--dry-run") == 0) || (command.get_name() == "bench" && command.count("--mpi") > 0);
}

/// Commands and the options they fill; lives as long as the parse.
class CommandLine {
 public:
  CommandLine() : app_("Talus: the material point method on triangles and tetrahedra", "talus")
  {
    app_.require_subcommand(1);
    app_.set_version_flag("--version", describe(version()));
    app_.set_help_all_flag("--help-all", "help of every command");
    add_new();
    add_run();
    add_check();
    add_mesh();
    add_drive();
    add_render();
    add_map();
    add_report();
    add_watch();
    add_surface();
    add_diff();
    add_sweep();
    add_fos();
    add_suite("verify", "run the benchmarks against their references; write verify.json and a report", verify_);
    add_suite("tradeoff", "sweep a benchmark: error over processor time and memory, and what to choose", tradeoff_);
    add_bench();
    add_manual();
    add_completion();
    app_.add_subcommand("info", "version, laws, kernels, licence")->callback([] { print_info(); });
    app_.parse_complete_callback([this] { leave_to_root(*app_.get_subcommands().front()); });
  }

  int parse(int argc, const char* const* argv)
  {
    std::vector<std::string> commands;
    for (const CLI::App* command : app_.get_subcommands([](const CLI::App*) { return true; }))
      commands.push_back(command->get_name());
    if (argc > 1 && argv[1][0] != '-' && std::find(commands.begin(), commands.end(), argv[1]) == commands.end()) {
      if (world().is_root())
        fmt::print(stderr, "error: there is no command \"{}\"{}\n", argv[1], suggestion(argv[1], commands));
      return usage_error;
    }
    try {
      app_.parse(argc, argv);
      return status_;
    } catch (const CLI::ParseError& e) {
      const int code = world().is_root() ? app_.exit(e) : e.get_exit_code();
      return code == 0 ? 0 : usage_error;
    }
  }

 private:
  /// Before the command does its work, on each rank: on all but the root it does none, unless they share it.
  static void leave_to_root(CLI::App& command)
  {
    if (!is_shared_by_ranks(command) && !goes_on_as_root())
      command.callback(nullptr);
  }

  void add_new()
  {
    CLI::App* made = app_.add_subcommand("new", "copy a commented scene, to be edited");
    made->add_option("template", new_.from, "name of a template (talus new --list), or the file of a scene")
        ->type_name(one_of(template_names()) + " or *.yaml");
    made->add_option("--out", new_.out, "file to write; default <template>.yaml")->type_name(scene_value);
    made->add_option("--set", new_.set, set_help);
    made->add_flag("--list", new_.list, "write nothing: tell the templates");
    made->add_flag("--force", new_.force, "replace the file if it is there");
    made->callback([this] { new_scene(new_); });
  }

  void add_manual()
  {
    CLI::App* manual = app_.add_subcommand("manual", "every key of a scene, as Markdown; or what some of them mean");
    CLI::Option* words =
        manual->add_option("key", manual_words_, "keys, laws, kernels, types: friction_angle, materials.cohesion, mohr_coulomb");
    words->type_name("KEY");
    manual->add_flag("--schema", schema_, "as JSON Schema, for editors")->excludes(words);
    manual->callback([this] { print_manual(schema_, manual_words_); });
  }

  void add_completion()
  {
    CLI::App* completion = app_.add_subcommand("completion", "print what makes a shell complete commands, options and files");
    completion->add_option("shell", shell_, "which shell")->required()->check(CLI::IsMember(completion_shells()));
    completion->callback([this] {
      std::vector<CommandWords> commands;
      for (const CLI::App* command : app_.get_subcommands([](const CLI::App*) { return true; })) {
        commands.push_back({command->get_name(), command->get_description(), {}});
        add_options(*command, commands.back().options);
      }
      fmt::print("{}", completion_script(shell_, commands));
    });
  }

  /// Those of a command and of the groups in it.
  static void add_options(const CLI::App& from, std::vector<OptionWords>& options)
  {
    for (const CLI::Option* option : from.get_options()) {
      OptionWords words{{}, option->get_items_expected_max() > 0 ? option->get_type_name() : "", option->get_description()};
      for (const std::string& name : option->get_snames())
        words.names.push_back("-" + name);
      for (const std::string& name : option->get_lnames())
        words.names.push_back("--" + name);
      options.push_back(std::move(words));
    }
    for (const CLI::App* group : from.get_subcommands([](const CLI::App*) { return true; }))
      add_options(*group, options);
  }

  void add_run()
  {
    CLI::App* run = app_.add_subcommand("run", "run a scene");
    CLI::Option_group* what = run->add_option_group("what");
    CLI::Option* scene = what->add_option("scene", run_.scene, "scene file (.yaml)")->type_name(scene_value);
    what->add_option("--resume", run_.resume, "go on with a run that was stopped: its folder, or one of its checkpoints")
        ->type_name(folder_value);
    what->require_option(1);
    run->add_option("--out", run_.out, "folder for the results; default runs/<name of the scene>, or that of the run to go on with")
        ->type_name(folder_value);
    run->add_option("--threads", run_.threads, "threads to use; default what the scene says, or as many as pay for its particles")
        ->check(number_within(1, 1024));
    run->add_option("--set", run_.set, set_help);
    run->add_option("--until", run_.until, "stop after so many steps with a checkpoint, to go on from or to look at")
        ->check(number_not_below_zero());
    run->add_option("--rebalance", run_.rebalance,
                    "several ranks: share the run out anew every so many steps; 0: never; default when it pays")
        ->check(number_not_below_zero());
    run->add_flag("--quick", run_.quick, "coarse and short: only to see that the scene runs")->needs(scene);
    run->add_flag("--quiet", run_.quiet, "no progress and no table");
    run->add_flag("--strict", run_.strict, "balances that do not close are an error: exit code 1 (strict: true in a scene)");
    run->add_flag("--force", run_.force, "replace a run that was stopped, or has failed, and could go on from its checkpoints");
    run->add_flag("--dry-run", run_.dry, "write nothing: tell what the run would take in memory, files and time, from a few steps")
        ->needs(scene);
    run->callback([this] { run_.dry ? dry_run(run_) : run_scene(run_); });
  }

  void add_check()
  {
    CLI::App* check = app_.add_subcommand("check", "find everything wrong with a scene and its mesh; say what a run would cost");
    check->add_option("scene", check_scene_, "scene file (.yaml)")->type_name(scene_value)->required();
    check->add_option("--set", check_set_, set_help);
    check->callback([this] { check_scene(check_scene_, check_set_); });
  }

  void add_mesh()
  {
    CLI::App* mesh = app_.add_subcommand("mesh", "quality and groups of a mesh; make it if need be");
    mesh->add_option("file", mesh_.file, "scene (.yaml), mesh (.msh) or geometry (.geo, .step)")
        ->type_name("*.yaml *.msh *.geo *.step")
        ->required();
    mesh->add_option("--out", mesh_.out, "write the mesh to this .msh")->type_name("*.msh");
    mesh->add_option("--size", mesh_.size, "edge length of the cells of a geometry [m]")->check(number_above_zero());
    mesh->add_option("--dimension", mesh_.dimension, "2 or 3; default that of the largest cells")->check(number_within(2, 3));
    mesh->add_option("--set", mesh_.set, set_help);
    mesh->callback([this] { show_mesh(mesh_); });
  }

  void add_drive()
  {
    CLI::App* drive = app_.add_subcommand("drive", "drive one law along a path of strains and stresses, or through a laboratory test");
    drive->add_option("file", drive_.file, "material and paths (.yaml); with --test a scene")->type_name(scene_value)->required();
    drive->add_option("--out", drive_.out, "write the table to this .csv; default the screen, and with --test nowhere");
    drive->add_option("--set", drive_.set, set_help);
    constexpr auto tests = enum_names(Laboratory{});
    CLI::Option* test = drive->add_option("--test", drive_.test, or_list(std::vector<std::string>(tests.begin(), tests.end())));
    test->type_name(one_of(std::vector<std::string>(tests.begin(), tests.end())));
    const auto of_test = [&](const char* name, auto& value, const char* help) { return drive->add_option(name, value, help)->needs(test); };
    of_test("--material", drive_.material, "material of the scene; may be left out where there is one");
    of_test("--pressure", drive_.pressure, "stress at the start, equal in all directions [Pa]; default 1e5, for the last two tests 0")
        ->check(number_not_below_zero());
    of_test("--strain", drive_.strain, "axial or shear strain at the end; default 0.2, 0.2, 0.5, 0.05, 0.2")->check(number_above_zero());
    of_test("--rate", drive_.rate, "of this strain [1/s]; default 0.001")->check(number_above_zero());
    of_test("--plot", drive_.plot, "draw the curve and the closed forms into this .png");
    of_test("--steps", drive_.steps, "default 500")->check(number_within(1, most_steps));
    drive->callback([this] { drive_law(drive_); });
  }

  /// Options of talus-render, whose words are handed on as they stand.
  template <class S>
  static void add_words(CLI::App& command, std::vector<std::string>& words)
  {
    render::add_options(
        command, S::options(),
        [&words](const auto& option, const std::vector<std::string>& values) {
          words.emplace_back(option.name);
          words.insert(words.end(), values.begin(), values.end());
        },
        render::Offered::to_users);
  }

  static void add_movie(CLI::App& command, MovieOptions& options, const char* help)
  {
    CLI::Option* movie = command.add_option("--movie", options.movie, help);
    command.add_option("--fps", options.per_second, "pictures per second of the movie; default 10")
        ->needs(movie)
        ->check(number_within(0.1, 100.0));
    command.add_flag("--keep-frames", options.keep_frames, "leave the pictures of the movie as numbered files in --out")->needs(movie);
  }

  void add_map()
  {
    CLI::App* map = app_.add_subcommand("map", "draw the maps of a run-out over a hillshade of the ground, and its sections");
    map->add_option("folder", map_.folder, "results of a run with outputs.runout")->type_name(folder_value)->required();
    add_words<render::MapSettings>(*map, map_.words);
    add_movie(*map, map_, "a .mp4 or .gif of the thickness, by ffmpeg; needs outputs.runout.frames_every");
    map->callback([this] { draw_maps(map_); });
  }

  void add_render()
  {
    CLI::App* render = app_.add_subcommand("render", "draw pictures of a run, or a movie");
    render->add_option("folder", render_.folder, "results of a run")->type_name(folder_value)->required();
    add_words<render::Settings>(*render, render_.words);
    add_movie(*render, render_, "a .mp4 or .gif of all frames, or those of --frames, by ffmpeg");
    render->callback([this] { render_results(render_); });
  }

  void add_report()
  {
    CLI::App* report = app_.add_subcommand("report", "make one page for the browser of a run: particles, history, numbers");
    report->add_option("folder", report_.folder, "results of a run, ended or not")->type_name(folder_value)->required();
    report->add_option("--out", report_.out, "a .html; default DIR/report.html");
    report
        ->add_option("--fields", report_.fields,
                     "particle fields, such as plastic_strain,stress:xy; default that of the pictures, then all")
        ->delimiter(',');
    report->add_option("--frames", report_.frames, "so many, evenly spread; default as many as there is room for")
        ->check(number_within(1, most_steps));
    report->add_option("--size", report_.size, "of the page at most [MB]; default 28")->check(number_above_zero());
    report->add_option("--page", report_.page, "page to fill instead of the one that was built with the program");
    report->callback([this] { write_report(report_); });
  }

  void add_watch()
  {
    constexpr int most_port = 65535;
    CLI::App* watch = app_.add_subcommand("watch", "follow a run in the terminal and in the browser until it ends");
    watch->add_option("folder", watch_.folder, "where a run leaves its results")->type_name(folder_value)->required();
    watch->add_option("--interval", watch_.interval, "seconds between looks; default 2")->check(number_within(0.1, 3600.0));
    watch->add_option("--port", watch_.port, "of the page, on this machine only; default any that is free")
        ->check(number_within(0, most_port));
    watch->add_flag("!--no-serve", watch_.serve, "no page, only the terminal");
    watch->add_flag("--once", watch_.once, "look once, serve nothing, end");
    watch->add_option("--page", watch_.page, "page to fill instead of the one that was built with the program");
    watch->callback([this] { status_ = watch_run(watch_); });
  }

  void add_surface()
  {
    CLI::App* surface = app_.add_subcommand("surface", "write the surface of bodies for other programs, and say what it encloses");
    surface->add_option("folder", surface_.folder, "results of a run")->type_name(folder_value)->required();
    surface->add_option("--body", surface_.body, "name of the body; default each of them, all in one file");
    add_words<render::SurfaceSettings>(*surface, surface_.words);
    surface->callback([this] { extract_surface(surface_); });
  }

  void add_diff()
  {
    CLI::App* diff = app_.add_subcommand("diff", "compare the results of two runs, field by field");
    diff->add_option("a", diff_.a, "results of a run")->type_name(folder_value)->required();
    diff->add_option("b", diff_.b, "results of another run")->type_name(folder_value)->required();
    const auto tolerance = [&](const char* name, Real& value, const char* help) {
      return diff->add_option(name, value, help)->check(number_not_below_zero());
    };
    tolerance("--relative", diff_.relative, "allowed difference over the largest value of the field in both runs; default 0");
    tolerance("--absolute", diff_.absolute, "allowed difference, in the unit of each field, besides that; default 0");
    diff->add_option("--field", diff_.fields, "compare only these fields")->delimiter(',');
    diff->add_flag("--last", diff_.last, "compare only the last time that both runs have");
    diff->callback([this] { status_ = same_results(diff_) ? 0 : results_differ; });
  }

  void add_sweep()
  {
    CLI::App* sweep = app_.add_subcommand("sweep", "run a scene with several values of its keys, and put their results into a table");
    sweep->add_option("study", sweep_.study, "study (.yaml): scene, what varies, what is told")->type_name(scene_value)->required();
    sweep->add_option("--out", sweep_.out, "folder of cases and table; default runs/<name of the study>")->type_name(folder_value);
    CLI::Option* jobs =
        sweep->add_option("--jobs", sweep_.jobs, "cases at a time; default as many as there are cores for")->check(number_within(1, 1024));
    sweep->add_option("--threads", sweep_.threads, "threads of each; default the cores over the cases at a time")
        ->check(number_within(1, 1024));
    CLI::Option* only = sweep->add_option("--case", sweep_.only, "run this case alone, counted from 1: for the jobs of an array");
    only->check(number_above_zero())->excludes(jobs);
    sweep->add_option("--launcher", sweep_.launcher, "what each run is started by, such as \"mpirun -n 4\"");
    sweep->add_flag("--list", sweep_.list, "run nothing: tell the cases and how far they are, bring the table up to date")->excludes(only);
    sweep->add_flag("!--no-pictures", sweep_.pictures, "draw nothing");
    sweep->add_flag("--quick", sweep_.quick, "each case coarse and short: only to see that they run");
    sweep->add_flag("--quiet", sweep_.quiet, "no progress and no table");
    sweep->callback([this] { talus::sweep(sweep_); });
  }

  void add_fos()
  {
    CLI::App* fos =
        app_.add_subcommand("fos", "find the factor of safety of a scene: by how much its strength can be divided before it fails");
    fos->add_option("scene", fos_.scene, "scene file (.yaml) with a geostatic stage")->type_name(scene_value)->required();
    fos->add_option("--out", fos_.out, "folder of trials and table; default runs/<name of the scene>_fos")->type_name(folder_value);
    const auto number = [&](const char* name, auto& value, const char* help) {
      return fos->add_option(name, value, help)->check(number_above_zero());
    };
    number("--from", fos_.range.from, "lowest factor that is tried first; default 0.5");
    number("--to", fos_.range.to, "highest factor that is tried first; default 3");
    number("--width", fos_.range.width, "how close holding and failing factors come; default 0.02");
    number("--duration", fos_.duration, "of a trial [s]; default 3 sqrt(height / gravity), or 20 passes of waves if that is longer");
    fos->add_option("--damping", fos_.damping, "local damping of a trial; default 0.3")->check(number_within(0.0, 0.9));
    number("--growth", fos_.criterion.growth, "moved in the second half of a trial over the first half, above which it fails; default 0.1");
    number("--kinetic", fos_.criterion.liveliness, "kinetic energy at the end over its peak, above which it fails; default 5e-4");
    fos->add_option("--bodies", fos_.bodies, "whose strength is divided; default all that have some")->delimiter(',');
    fos->add_option("--share", fos_.mass_share, "displacement that this share of the mass does not exceed is looked at; default 0.99")
        ->check(number_within(0.0, 1.0));
    fos->add_option("--set", fos_.set, set_help);
    fos->add_option("--jobs", fos_.jobs, "trials at a time; default one a core, up to 4")->check(number_within(1, 1024));
    fos->add_option("--threads", fos_.threads, "threads of each; default the cores over the trials at a time")
        ->check(number_within(1, 1024));
    fos->add_option("--launcher", fos_.launcher, "what each run is started by, such as \"mpirun -n 4\"");
    fos->add_flag("!--no-pictures", fos_.pictures, "draw nothing");
    fos->add_flag("--quick", fos_.quick, "each run coarse and short: only to see that they run");
    fos->add_flag("--quiet", fos_.quiet, "only the factor");
    fos->callback([this] { find_fos(fos_); });
  }

  void add_suite(const std::string& name, const std::string& help, SuiteOptions& options)
  {
    const bool verify = name == "verify";
    options.suite = name;
    CLI::App* suite = app_.add_subcommand(name, help);
    CLI::Option* cases = suite->add_option("case", options.cases, verify ? "benchmarks; default all" : "benchmark");
    if (!verify)
      cases->required()->expected(1);
    suite->add_option("--level", options.level, "quick or full; default quick")->check(CLI::IsMember({"quick", "full"}));
    suite->add_option("--out", options.out, "folder for runs and report; default runs/" + name)->type_name(folder_value);
    suite->add_option("--jobs", options.jobs, "runs at a time; default one a core")->check(number_within(1, 1024));
    suite->add_option("--threads", options.threads, "threads of each run; default 1")->check(number_within(1, 1024));
    suite->add_flag("--reuse", options.reuse, "do not repeat runs whose program and inputs are unchanged");
    if (verify) {
      suite->add_option("--kernel", options.kernel, "kernel of every run that does not choose one itself");
      suite->add_option("--transfer", options.transfer, "transfer scheme of every run that does not choose one itself");
      suite->add_option("--precision", options.precision, "double or single, of every run that does not choose itself");
      suite->add_flag("--regression", options.regression, "status 1 only where something is worse than in the last release");
    }
    suite->callback([&options] { run_suite(options); });
  }

  void add_bench()
  {
    constexpr int most_particles = 100'000'000;
    CLI::App* bench = app_.add_subcommand("bench", "speed of whole steps");
    const auto list = [&](const char* name, auto& values, const char* help) {
      return bench->add_option(name, values, help)->delimiter(',');
    };
    list("--kernel", bench_.kernels, "kernels, such as projected,umls");
    list("--transfer", bench_.transfers, "transfer schemes");
    list("--law", bench_.laws, "constitutive laws");
    list("--precision", bench_.precisions, "double, single or both");
    list("--dimension", bench_.dimensions, "2, 3 or both")->check(number_within(2, 3));
    list("--threads", bench_.threads, "numbers of threads")->check(number_within(1, 1024));
    list("--per-cell", bench_.per_cell, "particles per cell; default 8 in 3-D, 4 in 2-D")->check(number_within(1, 100));
    CLI::Option* all = bench->add_flag("--all", bench_.all, "every kernel, transfer, law, precision, dimension: hours");
    CLI::Option* options =
        bench->add_flag("--options", bench_.options, "what averaged volumes, friction, viscosity, loads and histories cost")->excludes(all);
    CLI::Option* mpi = bench->add_flag("--mpi", bench_.ranks, "one case on the ranks of mpirun: what each holds, sends and waits for");
    mpi->excludes(all)->excludes(options);
    bench->add_option("--particles", bench_.particles, "about so many; default 1000000")->check(number_within(1000, most_particles));
    bench->add_option("--warm-up", bench_.warm_up, "steps before the first that counts; default 10")->check(number_within(1, most_steps));
    bench->add_option("--repeats", bench_.repeats, "of which the median counts; default 3")->check(number_within(1, 1000));
    bench->add_option("--steps", bench_.steps, "of each repeat; default 5")->check(number_within(1, most_steps));
    bench->add_option("--json", bench_.json, "write all of it to this file");
    bench->add_option("--from", bench_.from, "measure nothing, show such a file")->excludes(mpi);
    bench->add_option("--compare", bench_.compare, "print times over those of such a file")->excludes(mpi);
    bench->callback([this] { talus::bench(bench_); });
  }

  CLI::App app_;
  NewOptions new_;
  RunOptions run_;
  std::filesystem::path check_scene_;
  std::vector<std::string> check_set_;
  DriveOptions drive_;
  MeshOptions mesh_;
  RenderOptions render_;
  MapOptions map_;
  ReportOptions report_;
  WatchOptions watch_;
  SurfaceOptions surface_;
  DiffOptions diff_;
  SweepOptions sweep_;
  FosOptions fos_;
  SuiteOptions verify_, tradeoff_;
  BenchOptions bench_;
  std::vector<std::string> manual_words_;
  std::string shell_;
  bool schema_ = false;
  int status_ = 0;
};

}  // namespace

int cli(int argc, const char* const* argv) { return CommandLine().parse(argc, argv); }

}  // namespace talus
