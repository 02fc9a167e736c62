#pragma once
// Files for ParaView: particles (.vtp), fields on the mesh (.vtu) and their time series (.pvd).
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/field_component.hpp"
#include "core/parallel/slices.hpp"
#include "mesh/mesh.hpp"

namespace talus {

class Communicator;

/// One field, item after item, in single precision: for display, not for restarts.
struct Column {
  std::string name;
  int components = 1;         ///< 1 scalar, 3 vector, 6 symmetric tensor xx, yy, zz, xy, yz, xz, 9 tensor by rows
  std::vector<float> values;  ///< components * number of items
  std::string unit = {};      ///< written with the field and shown in pictures; empty for none
};

/// Writes a .vtp (appended raw, LZ4, 64-bit headers) with one vertex per particle, the field "id" and the field "TimeValue" [s]; `made_by`,
/// the run that wrote it, is the field "MadeBy" of the whole unless it is empty.  positions: 3 numbers per particle [m], z = 0 in 2-D.
/// There may be no particles; values are not checked.  Throws EnvironmentError with the name of the file, std::invalid_argument for
/// inconsistent lengths.
void write_particles(const std::filesystem::path& file, Real time, std::span<const Real> positions, std::span<const std::int64_t> ids,
                     std::span<const Column> columns, const std::string& made_by = {});

/// Writes the same file by all ranks together, each its slice of the particles; the bytes do not depend on the number of ranks.
void write_particles(Communicator& ranks, const std::filesystem::path& file, Real time, const Slice& slice, std::span<const Real> positions,
                     std::span<const std::int64_t> ids, std::span<const Column> columns, const std::string& made_by = {});

/// Writes a .vtu of the mesh with fields per node and per cell, in the numbering of `mesh`.  Errors as for write_particles().
template <int D>
void write_mesh(const std::filesystem::path& file, Real time, const Mesh<D>& mesh, std::span<const Column> node_columns,
                std::span<const Column> cell_columns, const std::string& made_by = {});

/// The part of a mesh that a rank writes: nodes and cells in the numbers of the whole.
struct MeshSlice {
  int dimension;
  Slice nodes;
  std::vector<Real> positions;  ///< 3 numbers per node [m]
  Slice cells;                  ///< in pieces of the same size as those of the nodes
  std::vector<Index> corners;   ///< dimension + 1 per cell, nodes of the whole mesh
};
/// Writes a .vtu by all ranks together.
void write_mesh(Communicator& ranks, const std::filesystem::path& file, Real time, const MeshSlice& mesh,
                std::span<const Column> node_columns, std::span<const Column> cell_columns, const std::string& made_by = {});

/// One field of a file, item after item; single precision is converted without loss.
struct StoredField {
  std::string name;
  int components = 1;
  std::vector<Real> values;  ///< components * number of items
  std::string unit = {};     ///< empty for none
};

struct StoredParticles {
  std::vector<std::int64_t> ids;
  std::vector<StoredField> fields;  ///< first "position" [m], 3 numbers per particle, then in the order of the file
  std::string made_by;              ///< empty if not in the file
};
/// Reads a file of write_particles().  Throws EnvironmentError with the name of the file if it is missing or damaged, or if its particles
/// have no ids.
StoredParticles read_particles(const std::filesystem::path& file);

/// The field of that name; nullptr if the file does not have it.
const StoredField* stored_field(const StoredParticles& particles, std::string_view name);

/// The shown value of each particle.
std::vector<Real> viewed_values(const StoredField& field, const ViewedField& viewed);

/// Names and numbers of components of the fields in such a file, without "id"; values are not read.  Errors as for read_particles().
std::vector<std::pair<std::string, int>> stored_particle_fields(const std::filesystem::path& file);

struct StoredMeshFields {
  std::vector<StoredField> nodes;  ///< first "position" [m], 3 numbers per node
  std::vector<StoredField> cells;
};
/// Reads a file of write_mesh() without the corners of the cells.  Errors as for read_particles().
StoredMeshFields read_mesh_fields(const std::filesystem::path& file);

/// The mesh in such a file.
struct StoredMesh {
  int dimension = 2;
  std::vector<Real> nodes;     ///< 3 numbers a node [m]
  std::vector<Index> corners;  ///< dimension + 1 a cell
};
/// Reads the mesh.  Errors as for read_particles().
StoredMesh read_mesh(const std::filesystem::path& file);

/// The list of the files of a run with their times.  Every append rewrites it atomically, so it is valid after a kill.
class PvdSeries {
 public:
  /// `made_by` is written into the list unless it is empty.
  explicit PvdSeries(std::filesystem::path file, std::string made_by = {}) : file_(std::move(file)), made_by_(std::move(made_by)) {}

  /// Reads the entries of an existing list up to `time` [s], for a run that is resumed there, and drops later ones.  Does nothing if there
  /// is no list.
  void resume(Real time);
  std::size_t size() const noexcept { return entries_.size(); }
  /// Adds a file; a path below the folder of the list is stored relative to it.  Entries at this time or later are replaced.
  void append(Real time, const std::filesystem::path& file);

 private:
  void drop_from(Real time);
  void save() const;
  std::filesystem::path file_;
  std::string made_by_;
  std::vector<std::pair<Real, std::string>> entries_;
};

/// The entries of a .pvd as (time [s], path that can be opened), in ascending order.  Throws EnvironmentError if it cannot be read.
std::vector<std::pair<Real, std::filesystem::path>> read_pvd(const std::filesystem::path& file);

}  // namespace talus
