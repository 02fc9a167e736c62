#pragma once
// What each word after `talus` does.  The command line itself is read in cli.cpp.
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/fos_search.hpp"

namespace talus {

struct NewOptions {
  std::optional<std::string> from;  ///< name of a template, or its file
  std::optional<std::filesystem::path> out;
  std::vector<std::string> set;  ///< name=value of questions; then nothing is asked
  bool list = false, force = false;
};
/// Writes a scene from a template and answers.  SceneErrors, Error: an answer or the template is wrong; the file is there already.
void new_scene(const NewOptions& options);

struct RunOptions {
  std::filesystem::path scene;
  std::optional<std::filesystem::path> out;
  std::optional<std::filesystem::path> resume;  ///< a checkpoint, or the folder of a run, instead of the scene
  std::optional<std::int64_t> until;            ///< stop before the step after this one, with a checkpoint
  std::optional<int> threads;
  std::optional<std::int64_t> rebalance;  ///< ranks share the run out anew every so many steps; 0: never; default: when it pays
  std::vector<std::string> set;
  bool quick = false, quiet = false;
  bool strict = false;  ///< as the scene's key of this name
  bool dry = false;     ///< only tell what the run would cost
  bool force = false;   ///< replace a run that could go on
};
/// Runs a scene, or goes on with one, and leaves its results in a folder.  SceneErrors, RunError, EnvironmentError; Stopped by a signal or
/// where it was to stop.
void run_scene(const RunOptions& options);

/// Makes a few steps, writes nothing, says what the run would cost in memory, files and time.  SceneErrors, RunError.
void dry_run(const RunOptions& options);

/// Does everything but run, writes nothing, says what a run would cost.
void check_scene(const std::filesystem::path& scene, const std::vector<std::string>& set);

struct MeshOptions {
  std::filesystem::path file;  ///< a scene, a .msh, or a geometry
  std::vector<std::string> set;
  std::optional<Real> size;      ///< edge length for a geometry [m]
  std::optional<int> dimension;  ///< of a file; default: that of its largest cells
  std::optional<std::filesystem::path> out;
};
/// Statistics and groups of a mesh; writes it if asked to.
void show_mesh(const MeshOptions& options);

struct DriveOptions {
  std::filesystem::path file;  ///< of a material and paths; with `test`, a scene
  std::vector<std::string> set;
  std::optional<std::filesystem::path> out, plot;
  std::optional<std::string> test, material;  ///< standard test, on this material of the scene
  std::optional<Real> pressure, strain, rate;
  std::optional<Index> steps;
};
/// Drives the law of a file along its paths; CSV to `out`, or to standard output.
/// With a test: runs it on a material of a scene, prints strengths beside closed forms; CSV to `out` and a picture to `plot` if asked to
/// (a picture leaves the CSV it was drawn from beside it).
void drive_law(const DriveOptions& options);

struct MovieOptions {
  std::optional<std::filesystem::path> movie;  ///< a .mp4 or .gif of all pictures
  Real per_second = 10;                        ///< pictures of the movie
  bool keep_frames = false;
};

struct RenderOptions : MovieOptions {
  std::filesystem::path folder;
  std::vector<std::string> words;  ///< render::picture_options and what follows them
};
/// Draws the results in a folder; what is not asked for is as the scene says.  Error with all that is wrong with the words, before anything is
/// drawn; EnvironmentError.
void render_results(const RenderOptions& options);

struct MapOptions : MovieOptions {
  std::filesystem::path folder;
  std::vector<std::string> words;  ///< render::map_options and what follows them
};
/// Draws the maps and sections of a run with outputs.runout.  Errors as above.
void draw_maps(const MapOptions& options);

struct ReportOptions {
  std::filesystem::path folder;
  std::optional<std::filesystem::path> out;   ///< default DIR/report.html
  std::optional<std::filesystem::path> page;  ///< template; default the one beside the program
  std::vector<std::string> fields;            ///< empty: that of the pictures, then all that were written
  std::optional<int> frames;                  ///< so many
  std::optional<Real> size;                   ///< of the page at most [MB]
};
/// Makes one page for the browser of what is in the folder of a run, ended or not, and says what it leaves out.  Error: there is no run, or
/// what was asked for; EnvironmentError.
void write_report(const ReportOptions& options);

struct WatchOptions {
  std::filesystem::path folder;
  Real interval = 2;  ///< s
  int port = 0;       ///< 0: any that is free
  bool serve = true, once = false;
  std::optional<std::filesystem::path> page;  ///< template, as above
};
/// Follows a run in the terminal until it ends, and serves its page to browsers on this machine.  Returns what the run returns: 0 done (or,
/// with `once`, at work), 1 failed, 4 stopped.  Errors as above.
int watch_run(const WatchOptions& options);
struct SurfaceOptions {
  std::filesystem::path folder;
  std::optional<std::string> body;  ///< its name; default all of them
  std::vector<std::string> words;   ///< render::surface_options and what follows them
};
/// Writes the surfaces of bodies and prints how much they enclose.  Errors as above.
void extract_surface(const SurfaceOptions& options);

struct DiffOptions {
  std::filesystem::path a, b;       ///< folders of two runs
  Real relative = 0, absolute = 0;  ///< values differ where |a - b| > absolute + relative * largest value of their field
  std::vector<std::string> fields;  ///< empty: all
  bool last = false;                ///< only the last time that both have
};
/// Compares the results in two folders and prints a table; whether they are the same.  Error for what cannot be read, and for words that
/// mean nothing: a status of 1 says that results differ.
bool same_results(const DiffOptions& options);

struct SuiteOptions {
  std::string suite;  ///< verify or tradeoff
  std::vector<std::string> cases;
  std::optional<std::string> level, kernel, transfer, precision;
  std::optional<std::filesystem::path> out;
  std::optional<int> jobs, threads;
  bool reuse = false, regression = false;
};
/// Replaces this process by the suite of benchmarks/, which runs this program.  EnvironmentError.
[[noreturn]] void run_suite(const SuiteOptions& options);

struct SweepOptions {
  std::filesystem::path study;
  std::optional<std::filesystem::path> out;
  std::optional<int> jobs, threads;     ///< runs at a time; threads of each
  std::optional<int> only;              ///< number of the one case to run
  std::optional<std::string> launcher;  ///< words before the program, such as "mpirun -n 4"
  bool list = false;                    ///< run nothing
  bool quick = false, quiet = false, pictures = true;
};
/// Runs the cases of a study that are not done yet, each as a process of its own in a folder of its own, and keeps a table of them.  SceneErrors
/// with all that is wrong with any case, before anything runs; RunError if some failed; Stopped by a signal, or because cases were; EnvironmentError.
void sweep(const SweepOptions& options);

struct FosOptions {
  std::filesystem::path scene;
  std::vector<std::string> set;
  std::optional<std::filesystem::path> out;
  FosRange range;
  FosCriterion criterion;
  std::optional<Real> duration;     ///< of a trial [s]
  Real damping = 0.3;               ///< of a trial, as stages have it
  Real mass_share = 0.99;           ///< whose displacement counts, as outputs.history.moved has it
  std::vector<std::string> bodies;  ///< whose strength is divided; empty: of all that have some
  std::optional<int> jobs, threads;
  std::optional<std::string> launcher;
  bool quick = false, quiet = false, pictures = true;
};
/// Finds the factor by which the strength of bodies can be divided before they fail: runs the scene until it is at rest, then trials from there, and
/// leaves fos.csv, fos.json and pictures.  SceneErrors, RunError, Stopped, EnvironmentError as above.
void find_fos(const FosOptions& options);

struct BenchOptions {
  std::vector<std::string> kernels, transfers, laws, precisions;
  std::vector<int> dimensions, threads, per_cell;
  bool all = false;      ///< the whole product
  bool options = false;  ///< what one case costs with each option of a scene
  bool ranks = false;    ///< one case on the ranks that this process is one of
  Index particles = 1'000'000;
  int warm_up = 10, repeats = 3, steps = 5;
  std::optional<std::filesystem::path> json, from, compare;
};
/// Measures the speed of whole steps and prints a table; with `from` shows what a file has.  SceneErrors for words and files that mean
/// nothing.
void bench(const BenchOptions& options);

/// Every key of a scene: Markdown, or JSON Schema; or what these words mean.  Error: nothing.
void print_manual(bool schema, const std::vector<std::string>& words);
void print_info();

}  // namespace talus
