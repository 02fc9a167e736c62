// HDF5 behind ArrayWriter and ArrayReader.
#include "io/array_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <hdf5.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "core/error.hpp"
#include "core/exchange.hpp"
#include "core/parallel.hpp"
#include "io/whole_file.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

constexpr const char* digest_name = "digest";
constexpr const char* pieces_name = "pieces";
constexpr const char* unit_name = "unit";

/// What HDF5 has opened, closed at its end.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t id, Close closer) noexcept : id_(id), close_(closer) {}
  ~Handle()
  {
    if (is_open())
      close_(id_);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  bool is_open() const noexcept { return id_ >= 0; }
  hid_t id() const noexcept { return id_; }
  /// Errors of what is written as late as this.
  bool close() noexcept { return close_(std::exchange(id_, H5I_INVALID_HID)) >= 0; }

 private:
  hid_t id_;
  Close close_;
};

// What went wrong, from the innermost of HDF5's messages.
std::string last_words()
{
  std::string words;
  const auto first = [](unsigned, const H5E_error2_t* error, void* to) -> herr_t {
    *static_cast<std::string*>(to) = error->desc == nullptr ? "" : error->desc;
    return 1;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, first, &words);
  return words.empty() ? "no reason given" : words;
}

[[noreturn]] void refuse(const fs::path& file, const std::string& path, const std::string& what)
{
  throw EnvironmentError(fmt::format("{}: {} {}", file.string(), path.empty() ? "the file" : path, what));
}

[[noreturn]] void refuse_damaged(const fs::path& file, const std::string& path)
{
  refuse(file, path, fmt::format("is damaged ({})", last_words()));
}

/// The groups around a path, outermost first: "a", "a/b" of "a/b/c".
std::vector<std::string> groups_around(const std::string& path)
{
  std::vector<std::string> groups;
  std::size_t begin = 0;
  for (;;) {
    const std::size_t end = std::min(path.find('/', begin), path.size());
    const std::string name = path.substr(begin, end - begin);
    if (name.empty() || name == "." || name.find('\0') != std::string::npos)
      throw std::invalid_argument(fmt::format("\"{}\" is no path of names between single slashes", path));
    if (end == path.size())
      return groups;
    groups.push_back(path.substr(0, end));
    begin = end + 1;
  }
}

template <class T>
hid_t type_id()
{
  if constexpr (std::is_same_v<T, double>)
    return H5T_NATIVE_DOUBLE;
  else if constexpr (std::is_same_v<T, float>)
    return H5T_NATIVE_FLOAT;
  else if constexpr (std::is_same_v<T, std::int32_t>)
    return H5T_NATIVE_INT32;
  else if constexpr (std::is_same_v<T, std::int64_t>)
    return H5T_NATIVE_INT64;
  else {
    static_assert(std::is_same_v<T, std::uint8_t>);
    return H5T_NATIVE_UINT8;
  }
}

hid_t type_id(NumberKind kind)
{
  switch (kind) {
    case NumberKind::float64: return type_id<double>();
    case NumberKind::float32: return type_id<float>();
    case NumberKind::int32: return type_id<std::int32_t>();
    case NumberKind::int64: return type_id<std::int64_t>();
    default: return type_id<std::uint8_t>();
  }
}

std::string type_word(hid_t type)
{
  const std::array<std::pair<hid_t, const char*>, 5> words{{{type_id<double>(), "double"},
                                                            {type_id<float>(), "float"},
                                                            {type_id<std::int32_t>(), "int32"},
                                                            {type_id<std::int64_t>(), "int64"},
                                                            {type_id<std::uint8_t>(), "uint8"}}};
  for (const auto& [id, word] : words)
    if (H5Tequal(type, id) > 0)
      return word;
  return H5Tget_class(type) == H5T_STRING ? "text" : "an unknown type";
}

/// Changes with every word: each step is one to one, so a change inside one word is always noticed, any other but once in 2^64.
std::uint64_t digest_step(std::uint64_t h, std::uint64_t word) noexcept { return std::rotl((h ^ word) * 0x9e3779b97f4a7c15U, 29); }

// HDF5 has checksums of chunks only, which take words 0 and 65535 for the same, and with them a lost page (zeros) for entries of -1, and do not
// know which array they stand in.  This digest does.  Eight lanes: as fast as memory.  Files are read by it: it must not change.
class Digest {
 public:
  static constexpr std::size_t lanes = 8, block = lanes * sizeof(std::uint64_t);
  /// Of so many bytes.
  Digest(std::uint64_t seed, std::size_t bytes) noexcept : h_(digest_step(seed, bytes))
  {
    for (std::size_t k = 0; k < lanes; ++k)
      lane_[k] = digest_step(seed, k);
  }
  /// All but the last time whole blocks.
  void add(std::span<const std::byte> bytes) noexcept
  {
    std::size_t done = 0;
    for (; done + block <= bytes.size(); done += block) {
      std::array<std::uint64_t, lanes> word{};
      std::memcpy(word.data(), bytes.data() + done, block);
      for (std::size_t k = 0; k < lanes; ++k)
        lane_[k] = digest_step(lane_[k], word[k]);
    }
    if (done < bytes.size())
      std::memcpy(rest_.data(), bytes.data() + done, bytes.size() - done);
  }
  std::uint64_t value() const noexcept
  {
    std::uint64_t h = h_;
    for (std::size_t k = 0; k < lanes; ++k)
      h = digest_step(digest_step(h, lane_[k]), rest_[k]);
    return h ^ (h >> 32);
  }

 private:
  std::uint64_t h_;
  std::array<std::uint64_t, lanes> lane_{}, rest_{};
};

std::uint64_t digest_of(std::span<const std::byte> bytes, std::uint64_t seed) noexcept
{
  Digest digest(seed, bytes.size());
  digest.add(bytes);
  return digest.value();
}

/// The file below HDF5 while it is written.  HDF5 cannot close a file that cannot be written: it keeps the descriptor, hence the space on a
/// full disk, and crashes at the end of the process.  So it is told that all is well, and the first error is kept for the caller.
class Disk {
 public:
  explicit Disk(const fs::path& file) : number_(::open(file.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) { note(number_ >= 0); }
  ~Disk() { close(); }
  Disk(const Disk&) = delete;
  Disk& operator=(const Disk&) = delete;
  /// errno of the first call that failed, or 0.
  int failure() const noexcept { return failure_; }
  void close() noexcept
  {
    if (number_ >= 0)
      note(::close(std::exchange(number_, -1)) == 0);
  }
  /// For H5FDregister; its driver's property is a Disk*.
  static H5FD_class_t driver() noexcept;

 private:
  struct Record : H5FD_t {
    Disk* disk;
  };
  static Disk& of(const H5FD_t* file) noexcept { return *static_cast<const Record*>(file)->disk; }
  void note(bool good) noexcept
  {
    if (!good && failure_ == 0)
      failure_ = errno == 0 ? EIO : errno;
  }
  void put(haddr_t at, std::span<const std::byte> bytes) noexcept;
  void get(haddr_t at, std::span<std::byte> to) noexcept;
  void cut() noexcept
  {
    if (failure_ == 0 && size_ != used_)
      note(::ftruncate(number_, static_cast<off_t>(used_)) == 0);
    size_ = used_;
  }

  int number_;
  int failure_ = 0;
  haddr_t used_ = 0;  ///< bytes that HDF5 has given away
  haddr_t size_ = 0;  ///< bytes written
  Record record_{};
};

void Disk::put(haddr_t at, std::span<const std::byte> bytes) noexcept
{
  size_ = std::max(size_, at + bytes.size());
  while (failure_ == 0 && !bytes.empty()) {
    const ssize_t written = ::pwrite(number_, bytes.data(), bytes.size(), static_cast<off_t>(at));
    note(written > 0 || (written < 0 && errno == EINTR));
    if (written > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(written));
      at += static_cast<haddr_t>(written);
    }
  }
}

void Disk::get(haddr_t at, std::span<std::byte> to) noexcept
{
  while (failure_ == 0 && !to.empty()) {
    const ssize_t got = ::pread(number_, to.data(), to.size(), static_cast<off_t>(at));
    note(got >= 0 || errno == EINTR);
    if (got == 0)
      break;
    if (got > 0) {
      to = to.subspan(static_cast<std::size_t>(got));
      at += static_cast<haddr_t>(got);
    }
  }
  std::fill(to.begin(), to.end(), std::byte{});  // behind the end there are zeros
}

H5FD_class_t Disk::driver() noexcept
{
  H5FD_class_t driver{};
  driver.name = "talus";
  driver.maxaddr = static_cast<haddr_t>(std::numeric_limits<off_t>::max());
  driver.fc_degree = H5F_CLOSE_WEAK;
  driver.fapl_size = sizeof(Disk*);
  constexpr std::array<H5FD_mem_t, H5FD_MEM_NTYPES> map H5FD_FLMAP_DICHOTOMY;
  std::copy(map.begin(), map.end(), driver.fl_map);
  driver.open = [](const char*, unsigned, hid_t access, haddr_t) -> H5FD_t* {
    const auto* property = static_cast<Disk* const*>(H5Pget_driver_info(access));
    if (property == nullptr)
      return nullptr;
    Disk& disk = **property;
    disk.used_ = 0;
    disk.record_ = {};
    disk.record_.disk = &disk;
    return &disk.record_;
  };
  driver.close = [](H5FD_t*) -> herr_t { return 0; };
  driver.query = [](const H5FD_t*, unsigned long* flags) -> herr_t {
    *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE | H5FD_FEAT_AGGREGATE_SMALLDATA;
    return 0;
  };
  driver.get_eoa = [](const H5FD_t* file, H5FD_mem_t) { return of(file).used_; };
  driver.set_eoa = [](H5FD_t* file, H5FD_mem_t, haddr_t end) -> herr_t {
    of(file).used_ = end;
    return 0;
  };
  driver.get_eof = [](const H5FD_t* file, H5FD_mem_t) { return of(file).size_; };
  driver.read = [](H5FD_t* file, H5FD_mem_t, hid_t, haddr_t at, std::size_t size, void* to) -> herr_t {
    of(file).get(at, {static_cast<std::byte*>(to), size});
    return 0;
  };
  driver.write = [](H5FD_t* file, H5FD_mem_t, hid_t, haddr_t at, std::size_t size, const void* from) -> herr_t {
    of(file).put(at, {static_cast<const std::byte*>(from), size});
    return 0;
  };
  driver.truncate = [](H5FD_t* file, hid_t, hbool_t) -> herr_t {
    of(file).cut();
    return 0;
  };
  return driver;
}

struct Extents {
  hsize_t rows = 0;
  hsize_t columns = 1;
};

/// Of all that says what values mean: it goes into the digest of each piece of them.
std::uint64_t digest_of(const std::string& path, const std::string& type, const Extents& shape, const std::string& unit)
{
  const std::string meaning = fmt::format("{}\n{}\n{} x {}\n{}", path, type, shape.rows, shape.columns, unit);
  return digest_of(std::as_bytes(std::span(meaning)), 0);
}

/// The pieces of an array and their digests.
struct Pieces {
  Slice all;  // from row 0 on
  std::vector<std::uint64_t> digests;

  /// As they are kept; of one piece, or none, there is no more to say.
  std::vector<std::uint64_t> words() const
  {
    std::vector<std::uint64_t> kept;
    if (digests.size() > 1)
      kept = {static_cast<std::uint64_t>(all.piece), static_cast<std::uint64_t>(all.lead)};
    kept.insert(kept.end(), digests.begin(), digests.end());
    return kept;
  }
  std::uint64_t digest(std::uint64_t meaning) const { return digest_of(std::as_bytes(std::span<const std::uint64_t>(words())), meaning); }
};

/// Copies rows of an array from the one of that number on, as many as there is room for.
void pack(const SharedArray& array, std::size_t from, std::size_t row_bytes, std::span<std::byte> to)
{
  const std::byte* row = array.first + from * array.stride;
  for (; !to.empty(); to = to.subspan(row_bytes), row += array.stride)
    std::memcpy(to.data(), row, row_bytes);
}

/// Of the pieces that are here.
std::vector<std::uint64_t> digests_of(const SharedArray& array, std::size_t number_bytes, std::uint64_t meaning)
{
  if (!array.slice.is_whole(static_cast<std::int64_t>(array.rows)))
    throw std::invalid_argument(fmt::format("{}: {} rows from {} on are no whole pieces", array.path, array.rows, array.slice.first));
  if (array.rows == 0)
    return {};
  constexpr std::size_t at_once = Digest::block;  // so many rows are whole blocks, however long
  const std::size_t row_bytes = static_cast<std::size_t>(array.columns) * number_bytes;
  const Slice& slice = array.slice;
  const std::int64_t begin = slice.piece_of(slice.first), end = slice.piece_of(slice.first + static_cast<std::int64_t>(array.rows) - 1) + 1;
  std::vector<std::uint64_t> digests(static_cast<std::size_t>(end - begin));
  const bool is_packed = array.stride == row_bytes;
  std::vector<std::vector<std::byte>> room(std::min(static_cast<std::size_t>(threads()), digests.size()),
                                           std::vector<std::byte>(is_packed ? 0 : at_once * row_bytes));
  parallel_for(static_cast<Index>(room.size()), [&](Index t) {
    const auto thread = static_cast<std::size_t>(t);
    for (std::size_t i = thread; i < digests.size(); i += room.size()) {
      const std::int64_t number = begin + static_cast<std::int64_t>(i);
      auto row = static_cast<std::size_t>(slice.begin_of(number) - slice.first);
      const auto last = static_cast<std::size_t>(slice.begin_of(number + 1) - slice.first);
      Digest digest(meaning, (last - row) * row_bytes);
      if (is_packed)
        digest.add({array.first + row * row_bytes, (last - row) * row_bytes});
      for (; !is_packed && row < last; row += at_once) {
        const auto some = std::span(room[thread]).first(std::min(at_once, last - row) * row_bytes);
        pack(array, row, row_bytes, some);
        digest.add(some);
      }
      digests[i] = digest.value();
    }
  });
  return digests;
}

/// The bytes of the rows here to their places in an array that begins at `place`.
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

Handle text_type(std::size_t size)
{
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), std::max<std::size_t>(size, 1));  // HDF5 has no text of size zero
  H5Tset_strpad(type.id(), H5T_STR_NULLPAD);
  H5Tset_cset(type.id(), H5T_CSET_UTF8);
  return type;
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

/// How arrays lie in the file: in one piece, whose place is known at once, whoever writes it.
Handle array_layout()
{
  Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(layout.id(), false);  // the same values, the same bytes
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
  Disk disk;  // before what is closed into it
  Handle driver;
  Handle file;

  static hid_t register_driver()
  {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are thrown, not printed
    const H5FD_class_t driver = Disk::driver();
    return H5FDregister(&driver);
  }

  hid_t create()
  {
    const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose), access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    H5Pset_obj_track_times(creation.id(), false);                             // the same values, the same bytes
    H5Pset_libver_bounds(access.id(), H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);  // the formats whose metadata carry checksums
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

  /// An array without its values.
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

  /// Makes an array whose values are written by others.  Where they are to come in the file.
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

void write_arrays(Exchange& ranks, const fs::path& file, std::span<const SharedArray> shared, const std::function<void(ArrayWriter&)>& rest)
{
  // Digests first: the root lays out the file with them, and then everyone knows where its rows go.
  const auto shape_of = [](const SharedArray& array) {
    return Extents{static_cast<hsize_t>(array.slice.of_all), static_cast<hsize_t>(array.columns)};
  };
  const auto number_bytes = [](const SharedArray& array) { return H5Tget_size(type_id(array.kind)); };
  constexpr std::size_t room_bytes = std::size_t{1} << 20;
  std::vector<std::byte> room(room_bytes);
  std::vector<std::uint64_t> mine;  // of each array their number, then the digests
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
    std::vector<std::size_t> read(of_rank.size(), 0);  // of each rank
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
    std::vector<std::int64_t> told(places.begin(), places.end());  // 0 but on the root
    ranks.sum(told);
    for (std::size_t i = 0; i < shared.size(); ++i)
      put_rows(shared[i], static_cast<std::size_t>(shared[i].columns) * number_bytes(shared[i]), static_cast<std::uint64_t>(told[i]), put,
               room);
  });
}

struct ArrayReader::Opened {
  fs::path name;
  std::uintmax_t bytes;
  Handle file;

  /// What the link of that path leads to, nothing if there is no link.
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

  /// An array or a text.
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

  /// Nothing is compressed, so an array bigger than its file is not there: checked before anything is allocated.
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

  /// The words of an attribute; none if it is not there.
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

  /// Reads what has been opened and checked so far: the rows from `first` on, and the rest of their pieces to check them.
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
    const std::size_t last = first + to.size() / row_bytes;  // one behind
    for (std::size_t row = first; row < last;) {
      const std::int64_t number = pieces.all.piece_of(static_cast<std::int64_t>(row));
      const auto begin = static_cast<std::size_t>(pieces.all.begin_of(number)),
                 end = static_cast<std::size_t>(pieces.all.begin_of(number + 1));
      std::vector<std::byte> room;  // for a piece of which not all is wanted
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
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are thrown, not printed
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
  H5Pset_file_locking(access.id(), false, true);  // some cluster file systems have no locks
  Handle opened(H5Fopen(file.c_str(), H5F_ACC_RDONLY, access.id()), H5Fclose);
  if (!opened.is_open())
    refuse_damaged(file, "");
  opened_ = std::make_unique<Opened>(Opened{file, bytes, std::move(opened)});
}

ArrayReader::~ArrayReader() = default;

bool ArrayReader::has(const std::string& path) const { return opened_->kind(path) != H5O_TYPE_UNKNOWN; }

std::vector<std::string> ArrayReader::names(const std::string& group) const
{
  const H5O_type_t kind = group.empty() ? H5O_TYPE_GROUP : opened_->kind(group);
  if (kind != H5O_TYPE_GROUP)
    refuse(opened_->name, group, kind == H5O_TYPE_UNKNOWN ? "is not there" : "is not a group");
  const Handle opened(H5Gopen2(opened_->file.id(), group.empty() ? "/" : group.c_str(), H5P_DEFAULT), H5Gclose);
  std::vector<std::string> found;
  const auto add = [](hid_t, const char* name, const H5L_info_t*, void* to) -> herr_t {
    try {
      static_cast<std::vector<std::string>*>(to)->emplace_back(name);
      return 0;
    } catch (...) {  // not through C
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
  const Handle array = opened_->open(path);
  const Extents shape = opened_->check_array(array, type_id<T>(), static_cast<hsize_t>(columns), path);
  std::vector<T> values(shape.rows * shape.columns);
  opened_->get(array, type_id<T>(), shape, 0, std::as_writable_bytes(std::span(values)), path);
  return values;
}

template <class T>
void ArrayReader::read_into(const std::string& path, std::span<T> to, int columns) const
{
  const Handle array = opened_->open(path);
  const Extents shape = opened_->check_array(array, type_id<T>(), static_cast<hsize_t>(columns), path);
  if (shape.rows * shape.columns != to.size())
    refuse(opened_->name, path, fmt::format("has {} rows, not {}", shape.rows, to.size() / shape.columns));
  opened_->get(array, type_id<T>(), shape, 0, std::as_writable_bytes(to), path);
}

template <class T>
void ArrayReader::read_rows(const std::string& path, std::size_t first, std::span<T> to, int columns) const
{
  const Handle array = opened_->open(path);
  const Extents shape = opened_->check_array(array, type_id<T>(), static_cast<hsize_t>(columns), path);
  if (first > shape.rows || to.size() / shape.columns > shape.rows - first)
    refuse(opened_->name, path, fmt::format("has {} rows, not {}", shape.rows, first + to.size() / shape.columns));
  opened_->get(array, type_id<T>(), shape, first, std::as_writable_bytes(to), path);
}

std::size_t ArrayReader::rows(const std::string& path) const
{
  const Handle array = opened_->open(path);
  const Handle type = opened_->type_of(array, path);
  if (H5Tget_class(type.id()) == H5T_STRING)
    refuse(opened_->name, path, "holds text, not numbers");
  return opened_->shape_of(array, H5Tget_size(type.id()), path).rows;
}

std::string ArrayReader::unit(const std::string& path) const { return opened_->unit_of(opened_->open(path), path); }

std::string ArrayReader::text(const std::string& path) const
{
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

template void ArrayWriter::write(const std::string&, std::span<const double>, int, const std::string&);
template void ArrayWriter::write(const std::string&, std::span<const float>, int, const std::string&);
template void ArrayWriter::write(const std::string&, std::span<const std::int32_t>, int, const std::string&);
template void ArrayWriter::write(const std::string&, std::span<const std::int64_t>, int, const std::string&);
template void ArrayWriter::write(const std::string&, std::span<const std::uint8_t>, int, const std::string&);
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
