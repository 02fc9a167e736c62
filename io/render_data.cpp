// Result files back into plain arrays, by VTK's readers.
#include "io/render_data.hpp"

#include <fmt/format.h>
#include <vtkCallbackCommand.h>
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
#include <vtkXMLDataElement.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <vtkXMLUtilities.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/viewed.hpp"
#include "core/words.hpp"
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

std::vector<ResultFile> listed(const fs::path& pvd)
{
  const auto root = vtkSmartPointer<vtkXMLDataElement>::Take(vtkXMLUtilities::ReadElementFromFile(pvd.c_str()));
  vtkXMLDataElement* list = root ? root->FindNestedElementWithName("Collection") : nullptr;
  std::vector<ResultFile> files;
  for (int i = 0; list != nullptr && i < list->GetNumberOfNestedElements(); ++i) {
    double time = 0;
    list->GetNestedElement(i)->GetScalarAttribute("timestep", time);
    if (const char* name = list->GetNestedElement(i)->GetAttribute("file"))
      files.push_back({time, pvd.parent_path() / name});
  }
  return files;
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

}  // namespace

std::vector<ResultFile> particle_files(const fs::path& folder)
{
  const fs::path pvd = folder / "particles.pvd";
  if (!fs::exists(pvd))
    throw EnvironmentError(fmt::format("{} is not there: is {} the folder of a run with particle output?", pvd.string(), folder.string()));
  auto files = listed(pvd);
  if (files.empty())
    throw EnvironmentError(fmt::format("{} lists no file", pvd.string()));
  return files;
}

Cloud read_cloud(const fs::path& file, const std::optional<std::string>& field)
{
  vtkNew<vtkXMLPolyDataReader> reader;
  update(*reader, file);
  vtkPolyData* data = reader->GetOutput();
  Cloud cloud;
  cloud.x = points_of(data);
  cloud.value.resize(cloud.x.size());
  const auto viewed = ViewedField::of(field ? *field : default_field(field_names(data->GetPointData())));
  vtkDataArray* array = find_field(data->GetPointData(), viewed.name, file);
  const int components = array->GetNumberOfComponents();
  const auto component = viewed.component_of(components);
  for (std::size_t p = 0; p < cloud.value.size(); ++p) {
    const auto row = static_cast<vtkIdType>(p);
    cloud.value[p] = component ? array->GetComponent(row, *component) : viewed_value({array->GetTuple(row), static_cast<std::size_t>(components)});
  }
  cloud.label = viewed.label(components);
  if (const char* unit = array->GetInformation()->Get(vtkDataArray::UNITS_LABEL()))
    cloud.unit = unit;
  return cloud;
}

Outline read_outline(const fs::path& folder)
{
  fs::path file = folder / "mesh.vtu";
  if (!fs::exists(file)) {
    if (!fs::exists(folder / "mesh.pvd"))
      return {};
    const auto files = listed(folder / "mesh.pvd");
    if (files.empty())
      return {};
    file = files.front().path;
  }
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  update(*reader, file);
  vtkUnstructuredGrid* grid = reader->GetOutput();
  Outline outline{points_of(grid), {}};
  std::vector<Real> nodes;
  for (const Vec3& x : outline.nodes)
    nodes.insert(nodes.end(), x.begin(), x.end());
  std::vector<Index> corners;
  vtkNew<vtkIdList> cell;
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c) {
    grid->GetCellPoints(c, cell);
    for (const vtkIdType node : *cell)
      corners.push_back(static_cast<Index>(node));
  }
  const int dimension = grid->GetNumberOfCells() > 0 && grid->GetCellType(0) == VTK_TRIANGLE ? 2 : 3;
  outline.edges = edges_of(dimension, nodes, corners).outline;
  return outline;
}

}  // namespace talus::render
