// Reads files of particles, meshes and their lists.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "core/parallel/threads.hpp"
#include "io/files/atomic_file.hpp"
#include "io/output/vtk.hpp"
#include "io/output/vtk_layout.hpp"
#include "io/output/xml_tags.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view particles_kind = "PolyData", mesh_kind = "UnstructuredGrid";
constexpr std::string_view ids_field = "id", origin_field = "MadeBy", point_data = "PointData", cell_data = "CellData";
constexpr std::int64_t triangle = 5, tetrahedron = 10;  // VTK's types of cells

/// All fields of a section except the ids; those of points begin with the "position".
std::vector<StoredField> stored_fields(const VtkLayout& file, std::string_view section)
{
  std::vector<StoredField> fields;
  if (section == point_data) {
    fields.push_back({"position", 3, file.numbers(*file.find("Points", "Points")), "m"});
    const std::vector<Real>& places = fields.back().values;
    const auto wrong = std::ranges::find_if(places, [](Real x) { return !std::isfinite(x); });
    if (wrong != places.end())
      file.fail(fmt::format("position {} is not finite", (wrong - places.begin()) / 3));
  }
  for (const VtkArray& array : file.arrays())
    if (array.section == section && array.name != ids_field)
      fields.push_back({array.name, array.components, file.numbers(array), array.unit});
  return fields;
}

}  // namespace

StoredParticles read_particles(const fs::path& path)
{
  const VtkLayout file(path, particles_kind);
  const VtkArray* const ids = file.find(point_data, ids_field);
  if (ids == nullptr || ids->type != "Int64" || ids->components != 1)
    throw EnvironmentError(fmt::format("{}: its particles have no field \"{}\" of whole numbers", path.string(), ids_field));
  StoredParticles particles{file.whole_numbers(*ids), stored_fields(file, point_data), {}};
  if (const VtkArray* const origin = file.find("FieldData", origin_field); origin != nullptr && origin->type == "String")
    particles.made_by = file.text(*origin);
  return particles;
}

const StoredField* stored_field(const StoredParticles& particles, std::string_view name)
{
  const auto found = std::ranges::find(particles.fields, name, &StoredField::name);
  return found == particles.fields.end() ? nullptr : &*found;
}

std::vector<Real> viewed_values(const StoredField& field, const ViewedField& viewed)
{
  const auto width = static_cast<std::size_t>(field.components);
  const auto component = viewed.component_of(field.components);
  const std::span<const Real> all = field.values;
  std::vector<Real> values(all.size() / width);
  parallel_for(static_cast<Index>(values.size()), [&](Index i) {
    const auto entry = all.subspan(static_cast<std::size_t>(i) * width, width);
    values[static_cast<std::size_t>(i)] = component ? entry[static_cast<std::size_t>(*component)] : viewed_value(entry);
  });
  return values;
}

std::vector<std::pair<std::string, int>> stored_particle_fields(const fs::path& path)
{
  const VtkLayout file(path, particles_kind);
  std::vector<std::pair<std::string, int>> fields;
  for (const VtkArray& array : file.arrays())
    if (array.section == point_data && array.name != ids_field)
      fields.emplace_back(array.name, array.components);
  return fields;
}

StoredMeshFields read_mesh_fields(const fs::path& path)
{
  const VtkLayout file(path, mesh_kind);
  return {stored_fields(file, point_data), stored_fields(file, cell_data)};
}

StoredMesh read_mesh(const fs::path& path)
{
  const VtkLayout file(path, mesh_kind);
  StoredMesh mesh;
  mesh.nodes = std::move(stored_fields(file, point_data).front().values);
  const VtkArray *const corners = file.find("Cells", "connectivity"), *const ends = file.find("Cells", "offsets"),
                        *const types = file.find("Cells", "types");
  if (corners == nullptr || ends == nullptr || types == nullptr)
    file.fail("it has no cells");
  const std::vector<Real> type_of_cell = file.numbers(*types);
  mesh.dimension = !type_of_cell.empty() && type_of_cell.front() == tetrahedron ? 3 : 2;
  const std::int64_t width = mesh.dimension + 1;
  const std::vector<std::int64_t> end_of_cell = file.whole_numbers(*ends), nodes = file.whole_numbers(*corners);
  if (type_of_cell.size() != file.n_cells() || end_of_cell.size() != file.n_cells() ||
      nodes.size() != file.n_cells() * static_cast<std::size_t>(width))
    file.fail("its cells have other numbers of corners than triangles or tetrahedra");
  for (std::size_t c = 0; c < file.n_cells(); ++c)
    if (type_of_cell[c] != (mesh.dimension == 2 ? triangle : tetrahedron) || end_of_cell[c] != static_cast<std::int64_t>(c + 1) * width)
      throw EnvironmentError(fmt::format("{}: its cells are not all triangles, or all tetrahedra", path.string()));
  for (const std::int64_t node : nodes) {
    if (node < 0 || static_cast<std::size_t>(node) >= file.n_points())
      file.fail(fmt::format("a cell has the corner {}, of {} nodes", node, file.n_points()));
    mesh.corners.push_back(static_cast<Index>(node));
  }
  return mesh;
}

std::vector<std::pair<Real, fs::path>> read_pvd(const fs::path& path)
{
  const std::string text = read_whole(path);
  std::vector<std::pair<Real, fs::path>> entries;
  XmlTags tags(text);
  bool is_list = false, has_end = false;
  try {
    for (auto tag = tags.next(); tag; tag = tags.next()) {
      is_list = is_list || tag->name == "Collection";
      has_end = has_end || (tag->name == "VTKFile" && tag->kind == XmlTag::Kind::closes);
      if (!is_list || tag->name != "DataSet" || tag->kind == XmlTag::Kind::closes)
        continue;
      const std::string *const name = tag->find("file"), *const time_text = tag->find("timestep");
      Real time = std::numeric_limits<Real>::quiet_NaN();
      if (time_text != nullptr)
        if (const auto [end, error] = std::from_chars(time_text->data(), time_text->data() + time_text->size(), time);
            error != std::errc{} || end != time_text->data() + time_text->size())
          time = std::numeric_limits<Real>::quiet_NaN();
      if (name == nullptr || name->empty() || name->find('\0') != name->npos || !std::isfinite(time))
        throw EnvironmentError(fmt::format("entry {} has no file or no timestep", entries.size() + 1));
      entries.emplace_back(time, path.parent_path() / *name);
    }
  } catch (const EnvironmentError& wrong) {
    throw EnvironmentError(fmt::format("{}: {}", path.string(), wrong.what()));
  }
  if (!is_list)
    throw EnvironmentError(fmt::format("{} is not a list of VTK files (.pvd)", path.string()));
  if (!has_end)
    throw EnvironmentError(fmt::format("{} has no end: it has been cut short", path.string()));
  return entries;
}

}  // namespace talus
