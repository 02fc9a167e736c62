#pragma once
// Files for ParaView: particles (.vtp), fields on the mesh (.vtu) and their series in time (.pvd).
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/parallel/slices.hpp"
#include "mesh/mesh.hpp"

namespace talus {

class Communicator;

/// One field, item after item, in single precision: it is for viewing, not for restarting.
struct Column {
  std::string name;
  int components = 1;         ///< 1 scalar, 3 vector, 6 symmetric tensor xx, yy, zz, xy, yz, xz, 9 tensor by rows
  std::vector<float> values;  ///< components * number of items
  std::string unit = {};      ///< stored with the field, shown in pictures; empty for none
};

/// Writes a .vtp (appended raw, LZ4, 64-bit headers) with one vertex per particle, the field "id" and the field "TimeValue" [s]; `made_by`,
/// which run wrote it, as the field "MadeBy" of the whole, unless it is empty.
/// positions: 3 numbers per particle [m], z = 0 in 2-D.  Any number of particles, none included; values are written as they are.
/// Errors: EnvironmentError naming the file; std::invalid_argument for lengths that do not fit.
void write_particles(const std::filesystem::path& file, Real time, std::span<const Real> positions, std::span<const std::int64_t> ids,
                     std::span<const Column> columns, const std::string& made_by = {});

/// The same file written by all ranks together, each its slice of the particles: the same bytes for any number of them.
void write_particles(Communicator& ranks, const std::filesystem::path& file, Real time, const Slice& slice, std::span<const Real> positions,
                     std::span<const std::int64_t> ids, std::span<const Column> columns, const std::string& made_by = {});

/// Writes a .vtu of the mesh with fields per node and per cell, in the numbering of `mesh`.  Errors as above.
template <int D>
void write_mesh(const std::filesystem::path& file, Real time, const Mesh<D>& mesh, std::span<const Column> node_columns,
                std::span<const Column> cell_columns, const std::string& made_by = {});

/// What a rank writes of a mesh: nodes and cells in the numbers of the whole.
struct MeshSlice {
  int dimension;
  Slice nodes;
  std::vector<Real> positions;  ///< 3 numbers per node [m]
  Slice cells;                  ///< in pieces as large as those of the nodes
  std::vector<Index> corners;   ///< dimension + 1 per cell, nodes of the whole mesh
};
/// The same by all ranks together.
void write_mesh(Communicator& ranks, const std::filesystem::path& file, Real time, const MeshSlice& mesh,
                std::span<const Column> node_columns, std::span<const Column> cell_columns, const std::string& made_by = {});

/// One field as a file holds it, item after item; single precision is widened without loss.
struct StoredField {
  std::string name;
  int components = 1;
  std::vector<Real> values;  ///< components * number of items
  std::string unit = {};     ///< empty for none
};

struct StoredParticles {
  std::vector<std::int64_t> ids;
  std::vector<StoredField> fields;  ///< first "position" [m], 3 numbers per particle, then in the order of the file
  std::string made_by;              ///< empty if the file does not say
};
/// What write_particles has written.  EnvironmentError naming the file: it is not there, it is damaged, or its particles have no ids.
StoredParticles read_particles(const std::filesystem::path& file);

/// Names and numbers of components of the fields in such a file, "id" left out; none of their values are read.  Errors as above.
std::vector<std::pair<std::string, int>> stored_particle_fields(const std::filesystem::path& file);

struct StoredMeshFields {
  std::vector<StoredField> nodes;  ///< first "position" [m], 3 numbers per node
  std::vector<StoredField> cells;
};
/// What write_mesh has written, without the corners of the cells.  Errors as above.
StoredMeshFields read_mesh_fields(const std::filesystem::path& file);

/// The mesh itself in such a file.
struct StoredMesh {
  int dimension = 2;
  std::vector<Real> nodes;     ///< 3 numbers a node [m]
  std::vector<Index> corners;  ///< dimension + 1 a cell
};
/// Errors as above.
StoredMesh read_mesh(const std::filesystem::path& file);

/// The list of the files of a run with their times.  Rewritten as a whole by every append, so it is valid after a kill.
class PvdSeries {
 public:
  /// `made_by` is told in the list, unless it is empty.
  explicit PvdSeries(std::filesystem::path file, std::string made_by = {}) : file_(std::move(file)), made_by_(std::move(made_by)) {}

  /// Takes over the entries of an older list up to `time` [s], for a run that is resumed there, and forgets the later ones.  No list there:
  /// nothing to take.
  void resume(Real time);
  std::size_t size() const noexcept { return entries_.size(); }
  /// Adds a file; a path below the folder of the list is stored relative to it.  Entries that are not earlier give way.
  void append(Real time, const std::filesystem::path& file);

 private:
  void drop_from(Real time);
  void save() const;
  std::filesystem::path file_;
  std::string made_by_;
  std::vector<std::pair<Real, std::string>> entries_;
};

/// Entries of a .pvd as (time [s], path that can be opened), ascending as listed.  EnvironmentError if it cannot be read.
std::vector<std::pair<Real, std::filesystem::path>> read_pvd(const std::filesystem::path& file);

}  // namespace talus
