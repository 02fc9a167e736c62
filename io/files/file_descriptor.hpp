#pragma once
// A file opened by its POSIX number, which a stream does not give.
#include <fcntl.h>
#include <unistd.h>

#include <filesystem>

namespace talus {

/// Closes the file at its end.  A file that is made has the rights 0666, less those that the user's mask takes away.
class FileDescriptor {
 public:
  /// flags: of open(2); O_CLOEXEC is among them.  Where it fails is_open() is false and errno says why.
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
