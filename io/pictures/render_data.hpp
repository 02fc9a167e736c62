#pragma once
// What a picture is made of, read back from the result files: particles with one number each, and lines of the mesh.
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

/// Three a point.
inline std::span<const Real> numbers_of(const std::vector<Vec3>& points)
{
  static_assert(sizeof(Vec3) == 3 * sizeof(Real));
  return {points.empty() ? nullptr : points.front().data(), 3 * points.size()};
}

struct ResultFile {
  Real time;  ///< s
  std::filesystem::path path;
};

struct Cloud {
  std::vector<Vec3> x;      ///< m
  std::vector<Real> value;  ///< one per particle, in SI units
  std::string label, unit;  ///< of the values; empty where the file says nothing
  std::vector<std::int64_t> ids;
  std::vector<Real> volume = {};  ///< m^3, m^2 in 2-D; empty where the file has none
};

struct Lines {
  std::vector<Vec3> points;  ///< m
  std::vector<std::array<Index, 2>> ends;
};

struct Bounds {
  Vec3 low, high;
};

/// The files that particles.pvd of a run's folder lists.  EnvironmentError if there is none or it lists nothing.
std::vector<ResultFile> particle_files(const std::filesystem::path& folder);

/// What pictures of a run with so many frames can show, of which this is the first that can be read.  A run is 2-D if all particles of that
/// frame have z = 0.
RunFacts facts_of(const std::filesystem::path& first, std::size_t n_frames);

/// Particles of a .vtp with one field: scalars as they are, vectors by their length, symmetric tensors by their von Mises value;
/// "velocity:x" and "stress:xy" are components.  Without a name: displacement, else velocity, else the first field there is.
/// Error (which fields there are) if the name is unknown; EnvironmentError if the file cannot be read.
Cloud read_cloud(const std::filesystem::path& file, const std::optional<std::string>& field);

/// Of mesh.vtu, or of the first file of mesh.pvd.  outline: the boundary in 2-D, sharp edges of the boundary in 3-D; edges: all edges of cells,
/// in 3-D of those facets of cells that make up the boundary.  Nothing if the folder has no mesh.
Lines read_mesh_lines(const std::filesystem::path& folder, MeshLines which);
/// The lines among the cells.
Lines lines_of(vtkPolyData* data);

/// Particles of a .vtp by the number of their body, with values if a field is named.  Error if there is no field "volume"; others as read_cloud.
std::map<int, Matter> read_bodies(const std::filesystem::path& file, const std::optional<std::string>& field);

/// Two opposite corners, or nothing for an empty cloud.
std::optional<Bounds> bounds_of(const std::vector<Vec3>& x);

/// How much each particle faces `light` [-1, 1] if it lies at the surface of the cloud; zero deep inside.  The normal points away
/// from the centre of mass of the neighbours within `reach` [m].
std::vector<Real> facing(const Cloud& cloud, const Vec3& light, Real reach);

}  // namespace talus::render
