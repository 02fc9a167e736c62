// HDF5 behind ArrayReader.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>
#include <utility>

#include "core/error.hpp"
#include "core/library_call.hpp"
#include "io/checkpoint/array_digest.hpp"
#include "io/checkpoint/hdf5.hpp"
#include "io/files/atomic_file.hpp"

namespace talus {

using namespace hdf5;

namespace fs = std::filesystem;

struct ArrayReader::Opened {
  fs::path name;
  std::uintmax_t bytes;
  Handle file;

  /// The kind of object at a path; nothing if there is no link.
  H5O_type_t kind(const std::string& path) const
  {
    auto steps = groups_around(path);
    steps.push_back(path);
    H5O_info_t info{};
    info.type = H5O_TYPE_GROUP;
    for (const std::string& step : steps) {
      const htri_t exists = info.type == H5O_TYPE_GROUP ? H5Lexists(file.id(), step.c_str(), H5P_DEFAULT) : 0;
      if (exists == 0)
        return H5O_TYPE_UNKNOWN;
      if (exists < 0 || H5Oget_info_by_name2(file.id(), step.c_str(), &info, H5O_INFO_BASIC, H5P_DEFAULT) < 0)
        refuse_damaged(name, step);
    }
    return info.type;
  }

  /// Opens an array or a text.
  Handle open(const std::string& path) const
  {
    const H5O_type_t found = kind(path);
    if (found == H5O_TYPE_UNKNOWN)
      refuse(name, path, "is not there");
    if (found != H5O_TYPE_DATASET)
      refuse(name, path, "is a group of arrays, not an array");
    Handle array(H5Dopen2(file.id(), path.c_str(), H5P_DEFAULT), H5Dclose);
    if (!array.is_open())
      refuse_damaged(name, path);
    return array;
  }

  Handle type_of(const Handle& array, const std::string& path) const
  {
    Handle type(H5Dget_type(array.id()), H5Tclose);
    if (!type.is_open())
      refuse_damaged(name, path);
    return type;
  }

  /// The extents of an array.  Nothing is compressed, so an array larger than its file is an error; this is checked before memory is
  /// allocated.
  Extents shape_of(const Handle& array, std::size_t value_bytes, const std::string& path) const
  {
    const Handle space(H5Dget_space(array.id()), H5Sclose);
    const int rank = H5Sget_simple_extent_ndims(space.id());
    if (rank < 0)
      refuse_damaged(name, path);
    if (rank != 1 && rank != 2)
      refuse(name, path, fmt::format("has {} dimensions, not one or two", rank));
    std::array<hsize_t, 2> dims{0, 1};
    if (H5Sget_simple_extent_dims(space.id(), dims.data(), nullptr) < 0)
      refuse_damaged(name, path);
    if (dims[1] > static_cast<hsize_t>(std::numeric_limits<int>::max()) || dims[1] == 0 || value_bytes == 0 ||
        dims[0] > bytes / value_bytes / dims[1])
      refuse(name, path, fmt::format("is damaged (it claims {} rows of {} values in a file of {} bytes)", dims[0], dims[1], bytes));
    return {dims[0], dims[1]};
  }

  std::string unit_of(const Handle& array, const std::string& path) const
  {
    const htri_t exists = H5Aexists(array.id(), unit_name);
    if (exists == 0)
      return "";
    const Handle attribute(H5Aopen(array.id(), unit_name, H5P_DEFAULT), H5Aclose);
    const Handle type(H5Aget_type(attribute.id()), H5Tclose);
    const std::size_t size = H5Tget_size(type.id());
    if (exists < 0 || !attribute.is_open() || H5Tequal(type.id(), text_type(size).id()) <= 0 || size > bytes ||
        H5Aget_storage_size(attribute.id()) != size)
      refuse(name, path, "is damaged (its unit is unreadable)");
    std::string unit(size, '\0');
    if (H5Aread(attribute.id(), type.id(), unit.data()) < 0)
      refuse_damaged(name, path);
    return unit;
  }

  /// The words of an attribute; empty if it does not exist.
  std::vector<std::uint64_t> words_of(const Handle& array, const char* attribute_name, const std::string& path) const
  {
    const htri_t exists = H5Aexists(array.id(), attribute_name);
    if (exists == 0)
      return {};
    const Handle attribute(H5Aopen(array.id(), attribute_name, H5P_DEFAULT), H5Aclose);
    const Handle type(H5Aget_type(attribute.id()), H5Tclose), space(H5Aget_space(attribute.id()), H5Sclose);
    const hsize_t size = attribute.is_open() ? H5Aget_storage_size(attribute.id()) : 0;
    const hssize_t n = H5Sget_simple_extent_npoints(space.id());
    std::vector<std::uint64_t> words(size <= bytes ? size / sizeof(std::uint64_t) : 0);
    if (exists < 0 || words.empty() || H5Tequal(type.id(), H5T_NATIVE_UINT64) <= 0 || std::cmp_not_equal(n, words.size()) ||
        H5Aread(attribute.id(), type.id(), words.data()) < 0)
      refuse(name, path, "has no readable digest: it is damaged, or another program wrote it");
    return words;
  }

  [[noreturn]] void refuse_values(const std::string& path) const { refuse(name, path, "is damaged (the values do not fit their digest)"); }

  /// Reads an open and checked array: the rows from `first` on, and the remaining rows of their pieces to check the digests.
  void get(const Handle& array, hid_t type, const Extents& shape, std::size_t first, std::span<std::byte> to, const std::string& path) const
  {
    const std::uint64_t meaning = digest_of(path, type_word(type), shape, unit_of(array, path));
    const auto digest = words_of(array, digest_name, path), words = words_of(array, pieces_name, path);
    if (digest.size() != 1)
      refuse(name, path, "has no readable digest: it is damaged, or another program wrote it");
    Pieces pieces{{0, static_cast<std::int64_t>(shape.rows), std::max<std::int64_t>(static_cast<std::int64_t>(shape.rows), 1)}, {}};
    if (!words.empty()) {
      constexpr std::uint64_t longest = std::uint64_t{1} << 40;
      if (words.size() < 2 || words[0] == 0 || words[0] > longest || words[1] >= words[0])
        refuse_values(path);
      pieces.all.piece = static_cast<std::int64_t>(words[0]), pieces.all.lead = static_cast<std::int64_t>(words[1]);
      pieces.digests.assign(words.begin() + 2, words.end());
      if (std::cmp_not_equal(pieces.digests.size(), pieces.all.pieces()) || pieces.digest(meaning) != digest[0])
        refuse_values(path);
    }
    if (shape.rows == 0 && pieces.digest(meaning) != digest[0])
      refuse_values(path);
    const std::size_t row_bytes = shape.columns * H5Tget_size(type);
    const std::size_t last = first + to.size() / row_bytes;  // one after the last
    for (std::size_t row = first; row < last;) {
      const std::int64_t number = pieces.all.piece_of(static_cast<std::int64_t>(row));
      const auto begin = static_cast<std::size_t>(pieces.all.begin_of(number)),
                 end = static_cast<std::size_t>(pieces.all.begin_of(number + 1));
      std::vector<std::byte> room;  // buffer for a piece that is wanted only in part
      std::span<std::byte> piece = to.subspan((row - first) * row_bytes, (std::min(end, last) - row) * row_bytes);
      const std::span<std::byte> wanted = piece;
      if (begin < row || end > last) {
        room.resize((end - begin) * row_bytes);
        piece = room;
      }
      read_piece(array, type, shape, begin, end - begin, piece, path);
      if (!room.empty())
        std::copy_n(room.begin() + static_cast<std::ptrdiff_t>((row - begin) * row_bytes), wanted.size(), wanted.begin());
      const std::uint64_t found = digest_of(piece, meaning);
      const bool fits = words.empty() ? Pieces{pieces.all, {found}}.digest(meaning) == digest[0]
                                      : found == pieces.digests[static_cast<std::size_t>(number)];
      if (!fits)
        refuse_values(path);
      row = end;
    }
  }

  void read_piece(const Handle& array, hid_t type, const Extents& shape, std::size_t first, std::size_t rows, std::span<std::byte> to,
                  const std::string& path) const
  {
    const Handle in_file(H5Dget_space(array.id()), H5Sclose);
    const std::array<hsize_t, 2> from{first, 0}, count{rows, shape.columns};
    const hsize_t n = rows * shape.columns;
    const Handle in_memory(H5Screate_simple(1, &n, nullptr), H5Sclose);
    if (H5Sselect_hyperslab(in_file.id(), H5S_SELECT_SET, from.data(), nullptr, count.data(), nullptr) < 0 ||
        H5Dread(array.id(), type, in_memory.id(), in_file.id(), H5P_DEFAULT, to.data()) < 0)
      refuse_damaged(name, path);
  }

  Extents check_array(const Handle& array, hid_t wanted, hsize_t columns, const std::string& path) const
  {
    const Handle type = type_of(array, path);
    if (H5Tequal(type.id(), wanted) <= 0)
      refuse(name, path, fmt::format("holds {}, not {}", type_word(type.id()), type_word(wanted)));
    const Extents shape = shape_of(array, H5Tget_size(type.id()), path);
    if (shape.columns != columns)
      refuse(name, path, fmt::format("has {} columns, not {}", shape.columns, columns));
    return shape;
  }
};

ArrayReader::ArrayReader(const fs::path& file)
{
  const LibraryCall at_work("HDF5", "reading", file.native());
  keep_quiet();
  const std::string_view mark = "\x89HDF\r\n\x1a\n";
  std::string begin(mark.size(), '\0');
  if (const auto why = not_ordinary(file))
    throw EnvironmentError(fmt::format("cannot read {}: it {}", file.string(), *why));
  std::ifstream stream(file, std::ios::binary);
  if (!stream)
    throw EnvironmentError(fmt::format("cannot read {}: {}", file.string(), std::strerror(errno)));
  if (!stream.read(begin.data(), static_cast<std::streamsize>(begin.size())) || begin != mark)
    throw EnvironmentError(fmt::format("{} is not an HDF5 file, or its beginning is damaged", file.string()));
  stream.close();
  std::error_code failed;
  const std::uintmax_t bytes = fs::file_size(file, failed);
  if (failed)
    throw EnvironmentError(fmt::format("cannot read {}: {}", file.string(), failed.message()));
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_file_locking(access.id(), false, true);  // some cluster file systems do not support locks
  Handle opened(H5Fopen(file.c_str(), H5F_ACC_RDONLY, access.id()), H5Fclose);
  if (!opened.is_open())
    refuse_damaged(file, "");
  opened_ = std::make_unique<Opened>(Opened{file, bytes, std::move(opened)});
}

ArrayReader::~ArrayReader() = default;

bool ArrayReader::has(const std::string& path) const { return opened_->kind(path) != H5O_TYPE_UNKNOWN; }

std::vector<std::string> ArrayReader::names(const std::string& group) const
{
  const LibraryCall at_work("HDF5", "reading", opened_->name.native());
  const H5O_type_t kind = group.empty() ? H5O_TYPE_GROUP : opened_->kind(group);
  if (kind != H5O_TYPE_GROUP)
    refuse(opened_->name, group, kind == H5O_TYPE_UNKNOWN ? "is not there" : "is not a group");
  const Handle opened(H5Gopen2(opened_->file.id(), group.empty() ? "/" : group.c_str(), H5P_DEFAULT), H5Gclose);
  std::vector<std::string> found;
  const auto add = [](hid_t, const char* name, const H5L_info_t*, void* to) -> herr_t {
    try {
      static_cast<std::vector<std::string>*>(to)->emplace_back(name);
      return 0;
    } catch (...) {  // exceptions must not pass through C
      return -1;
    }
  };
  if (!opened.is_open() || H5Literate(opened.id(), H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, add, &found) < 0)
    refuse_damaged(opened_->name, group);
  std::sort(found.begin(), found.end());
  return found;
}

template <class T>
std::vector<T> ArrayReader::read(const std::string& path, int columns) const
{
  const LibraryCall at_work("HDF5", "reading", opened_->name.native());
  const Handle array = opened_->open(path);
  const Extents shape = opened_->check_array(array, type_id<T>(), static_cast<hsize_t>(columns), path);
  std::vector<T> values(shape.rows * shape.columns);
  opened_->get(array, type_id<T>(), shape, 0, std::as_writable_bytes(std::span(values)), path);
  return values;
}

template <class T>
void ArrayReader::read_into(const std::string& path, std::span<T> to, int columns) const
{
  const LibraryCall at_work("HDF5", "reading", opened_->name.native());
  const Handle array = opened_->open(path);
  const Extents shape = opened_->check_array(array, type_id<T>(), static_cast<hsize_t>(columns), path);
  if (shape.rows * shape.columns != to.size())
    refuse(opened_->name, path, fmt::format("has {} rows, not {}", shape.rows, to.size() / shape.columns));
  opened_->get(array, type_id<T>(), shape, 0, std::as_writable_bytes(to), path);
}

template <class T>
void ArrayReader::read_rows(const std::string& path, std::size_t first, std::span<T> to, int columns) const
{
  const LibraryCall at_work("HDF5", "reading", opened_->name.native());
  const Handle array = opened_->open(path);
  const Extents shape = opened_->check_array(array, type_id<T>(), static_cast<hsize_t>(columns), path);
  if (first > shape.rows || to.size() / shape.columns > shape.rows - first)
    refuse(opened_->name, path, fmt::format("has {} rows, not {}", shape.rows, first + to.size() / shape.columns));
  opened_->get(array, type_id<T>(), shape, first, std::as_writable_bytes(to), path);
}

std::size_t ArrayReader::rows(const std::string& path) const
{
  const LibraryCall at_work("HDF5", "reading", opened_->name.native());
  const Handle array = opened_->open(path);
  const Handle type = opened_->type_of(array, path);
  if (H5Tget_class(type.id()) == H5T_STRING)
    refuse(opened_->name, path, "holds text, not numbers");
  return opened_->shape_of(array, H5Tget_size(type.id()), path).rows;
}

std::string ArrayReader::unit(const std::string& path) const { return opened_->unit_of(opened_->open(path), path); }

std::string ArrayReader::text(const std::string& path) const
{
  const LibraryCall at_work("HDF5", "reading", opened_->name.native());
  const Handle array = opened_->open(path);
  const Handle type = opened_->type_of(array, path);
  const std::size_t size = H5Tget_size(type.id());
  if (H5Tget_class(type.id()) != H5T_STRING)
    refuse(opened_->name, path, fmt::format("holds {}, not text", type_word(type.id())));
  const Extents shape = opened_->shape_of(array, size, path);
  if (H5Tequal(type.id(), text_type(size).id()) <= 0 || shape.columns != 1 || shape.rows > 1)
    refuse(opened_->name, path, "is not one text of a known size");
  std::string text(shape.rows * size, '\0');
  opened_->get(array, type.id(), shape, 0, std::as_writable_bytes(std::span(text)), path);
  return text;
}

template std::vector<double> ArrayReader::read(const std::string&, int) const;
template std::vector<float> ArrayReader::read(const std::string&, int) const;
template std::vector<std::int32_t> ArrayReader::read(const std::string&, int) const;
template std::vector<std::int64_t> ArrayReader::read(const std::string&, int) const;
template std::vector<std::uint8_t> ArrayReader::read(const std::string&, int) const;
template void ArrayReader::read_into(const std::string&, std::span<double>, int) const;
template void ArrayReader::read_rows(const std::string&, std::size_t, std::span<double>, int) const;
template void ArrayReader::read_into(const std::string&, std::span<float>, int) const;
template void ArrayReader::read_rows(const std::string&, std::size_t, std::span<float>, int) const;
template void ArrayReader::read_into(const std::string&, std::span<std::int32_t>, int) const;
template void ArrayReader::read_rows(const std::string&, std::size_t, std::span<std::int32_t>, int) const;
template void ArrayReader::read_into(const std::string&, std::span<std::int64_t>, int) const;
template void ArrayReader::read_rows(const std::string&, std::size_t, std::span<std::int64_t>, int) const;
template void ArrayReader::read_into(const std::string&, std::span<std::uint8_t>, int) const;
template void ArrayReader::read_rows(const std::string&, std::size_t, std::span<std::uint8_t>, int) const;

}  // namespace talus
