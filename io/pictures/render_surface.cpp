// Surfaces from particles, written as PLY, STL and OBJ by VTK's writers.
#include "io/pictures/render_surface.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <vtkAppendPolyData.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkOBJWriter.h>
#include <vtkPLYWriter.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSTLWriter.h>
#include <vtkSmartPointer.h>
#include <vtkStripper.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <numeric>

#include "core/error.hpp"
#include "io/files/atomic_file.hpp"
#include "io/pictures/render_colours.hpp"
#include "io/pictures/render_series.hpp"

namespace talus::render {

namespace {

namespace fs = std::filesystem;
using Surface = vtkSmartPointer<vtkPolyData>;

constexpr auto colour_name = "colour";

/// Sets colours of vertices from their values.
void colour(vtkPolyData* surface)
{
  vtkDataArray* value = surface->GetPointData()->GetArray("value");
  const auto n = value->GetNumberOfTuples();
  std::vector<Real> values(static_cast<std::size_t>(n));
  for (vtkIdType i = 0; i < n; ++i)
    values[static_cast<std::size_t>(i)] = value->GetComponent(i, 0);
  Extent extent(false);
  extent.add(values);
  const Scale scale{Map::viridis, extent.range(false)};
  vtkNew<vtkUnsignedCharArray> colours;
  colours->SetName(colour_name);
  colours->SetNumberOfComponents(3);
  for (const Real v : values) {
    const Colour c = scale.colour(v);
    colours->InsertNextTuple3(c[0], c[1], c[2]);
  }
  surface->GetPointData()->AddArray(colours);
}

/// Joins segments to long lines, which drawing programs can use.
Surface joined(vtkPolyData* contour)
{
  vtkNew<vtkStripper> stripper;
  stripper->SetInputData(contour);
  stripper->SetMaximumLength(static_cast<int>(std::min<vtkIdType>(contour->GetNumberOfLines() + 1, std::numeric_limits<int>::max() - 1)));
  stripper->JoinContiguousSegmentsOn();
  stripper->Update();
  return stripper->GetOutput();
}

template <class Writer>
void write_as(Writer& writer, vtkPolyData* surface, const fs::path& file)
{
  writer.SetInputData(surface);
  write_whole(file, [&](const fs::path& temporary) {
    const fs::path named = temporary.string() + file.extension().string();  // the writer of .ply adds the ending if it is missing
    writer.SetFileName(named.c_str());
    const bool written = writer.Write() != 0;
    std::error_code failed;
    // Not every writer of VTK reports a full disk: each triangle takes at least twelve bytes.
    const bool whole = fs::file_size(named, failed) > 12 * static_cast<std::uintmax_t>(surface->GetNumberOfPolys());
    if (!failed)
      fs::rename(named, temporary, failed);
    if (written && whole && !failed && writer.GetErrorCode() == 0)
      return;
    fs::remove(named, failed);
    throw EnvironmentError(fmt::format("cannot write {}", file.string()));
  });
}

void write(vtkPolyData* surface, const fs::path& file)
{
  if (file.extension() == ".obj")
    return write_as(*vtkNew<vtkOBJWriter>(), surface, file);
  if (file.extension() == ".stl") {
    vtkNew<vtkSTLWriter> writer;
    writer->SetFileTypeToBinary();
    return write_as(*writer, surface, file);
  }
  vtkNew<vtkPLYWriter> writer;
  writer->SetFileTypeToBinary();
  if (surface->GetPointData()->HasArray(colour_name) != 0)
    writer->SetArrayName(colour_name);
  write_as(*writer, surface, file);
}

struct Extracted {
  Surface surface;
  std::string said;
};

Extracted extract(const Matter& matter, const std::string& name, const SurfaceSettings& settings, int dimension)
{
  const Real spacing = settings.spacing.value_or(default_spacing(matter, dimension));
  Extracted result{surface_of(matter, dimension, spacing, settings.level), {}};
  const Real held = std::accumulate(matter.volume.begin(), matter.volume.end(), 0.0), around = enclosed(result.surface, dimension);
  const char* unit = dimension == 2 ? "m^2" : "m^3";
  result.said =
      fmt::format("{}: {} {}, spacing {:.3g} m; encloses {:.6g} {}, its {} particles have {:.6g} {} ({:+.2f} %)", name,
                  dimension == 2 ? result.surface->GetNumberOfLines() : result.surface->GetNumberOfPolys(),
                  dimension == 2 ? "segments" : "triangles", spacing, around, unit, matter.x.size(), held, unit, 100 * (around / held - 1));
  return result;
}

std::vector<SurfaceSettings::Body> wanted_bodies(const SurfaceSettings& settings, const std::map<int, Matter>& there)
{
  if (!settings.bodies.empty())
    return settings.bodies;
  std::vector<SurfaceSettings::Body> all;
  for (const auto& [number, matter] : there)
    all.push_back({number, fmt::format("body {}", number)});
  return all;
}

/// Combines the surfaces of all bodies of one frame, with a line of text about each.
Extracted extract(const std::map<int, Matter>& bodies, const SurfaceSettings& settings, int dimension)
{
  vtkNew<vtkAppendPolyData> together;
  std::vector<std::string> said;
  for (const auto& [number, name] : wanted_bodies(settings, bodies)) {
    const auto found = bodies.find(number);
    if (found == bodies.end()) {
      said.push_back(fmt::format("{}: has no particles", name));
      continue;
    }
    const Extracted one = extract(found->second, name, settings, dimension);
    together->AddInputData(one.surface);
    said.push_back(one.said);
  }
  vtkNew<vtkPolyData> nothing;
  together->AddInputData(nothing);
  together->Update();
  Surface surface = together->GetOutput();
  if (surface->GetNumberOfCells() == 0)
    throw Error(fmt::format("--level, --spacing: nothing is as dense as {} of the inside, or the spacing is too wide to see it: {}",
                            settings.level, fmt::join(said, "; ")));
  if (settings.field)
    colour(surface);
  return {dimension == 2 ? joined(surface) : surface, fmt::format("{}", fmt::join(said, "\n"))};
}

fs::path numbered(const fs::path& file, std::size_t frame)
{
  return file.parent_path() / fmt::format("{}_{:04}{}", file.stem().string(), frame, file.extension().string());
}

}  // namespace

void make_surfaces(const SurfaceSettings& settings, const std::function<void(const fs::path&, const std::string&)>& written)
{
  FrameSeries series(particle_files(settings.folder));
  const RunFacts facts = series.first([&](const fs::path& file) { return facts_of(file, series.size()); });
  std::vector<std::string> problems;
  check(settings, facts, problems);
  require_none(problems);
  const auto frames = chosen(settings.frames, series.size());
  bool any = false;
  for (const std::size_t frame : frames) {
    const auto bodies = series.read(frame, [&](const fs::path& file) { return read_bodies(file, settings.field); });
    if (!bodies)
      continue;
    const Extracted result = extract(*bodies, settings, facts.dimension);
    const fs::path file = frames.size() > 1 ? numbered(settings.out, frame) : settings.out;
    write(result.surface, file);
    written(file, result.said);
    any = true;
  }
  if (!any)
    throw EnvironmentError("none of the frames that are asked for can be read");
}

}  // namespace talus::render
