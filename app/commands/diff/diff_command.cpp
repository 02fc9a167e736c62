// talus diff
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "app/commands/diff/diff_command.hpp"
#include "app/commands/diff/differences.hpp"
#include "app/observers/results.hpp"
#include "core/error.hpp"
#include "core/field_component.hpp"
#include "core/word_match.hpp"
#include "io/files/atomic_file.hpp"
#include "io/output/csv.hpp"
#include "io/output/origin_json.hpp"
#include "io/output/vtk.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

using RunFolders = std::array<fs::path, 2>;

/// Unit and number of components of a field in one of the runs.
struct FieldShape {
  std::string unit;
  int components = 1;
  friend bool operator==(const FieldShape&, const FieldShape&) = default;
};

/// One line of the table.
struct FieldLine {
  std::string name;
  std::array<std::optional<FieldShape>, 2> shape;  ///< nothing where the run does not have the field
  Real scale = 0;                                  ///< largest value in both runs at all times
  Gap gap = {};
  std::string where = {};     ///< the largest difference
  std::string obstacle = {};  ///< why values could not be compared; they count as different

  bool differs() const noexcept { return !obstacle.empty() || gap.differing > 0; }
};

/// Particles, nodes, cells or rows of the history of both runs.
struct FieldTable {
  std::string title, item;                  ///< what the items are called, many and one
  std::vector<std::string> names = {};      ///< of all fields, in the order of the files
  std::vector<FieldLine> lines = {};        ///< of those that are asked for
  std::size_t times = 0;                    ///< compared
  std::vector<std::string> one_sided = {};  ///< times and items that only one run has, in words
};

/// What one file holds of one table.
struct Snapshot {
  std::optional<std::vector<std::int64_t>> ids;  ///< nothing for items that are numbered
  std::vector<StoredField> fields;
};

bool is_there(const fs::path& file)
{
  std::error_code ignored;  // what cannot be looked at is not there for us
  return fs::exists(file, ignored);
}

const StoredField* find_field(const std::vector<StoredField>& fields, const std::string& name)
{
  const auto found = std::find_if(fields.begin(), fields.end(), [&](const StoredField& field) { return field.name == name; });
  return found == fields.end() ? nullptr : &*found;
}

/// Row i beside row i.
std::vector<std::pair<std::size_t, std::size_t>> side_by_side(std::size_t rows)
{
  std::vector<std::pair<std::size_t, std::size_t>> pairs(rows);
  for (std::size_t i = 0; i < rows; ++i)
    pairs[i] = {i, i};
  return pairs;
}

FieldLine& line_of(FieldTable& table, const std::string& name)
{
  const auto found = std::find_if(table.lines.begin(), table.lines.end(), [&](const FieldLine& line) { return line.name == name; });
  if (found != table.lines.end())
    return *found;
  table.lines.push_back({name, {}});
  return table.lines.back();
}

/// Takes note of a field of run `r` before anything is compared: the tolerance needs the largest value of all.
void note_field(FieldTable& table, std::size_t r, const std::string& name, const FieldShape& shape, std::span<const Real> values)
{
  FieldLine& line = line_of(table, name);
  line.scale = std::max(line.scale, largest_modulus(values));
  if (!line.shape[r])
    line.shape[r] = shape;
}

/// Keeps the lines that are asked for, and says what keeps them from being compared at all.
void choose_lines(FieldTable& table, const RunFolders& folders, const DiffOptions& options)
{
  for (const FieldLine& line : table.lines)
    table.names.push_back(line.name);
  std::erase_if(table.lines, [&](const FieldLine& line) {
    return !options.fields.empty() && std::find(options.fields.begin(), options.fields.end(), line.name) == options.fields.end();
  });
  for (FieldLine& line : table.lines) {
    const auto& [a, b] = line.shape;
    if (!a || !b)
      line.obstacle = fmt::format("only in {}", folders[a ? 0 : 1].string());
    else if (a->components != b->components)
      line.obstacle = fmt::format("{} and {} components", a->components, b->components);
    else if (a->unit != b->unit)
      line.obstacle = fmt::format("in [{}] and in [{}]", a->unit, b->unit);
  }
}

/// Behind a comma; nothing for a scalar.
std::string component_name(int component, int components)
{
  if (components == 1)
    return "";
  const auto names = component_names(components);
  return names.empty() ? fmt::format(", component {}", component) : ", " + names[static_cast<std::size_t>(component)];
}

/// Adds what was found in one pair of files; `where` is asked only for a new largest difference.
template <class Where>
void add_gap(FieldLine& line, const Gap& gap, Where&& where)
{
  const Gap before = line.gap;
  if (gap.largest > before.largest) {
    line.where = where() + component_name(gap.component, line.shape[0]->components);
    if (std::isinf(gap.largest))
      line.where += fmt::format(": {:.6g} and {:.6g}", gap.a, gap.b);
    line.gap = gap;
  }
  line.gap.values = before.values + gap.values;
  line.gap.differing = before.differing + gap.differing;
}

Real tolerance_of(const FieldLine& line, const DiffOptions& options) { return options.absolute + options.relative * line.scale; }

/// Times must ascend for two lists of them to be laid side by side.
void check_ascending(std::span<const Real> times, const fs::path& file)
{
  for (std::size_t i = 0; i < times.size(); ++i)
    if (!std::isfinite(times[i]) || (i > 0 && !(times[i] > times[i - 1])))
      throw Error(fmt::format("{}: its times do not ascend: entry {} is {} s", file.string(), i + 1, times[i]));
}

/// Times that are compared, and in words what only one run has.
struct CommonTimes {
  std::vector<std::pair<std::size_t, std::size_t>> both;
  std::vector<std::string> one_sided = {};
};

CommonTimes common_times(const std::array<std::vector<Real>, 2>& times, const RunFolders& folders, bool last)
{
  const Pairs pairs = match_times(times[0], times[1]);
  CommonTimes common{pairs.both};
  if (times[0].empty() != times[1].empty()) {
    common.one_sided.push_back(fmt::format("only in {}", folders[times[0].empty() ? 1 : 0].string()));
    return common;
  }
  if (pairs.both.empty() && !times[0].empty())
    common.one_sided.emplace_back("there is no time that both have");
  if (last && !pairs.both.empty())
    common.both = {pairs.both.back()};
  for (const std::size_t r : {0, 1})
    if (const auto& alone = r == 0 ? pairs.only_a : pairs.only_b; !last && !alone.empty())
      common.one_sided.push_back(fmt::format("only in {}: {} time{}, the first t = {} s", folders[r].string(), alone.size(),
                                             alone.size() == 1 ? "" : "s", times[r][alone.front()]));
  return common;
}

/// Particles that only one run has, at all times together.
struct LoneItems {
  std::size_t times = 0;
  std::string first = {};  ///< in words

  void add(const std::vector<std::int64_t>& ids, const std::vector<std::size_t>& rows, Real time)
  {
    constexpr std::size_t shown = 5;
    if (rows.empty() || ++times > 1)
      return;
    std::vector<std::int64_t> some;
    for (const std::size_t row : std::span(rows).first(std::min(shown, rows.size())))
      some.push_back(ids[row]);
    first = fmt::format("particle{} {}{} at t = {:.6g} s", rows.size() == 1 ? "" : "s", fmt::join(some, ", "),
                        rows.size() > shown ? fmt::format(" and {} more", rows.size() - shown) : "", time);
  }
};

/// Compares one pair of files.
void compare_snapshots(FieldTable& table, const Snapshot& a, const Snapshot& b, Real time, const DiffOptions& options,
                       std::array<LoneItems, 2>& lone)
{
  const bool by_id = a.ids.has_value() && b.ids.has_value();
  Pairs pairs;
  if (by_id) {
    pairs = match_ids(*a.ids, *b.ids);
    lone[0].add(*a.ids, pairs.only_a, time);
    lone[1].add(*b.ids, pairs.only_b, time);
  }
  for (FieldLine& line : table.lines) {
    if (!line.obstacle.empty())
      continue;
    const StoredField* field_a = find_field(a.fields, line.name);
    const StoredField* field_b = find_field(b.fields, line.name);
    if (field_a == nullptr && field_b == nullptr)
      continue;
    if (field_a == nullptr || field_b == nullptr) {
      line.obstacle = fmt::format("at t = {:.6g} s only in one run", time);
      continue;
    }
    const auto items = field_a->values.size() / static_cast<std::size_t>(field_a->components);
    if (!by_id && field_b->values.size() != field_a->values.size()) {
      line.obstacle =
          fmt::format("{} and {} {}", items, field_b->values.size() / static_cast<std::size_t>(field_b->components), table.title);
      continue;
    }
    if (!by_id && pairs.both.size() != items)
      pairs.both = side_by_side(items);
    const Gap gap = compare(field_a->values, field_b->values, field_a->components, pairs.both, tolerance_of(line, options));
    add_gap(line, gap, [&] {
      const std::size_t row = pairs.both[gap.pair].first;
      return fmt::format("t = {:.6g} s, {} {}", time, table.item, by_id ? (*a.ids)[row] : static_cast<std::int64_t>(row));
    });
  }
}

/// Compares the files of a list (.pvd), each of which holds a snapshot for each of the tables.
template <class ReadSnapshots>
void compare_series(std::vector<FieldTable>& tables, const std::string& list, ReadSnapshots&& read, const RunFolders& folders,
                    const DiffOptions& options)
{
  std::array<std::vector<Real>, 2> times;
  std::array<std::vector<fs::path>, 2> files;
  for (const std::size_t r : {0, 1})
    if (const fs::path file = folders[r] / list; is_there(file)) {
      for (const auto& [time, path] : read_pvd(file)) {
        times[r].push_back(time);
        files[r].push_back(path);
      }
      check_ascending(times[r], file);
    }
  for (const std::size_t r : {0, 1})
    for (const fs::path& file : files[r]) {
      const std::vector<Snapshot> snapshots = read(file);
      for (std::size_t k = 0; k < tables.size(); ++k)
        for (const StoredField& field : snapshots[k].fields)
          note_field(tables[k], r, field.name, {field.unit, field.components}, field.values);
    }
  const CommonTimes common = common_times(times, folders, options.last);
  for (FieldTable& table : tables) {
    choose_lines(table, folders, options);
    table.one_sided = common.one_sided;
    table.times = common.both.size();
  }
  if (std::all_of(tables.begin(), tables.end(), [](const FieldTable& table) { return table.lines.empty(); }))
    return;
  std::vector<std::array<LoneItems, 2>> lone(tables.size());
  for (const auto& [i, j] : common.both) {
    const std::vector<Snapshot> a = read(files[0][i]), b = read(files[1][j]);
    for (std::size_t k = 0; k < tables.size(); ++k)
      compare_snapshots(tables[k], a[k], b[k], times[0][i], options, lone[k]);
  }
  for (std::size_t k = 0; k < tables.size(); ++k)
    for (const std::size_t r : {0, 1})
      if (const auto& [n, first] = lone[k][r]; n > 0)
        tables[k].one_sided.push_back(
            fmt::format("only in {}: {}{}", folders[r].string(), first, n > 1 ? fmt::format(", others at {} more times", n - 1) : ""));
}

std::vector<Snapshot> particles_in(const fs::path& file)
{
  StoredParticles particles = read_particles(file);
  auto ids = particles.ids;
  std::sort(ids.begin(), ids.end());
  if (const auto twice = std::adjacent_find(ids.begin(), ids.end()); twice != ids.end())
    throw Error(fmt::format("{}: there are two particles {}", file.string(), *twice));
  std::vector<Snapshot> snapshots;
  snapshots.push_back({std::move(particles.ids), std::move(particles.fields)});
  return snapshots;
}

std::vector<Snapshot> mesh_fields_in(const fs::path& file)
{
  StoredMeshFields mesh = read_mesh_fields(file);
  std::vector<Snapshot> snapshots;
  snapshots.push_back({std::nullopt, std::move(mesh.nodes)});
  snapshots.push_back({std::nullopt, std::move(mesh.cells)});
  return snapshots;
}

/// Columns are told apart by their names.
void check_different(const std::vector<CsvColumn>& columns, const fs::path& file)
{
  for (std::size_t c = 0; c < columns.size(); ++c)
    for (std::size_t earlier = 0; earlier < c; ++earlier)
      if (columns[c].name == columns[earlier].name)
        throw Error(fmt::format("{}: columns {} and {} are both called \"{}\"", file.string(), earlier + 1, c + 1, columns[c].name));
}

FieldTable compare_histories(const RunFolders& folders, const DiffOptions& options)
{
  FieldTable table{"history", "row"};
  std::array<HistoryTable, 2> histories;
  std::array<std::vector<Real>, 2> times;
  for (const std::size_t r : {0, 1})
    if (const fs::path file = folders[r] / "history.csv"; is_there(file)) {
      histories[r] = read_history(file);
      if (histories[r].columns.front().name != "time")
        throw Error(fmt::format("{}: its first column is not the time", file.string()));
      times[r] = histories[r].values.front();
      check_ascending(times[r], file);
      check_different(histories[r].columns, file);
      for (std::size_t c = 1; c < histories[r].columns.size(); ++c)
        note_field(table, r, histories[r].columns[c].name, {histories[r].columns[c].unit, 1}, histories[r].values[c]);
    }
  choose_lines(table, folders, options);
  const CommonTimes common = common_times(times, folders, options.last);
  table.one_sided = common.one_sided;
  table.times = common.both.size();
  for (FieldLine& line : table.lines) {
    if (!line.obstacle.empty())
      continue;
    const Gap gap = compare(*histories[0][line.name], *histories[1][line.name], 1, common.both, tolerance_of(line, options));
    add_gap(line, gap, [&] {
      const std::size_t row = common.both[gap.pair].first;
      return fmt::format("t = {:.6g} s, row {}", times[0][row], row + 1);
    });
  }
  return table;
}

/// Entries of a line of the printed table.
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

/// What the runs were made from and with: told, but no difference of results.
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
                                     {"precision", &RunOrigin::precision},
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

std::vector<FieldTable> compare_all(const RunFolders& folders, const DiffOptions& options)
{
  std::vector<FieldTable> particles{{"particles", "particle"}}, mesh{{"nodes", "node"}, {"cells", "cell"}};
  compare_series(particles, "particles.pvd", particles_in, folders, options);
  compare_series(mesh, "mesh.pvd", mesh_fields_in, folders, options);
  std::vector<FieldTable> tables = std::move(particles);
  std::move(mesh.begin(), mesh.end(), std::back_inserter(tables));
  tables.push_back(compare_histories(folders, options));
  return tables;
}

/// Fields that were asked for must be in one of the runs at least.
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
