// Driver of the "virtual file layer" of HDF5.
#include "io/checkpoint/hdf5_disk.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace talus::hdf5 {

Disk::Disk(const std::filesystem::path& file) : number_(::open(file.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666))
{
  note(number_ >= 0);
}

void Disk::close() noexcept
{
  if (number_ >= 0)
    note(::close(std::exchange(number_, -1)) == 0);
}

void Disk::cut() noexcept
{
  if (failure_ == 0 && size_ != used_)
    note(::ftruncate(number_, static_cast<off_t>(used_)) == 0);
  size_ = used_;
}

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
  std::fill(to.begin(), to.end(), std::byte{});  // bytes after the end are zero
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

}  // namespace talus::hdf5
