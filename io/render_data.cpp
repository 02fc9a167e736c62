// Result files back into plain arrays, by VTK's readers.
#include "io/render_data.hpp"

#include <fmt/format.h>
#include <vtkCallbackCommand.h>
#include <vtkCellArray.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkExecutive.h>
#include <vtkIdList.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/viewed.hpp"
#include "core/words.hpp"
#include "io/picture_settings.hpp"
#include "io/vtk.hpp"
#include "mesh/outline.hpp"

namespace talus::render {

namespace {

namespace fs = std::filesystem;

void keep_message(vtkObject*, unsigned long, void* kept, void* message)
{
  auto& text = *static_cast<std::string*>(kept);
  if (text.empty() && message != nullptr)
    text = static_cast<const char*>(message);
}

/// VTK's readers go on after errors; this one stops.
template <class Reader>
void update(Reader& reader, const fs::path& file)
{
  std::string message;
  vtkNew<vtkCallbackCommand> observer;
  observer->SetCallback(keep_message);
  observer->SetClientData(&message);
  reader.AddObserver(vtkCommand::ErrorEvent, observer);
  reader.GetExecutive()->AddObserver(vtkCommand::ErrorEvent, observer);
  reader.SetFileName(file.c_str());
  if (fs::exists(file))
    reader.Update();
  else
    message = "there is no such file";
  if (!message.empty() || reader.GetErrorCode() != 0)
    throw EnvironmentError(fmt::format("cannot read {}: {}", file.string(), message));
}

std::vector<std::string> field_names(vtkPointData* data)
{
  std::vector<std::string> names;
  for (int i = 0; i < data->GetNumberOfArrays(); ++i)
    if (data->GetArrayName(i) != nullptr && data->GetArrayName(i) != std::string("id"))
      names.emplace_back(data->GetArrayName(i));
  return names;
}

std::string default_field(const std::vector<std::string>& names)
{
  for (const char* wanted : {"displacement", "velocity"})
    if (std::find(names.begin(), names.end(), wanted) != names.end())
      return wanted;
  return names.empty() ? "id" : names.front();
}

vtkDataArray* find_field(vtkPointData* data, const std::string& name, const fs::path& file)
{
  vtkDataArray* array = data->GetArray(name.c_str());
  if (array == nullptr)
    throw Error(fmt::format("{} has no field \"{}\"{}", file.string(), name, suggestion(name, field_names(data))));
  return array;
}

std::vector<Vec3> points_of(vtkPointSet* data)
{
  std::vector<Vec3> x(static_cast<std::size_t>(data->GetNumberOfPoints()));
  for (std::size_t p = 0; p < x.size(); ++p)
    data->GetPoint(static_cast<vtkIdType>(p), x[p].data());
  return x;
}

std::vector<Real> values_of(vtkPolyData* data, const ViewedField& field, const fs::path& file)
{
  vtkDataArray* array = find_field(data->GetPointData(), field.name, file);
  const int components = array->GetNumberOfComponents();
  const auto component = field.component_of(components);
  std::vector<Real> values(static_cast<std::size_t>(array->GetNumberOfTuples()));
  for (std::size_t p = 0; p < values.size(); ++p) {
    const auto row = static_cast<vtkIdType>(p);
    values[p] =
        component ? array->GetComponent(row, *component) : viewed_value({array->GetTuple(row), static_cast<std::size_t>(components)});
  }
  return values;
}

/// Of mesh.vtu, or of the first file of mesh.pvd, if there is one.
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

RunFacts facts_of(const std::vector<ResultFile>& files)
{
  vtkNew<vtkXMLPolyDataReader> reader;
  update(*reader, files.front().path);
  const std::vector<Vec3> x = points_of(reader->GetOutput());
  const bool flat = std::all_of(x.begin(), x.end(), [](const Vec3& point) { return point[2] == 0; });
  RunFacts facts{flat ? 2 : 3, files.size(), {}};
  for (const auto& [name, components] : stored_particle_fields(files.front().path))
    facts.fields.push_back({name, components});
  return facts;
}

Cloud read_cloud(const fs::path& file, const std::optional<std::string>& field)
{
  vtkNew<vtkXMLPolyDataReader> reader;
  update(*reader, file);
  vtkPolyData* data = reader->GetOutput();
  Cloud cloud;
  cloud.x = points_of(data);
  const auto viewed = ViewedField::of(field ? *field : default_field(field_names(data->GetPointData())));
  cloud.value = values_of(data, viewed, file);
  vtkDataArray* array = data->GetPointData()->GetArray(viewed.name.c_str());
  cloud.label = viewed.label(array->GetNumberOfComponents());
  if (const char* unit = array->GetInformation()->Get(vtkDataArray::UNITS_LABEL()))
    cloud.unit = unit;
  return cloud;
}

Lines read_mesh_lines(const fs::path& folder, MeshLines which)
{
  const auto file = which == MeshLines::none ? std::nullopt : mesh_file(folder);
  if (!file)
    return {};
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  update(*reader, *file);
  vtkUnstructuredGrid* grid = reader->GetOutput();
  Lines lines{points_of(grid), {}};
  std::vector<Index> corners;
  vtkNew<vtkIdList> cell;
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c) {
    grid->GetCellPoints(c, cell);
    for (const vtkIdType node : *cell)
      corners.push_back(static_cast<Index>(node));
  }
  const int dimension = grid->GetNumberOfCells() > 0 && grid->GetCellType(0) == VTK_TRIANGLE ? 2 : 3;
  MeshEdges edges = edges_of(dimension, numbers_of(lines.points), corners);
  lines.ends = std::move(which == MeshLines::edges ? edges.all : edges.outline);
  return lines;
}

Lines lines_of(vtkPolyData* data)
{
  Lines lines{points_of(data), {}};
  vtkNew<vtkIdList> ends;
  vtkCellArray* cells = data->GetLines();
  for (cells->InitTraversal(); cells->GetNextCell(ends) != 0;)
    for (vtkIdType a = 0; a + 1 < ends->GetNumberOfIds(); ++a)
      lines.ends.push_back({static_cast<Index>(ends->GetId(a)), static_cast<Index>(ends->GetId(a + 1))});
  return lines;
}

std::map<int, Matter> read_bodies(const fs::path& file, const std::optional<std::string>& field)
{
  vtkNew<vtkXMLPolyDataReader> reader;
  update(*reader, file);
  vtkPolyData* data = reader->GetOutput();
  vtkDataArray* volume = data->GetPointData()->GetArray("volume");
  if (volume == nullptr)
    throw Error(
        fmt::format("{} has no field \"volume\", from which surfaces are reckoned: run the scene again with it among "
                    "outputs.particles.fields",
                    file.string()));
  vtkDataArray* body = data->GetPointData()->GetArray("body");
  const std::vector<Real> values = field ? values_of(data, ViewedField::of(*field), file) : std::vector<Real>{};
  const std::vector<Vec3> x = points_of(data);
  std::map<int, Matter> bodies;
  for (std::size_t p = 0; p < x.size(); ++p) {
    const auto row = static_cast<vtkIdType>(p);
    Matter& matter = bodies[body == nullptr ? 0 : static_cast<int>(body->GetComponent(row, 0))];
    matter.x.push_back(x[p]);
    matter.volume.push_back(volume->GetComponent(row, 0));
    if (field)
      matter.value.push_back(values[p]);
  }
  return bodies;
}

}  // namespace talus::render
