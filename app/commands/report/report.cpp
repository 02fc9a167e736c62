#include "app/commands/report/report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "app/commands/report/report_metrics.hpp"
#include "app/commands/report/report_particles.hpp"
#include "app/observers/results.hpp"
#include "app/run/summary.hpp"
#include "core/error.hpp"
#include "io/files/atomic_file.hpp"
#include "io/pictures/ground_file.hpp"
#include "io/scene/reader.hpp"
#include "mesh/geometry/outline.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

constexpr Real bytes_of_megabyte = 1e6;
constexpr std::size_t most_cell_edges = 200'000;  // most edges of a mesh: with more it would be a grey area

std::vector<PageBody> bodies_of(const RunFolder& run)
{
  std::vector<PageBody> bodies;
  for (const BodySummary& body : run.summary.bodies)
    bodies.push_back({body.name, body.material, body.law});
  if (!bodies.empty())
    return bodies;
  for (const BodySpec& body : run.scene.bodies)  // a run that has not ended
    bodies.push_back({body.name, body.material, ""});
  return bodies;
}

std::vector<Real> axis_of(std::span<const Real> places, std::size_t axis)
{
  std::vector<Real> values;
  for (std::size_t i = axis; i < places.size(); i += 3)
    values.push_back(places[i]);
  return values;
}

BlockId add_edges(const std::vector<Edge>& edges, Page& page)
{
  std::vector<std::uint32_t> nodes;
  for (const Edge& edge : edges)
    for (const Index node : edge)
      nodes.push_back(static_cast<std::uint32_t>(node));
  return page.add(packed(nodes));
}

/// The nodes of these edges, renumbered; other nodes of a 3-D mesh are not visible.
std::vector<Real> renumber(std::span<const Real> nodes, MeshEdges& edges)
{
  std::vector<Index> number(nodes.size() / 3, none);
  for (const Edge& edge : edges.all)
    for (const Index n : edge)
      number[static_cast<std::size_t>(n)] = 0;
  std::vector<Real> used;
  for (std::size_t n = 0; n < number.size(); ++n)
    if (number[n] != none) {
      number[n] = static_cast<Index>(used.size() / 3);
      used.insert(used.end(), nodes.begin() + static_cast<std::ptrdiff_t>(3 * n), nodes.begin() + static_cast<std::ptrdiff_t>(3 * n + 3));
    }
  for (std::vector<Edge>* list : {&edges.all, &edges.outline})
    for (Edge& edge : *list)
      for (Index& n : edge)
        n = number[static_cast<std::size_t>(n)];
  return used;
}

PagePlaces places_of(std::span<const Real> nodes, Page& page)
{
  PagePlaces places;
  for (std::size_t d = 0; d < static_cast<std::size_t>(page.dimension); ++d) {
    const std::vector<Real> values = axis_of(nodes, d);
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    places.low[static_cast<Index>(d)] = *low;
    places.high[static_cast<Index>(d)] = *high;
    places.axes.push_back(page.add(packed(quantised(values, *low, *high))));
  }
  return places;
}

/// The mesh; nothing if the file is missing, or damaged, which is noted in the page.
std::optional<StoredMesh> mesh_in(const fs::path& folder, Page& page)
try {
  const fs::path file = folder / "mesh.vtu";
  return fs::exists(file) ? std::optional(read_mesh(file)) : std::nullopt;
} catch (const EnvironmentError& damaged) {
  page.notes.push_back(fmt::format("mesh: it is left out: {}", damaged.what()));
  return std::nullopt;
}

void add_mesh(const StoredMesh& mesh, Page& page)
{
  MeshEdges edges = edges_of(mesh.dimension, mesh.nodes, mesh.corners);
  const std::vector<Real> nodes = renumber(mesh.nodes, edges);
  if (nodes.empty())
    return;
  PageMesh shown;
  shown.nodes = static_cast<std::int64_t>(nodes.size() / 3);
  shown.x = places_of(nodes, page);
  shown.outline = add_edges(edges.outline, page);
  if (edges.all.size() <= most_cell_edges)
    shown.cells = add_edges(edges.all, page);
  else
    page.notes.push_back(fmt::format("mesh: its {} edges are not shown, only its outline", edges.all.size()));
  page.mesh = std::move(shown);
}

/// Adds the ground; an unreadable mesh file gives a page without ground and a note.
void add_ground(const fs::path& folder, Page& page)
{
  std::optional<RigidGround> ground;
  try {
    ground = read_ground(folder, page.dimension);
  } catch (const EnvironmentError& e) {
    page.notes.push_back(fmt::format("the ground is not shown: {}", e.what()));
  }
  if (!ground)
    return;
  PageGround shown;
  shown.nodes = static_cast<std::int64_t>(ground->nodes.size() / 3);
  shown.x = places_of(ground->nodes, page);
  std::vector<std::uint32_t> corners;
  for (const auto& triangle : ground->triangles)
    for (const Index node : triangle)
      corners.push_back(static_cast<std::uint32_t>(node));
  shown.rigid = page.dimension == 2 ? add_edges(ground->lines, page) : page.add(packed(corners));
  shown.layers = add_edges(ground->layers, page);
  page.ground = std::move(shown);
}

/// A table; empty with a note if it cannot be read.
HistoryTable table_in(const fs::path& file, const std::string& what, Page& page)
{
  if (!fs::exists(file))
    return {};
  try {
    return read_history(file);
  } catch (const EnvironmentError& e) {
    page.notes.push_back(fmt::format("{}: {}", what, e.what()));
    return {};
  }
}

void add_history_table(const HistoryTable& history, std::size_t most, Page& page)
{
  if (history.rows() == 0)
    return;
  page.history = table_of(history.columns, history.values, most, page);
  if (page.history->thinned > 1)
    page.notes.push_back(fmt::format("history: every {}th of {} rows is shown", page.history->thinned, history.rows()));
}

std::optional<std::array<Real, 2>> picture_range(const PictureSpec& picture, const RunSurvey& survey)
{
  if (picture.range.size() != 2 || survey.fields.empty() || words_of(survey.fields.front()) != picture.field)
    return std::nullopt;
  return std::array{picture.range[0], picture.range[1]};
}

std::vector<std::string> names_of_bodies(const std::vector<PageBody>& bodies)
{
  std::vector<std::string> names;
  for (const PageBody& body : bodies)
    names.push_back(body.name);
  return names;
}

ReachRule rule_of(const std::optional<RunoutSpec>& runout, const std::optional<StoredMesh>& mesh)
{
  const bool asked = runout && runout->cell;
  return reach_rule(runout, asked ? *runout->cell : mesh ? mean_node_size(mesh->dimension, mesh->nodes, mesh->corners) : 0);
}

SurveyTask survey_task(const RunFolder& run, const PageOptions& wishes, const std::vector<PageBody>& bodies, const ReachRule& rule,
                       const Vec3& up)
{
  SurveyTask task{up, bodies.size(), wishes.fields, run.scene.outputs.picture.field, rule, {}, {}};
  const auto& runout = run.scene.outputs.runout;
  for (const PageBody& body : bodies)
    task.runs_out.push_back(!runout || runout->bodies.empty() || std::ranges::find(runout->bodies, body.name) != runout->bodies.end());
  for (const BodySummary& body : run.summary.bodies)
    task.mass.push_back(body.mass);
  return task;
}

Page begin_page(const RunFolder& run, const PageOptions& wishes)
{
  Page page;
  page.title = run.scene.title;
  page.name = fs::weakly_canonical(run.path).filename().string();
  page.dimension = static_cast<int>(run.scene.dimension);
  page.up = upright_of(run.scene);
  page.live = wishes.live;
  if (run.state != RunState::at_work)
    page.summary = run.summary.text;
  page.scene_file = fs::path(run.summary.scene_file).filename().string();
  page.scene_text = run.scene.text;
  for (const std::string& warning : run.summary.warnings)
    page.warnings.push_back({warning, line_of_warning(warning, run.summary.scene_file, run.scene.text)});
  return page;
}

}  // namespace

fs::path page_template(const std::optional<fs::path>& given)
{
  const fs::path page = given ? *given : fs::read_symlink("/proc/self/exe").parent_path() / report_file;
  if (!given && !fs::exists(page))
    throw EnvironmentError(
        fmt::format("the page was left out when this program was built, since npm could not fetch its libraries: {} is not there; "
                    "build again with the network within reach, copy it there from another build of the same commit, or name it by --page",
                    page.string()));
  return page;
}

RunState state_of_run(const fs::path& folder, const SummaryBack& summary)
{
  if (summary.status == "done")
    return RunState::done;
  if (summary.status == "stopped")
    return RunState::stopped;
  if (summary.message != message_before_the_end)
    return RunState::failed;
  return run_is_at_work(folder) ? RunState::at_work : RunState::killed;
}

RunFolder read_run_folder(const fs::path& folder)
{
  require_run(folder);
  RunFolder run{folder, read_summary(folder / "summary.json"), {}, {}};
  run.scene = read_scene(folder / "scene.yaml", run.summary.overrides, Libraries::closed);
  run.state = state_of_run(folder, run.summary);
  return run;
}

std::string page_of(const RunFolder& run, const PageOptions& wishes, const fs::path& template_file, RunSurvey& survey,
                    std::vector<std::string>& notes)
{
  const std::string text = read_whole(template_file);
  Page page = begin_page(run, wishes);
  const std::vector<PageBody> bodies = bodies_of(run);
  const std::optional<StoredMesh> mesh = mesh_in(run.path, page);
  const auto& outputs = run.scene.outputs;
  const ReachRule rule = rule_of(outputs.runout, mesh);
  look_over(run.path, survey_task(run, wishes, bodies, rule, page.up), survey);
  page.notes.insert(page.notes.end(), survey.left_out.begin(), survey.left_out.end());
  if (survey.frames.empty() && !wishes.fields.empty())
    throw Error(fmt::format("--fields: {} has no particle files", run.path.string()));

  const HistoryTable history = table_in(run.path / "history.csv", "history", page);
  const MetricTask task{page.dimension,
                        page.up,
                        against_gravity(run.scene).has_value(),
                        names_of_bodies(bodies),
                        outputs.history ? outputs.history->fronts : std::vector<FrontSpec>(),
                        rule,
                        table_in(run.path / "runout.csv", "run-out", page)};
  page.metrics = metrics_of(survey, history, task);
  if (!survey.frames.empty()) {
    const RunOutTable run_out = run_out_of(survey, task);
    page.run_out = table_of(run_out.columns, run_out.values, wishes.history_rows, page);
  }
  add_history_table(history, wishes.history_rows, page);
  if (mesh)
    add_mesh(*mesh, page);
  add_ground(run.path, page);
  RigidFrames rigid(run.path, run.scene.rigid, page);

  const Real room = bytes_of_megabyte * wishes.megabytes - static_cast<Real>(text.size() + to_json(page).size() + page.block_bytes());
  if (room < 0)
    throw Error(fmt::format("--size: too small: the page without particles takes {:.3g} MB", wishes.megabytes - room / bytes_of_megabyte));
  add_particles(
      survey,
      {page.dimension, bodies, picture_range(outputs.picture, survey), wishes.frames, !wishes.fields.empty(), room, std::move(rigid)},
      page);
  note_frames_without_rigid(page);
  notes = page.notes;
  return filled(text, template_file, page);
}

void write_report(const ReportOptions& options)
{
  const RunFolder run = read_run_folder(options.folder);
  PageOptions wishes{options.fields, {}, options.size.value_or(PageOptions{}.megabytes), {}};
  if (options.frames)
    wishes.frames = static_cast<std::size_t>(*options.frames);
  const auto file = options.out.value_or(options.folder / report_file);
  if (file.extension() != ".html")
    throw Error(fmt::format("--out {}: the name of a page ends in .html", file.string()));
  RunSurvey survey;
  std::vector<std::string> notes;
  const std::string page = page_of(run, wishes, page_template(options.page), survey, notes);
  write_whole(file, page);
  fmt::print("{}  {:.1f} MB\n", file.string(), static_cast<Real>(page.size()) / 1e6);
  for (const std::string& note : notes)
    fmt::print("  {}\n", note);
}

}  // namespace talus
