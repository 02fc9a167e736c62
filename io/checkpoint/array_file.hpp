#pragma once
// Arrays and words by path ("particles/position") in one file: what is written is read back as the same bits or not at all.
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

/// An array that ranks write together: the rows of this one, as they lie in memory.
struct SharedArray {
  std::string path;
  NumberKind kind;
  int columns;
  std::string unit;
  const std::byte* first;    ///< of `columns` numbers there, and at every `stride` bytes from there
  std::size_t rows, stride;  ///< how many rows are here
  Slice slice;               ///< which they are: whole pieces
};

/// A file while it is being written, HDF5 inside.  Other programs read it as such; every array and every text also carries a digest
/// that ArrayReader checks, of pieces of rows (core/parallel/slices.hpp) and of all of them.  The same calls make the same bytes.  Here and below: paths are names between single slashes, anything
/// else is std::invalid_argument; one thread at a time in the whole process, the library behind is not made for more.
class ArrayWriter {
 public:
  /// Starts a new file, replacing an old one.  EnvironmentError names the file.  It is no write_whole(): call it inside of one.
  explicit ArrayWriter(const std::filesystem::path& file);
  /// Closes silently: call close() where the file matters.
  ~ArrayWriter();
  ArrayWriter(const ArrayWriter&) = delete;
  ArrayWriter& operator=(const ArrayWriter&) = delete;

  /// values: row by row, `columns` to a row.  T: double, float, std::int32_t, std::int64_t, std::uint8_t.  Empty arrays are arrays.
  /// unit: for readers, such as "m/s"; empty for a pure number.  EnvironmentError if the disk is full; std::invalid_argument if the
  /// path is taken or the values are no whole rows.
  template <class T>
  void write(const std::string& path, std::span<const T> values, int columns = 1, const std::string& unit = "");
  /// A text of any bytes.
  void write(const std::string& path, std::string_view text);
  /// The file is whole when this returns, EnvironmentError otherwise.  Nothing can be written afterwards.
  void close();

 private:
  friend void write_arrays(Communicator&, const std::filesystem::path&, std::span<const SharedArray>,
                           const std::function<void(ArrayWriter&)>&);
  struct Opened;
  std::unique_ptr<Opened> opened_;
};

/// Writes a file by all ranks together, as in write_together(): rest(writer) on the root, and the rows of each rank at their places.  The same
/// bytes for any number of ranks that share out the same rows, whatever the stride.
void write_arrays(Communicator& ranks, const std::filesystem::path& file, std::span<const SharedArray> shared,
                  const std::function<void(ArrayWriter&)>& rest);

/// A file that ArrayWriter wrote.  Whatever is damaged, missing or of another kind than asked for is an EnvironmentError that names the
/// file and the path; a wrong value is never returned.
class ArrayReader {
 public:
  /// EnvironmentError: not there, not such a file, cut short, damaged.  Arrays are checked as they are read.
  explicit ArrayReader(const std::filesystem::path& file);
  ~ArrayReader();
  ArrayReader(const ArrayReader&) = delete;
  ArrayReader& operator=(const ArrayReader&) = delete;

  /// An array, a text or a group.
  bool has(const std::string& path) const;
  /// What is directly in a group, sorted; "" is the whole file.
  std::vector<std::string> names(const std::string& group) const;
  /// The values, row by row.  An array of another type or another number of columns is an error.
  template <class T>
  std::vector<T> read(const std::string& path, int columns = 1) const;
  /// The same to a place that has as many rows.  After an error its values are unspecified.
  template <class T>
  void read_into(const std::string& path, std::span<T> to, int columns = 1) const;
  /// As many rows as there is room for, from `first` on: what is checked is read, hence up to a piece more at both ends.
  template <class T>
  void read_rows(const std::string& path, std::size_t first, std::span<T> to, int columns = 1) const;
  /// The rows of an array of any type.
  std::size_t rows(const std::string& path) const;
  /// The unit of an array, empty for a pure number.
  std::string unit(const std::string& path) const;
  std::string text(const std::string& path) const;

 private:
  struct Opened;
  std::unique_ptr<Opened> opened_;
};

}  // namespace talus
