// Reads result files into arrays.
#include "io/pictures/render_data.hpp"

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPolyData.h>

#include <algorithm>

#include "core/error.hpp"
#include "core/word_match.hpp"
#include "io/output/vtk.hpp"
#include "mesh/geometry/outline.hpp"

namespace talus::render {

namespace {

namespace fs = std::filesystem;

std::vector<std::string> field_names(const StoredParticles& particles)
{
  std::vector<std::string> names;
  for (const StoredField& field : std::span(particles.fields).subspan(1))  // without the position
    names.push_back(field.name);
  return names;
}

std::string default_field(const std::vector<std::string>& names)
{
  for (const char* wanted : {"displacement", "velocity"})
    if (std::find(names.begin(), names.end(), wanted) != names.end())
      return wanted;
  return names.empty() ? "id" : names.front();
}

StoredField find_field(const StoredParticles& particles, const std::string& name, const fs::path& file)
{
  if (name == "id")
    return {name, 1, {particles.ids.begin(), particles.ids.end()}};
  if (const StoredField* field = stored_field(particles, name); field != nullptr && name != "position")
    return *field;
  throw Error(fmt::format("{} has no field \"{}\"{}", file.string(), name, suggestion(name, field_names(particles))));
}

std::vector<Vec3> points_of(std::span<const Real> numbers)
{
  std::vector<Vec3> x(numbers.size() / 3);
  for (std::size_t p = 0; p < x.size(); ++p)
    x[p] = Eigen::Map<const Vec3>(numbers.data() + 3 * p);
  return x;
}

/// The file mesh.vtu, or the first file of mesh.pvd, if it exists.
std::optional<fs::path> mesh_file(const fs::path& folder)
{
  if (fs::exists(folder / "mesh.vtu"))
    return folder / "mesh.vtu";
  if (!fs::exists(folder / "mesh.pvd"))
    return std::nullopt;
  const auto files = read_pvd(folder / "mesh.pvd");
  return files.empty() ? std::nullopt : std::optional(files.front().second);
}

}  // namespace

std::vector<ResultFile> particle_files(const fs::path& folder)
{
  const fs::path pvd = folder / "particles.pvd";
  if (!fs::exists(pvd))
    throw EnvironmentError(fmt::format("{} is not there: is {} the folder of a run with particle output?", pvd.string(), folder.string()));
  std::vector<ResultFile> files;
  for (const auto& [time, path] : read_pvd(pvd))
    files.push_back({time, path});
  if (files.empty())
    throw EnvironmentError(fmt::format("{} lists no file", pvd.string()));
  return files;
}

RunFacts facts_of(const fs::path& first, std::size_t n_frames)
{
  const StoredParticles particles = read_particles(first);
  const std::vector<Vec3> x = points_of(particles.fields.front().values);
  const bool flat = std::all_of(x.begin(), x.end(), [](const Vec3& point) { return point[2] == 0; });
  RunFacts facts{flat ? 2 : 3, n_frames, {}};
  for (const StoredField& field : std::span(particles.fields).subspan(1))
    facts.fields.push_back({field.name, field.components});
  return facts;
}

Cloud read_cloud(const fs::path& file, const std::optional<std::string>& field)
{
  const StoredParticles particles = read_particles(file);
  const auto viewed = ViewedField::of(field ? *field : default_field(field_names(particles)));
  const StoredField shown = find_field(particles, viewed.name, file);
  Cloud cloud{points_of(particles.fields.front().values), viewed_values(shown, viewed), viewed.label(shown.components), shown.unit,
              particles.ids};
  if (const StoredField* volume = stored_field(particles, "volume"); volume != nullptr && volume->components == 1)
    cloud.volume = volume->values;
  return cloud;
}

Lines read_mesh_lines(const fs::path& folder, MeshLines which)
{
  const auto file = which == MeshLines::none ? std::nullopt : mesh_file(folder);
  if (!file)
    return {};
  const StoredMesh mesh = read_mesh(*file);
  Lines lines{points_of(mesh.nodes), {}};
  MeshEdges edges = edges_of(mesh.dimension, mesh.nodes, mesh.corners);
  lines.ends = std::move(which == MeshLines::edges ? edges.all : edges.outline);
  return lines;
}

Lines lines_of(vtkPolyData* data)
{
  Lines lines;
  lines.points.resize(static_cast<std::size_t>(data->GetNumberOfPoints()));
  for (std::size_t p = 0; p < lines.points.size(); ++p)
    data->GetPoint(static_cast<vtkIdType>(p), lines.points[p].data());
  vtkNew<vtkIdList> ends;
  vtkCellArray* cells = data->GetLines();
  for (cells->InitTraversal(); cells->GetNextCell(ends) != 0;)
    for (vtkIdType a = 0; a + 1 < ends->GetNumberOfIds(); ++a)
      lines.ends.push_back({static_cast<Index>(ends->GetId(a)), static_cast<Index>(ends->GetId(a + 1))});
  return lines;
}

std::map<int, Matter> read_bodies(const fs::path& file, const std::optional<std::string>& field)
{
  const StoredParticles particles = read_particles(file);
  const StoredField* const volume = stored_field(particles, "volume");
  if (volume == nullptr || volume->components != 1)
    throw Error(
        fmt::format("{} has no field \"volume\", from which surfaces are reckoned: run the scene again with it among "
                    "outputs.particles.fields",
                    file.string()));
  const StoredField* const body = stored_field(particles, "body");
  std::vector<Real> values;
  if (field) {
    const auto viewed = ViewedField::of(*field);
    values = viewed_values(find_field(particles, viewed.name, file), viewed);
  }
  const std::vector<Vec3> x = points_of(particles.fields.front().values);
  constexpr Real most_bodies = 1e6;
  std::map<int, Matter> bodies;
  for (std::size_t p = 0; p < x.size(); ++p) {
    const Real number = body == nullptr ? 0 : body->values[p * static_cast<std::size_t>(body->components)];
    if (!(number >= 0 && number < most_bodies))
      throw EnvironmentError(fmt::format("cannot read {}: it is damaged: a particle of body {}", file.string(), number));
    Matter& matter = bodies[static_cast<int>(number)];
    matter.x.push_back(x[p]);
    matter.volume.push_back(volume->values[p]);
    if (field)
      matter.value.push_back(values[p]);
  }
  return bodies;
}

}  // namespace talus::render
