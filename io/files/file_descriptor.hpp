#pragma once
// A file opened by POSIX calls, with its descriptor, which a stream does not provide.
#include <fcntl.h>
#include <unistd.h>

#include <filesystem>

namespace talus {

/// Closes the file in its destructor.  A new file has the mode 0666 without the bits of the user's mask.
class FileDescriptor {
 public:
  /// flags: of open(2); O_CLOEXEC is added.  If it fails, is_open() is false and errno has the reason.
  FileDescriptor(const std::filesystem::path& path, int flags) : number_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {}
  ~FileDescriptor()
  {
    if (is_open())
      ::close(number_);
  }
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  bool is_open() const noexcept { return number_ >= 0; }
  int number() const noexcept { return number_; }

 private:
  int number_;
};

}  // namespace talus
