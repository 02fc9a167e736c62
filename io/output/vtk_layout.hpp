#pragma once
// What write_particles() and write_mesh() have written, taken apart without VTK's parsers, which check little of what they read: every count, size and
// place in the head is compared with the bytes that are there before anything is allocated or unpacked.
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/types.hpp"

namespace talus {

/// Packed blocks of an array in the file.
struct VtkBlocks {
  std::size_t sizes = 0, bytes = 0;  ///< where their packed sizes are (8 bytes each), where the first begins
  std::uint64_t count = 0, size = 0,
                last_size = 0;  ///< number of blocks, bytes of each when unpacked, of the last if it is not whole (or 0)
  std::uint64_t unpacked() const noexcept { return count == 0 ? 0 : (count - 1) * size + (last_size == 0 ? size : last_size); }
};

struct VtkArray {
  std::string section, name, type;  ///< "PointData", "velocity", "Float32"; a text has the type "String"
  int components = 1;
  std::string unit;  ///< empty for none
  VtkBlocks blocks;
};

/// One file, in memory.
class VtkLayout {
 public:
  /// `kind`: "PolyData" or "UnstructuredGrid".  EnvironmentError naming the file: it is not there, it is damaged, or it is not written by Talus.
  /// All that the head says of lengths is right afterwards; what is packed in the blocks has not been looked at.
  VtkLayout(const std::filesystem::path& file, std::string_view kind);

  std::size_t n_points() const noexcept { return n_points_; }
  std::size_t n_cells() const noexcept { return n_cells_; }  ///< of a mesh
  std::span<const VtkArray> arrays() const noexcept { return arrays_; }
  /// Nothing: there is none of that name in that section.
  const VtkArray* find(std::string_view section, std::string_view name) const noexcept;

  /// The numbers of an array, its single precision and whole numbers widened.  EnvironmentError: its blocks are damaged.
  std::vector<Real> numbers(const VtkArray& array) const;
  /// Of the type Int64 or Int32.  EnvironmentError: of another one, or damaged.
  std::vector<std::int64_t> whole_numbers(const VtkArray& array) const;
  std::string text(const VtkArray& array) const;
  /// EnvironmentError: cannot read the file, it is damaged, for this reason.
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
