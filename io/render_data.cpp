// Result files back into plain arrays, by VTK's readers.
#include "io/render_data.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <vtkCallbackCommand.h>
#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkDataSetSurfaceFilter.h>
#include <vtkExecutive.h>
#include <vtkFeatureEdges.h>
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
#include "core/words.hpp"

namespace talus::render {

namespace {

namespace fs = std::filesystem;

constexpr double sharp_edge = 30;  // degrees between the normals of two boundary facets

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

std::vector<std::string> component_names(int components)
{
  if (components == 3)
    return {"x", "y", "z"};
  if (components == 6)
    return {"xx", "yy", "zz", "xy", "yz", "xz"};
  if (components == 9)
    return {"xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"};
  return {};
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

Real measure(const double* entry, int components)
{
  if (components == 6) {
    const auto square = [](double a) { return a * a; };
    return std::sqrt(0.5 * (square(entry[0] - entry[1]) + square(entry[1] - entry[2]) + square(entry[2] - entry[0])) +
                     3 * (square(entry[3]) + square(entry[4]) + square(entry[5])));
  }
  if (components == 1)
    return entry[0];
  Real sum = 0;
  for (int c = 0; c < components; ++c)
    sum += entry[c] * entry[c];
  return std::sqrt(sum);
}

struct Wanted {
  vtkDataArray* array;
  std::optional<int> component;
};

Wanted find_field(vtkPointData* data, const std::string& field, const fs::path& file)
{
  const auto colon = field.find(':');
  const std::string name = field.substr(0, colon);
  vtkDataArray* array = data->GetArray(name.c_str());
  if (array == nullptr)
    throw Error(fmt::format("{} has no field \"{}\"{}", file.string(), name, suggestion(name, field_names(data))));
  if (colon == std::string::npos)
    return {array, std::nullopt};
  const auto components = component_names(array->GetNumberOfComponents());
  const auto found = std::find(components.begin(), components.end(), field.substr(colon + 1));
  if (found == components.end())
    throw Error(
        fmt::format("field \"{}\" has no component \"{}\"; it has: {}", name, field.substr(colon + 1), fmt::join(components, ", ")));
  return {array, static_cast<int>(found - components.begin())};
}

std::string label_of(const std::string& field, int components, bool one_component)
{
  std::string label = field;
  std::replace(label.begin(), label.end(), '_', ' ');
  if (one_component)
    label.replace(label.find(':'), 1, " ");
  return components == 6 && !one_component ? label + " (von Mises)" : label;
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
  const std::string name = field ? *field : default_field(field_names(data->GetPointData()));
  const auto [array, component] = find_field(data->GetPointData(), name, file);
  const int components = array->GetNumberOfComponents();
  for (std::size_t p = 0; p < cloud.value.size(); ++p) {
    const auto row = static_cast<vtkIdType>(p);
    cloud.value[p] = component ? array->GetComponent(row, *component) : measure(array->GetTuple(row), components);
  }
  cloud.label = label_of(name, components, component.has_value());
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
  vtkNew<vtkDataSetSurfaceFilter> surface;
  surface->SetInputData(reader->GetOutput());
  vtkNew<vtkFeatureEdges> edges;
  edges->SetInputConnection(surface->GetOutputPort());
  edges->BoundaryEdgesOn();
  edges->FeatureEdgesOn();
  edges->SetFeatureAngle(sharp_edge);
  edges->NonManifoldEdgesOff();
  edges->ManifoldEdgesOff();
  edges->Update();

  Outline outline{points_of(edges->GetOutput()), {}};
  vtkNew<vtkIdList> ends;
  vtkCellArray* lines = edges->GetOutput()->GetLines();
  for (lines->InitTraversal(); lines->GetNextCell(ends) != 0;)
    outline.edges.push_back({static_cast<Index>(ends->GetId(0)), static_cast<Index>(ends->GetId(1))});
  return outline;
}

}  // namespace talus::render
