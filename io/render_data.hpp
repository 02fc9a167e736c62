#pragma once
// What a picture is made of, read back from the result files: particles with one number each, and the edges of the mesh.
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace talus::render {

struct ResultFile {
  Real time;  ///< s
  std::filesystem::path path;
};

struct Cloud {
  std::vector<Vec3> x;      ///< m
  std::vector<Real> value;  ///< one per particle, in SI units
  std::string label, unit;  ///< of the values; empty where the file says nothing
};

struct Outline {
  std::vector<Vec3> nodes;
  std::vector<std::array<Index, 2>> edges;
};

struct Bounds {
  Vec3 low, high;
};

/// The files that particles.pvd of a run's folder lists.  EnvironmentError if there is none or it lists nothing.
std::vector<ResultFile> particle_files(const std::filesystem::path& folder);

/// Particles of a .vtp with one field: scalars as they are, vectors by their length, symmetric tensors by their von Mises value;
/// "velocity:x" and "stress:xy" are components.  Without a name: displacement, else velocity, else the first field there is.
/// Error (which fields there are) if the name is unknown; EnvironmentError if the file cannot be read.
Cloud read_cloud(const std::filesystem::path& file, const std::optional<std::string>& field);

/// Edges to draw of mesh.vtu, or of the first file of mesh.pvd: the boundary in 2-D, sharp edges of the boundary in 3-D.
/// Nothing if the folder has no mesh.
Outline read_outline(const std::filesystem::path& folder);

/// Two opposite corners, or nothing for an empty cloud.
std::optional<Bounds> bounds_of(const std::vector<Vec3>& x);

/// How much each particle faces `light` [-1, 1] if it lies at the surface of the cloud; zero deep inside.  The normal points away
/// from the centre of mass of the neighbours within `reach` [m].
std::vector<Real> facing(const Cloud& cloud, const Vec3& light, Real reach);

}  // namespace talus::render
