#pragma once
// Reads files of write_particles() and write_mesh() without VTK's parsers, which check little: every count, size and position in the header
// is compared with the bytes of the file before memory is allocated or data are uncompressed.
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/types.hpp"

namespace talus {

/// Compressed blocks of an array in the file.
struct VtkBlocks {
  std::size_t sizes = 0, bytes = 0;  ///< position of their compressed sizes (8 bytes each), position of the first block
  std::uint64_t count = 0, size = 0,
                last_size = 0;  ///< number of blocks, uncompressed bytes of each, bytes of the last one if it is shorter (or 0)
  std::uint64_t unpacked() const noexcept { return count == 0 ? 0 : (count - 1) * size + (last_size == 0 ? size : last_size); }
};

struct VtkArray {
  std::string section, name, type;  ///< "PointData", "velocity", "Float32"; a text has the type "String"
  int components = 1;
  std::string unit;  ///< empty for none
  VtkBlocks blocks;
};

/// One file in memory.
class VtkLayout {
 public:
  /// `kind`: "PolyData" or "UnstructuredGrid".  Throws EnvironmentError with the name of the file if it is missing, damaged, or not written
  /// by Talus.  Afterwards all lengths in the header are valid; the contents of the blocks have not been checked.
  VtkLayout(const std::filesystem::path& file, std::string_view kind);

  std::size_t n_points() const noexcept { return n_points_; }
  std::size_t n_cells() const noexcept { return n_cells_; }  ///< number of cells of a mesh
  std::span<const VtkArray> arrays() const noexcept { return arrays_; }
  /// The array of that name in that section, or nullptr.
  const VtkArray* find(std::string_view section, std::string_view name) const noexcept;

  /// The numbers of an array, with single precision and integers converted to double.  Throws EnvironmentError if its blocks are damaged.
  std::vector<Real> numbers(const VtkArray& array) const;
  /// The numbers of an array of the type Int64 or Int32.  Throws EnvironmentError for another type or damaged blocks.
  std::vector<std::int64_t> whole_numbers(const VtkArray& array) const;
  std::string text(const VtkArray& array) const;
  /// Throws EnvironmentError: the file cannot be read or is damaged, with the reason.
  [[noreturn]] void fail(const std::string& why) const;

 private:
  void read_head(std::string_view kind);
  void check_sizes() const;
  VtkBlocks blocks_at(std::size_t at) const;
  std::vector<std::byte> unpacked(const VtkArray& array) const;

  std::filesystem::path file_;
  std::string bytes_;
  std::size_t n_points_ = 0, n_cells_ = 0;
  bool has_cells_ = false;
  std::vector<VtkArray> arrays_;
};

}  // namespace talus
