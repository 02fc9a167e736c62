#pragma once
// The file driver of HDF5 for writing, which keeps the first error.
#include <hdf5.h>

#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <span>

namespace talus::hdf5 {

/// The file that HDF5 writes to.  HDF5 cannot close a file after a failed write: it keeps the descriptor, and so the space on a full disk,
/// and crashes at the end of the process.  So this driver reports success to HDF5 and keeps the first error for the caller.
class Disk {
 public:
  explicit Disk(const std::filesystem::path& file);
  ~Disk() { close(); }
  Disk(const Disk&) = delete;
  Disk& operator=(const Disk&) = delete;
  /// errno of the first call that failed, or 0.
  int failure() const noexcept { return failure_; }
  void close() noexcept;
  /// The class to register by H5FDregister; the driver's property is a Disk*.
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
  void cut() noexcept;

  int number_;
  int failure_ = 0;
  haddr_t used_ = 0;  ///< bytes allocated by HDF5
  haddr_t size_ = 0;  ///< bytes written
  Record record_{};
};

}  // namespace talus::hdf5
