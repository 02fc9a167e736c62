#pragma once
// A file opened by POSIX calls, with its descriptor, which a stream does not provide.
#include <fcntl.h>
#include <unistd.h>

#include <filesystem>
#include <utility>

namespace talus {

/// Closes the file in its destructor.  A new file has the mode 0666 without the bits of the user's mask.
class FileDescriptor {
 public:
  FileDescriptor() = default;
  /// Takes over a descriptor, which may be negative.
  explicit FileDescriptor(int number) noexcept : number_(number) {}
  /// flags: of open(2); O_CLOEXEC is added.  If it fails, is_open() is false and errno has the reason.
  FileDescriptor(const std::filesystem::path& path, int flags) : number_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {}
  ~FileDescriptor()
  {
    if (is_open())
      ::close(number_);
  }
  FileDescriptor(FileDescriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept
  {
    std::swap(number_, other.number_);
    return *this;
  }
  bool is_open() const noexcept { return number_ >= 0; }
  int number() const noexcept { return number_; }

 private:
  int number_ = -1;
};

}  // namespace talus
