#pragma once
// Runs the program as a user does, in a folder that is gone afterwards.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>

#include "io/files/atomic_file.hpp"
#include "io/output/csv.hpp"
#include "tests/io/scratch_folder.hpp"

namespace talus {

struct Outcome {
  int code;
  std::string out, err;
};

/// What starts the program on so many ranks.  Open MPI refuses root and more ranks than cores, unless told.  Ranks that wait leave the core to
/// others: on as many cores as ranks they would not, unless told, and two ranks beside another test take ten times as long.
inline std::string launcher_of(int ranks)
{
  return "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_mpi_yield_when_idle=1 '" TALUS_MPIEXEC "' -n " +
         std::to_string(ranks) + " --oversubscribe --bind-to none";
}

class Program : public testing::Test {
 protected:
  ScratchFolder folder_;

  /// `talus words` in the scratch folder, started by `launcher`.
  Outcome talus(const std::string& words, const std::string& launcher = "") const
  {
    const std::string command =
        "cd '" + folder_.path().string() + "' && " + launcher + " '" TALUS_BINARY "' " + words + " >out.txt 2>err.txt";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_whole(folder_ / "out.txt"), read_whole(folder_ / "err.txt")};
  }
  void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }
  std::string read(const std::string& name) const { return read_whole(folder_ / name); }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }
  HistoryTable history(const std::string& run) const { return read_history(folder_ / (run + "/history.csv")); }
};

/// First and last value of a column; NaN if there is none, so that every comparison fails.
inline Real first(const HistoryTable& table, std::string_view column)
{
  const auto values = table[column];
  return values ? values->front() : std::numeric_limits<Real>::quiet_NaN();
}
inline Real last(const HistoryTable& table, std::string_view column)
{
  const auto values = table[column];
  return values ? values->back() : std::numeric_limits<Real>::quiet_NaN();
}

/// What a run said on stderr, without the warnings about what particles and nodes lost between them, of which runs with the few cells of a
/// test lose much: see failed_accounts_test.cpp for these.  Balances have to close.
inline std::string without_losses(const std::string& err)
{
  return std::regex_replace(err, std::regex("warning: particles and nodes lost[^\n]*\n"), "");
}

/// An elastic block of 1 x 1 m in a box of 2 x 2 m; `rest` adds loads, boundaries and so on.
inline std::string block_scene(const std::string& rest, const std::string& velocity = "")
{
  return R"yaml(title: Block
dimension: 2
mesh: {grid: {low: [0, 0], high: [2, 2], cells: [8, 8]}}
materials: [{name: rubber, law: neo_hookean, density: 1000, youngs_modulus: 1.0e5, poisson_ratio: 0.3}]
bodies:
  - {name: block, material: rubber, shape: {type: box, low: [0.5, 0], high: [1.5, 1]}, particles_per_cell: 3)yaml" +
         velocity + "}\n" + rest;
}

}  // namespace talus
