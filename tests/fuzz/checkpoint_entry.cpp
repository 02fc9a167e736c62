// A small state is kept as a run keeps it; lines change what is in the file, whose digests are made anew.  The file is taken over by a run
// that goes on, and its bodies are read as by a scene that begins with them.
//
//   number PATH I VALUE    value I of an array            columns PATH N    another width
//   rows PATH N            so many values                 text PATH WORDS   another text, or a text in place of numbers
//   type PATH TYPE         double, float, int32, int64, uint8             drop PATH         not there
//   byte I VALUE           of the file itself, its digests left as they are
//
// A PATH that is not there is taken for the number of one.
#include <charconv>
#include <optional>
#include <sstream>
#include <variant>

#include "app/observers/checkpoints.hpp"
#include "core/error.hpp"
#include "io/files/atomic_file.hpp"
#include "materials/von_mises.hpp"
#include "mesh/generate/generate.hpp"
#include "mesh/simplex.hpp"
#include "tests/fuzz/entries.hpp"
#include "tests/fuzz/memory_file.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

/// A folder in memory, one for all runs of the process.
const fs::path& run_folder()
{
  static const struct Folder {
    fs::path path = MemoryFile().path();
    Folder()
    {
      fs::create_directories(path);
      write_whole(path / "summary.json", "{}\n");  // as every run begins
    }
    ~Folder()
    {
      std::error_code stays;
      fs::remove_all(path, stays);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
  } folder;
  return folder.path;
}

OutputSpec small_outputs()
{
  PointSpec point;
  point.name = "top";
  point.at = {0.3, 0.6};
  OutputSpec outputs;
  outputs.history.emplace();
  outputs.history->every = 0.1;
  outputs.history->points.push_back(std::move(point));
  return outputs;
}

std::vector<Stage> small_stages()
{
  std::vector<Stage> stages(1);
  stages[0].name = "the only";
  stages[0].duration = 1;
  return stages;
}

/// All that a checkpoint is of.
struct SmallRun {
  static constexpr Index n_particles = 3;
  Problem<2> problem{Mesh<2>(box<2>({0, 0}, {1, 1}, {2, 2}))};
  State<2> state{};
  CellOrder order;
  std::vector<VelocityField<2>> fields = std::vector<VelocityField<2>>(1);
  OutputSpec outputs = small_outputs();
  std::vector<Stage> stages = small_stages();
  Recorder<2> recorder{run_folder(), outputs, stages, true, ""};
  StateLimits limits{problem.mesh.n_cells(), 1, n_particles};

  SmallRun()
  {
    const auto make_room = [](auto&... columns) { (columns.resize(n_particles), ...); };
    state.crossing = 1;
    state.bodies = {{"block", 0, n_particles, {}}};
    state.materials.push_back(make_material(VonMises{}, 0, n_particles, "steel"));
    Particles<2>& p = state.particles;
    make_room(p.id, p.cell, p.x, p.x0, p.v, p.L, p.F, p.stress, p.volume0, p.volume, p.mass);
    for (std::size_t row = 0; row < n_particles; ++row) {
      p.id[row] = static_cast<std::int64_t>(row);
      p.cell[row] = static_cast<Index>(row);
      p.x.set(row, centroid<2>(problem.mesh.corners(p.cell[row])));
      p.x0.set(row, p.x[row]);
      p.v.set(row, Vec<2>::Zero());
      p.L.set(row, Mat<2>::Zero());
      p.F.set(row, Mat3::Identity());
      p.stress.set(row, Sym3::Zero());
      p.volume0.set(row, 0.1);
      p.volume.set(row, 0.1);
      p.mass.set(row, 100);
    }
    sort();
    const std::vector<Index> held{0, 1};
    state.boundary.add({.name = "floor", .kind = Fixed<2>{}}, problem.mesh, held);
  }
  void sort() { sort_by_cell(state.particles.cell, state.particles.id, state.bodies, problem.mesh.n_cells(), order); }
  RunView<2> view() const { return {problem, state, order, fields, "the only", "run", 0, 0}; }
};

/// As a run goes on.
void go_on(const CheckpointList& checkpoints)
{
  SmallRun run;
  checkpoints.take_over(run.state, run.recorder, run.limits);
  run.sort();
  run.recorder.resume(run.view());
}

/// As a scene begins with the bodies: each row is read.
void begin_with(const CheckpointList& checkpoints)
{
  KeptBodies<2> saved;
  saved.bodies = {{"block", 0, 0, {}}};
  saved.materials.push_back(make_material(VonMises{}, 0, 0, "steel"));
  checkpoints.read(saved);
  const Particles<2>& p = saved.particles;
  volatile Real sum = 0;  // so that it is worked out
  for (const Body& body : saved.bodies)
    for (Index i = body.begin; i < body.end; ++i) {
      const auto row = static_cast<std::size_t>(i);
      sum = sum + static_cast<Real>(p.id[row]) + p.x[row].sum() + p.v[row].sum() + p.L[row].sum() + p.F[row].sum() + p.stress[row].sum() +
            p.mass[row] + p.volume0[row] + p.volume[row];
    }
}

/// The file that a run would leave.
std::string good_checkpoint()
{
  SmallRun run;
  Checkpoints<2> checkpoints(run_folder(), {},
                             {"0.1", "commit", "compiler", "build", "scene.yaml", "title: none\n", {"time.end=1"}, false, 1, 2, ""});
  run.recorder.watch(run.view(), RunEvent::stage_begins);
  ++run.state.clock.step;
  checkpoints.write(run.view(), run.recorder);
  const CheckpointList good(checkpoints.last());  // refused, it would be of no use to what follows
  go_on(good);
  begin_with(good);
  return read_whole(checkpoints.last());
}

using Values = std::variant<std::vector<double>, std::vector<float>, std::vector<std::int32_t>, std::vector<std::int64_t>,
                            std::vector<std::uint8_t>, std::string>;
struct Entry {
  std::string path;
  Values values;
  int columns = 1;
};

template <class T>
bool read_entry(const ArrayReader& file, Entry& entry)
{
  for (const int columns : {1, 2, 3, 4, 6, 9})
    try {
      entry.values = file.read<T>(entry.path, columns);
      entry.columns = columns;
      return true;
    } catch (const EnvironmentError&) {  // of another type, or width
    }
  return false;
}

void read_entries(const ArrayReader& file, const std::string& group, std::vector<Entry>& entries)
{
  for (const std::string& name : file.names(group)) {
    const std::string path = group.empty() ? name : group + "/" + name;
    try {
      read_entries(file, path, entries);
      continue;
    } catch (const EnvironmentError&) {  // no group
    }
    Entry entry{path, {}};
    if (!(read_entry<double>(file, entry) || read_entry<float>(file, entry) || read_entry<std::int32_t>(file, entry) ||
          read_entry<std::int64_t>(file, entry) || read_entry<std::uint8_t>(file, entry)))
      entry.values = file.text(path);
    entries.push_back(std::move(entry));
  }
}

const std::string& good_bytes()
{
  static const std::string bytes = good_checkpoint();
  return bytes;
}

const std::vector<Entry>& good_entries()
{
  static const std::vector<Entry> entries = [] {
    const MemoryFile file(good_bytes());
    std::vector<Entry> found;
    read_entries(ArrayReader(file.path()), "", found);
    return found;
  }();
  return entries;
}

template <class Number>
std::optional<Number> number_of(std::string_view word)
{
  Number number{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  return error == std::errc{} ? std::optional(number) : std::nullopt;
}

/// A double as any other number; what does not fit wraps around, so that negative and huge ones come about.
template <class T>
T converted(double value)
{
  if constexpr (std::is_floating_point_v<T>)
    return static_cast<T>(value);
  else
    return std::abs(value) < 9e18 ? static_cast<T>(static_cast<std::int64_t>(value)) : std::numeric_limits<T>::max();
}

template <class T>
Values as_type(const Values& values)
{
  std::vector<T> result;
  std::visit(
      [&](const auto& all) {
        for (const auto value : all)
          result.push_back(converted<T>(static_cast<double>(value)));
      },
      values);
  return result;
}

/// A good checkpoint that lines change.
class Recipe {
 public:
  explicit Recipe(std::string_view lines)
  {
    std::istringstream stream{std::string(lines)};
    for (std::string line; std::getline(stream, line);)
      follow(line);
  }

  /// The file made so.
  std::string cooked() const
  {
    std::string bytes = is_changed_ ? written() : good_bytes();
    for (const auto& [at, value] : damage_)
      bytes[at % bytes.size()] = static_cast<char>(value);
    return bytes;
  }

 private:
  std::string written() const
  {
    const MemoryFile file;
    ArrayWriter writer(file.path());
    for (const Entry& entry : entries_)
      std::visit([&](const auto& values) { write(writer, entry, values); }, entry.values);
    writer.close();
    return read_whole(file.path());
  }

  static void write(ArrayWriter& to, const Entry& entry, const std::string& text) { to.write(entry.path, std::string_view(text)); }
  template <class T>
  static void write(ArrayWriter& to, const Entry& entry, const std::vector<T>& values)
  {
    const auto width = static_cast<std::size_t>(entry.columns);
    to.write<T>(entry.path, std::span(values).first(values.size() / width * width), entry.columns);
  }

  Entry* find(std::string_view path)
  {
    for (Entry& entry : entries_)
      if (entry.path == path)
        return &entry;
    const auto number = number_of<std::size_t>(path);
    return number && !entries_.empty() ? &entries_[*number % entries_.size()] : nullptr;
  }

  void follow(const std::string& line)
  {
    constexpr std::int64_t most_rows = 1000, most_columns = 20;
    std::istringstream words(line);
    std::string verb, path, first, second;
    words >> verb >> path >> first >> second;
    const auto value = number_of<double>(second);
    const auto number = number_of<std::int64_t>(first);
    if (const auto at = number_of<std::size_t>(path); verb == "byte" && at && number)
      damage_.emplace_back(*at, *number);
    Entry* const entry = verb == "byte" ? nullptr : find(path);
    if (entry == nullptr)
      return;
    is_changed_ = true;
    if (verb == "drop")
      entries_.erase(entries_.begin() + (entry - entries_.data()));
    else if (verb == "columns" && number && *number > 0 && *number <= most_columns)
      entry->columns = static_cast<int>(*number);
    else if (verb == "rows" && number && *number >= 0 && *number <= most_rows)
      std::visit([&](auto& values) { values.resize(static_cast<std::size_t>(*number)); }, entry->values);
    else if (verb == "text")
      entry->values = first;
    else if (verb == "type")
      change_type(first, *entry);
    else if (verb == "number" && number && value)
      std::visit([&](auto& values) { set(values, static_cast<std::size_t>(*number), *value); }, entry->values);
  }

  template <class T>
  static void set(T& values, std::size_t at, double value)
  {
    if (!values.empty())
      values[at % values.size()] = converted<typename T::value_type>(value);
  }

  static void change_type(const std::string& type, Entry& entry)
  {
    if (type == "double")
      entry.values = as_type<double>(entry.values);
    else if (type == "float")
      entry.values = as_type<float>(entry.values);
    else if (type == "int32")
      entry.values = as_type<std::int32_t>(entry.values);
    else if (type == "int64")
      entry.values = as_type<std::int64_t>(entry.values);
    else if (type == "uint8")
      entry.values = as_type<std::uint8_t>(entry.values);
  }

  std::vector<Entry> entries_ = good_entries();
  bool is_changed_ = false;
  std::vector<std::pair<std::size_t, std::int64_t>> damage_;
};

}  // namespace

void fuzz_checkpoint(std::string_view bytes)
{
  const MemoryFile file(bytes.starts_with("\x89HDF") ? std::string(bytes) : Recipe(bytes).cooked());
  for (const auto& way : {go_on, begin_with})
    try {
      way(CheckpointList(file.path()));
    } catch (const EnvironmentError&) {
    }
}

}  // namespace talus
