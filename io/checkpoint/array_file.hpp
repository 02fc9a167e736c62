#pragma once
// Arrays and texts by path ("particles/position") in one file; what is read back is bitwise what was written, or an error.
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/parallel/slices.hpp"

namespace talus {

class Communicator;

enum class NumberKind : std::uint8_t { float64, float32, int32, int64, uint8 };
template <class T>
constexpr NumberKind number_kind()
{
  if constexpr (std::is_same_v<T, double>)
    return NumberKind::float64;
  else if constexpr (std::is_same_v<T, float>)
    return NumberKind::float32;
  else if constexpr (std::is_same_v<T, std::int32_t>)
    return NumberKind::int32;
  else if constexpr (std::is_same_v<T, std::int64_t>)
    return NumberKind::int64;
  else {
    static_assert(std::is_same_v<T, std::uint8_t>);
    return NumberKind::uint8;
  }
}

/// An array that ranks write together: the rows of this rank, as they lie in memory.
struct SharedArray {
  std::string path;
  NumberKind kind;
  int columns;
  std::string unit;
  const std::byte* first;    ///< first of the rows, each of `columns` numbers, at a distance of `stride` bytes
  std::size_t rows, stride;  ///< number of rows on this rank; bytes from row to row
  Slice slice;               ///< the position of these rows in the array: whole pieces
};

/// Writes a file in the format HDF5, which other programs can read.  Every array and every text also has a digest that ArrayReader checks,
/// for pieces of rows (core/parallel/slices.hpp) and for all of them.  Equal calls write equal bytes.  Here and below, paths are names
/// between single slashes; anything else is std::invalid_argument.  Only one thread of the process may use these classes at a time, because
/// the HDF5 library is not thread-safe.
class ArrayWriter {
 public:
  /// Starts a new file, replacing an existing one.  Throws EnvironmentError with the name of the file.  To replace a file atomically, call
  /// it inside write_whole().
  explicit ArrayWriter(const std::filesystem::path& file);
  /// Closes the file and ignores errors: call close() where the file matters.
  ~ArrayWriter();
  ArrayWriter(const ArrayWriter&) = delete;
  ArrayWriter& operator=(const ArrayWriter&) = delete;

  /// Writes values row by row, `columns` in each row.  T: double, float, std::int32_t, std::int64_t, std::uint8_t.  An array may be empty.
  /// `unit` is for readers, such as "m/s"; empty for a pure number.  Throws EnvironmentError if the disk is full, std::invalid_argument if
  /// the path exists or the values are not whole rows.
  template <class T>
  void write(const std::string& path, std::span<const T> values, int columns = 1, const std::string& unit = "");
  /// Writes a text of any bytes.
  void write(const std::string& path, std::string_view text);
  /// Completes the file; throws EnvironmentError if that fails.  Nothing can be written afterwards.
  void close();

 private:
  friend void write_arrays(Communicator&, const std::filesystem::path&, std::span<const SharedArray>,
                           const std::function<void(ArrayWriter&)>&);
  struct Opened;
  std::unique_ptr<Opened> opened_;
};

/// Writes a file by all ranks together, as write_together(): rest(writer) on the root, and the rows of each rank at their positions.  The
/// bytes do not depend on the number of ranks or on the stride.
void write_arrays(Communicator& ranks, const std::filesystem::path& file, std::span<const SharedArray> shared,
                  const std::function<void(ArrayWriter&)>& rest);

/// Reads a file written by ArrayWriter.  Anything damaged, missing or of another type than requested is an EnvironmentError that names file
/// and path; a wrong value is never returned.
class ArrayReader {
 public:
  /// Opens a file.  Throws EnvironmentError if it is missing, of another kind, truncated or damaged.  Arrays are checked when they are
  /// read.
  explicit ArrayReader(const std::filesystem::path& file);
  ~ArrayReader();
  ArrayReader(const ArrayReader&) = delete;
  ArrayReader& operator=(const ArrayReader&) = delete;

  /// Whether there is an array, a text or a group at a path.
  bool has(const std::string& path) const;
  /// The names of the members of a group, sorted; "" is the whole file.
  std::vector<std::string> names(const std::string& group) const;
  /// The values of an array, row by row.  Another type or another number of columns is an error.
  template <class T>
  std::vector<T> read(const std::string& path, int columns = 1) const;
  /// Reads an array into memory for as many rows.  After an error the values there are unspecified.
  template <class T>
  void read_into(const std::string& path, std::span<T> to, int columns = 1) const;
  /// Reads rows from `first` on, as many as fit.  Whole pieces are read and checked, so up to one more piece is read at both ends.
  template <class T>
  void read_rows(const std::string& path, std::size_t first, std::span<T> to, int columns = 1) const;
  /// The number of rows of an array of any type.
  std::size_t rows(const std::string& path) const;
  /// The unit of an array, empty for a pure number.
  std::string unit(const std::string& path) const;
  std::string text(const std::string& path) const;

 private:
  struct Opened;
  std::unique_ptr<Opened> opened_;
};

}  // namespace talus
