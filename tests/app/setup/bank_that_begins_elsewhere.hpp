#pragma once
// A bank of soil that begins as another run left it, and what tests ask of such runs.
#include <gmock/gmock.h>

#include <algorithm>
#include <limits>
#include <tuple>

#include "io/checkpoint/array_file.hpp"
#include "io/output/vtk.hpp"
#include "tests/app/forged.hpp"
#include "tests/app/program.hpp"

namespace talus::initial_test {

namespace fs = std::filesystem;
using testing::HasSubstr;

inline const std::string soil =
    "law: drucker_prager, density: 2000, youngs_modulus: 2.0e6, poisson_ratio: 0.3, friction_angle: 15, cohesion: 500, "
    "match: plane_strain, residual_cohesion: 100, softening_strain: 0.05";
inline const std::string strong =
    "law: drucker_prager, density: 2000, youngs_modulus: 2.0e6, poisson_ratio: 0.3, friction_angle: 35, cohesion: 2.0e4, match: "
    "plane_strain";
inline const std::string at_rest = "stages: [{type: geostatic, duration: 20, initial_stress: {k0: 0.43}}]\n";
inline const std::string filled = "shape: {type: box, low: [0, 0], high: [1, 1]}, particles_per_cell: 3";

/// A bank of soil 1 m high, and the room that it fails into.  Every part may be replaced.
struct Bank {
  std::string mesh = "{grid: {low: [0, 0], high: [3, 1.5], cells: [12, 6]}}";
  std::string more = "";  ///< transfer, accuracy
  std::string material = soil;
  std::string bodies = "{name: bank, material: soil, " + filled + "}";
  std::string initial = "";
  std::string when = at_rest;
  std::string checkpoint = "";  ///< besides that at the end
  std::string text() const
  {
    return "title: Bank\ndimension: 2\nmesh: " + mesh + "\n" + more + "materials: [{name: soil, " + material + "}]\nbodies: [" + bodies +
           "]\n" + initial +
           "loads: [{type: gravity, acceleration: [0, -9.81]}]\n"
           "boundaries: [{type: fixed, on: y_min}, {type: roller, on: x_min}, {type: roller, on: x_max}]\n" +
           when + "outputs:\n  checkpoint: {at_end: true" + checkpoint + "}\n  particles: {every: 0.02}\n  history: {every: 0.004, " +
           "points: [{name: deep, at: [0.1, 0.1]}]}\n";
  }
};

/// Of the bank that began elsewhere.
inline Bank second(const std::string& more_of_initial = "", const std::string& from = "first")
{
  return {.bodies = "{name: bank, material: soil}",
          .initial = "initial: {from: " + from + more_of_initial + "}\n",
          .when = "time: {end: 0.05}\n"};
}

struct Row {
  Real deep_sxx, deep_syy, mass, kinetic, momentum_x, momentum_y, centre_x, centre_y;
};
inline Row row_of(const HistoryTable& table, std::size_t row)
{
  const auto value = [&](const char* column) { return (*table[column])[row]; };
  return {value("deep_sxx"),   value("deep_syy"),   value("mass"),     value("kinetic"),
          value("momentum_x"), value("momentum_y"), value("centre_x"), value("centre_y")};
}

class Initial : public Program {
 protected:
  Outcome run(const std::string& name, const Bank& bank, const std::string& words = "") const
  {
    write(name + ".yaml", bank.text());
    return talus("run " + name + ".yaml --quiet --out " + name + " " + words);
  }
  void run_well(const std::string& name, const Bank& bank, const std::string& words = "") const
  {
    const Outcome outcome = run(name, bank, words);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(without_losses(outcome.err), "");
  }
  Row first_row(const std::string& name) const { return row_of(history(name), 0); }
  Row last_row(const std::string& name) const
  {
    const HistoryTable table = history(name);
    return row_of(table, table.rows() - 1);
  }
  /// Of a summary, without blanks: from one word up to another.
  std::string part(const std::string& run, const std::string& from, const std::string& to) const
  {
    std::string text = read(run + "/summary.json");
    text.erase(std::remove_if(text.begin(), text.end(), [](char c) { return c == ' ' || c == '\n'; }), text.end());
    const auto begin = text.find(from);
    return begin == text.npos ? "" : text.substr(begin, text.find(to, begin) - begin);
  }
  std::string origin(const std::string& run) const { return part(run, "\"initial\":", ",\"stages\""); }
  /// Checkpoints of a run, the oldest first.
  std::vector<fs::path> checkpoints(const std::string& run) const
  {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder_ / (run + "/checkpoints")))
      files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
  }
  /// What `talus check` says against a bank that begins as `first` ended.
  std::string refusal(const Bank& bank) const
  {
    write("refused.yaml", bank.text());
    const Outcome outcome = talus("check refused.yaml");
    EXPECT_EQ(outcome.code, 2) << outcome.out;
    return outcome.err;
  }
};

/// A column of the particles in the order of their ids.
inline std::vector<Real> by_id(const fs::path& checkpoint, const std::string& path, int columns)
{
  const ArrayReader file(checkpoint);
  const auto id = file.read<std::int64_t>("particles/id");
  const auto values = file.read<Real>(path, columns);
  const auto width = static_cast<std::size_t>(columns);
  std::vector<Real> sorted(values.size());
  for (std::size_t row = 0; row < id.size(); ++row)
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(row * width), width,
                sorted.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(id[row]) * width));
  return sorted;
}

}  // namespace talus::initial_test
