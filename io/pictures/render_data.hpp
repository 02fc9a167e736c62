#pragma once
// Data of a picture, read from the result files: particles with one value each, and lines of the mesh.
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/pictures/render_density.hpp"
#include "io/pictures/settings/picture_settings.hpp"

namespace talus::render {

/// The coordinates, three numbers per point.
inline std::span<const Real> numbers_of(const std::vector<Vec3>& points)
{
  static_assert(sizeof(Vec3) == 3 * sizeof(Real));
  return {points.empty() ? nullptr : points.front().data(), 3 * points.size()};
}

struct ResultFile {
  Real time;  ///< time of the frame [s]
  std::filesystem::path path;
};

struct Cloud {
  std::vector<Vec3> x;      ///< positions [m]
  std::vector<Real> value;  ///< one value per particle, in SI units
  std::string label, unit;  ///< label and unit of the values; empty if not in the file
  std::vector<std::int64_t> ids;
  std::vector<Real> volume = {};  ///< m^3, m^2 in 2-D; empty if not in the file
};

struct Lines {
  std::vector<Vec3> points;  ///< positions [m]
  std::vector<std::array<Index, 2>> ends;
};

struct Bounds {
  Vec3 low, high;
};

/// The files listed in particles.pvd of a results folder.  Throws EnvironmentError if it is missing or lists nothing.
std::vector<ResultFile> particle_files(const std::filesystem::path& folder);

/// What pictures of a run can show, from its number of frames and the first readable one.  A run is 2-D if all particles of that frame have
/// z = 0.
RunFacts facts_of(const std::filesystem::path& first, std::size_t n_frames);

/// The particles of a .vtp with one field: scalars, lengths of vectors, von Mises values of symmetric tensors; "velocity:x" and "stress:xy"
/// are components.  Without a name: displacement, else velocity, else the first field.  Throws Error with the existing fields if the name
/// is unknown, EnvironmentError if the file cannot be read.
Cloud read_cloud(const std::filesystem::path& file, const std::optional<std::string>& field);

/// Lines of mesh.vtu, or of the first file of mesh.pvd.  outline: the boundary in 2-D, sharp edges of the boundary in 3-D; edges: all edges
/// of cells, in 3-D those of boundary facets.  Nothing if the folder has no mesh.
Lines read_mesh_lines(const std::filesystem::path& folder, MeshLines which);
/// The lines in a data set of VTK.
Lines lines_of(vtkPolyData* data);

/// The particles of a .vtp by the number of their body, with values if a field is named.  Throws Error if there is no field "volume"; other
/// errors as for read_cloud().
std::map<int, Matter> read_bodies(const std::filesystem::path& file, const std::optional<std::string>& field);

/// The low and high corner of the bounding box; nothing for an empty cloud.
std::optional<Bounds> bounds_of(const std::vector<Vec3>& x);

/// The cosine of the angle between the normal of each surface particle and `light`; zero in the interior.  The normal points away from the
/// centre of mass of the neighbours within `reach` [m].
std::vector<Real> facing(const Cloud& cloud, const Vec3& light, Real reach);

}  // namespace talus::render
