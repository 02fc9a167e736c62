#pragma once
// The commands of talus in groups, with their options; each group lives as long as the parse.
#include <CLI/CLI.hpp>

#include "app/commands/bench/bench_command.hpp"
#include "app/commands/check_command.hpp"
#include "app/commands/drive_command.hpp"
#include "app/commands/mesh_command.hpp"
#include "app/commands/new/new_command.hpp"
#include "app/commands/package_command.hpp"
#include "app/commands/pictures/picture_commands.hpp"
#include "app/commands/report/report.hpp"
#include "app/commands/run_command.hpp"
#include "app/commands/suite_command.hpp"
#include "app/commands/watch/watch_command.hpp"

namespace talus {

/// The commands for scenes: new, run, check, mesh, drive.
class SceneCommands {
 public:
  void add_to(CLI::App& app);

 private:
  void add_new(CLI::App& app);
  void add_run(CLI::App& app);
  void add_check(CLI::App& app);
  void add_mesh(CLI::App& app);
  void add_drive(CLI::App& app);

  NewOptions new_;
  RunOptions run_;
  std::filesystem::path check_scene_;
  std::vector<std::string> check_set_;
  std::optional<std::filesystem::path> variants_;
  bool check_json_ = false, check_keys_ = false;
  DriveOptions drive_;
  MeshOptions mesh_;
};

/// The commands for results: map, render, report, watch, surface, diff.
class ResultCommands {
 public:
  void add_to(CLI::App& app);
  /// The exit code of the command, if it has one of its own.
  int status() const noexcept { return status_; }

 private:
  void add_map(CLI::App& app);
  void add_render(CLI::App& app);
  void add_report(CLI::App& app);
  void add_watch(CLI::App& app);
  void add_surface(CLI::App& app);
  void add_diff(CLI::App& app);

  RenderOptions render_;
  MapOptions map_;
  ReportOptions report_;
  WatchOptions watch_;
  SurfaceOptions surface_;
  PackageCommand diff_{.name = "diff", .words = {}, .starts_runs = false};
  int status_ = 0;
};

/// The commands with many runs: sweep, converge, fos, calibrate, verify, tradeoff, bench.
class StudyCommands {
 public:
  void add_to(CLI::App& app);

 private:
  void add_sweep(CLI::App& app);
  void add_converge(CLI::App& app);
  void add_fos(CLI::App& app);
  void add_calibrate(CLI::App& app);
  void add_suite(CLI::App& app, const std::string& name, const std::string& help, SuiteOptions& options);
  void add_bench(CLI::App& app);

  PackageCommand sweep_{.name = "sweep", .words = {}}, converge_{.name = "converge", .words = {}}, fos_{.name = "fos", .words = {}},
      calibrate_{.name = "calibrate", .words = {}};
  SuiteOptions verify_, tradeoff_;
  BenchOptions bench_;
};

}  // namespace talus
