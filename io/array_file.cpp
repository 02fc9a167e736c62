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
#include "io/whole_file.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t chunk_bytes = 1 << 20;  // as much as HDF5 keeps of one array while it is written or read
constexpr const char* digest_name = "digest";
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

// Fletcher32 in the file takes words 0 and 65535 for the same, and with them a lost page (zeros) for entries of -1, and HDF5's checksums do
// not know which array they stand in.  This digest does.  Eight lanes: as fast as memory.  Files are read by it: it must not change.
std::uint64_t digest_of(std::span<const std::byte> bytes, std::uint64_t seed) noexcept
{
  constexpr std::size_t lanes = 8, block = lanes * sizeof(std::uint64_t);
  std::array<std::uint64_t, lanes> lane{};
  for (std::size_t k = 0; k < lanes; ++k)
    lane[k] = digest_step(seed, k);
  std::array<std::uint64_t, lanes> word{};
  std::size_t done = 0;
  for (; done + block <= bytes.size(); done += block) {
    std::memcpy(word.data(), bytes.data() + done, block);
    for (std::size_t k = 0; k < lanes; ++k)
      lane[k] = digest_step(lane[k], word[k]);
  }
  word = {};
  if (done < bytes.size())
    std::memcpy(word.data(), bytes.data() + done, bytes.size() - done);
  std::uint64_t h = digest_step(seed, bytes.size());
  for (std::size_t k = 0; k < lanes; ++k)
    h = digest_step(digest_step(h, lane[k]), word[k]);
  return h ^ (h >> 32);
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
  friend bool operator==(const Extents&, const Extents&) = default;
};

/// Of the values and of all that says what they mean.
std::uint64_t digest_of(const std::string& path, const std::string& type, const Extents& shape, const std::string& unit,
                        std::span<const std::byte> values)
{
  const std::string meaning = fmt::format("{}\n{}\n{} x {}\n{}", path, type, shape.rows, shape.columns, unit);
  return digest_of(values, digest_of(std::as_bytes(std::span(meaning)), 0));
}

Handle text_type(std::size_t size)
{
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), std::max<std::size_t>(size, 1));  // HDF5 has no text of size zero
  H5Tset_strpad(type.id(), H5T_STR_NULLPAD);
  H5Tset_cset(type.id(), H5T_CSET_UTF8);
  return type;
}

bool write_attribute(const Handle& array, const char* name, hid_t type, const void* value)
{
  const Handle scalar(H5Screate(H5S_SCALAR), H5Sclose);
  Handle attribute(H5Acreate2(array.id(), name, type, scalar.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  return attribute.is_open() && H5Awrite(attribute.id(), type, value) >= 0 && attribute.close();
}

/// How arrays lie in the file: chunks with checksums.
Handle array_layout(const Extents& shape, int rank, std::size_t value_bytes)
{
  Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(layout.id(), false);  // the same values, the same bytes
  // HDF5 has no chunks without rows, and nothing to check there.
  if (shape.rows > 0) {
    const hsize_t fit = std::max<hsize_t>(1, chunk_bytes / (shape.columns * value_bytes));
    const std::array<hsize_t, 2> chunk{std::min(shape.rows, fit), shape.columns};
    H5Pset_chunk(layout.id(), rank, chunk.data());
    H5Pset_fletcher32(layout.id());
  }
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

  void put(const std::string& path, hid_t type, const Extents& shape, std::span<const std::byte> values, const std::string& unit) const
  {
    if (!file.is_open())
      throw std::invalid_argument(fmt::format("{} is closed: {} cannot be written", name.string(), path));
    make_groups_around(path);
    if (is_taken(path))
      throw std::invalid_argument(fmt::format("{} has {} already", name.string(), path));
    const int rank = shape.columns > 1 ? 2 : 1;
    const std::array<hsize_t, 2> dims{shape.rows, shape.columns};
    const Handle space(H5Screate_simple(rank, dims.data(), nullptr), H5Sclose);
    const Handle layout = array_layout(shape, rank, H5Tget_size(type));
    Handle array(H5Dcreate2(file.id(), path.c_str(), type, space.id(), H5P_DEFAULT, layout.id(), H5P_DEFAULT), H5Dclose);
    if (!array.is_open())
      refuse_write(path);
    if (!values.empty() && H5Dwrite(array.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
      refuse_write(path);
    if (!unit.empty() && !write_attribute(array, unit_name, text_type(unit.size()).id(), unit.data()))
      refuse_write(path);
    const std::uint64_t digest = digest_of(path, type_word(type), shape, unit, values);
    if (!write_attribute(array, digest_name, H5T_NATIVE_UINT64, &digest) || !array.close() || disk.failure() != 0)
      refuse_write(path);
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

  void check_digest(const Handle& array, std::uint64_t wanted, const std::string& path) const
  {
    const Handle attribute(H5Aopen(array.id(), digest_name, H5P_DEFAULT), H5Aclose);
    const Handle type(H5Aget_type(attribute.id()), H5Tclose);
    std::uint64_t digest = 0;
    if (!attribute.is_open() || H5Tequal(type.id(), H5T_NATIVE_UINT64) <= 0 || H5Aget_storage_size(attribute.id()) != sizeof(digest) ||
        H5Aread(attribute.id(), type.id(), &digest) < 0)
      refuse(name, path, "has no readable digest: it is damaged, or another program wrote it");
    if (digest != wanted)
      refuse(name, path, "is damaged (the values do not fit their digest)");
  }

  /// Reads what has been opened and checked so far; as many values as `shape` says.
  void get(const Handle& array, hid_t type, const Extents& shape, std::span<std::byte> to, const std::string& path) const
  {
    if (!to.empty() && H5Dread(array.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, to.data()) < 0)
      refuse_damaged(name, path);
    check_digest(array, digest_of(path, type_word(type), shape, unit_of(array, path), to), path);
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
  opened_->get(array, type_id<T>(), shape, std::as_writable_bytes(std::span(values)), path);
  return values;
}

template <class T>
void ArrayReader::read_into(const std::string& path, std::span<T> to, int columns) const
{
  const Handle array = opened_->open(path);
  const Extents shape = opened_->check_array(array, type_id<T>(), static_cast<hsize_t>(columns), path);
  if (shape.rows * shape.columns != to.size())
    refuse(opened_->name, path, fmt::format("has {} rows, not {}", shape.rows, to.size() / shape.columns));
  opened_->get(array, type_id<T>(), shape, std::as_writable_bytes(to), path);
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
  opened_->get(array, type.id(), shape, std::as_writable_bytes(std::span(text)), path);
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
template void ArrayReader::read_into(const std::string&, std::span<float>, int) const;
template void ArrayReader::read_into(const std::string&, std::span<std::int32_t>, int) const;
template void ArrayReader::read_into(const std::string&, std::span<std::int64_t>, int) const;
template void ArrayReader::read_into(const std::string&, std::span<std::uint8_t>, int) const;

}  // namespace talus
