#include "app/commands/diff/compare_runs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/error.hpp"
#include "core/field_component.hpp"
#include "io/output/csv.hpp"
#include "io/output/vtk.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

/// The contents of one file for one table.
struct Snapshot {
  std::optional<std::vector<std::int64_t>> ids;  ///< nothing for numbered items
  std::vector<StoredField> fields;
};

const StoredField* find_field(const std::vector<StoredField>& fields, const std::string& name)
{
  const auto found = std::find_if(fields.begin(), fields.end(), [&](const StoredField& field) { return field.name == name; });
  return found == fields.end() ? nullptr : &*found;
}

/// Pairs row i with row i.
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

/// Records a field of run `r` before the comparison: the tolerance needs the largest value of all files.
void note_field(FieldTable& table, std::size_t r, const std::string& name, const FieldShape& shape, std::span<const Real> values)
{
  FieldLine& line = line_of(table, name);
  line.scale = std::max(line.scale, largest_modulus(values));
  if (!line.shape[r])
    line.shape[r] = shape;
}

/// Keeps the requested lines, and records why some cannot be compared.
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

/// The name of a component with a preceding comma; empty for a scalar.
std::string component_name(int component, int components)
{
  if (components == 1)
    return "";
  const auto names = component_names(components);
  return names.empty() ? fmt::format(", component {}", component) : ", " + names[static_cast<std::size_t>(component)];
}

/// Adds the result for one pair of files; `where` is called only for a new largest difference.
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

/// Checks that times ascend, so that two lists can be compared.
void check_ascending(std::span<const Real> times, const fs::path& file)
{
  for (std::size_t i = 0; i < times.size(); ++i)
    if (!std::isfinite(times[i]) || (i > 0 && !(times[i] > times[i - 1])))
      throw Error(fmt::format("{}: its times do not ascend: entry {} is {} s", file.string(), i + 1, times[i]));
}

/// The times that both runs have, and a description of the others.
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

/// Particles that only one run has, over all times.
struct LoneItems {
  std::size_t times = 0;
  std::string first = {};  ///< description of the first one

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

/// Compares the files of a list (.pvd), each of which has a snapshot for each table.
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

/// Checks that the names of columns differ.
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

}  // namespace

bool is_there(const fs::path& file)
{
  std::error_code ignored;  // inaccessible files count as missing
  return fs::exists(file, ignored);
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

}  // namespace talus
