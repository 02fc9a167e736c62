// HDF5 behind ArrayWriter.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>

#include "core/error.hpp"
#include "core/library_call.hpp"
#include "core/parallel/communicator.hpp"
#include "io/checkpoint/array_digest.hpp"
#include "io/checkpoint/hdf5.hpp"
#include "io/checkpoint/hdf5_disk.hpp"
#include "io/files/atomic_file.hpp"

namespace talus {

using namespace hdf5;

namespace {

namespace fs = std::filesystem;

/// Writes the rows of this rank at their positions in an array that begins at the byte `place`.
void put_rows(const SharedArray& array, std::size_t row_bytes, std::uint64_t place, const PutBytes& put, std::span<std::byte> room)
{
  place += static_cast<std::uint64_t>(array.slice.first) * row_bytes;
  if (array.stride == row_bytes)
    return put(place, {array.first, array.rows * row_bytes});
  for (std::size_t row = 0; row < array.rows;) {
    const std::size_t n = std::min(room.size() / row_bytes, array.rows - row);
    pack(array, row, row_bytes, room.first(n * row_bytes));
    put(place + row * row_bytes, room.first(n * row_bytes));
    row += n;
  }
}

bool write_attribute(const Handle& array, const char* name, hid_t type, const Handle& space, const void* value)
{
  Handle attribute(H5Acreate2(array.id(), name, type, space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  return attribute.is_open() && H5Awrite(attribute.id(), type, value) >= 0 && attribute.close();
}
bool write_attribute(const Handle& array, const char* name, hid_t type, const void* value)
{
  return write_attribute(array, name, type, Handle(H5Screate(H5S_SCALAR), H5Sclose), value);
}
bool write_attribute(const Handle& array, const char* name, const std::vector<std::uint64_t>& words)
{
  const hsize_t n = words.size();
  return write_attribute(array, name, H5T_NATIVE_UINT64, Handle(H5Screate_simple(1, &n, nullptr), H5Sclose), words.data());
}

/// The layout of arrays in the file: contiguous, so that the position is known to all ranks.
Handle array_layout()
{
  Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(layout.id(), false);  // no times, so that equal values give equal bytes
  H5Pset_layout(layout.id(), H5D_CONTIGUOUS);
  H5Pset_alloc_time(layout.id(), H5D_ALLOC_TIME_EARLY);
  H5Pset_fill_time(layout.id(), H5D_FILL_TIME_NEVER);
  return layout;
}

}  // namespace

struct ArrayWriter::Opened {
  explicit Opened(const fs::path& path)
      : name(path), disk(path), driver(register_driver(), H5FDunregister), file(disk.failure() == 0 ? create() : H5I_INVALID_HID, H5Fclose)
  {
    if (!file.is_open() || disk.failure() != 0)
      refuse_write("");
  }
  fs::path name;
  Disk disk;  // constructed before, so destroyed after the objects that write to it
  Handle driver;
  Handle file;

  static hid_t register_driver()
  {
    keep_quiet();
    const H5FD_class_t driver = Disk::driver();
    return H5FDregister(&driver);
  }

  hid_t create()
  {
    const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose), access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    H5Pset_obj_track_times(creation.id(), false);                             // no times, so that equal values give equal bytes
    H5Pset_libver_bounds(access.id(), H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);  // the formats whose metadata have checksums
    Disk* const below = &disk;
    H5Pset_driver(access.id(), driver.id(), &below);
    return H5Fcreate(name.c_str(), H5F_ACC_TRUNC, creation.id(), access.id());
  }

  [[noreturn]] void refuse_write(const std::string& path) const
  {
    const std::string why = disk.failure() != 0 ? std::strerror(disk.failure()) : last_words();
    throw EnvironmentError(fmt::format("cannot write {}{}{}: {}", name.string(), path.empty() ? "" : ": ", path, why));
  }

  bool is_taken(const std::string& path) const { return H5Lexists(file.id(), path.c_str(), H5P_DEFAULT) > 0; }

  void make_groups_around(const std::string& path) const
  {
    const auto groups = groups_around(path);
    const Handle creation(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
    H5Pset_obj_track_times(creation.id(), false);
    for (const std::string& group : groups)
      if (!is_taken(group) && !Handle(H5Gcreate2(file.id(), group.c_str(), H5P_DEFAULT, creation.id(), H5P_DEFAULT), H5Gclose).is_open())
        refuse_write(group);
  }

  /// Makes an array without values.
  Handle make(const std::string& path, hid_t type, const Extents& shape, const std::string& unit, const Pieces& pieces) const
  {
    if (!file.is_open())
      throw std::invalid_argument(fmt::format("{} is closed: {} cannot be written", name.string(), path));
    make_groups_around(path);
    if (is_taken(path))
      throw std::invalid_argument(fmt::format("{} has {} already", name.string(), path));
    const std::array<hsize_t, 2> dims{shape.rows, shape.columns};
    const Handle space(H5Screate_simple(shape.columns > 1 ? 2 : 1, dims.data(), nullptr), H5Sclose);
    Handle array(H5Dcreate2(file.id(), path.c_str(), type, space.id(), H5P_DEFAULT, array_layout().id(), H5P_DEFAULT), H5Dclose);
    const std::uint64_t digest = pieces.digest(digest_of(path, type_word(type), shape, unit));
    if (!array.is_open() || (!unit.empty() && !write_attribute(array, unit_name, text_type(unit.size()).id(), unit.data())) ||
        (pieces.digests.size() > 1 && !write_attribute(array, pieces_name, pieces.words())) ||
        !write_attribute(array, digest_name, H5T_NATIVE_UINT64, &digest))
      refuse_write(path);
    return array;
  }

  void put(const std::string& path, hid_t type, const Extents& shape, std::span<const std::byte> values, const std::string& unit) const
  {
    const auto rows = static_cast<std::size_t>(shape.rows), row_bytes = values.size() / std::max<std::size_t>(rows, 1);
    const Slice all{0, static_cast<std::int64_t>(rows)};
    const SharedArray bytes{path, NumberKind::uint8, static_cast<int>(row_bytes), {}, values.data(), rows, row_bytes, all};
    Handle array = make(path, type, shape, unit, {all, digests_of(bytes, 1, digest_of(path, type_word(type), shape, unit))});
    if ((!values.empty() && H5Dwrite(array.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) || !array.close() ||
        disk.failure() != 0)
      refuse_write(path);
  }

  /// Makes an array whose values other ranks write.  Returns its position in the file.
  std::uint64_t reserve(const SharedArray& array, const Extents& shape, const Pieces& pieces) const
  {
    Handle made = make(array.path, type_id(array.kind), shape, array.unit, pieces);
    const haddr_t place = shape.rows > 0 ? H5Dget_offset(made.id()) : 0;
    if (place == HADDR_UNDEF || !made.close() || disk.failure() != 0)
      refuse_write(array.path);
    return place;
  }
};

ArrayWriter::ArrayWriter(const fs::path& file) : opened_(std::make_unique<Opened>(file)) {}

ArrayWriter::~ArrayWriter() = default;

template <class T>
void ArrayWriter::write(const std::string& path, std::span<const T> values, int columns, const std::string& unit)
{
  if (columns < 1 || values.size() % static_cast<std::size_t>(columns) != 0)
    throw std::invalid_argument(fmt::format("{}: {} values are no rows of {}", path, values.size(), columns));
  const auto width = static_cast<hsize_t>(columns);
  opened_->put(path, type_id<T>(), {values.size() / width, width}, std::as_bytes(values), unit);
}

void ArrayWriter::write(const std::string& path, std::string_view text)
{
  opened_->put(path, text_type(text.size()).id(), {text.empty() ? 0U : 1U, 1}, std::as_bytes(std::span(text)), "");
}

void ArrayWriter::close()
{
  if (!opened_->file.is_open())
    return;
  const bool closed = opened_->file.close();
  opened_->disk.close();
  if (!closed || opened_->disk.failure() != 0)
    opened_->refuse_write("");
}

void write_arrays(Communicator& ranks, const fs::path& file, std::span<const SharedArray> shared,
                  const std::function<void(ArrayWriter&)>& rest)
{
  const LibraryCall at_work("HDF5", "writing", file.native());  // the types for the digests are HDF5 objects too
  // Digests are sent first: the root writes the metadata with them, and then all ranks know the positions of their rows.
  const auto shape_of = [](const SharedArray& array) {
    return Extents{static_cast<hsize_t>(array.slice.of_all), static_cast<hsize_t>(array.columns)};
  };
  const auto number_bytes = [](const SharedArray& array) { return H5Tget_size(type_id(array.kind)); };
  constexpr std::size_t room_bytes = std::size_t{1} << 20;
  std::vector<std::byte> room(room_bytes);
  std::vector<std::uint64_t> mine;  // for each array the number of digests, then the digests
  for (const SharedArray& array : shared) {
    const auto digests =
        digests_of(array, number_bytes(array), digest_of(array.path, type_word(type_id(array.kind)), shape_of(array), array.unit));
    mine.push_back(digests.size());
    mine.insert(mine.end(), digests.begin(), digests.end());
  }
  const auto of_rank = gather_rows<std::uint64_t>(ranks, mine);
  std::vector<std::uint64_t> places;
  const auto lay_out = [&](const fs::path& temporary) {
    ArrayWriter writer(temporary);
    rest(writer);
    std::vector<std::size_t> read(of_rank.size(), 0);  // number read from each rank
    for (const SharedArray& array : shared) {
      Pieces pieces{array.slice, {}};
      for (std::size_t r = 0; r < of_rank.size(); ++r) {
        const auto begin = of_rank[r].begin() + static_cast<std::ptrdiff_t>(read[r] + 1);
        pieces.digests.insert(pieces.digests.end(), begin, begin + static_cast<std::ptrdiff_t>(of_rank[r][read[r]]));
        read[r] += 1 + of_rank[r][read[r]];
      }
      if (std::cmp_not_equal(pieces.digests.size(), array.slice.pieces()))
        throw std::invalid_argument(fmt::format("{}: {} pieces of {} are there", array.path, pieces.digests.size(), array.slice.pieces()));
      places.push_back(writer.opened_->reserve(array, shape_of(array), pieces));
    }
    writer.close();
  };
  write_together(ranks, file, lay_out, [&](const PutBytes& put) {
    places.resize(shared.size(), 0);
    std::vector<std::int64_t> told(places.begin(), places.end());  // 0 on ranks other than the root
    ranks.sum(told);
    for (std::size_t i = 0; i < shared.size(); ++i)
      put_rows(shared[i], static_cast<std::size_t>(shared[i].columns) * number_bytes(shared[i]), static_cast<std::uint64_t>(told[i]), put,
               room);
  });
}

template void ArrayWriter::write(const std::string&, std::span<const double>, int, const std::string&);
template void ArrayWriter::write(const std::string&, std::span<const float>, int, const std::string&);
template void ArrayWriter::write(const std::string&, std::span<const std::int32_t>, int, const std::string&);
template void ArrayWriter::write(const std::string&, std::span<const std::int64_t>, int, const std::string&);
template void ArrayWriter::write(const std::string&, std::span<const std::uint8_t>, int, const std::string&);

}  // namespace talus
