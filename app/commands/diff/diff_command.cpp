// talus diff
#include "app/commands/diff/diff_command.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "app/commands/diff/compare_runs.hpp"
#include "app/observers/results.hpp"
#include "core/error.hpp"
#include "core/word_match.hpp"
#include "io/files/atomic_file.hpp"
#include "io/output/summary_json.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

/// The entries of a line of the printed table.
using Cells = std::array<std::string, 6>;

Cells cells_of(const FieldLine& line)
{
  const std::string unit = line.shape[0] ? line.shape[0]->unit : line.shape[1]->unit;
  if (!line.obstacle.empty())
    return {"  " + line.name, unit, "-", "-", line.obstacle, "-"};
  const Gap& gap = line.gap;
  const std::string largest = gap.values == 0 ? "-" : fmt::format("{:.3g}", gap.largest);
  const std::string over_scale = gap.values == 0 ? "-" : fmt::format("{:.3g}", gap.largest == 0 ? 0 : gap.largest / line.scale);
  return {"  " + line.name,
          unit,
          largest,
          over_scale,
          line.where.empty() ? "-" : line.where,
          fmt::format("{} of {}", gap.differing, gap.values)};
}

void print_table(const FieldTable& table)
{
  std::vector<Cells> rows{{table.title, "unit", "largest difference", "over scale", "where", "values that differ"}};
  for (const FieldLine& line : table.lines)
    rows.push_back(cells_of(line));
  std::array<std::size_t, 6> width{};
  for (const Cells& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c)
      width[c] = std::max(width[c], row[c].size());
  for (const Cells& row : rows)
    fmt::print("{:<{}}  {:<{}}  {:>{}}  {:>{}}  {:<{}}  {:>{}}\n", row[0], width[0], row[1], width[1], row[2], width[2], row[3], width[3],
               row[4], width[4], row[5], width[5]);
  fmt::print("  {} time{} compared\n", table.times, table.times == 1 ? "" : "s");
  for (const std::string& words : table.one_sided)
    fmt::print("  {}\n", words);
}

/// Prints scene and program of the runs, which do not count as differences.
void print_origins(const RunFolders& folders)
{
  std::vector<std::string> same, other;
  for (const char* name : {"scene.yaml", "mesh.msh"}) {
    const bool in_a = is_there(folders[0] / name), in_b = is_there(folders[1] / name);
    if (in_a != in_b)
      other.push_back(fmt::format("{} (only in {})", name, folders[in_a ? 0 : 1].string()));
    else if (in_a)
      (read_whole(folders[0] / name) == read_whole(folders[1] / name) ? same : other).emplace_back(name);
  }
  const RunOrigin a = read_origin(folders[0] / "summary.json"), b = read_origin(folders[1] / "summary.json");
  using Member = std::string RunOrigin::*;
  for (const auto& [name, member] : {std::pair<const char*, Member>{"status", &RunOrigin::status},
                                     {"version", &RunOrigin::version},
                                     {"commit", &RunOrigin::commit},
                                     {"compiler", &RunOrigin::compiler},
                                     {"flags", &RunOrigin::build},
                                     {"kernel", &RunOrigin::kernel},
                                     {"transfer", &RunOrigin::transfer},
                                     {"threads", &RunOrigin::threads}}) {
    if (a.*member == b.*member)
      same.emplace_back(name);
    else
      other.push_back(fmt::format("{} ({} and {})", name, a.*member, b.*member));
  }
  if (!same.empty())
    fmt::print("made with the same {}\n", fmt::join(same, ", "));
  if (!other.empty())
    fmt::print("made with other {}\n", fmt::join(other, ", "));
}

/// Throws unless each requested field exists in at least one run.
void check_names(const std::vector<FieldTable>& tables, const RunFolders& folders, const DiffOptions& options)
{
  std::vector<std::string> known;
  for (const FieldTable& table : tables)
    for (const std::string& name : table.names)
      if (std::find(known.begin(), known.end(), name) == known.end())
        known.push_back(name);
  if (known.empty())
    throw Error(fmt::format("{} and {} hold nothing to compare: no particles.pvd, no mesh.pvd, no history.csv", folders[0].string(),
                            folders[1].string()));
  for (const std::string& name : options.fields)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw Error(
          fmt::format("neither {} nor {} has a field \"{}\"{}", folders[0].string(), folders[1].string(), name, suggestion(name, known)));
}

bool print_all(const std::vector<FieldTable>& tables, const RunFolders& folders)
{
  std::size_t fields = 0, differing = 0, one_sided = 0;
  for (const FieldTable& table : tables) {
    if (table.lines.empty())
      continue;
    print_table(table);
    fmt::print("\n");
    fields += table.lines.size();
    one_sided += table.one_sided.size();
    for (const FieldLine& line : table.lines)
      differing += line.differs() ? 1 : 0;
  }
  print_origins(folders);
  const bool same = differing == 0 && one_sided == 0;
  if (same)
    fmt::print("the same\n");
  else
    fmt::print("{} of {} fields differ{}\n", differing, fields, one_sided > 0 ? "; not all is in both runs" : "");
  return same;
}

}  // namespace

bool same_results(const DiffOptions& options)
try {
  const RunFolders folders{options.a, options.b};
  for (const fs::path& folder : folders)
    require_run(folder);
  const std::vector<FieldTable> tables = compare_all(folders, options);
  check_names(tables, folders, options);
  return print_all(tables, folders);
} catch (const EnvironmentError& e) {
  throw Error(e.what());
}

}  // namespace talus
