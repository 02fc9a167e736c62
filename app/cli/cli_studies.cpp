// Commands that make many runs.
#include "app/cli/cli_checks.hpp"
#include "app/cli/cli_commands.hpp"
#include "app/cli/cli_python.hpp"

namespace talus {

void StudyCommands::add_sweep(CLI::App& app)
{
  CLI::App* sweep = app.add_subcommand("sweep", "run a scene with several values of its keys, and put their results into a table");
  const OptionsOfPython words(*sweep, sweep_);
  words.add_file("study", "study (.yaml): scene, what varies, what the table collects")->type_name(scene_value);
  words.add("--out", "folder of cases and table; default runs/<name of the study>")->type_name(folder_value);
  CLI::Option* jobs = words.add("--jobs", "cases at a time; default as many as there are cores for")->check(number_within(1, 1024));
  words.add("--threads", "threads of each; default the cores over the cases at a time")->check(number_within(1, 1024));
  CLI::Option* only = words.add("--case", "run this case alone, counted from 1: for the jobs of an array");
  only->check(number_above_zero())->excludes(jobs);
  words.add("--launcher", "what each run is started by, such as \"mpirun -n 4\"");
  words.add_flag("--list", "run nothing: tell the cases and how far they are, bring the table up to date")->excludes(only);
  words.add_flag("--no-pictures", "draw nothing");
  words.add_flag("--quick", "each case coarse and short: only to see that they run");
  words.add_flag("--quiet", "no progress and no table");
  sweep->callback([this] { run_in_package(sweep_); });
}

void StudyCommands::add_converge(CLI::App& app)
{
  constexpr int most_levels = 8;
  CLI::App* converge =
      app.add_subcommand("converge", "run a scene with cells of several sizes: order of convergence and uncertainty of its results");
  const OptionsOfPython words(*converge, converge_);
  words.add_file("scene", "scene file (.yaml) whose mesh Talus makes")->type_name(scene_value);
  words.add("--out", "folder of levels and table; default runs/<name of the scene>_convergence")->type_name(folder_value);
  words.add("--ratio", "size of cells over that of the next finer level; default sqrt(2)")->check(number_within(1.2, 4.0));
  words.add("--levels", "how many; default 3")->check(number_within(3, most_levels));
  words.add("--finer", "how many of them have smaller cells than the scene; default 0: its cells and larger ones")
      ->check(number_within(0, most_levels - 1));
  CLI::Option* collect = words.add_list("--collect", "numbers, such as toe or max(kinetic); default all physical results")->delimiter(',');
  words.add("--within", "status 1 unless each of --collect is within this share, such as 0.05")->check(number_above_zero())->needs(collect);
  words.add_list("--set", set_help);
  words.add("--jobs", "levels at a time; default 1, as the finest takes most of the time")->check(number_within(1, 1024));
  words.add("--threads", "threads of each; default as for a run, with --jobs the cores over that")->check(number_within(1, 1024));
  words.add("--launcher", "what each run is started by, such as \"mpirun -n 4\"");
  words.add_flag("--list", "run nothing: tell the levels and how far they are");
  words.add_flag("--json", "print convergence.json and nothing else");
  words.add_flag("--quick", "each level coarse and short: only to see that they run");
  words.add_flag("--quiet", "no progress and no table");
  converge->callback([this] { run_in_package(converge_); });
}

void StudyCommands::add_fos(CLI::App& app)
{
  CLI::App* fos =
      app.add_subcommand("fos", "find the factor of safety of a scene: by how much its strength can be divided before it fails");
  const OptionsOfPython words(*fos, fos_);
  words.add_file("scene", "scene file (.yaml) with a geostatic or static stage")->type_name(scene_value);
  words.add("--out", "folder of trials and table; default runs/<name of the scene>_fos")->type_name(folder_value);
  const auto number = [&](const char* name, const char* help) { words.add(name, help)->check(number_above_zero()); };
  number("--from", "lowest factor that is tried first; default 0.5");
  number("--to", "highest factor that is tried first; default 3");
  number("--width", "how close holding and failing factors come; default 0.02");
  words.add("--trials", "runs with inertia, or static equilibria; default as the stage that finds the state at rest")
      ->type_name(one_of({"run", "static"}))
      ->check(CLI::IsMember({"run", "static"}));
  words.add("--increments", "of a static trial; default 6")->check(number_within(2, 1000));
  number("--duration", "of a run [s]; default 3 sqrt(height / gravity), or 20 passes of waves if that is longer");
  words.add("--damping", "local damping of a run; default 0.3")->check(number_within(0.0, 0.9));
  number("--growth", "moved in the second half of a trial over the first half, above which it fails; default 0.1");
  number("--kinetic", "of a run: kinetic energy at the end over its peak, above which it fails; default 5e-4");
  number("--steadiness", "of a static trial: moved in its last third over the middle third, above which it fails; default 0.5");
  words.add_list("--bodies", "whose strength is divided; default all that have some")->delimiter(',');
  words.add("--share", "displacement that this share of the mass does not exceed is looked at; default 0.99")
      ->check(number_within(0.0, 1.0));
  words.add_list("--set", set_help);
  words.add("--jobs", "trials at a time; default one a core, up to 4")->check(number_within(1, 1024));
  words.add("--threads", "threads of each; default the cores over the trials at a time")->check(number_within(1, 1024));
  words.add("--launcher", "what each run is started by, such as \"mpirun -n 4\"");
  words.add_flag("--no-pictures", "draw nothing");
  words.add_flag("--quick", "each run coarse and short: only to see that they run");
  words.add_flag("--quiet", "only the factor");
  fos->callback([this] { run_in_package(fos_); });
}

void StudyCommands::add_calibrate(CLI::App& app)
{
  CLI::App* calibrate = app.add_subcommand("calibrate", "find parameters of a scene from observations, with their uncertainty");
  const OptionsOfPython words(*calibrate, calibrate_);
  words.add_file("specification", "file (.yaml) that names scene, parameters and observations")->type_name(scene_value);
  words.add("--out", "folder of runs and results; default runs/<name of the file>")->type_name(folder_value);
  words.add("--jobs", "runs at a time; default 1")->check(number_within(1, 1024));
  words.add("--threads", "threads of each; default as for a run, with --jobs the cores over that")->check(number_within(1, 1024));
  words.add("--launcher", "what each run is started by, such as \"mpirun -n 4\"");
  words.add_flag("--no-pictures", "draw nothing");
  words.add_flag("--quiet", "only the results");
  calibrate->callback([this] { run_in_package(calibrate_); });
}

void StudyCommands::add_suite(CLI::App& app, const std::string& name, const std::string& help, SuiteOptions& options)
{
  const bool verify = name == "verify";
  options.suite = name;
  CLI::App* suite = app.add_subcommand(name, help);
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
    suite->add_flag("--regression", options.regression, "status 1 only where something is worse than in the last release");
  }
  suite->callback([&options] { run_suite(options); });
}

void StudyCommands::add_bench(CLI::App& app)
{
  constexpr int most_particles = 100'000'000;
  CLI::App* bench = app.add_subcommand("bench", "speed of whole steps");
  const auto list = [&](const char* name, auto& values, const char* help) { return bench->add_option(name, values, help)->delimiter(','); };
  list("--kernel", bench_.kernels, "kernels, such as projected,umls");
  list("--transfer", bench_.transfers, "transfer schemes");
  list("--law", bench_.laws, "constitutive laws");
  list("--dimension", bench_.dimensions, "2, 3 or both")->check(number_within(2, 3));
  list("--threads", bench_.threads, "numbers of threads")->check(number_within(1, 1024));
  list("--per-cell", bench_.per_cell, "particles per cell; default 8 in 3-D, 4 in 2-D")->check(number_within(1, 100));
  CLI::Option* all = bench->add_flag("--all", bench_.all, "every kernel, transfer, law, dimension: hours");
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

void StudyCommands::add_to(CLI::App& app)
{
  add_sweep(app);
  add_converge(app);
  add_fos(app);
  add_calibrate(app);
  add_suite(app, "verify", "run the benchmarks against their references; write verify.json and a report", verify_);
  add_suite(app, "tradeoff", "sweep a benchmark: error over processor time and memory, and what to choose", tradeoff_);
  add_bench(app);
}

}  // namespace talus
