#pragma once
// A file in memory, gone with the object.  It has a name in a folder: HDF5 asks for the real path of what it opens.
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace talus {

class MemoryFile {
 public:
  explicit MemoryFile(std::string_view bytes = {}, const std::string& extension = "") : path_(new_path() += extension)
  {
    std::ofstream(path_, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }
  ~MemoryFile()
  {
    std::error_code stays;
    std::filesystem::remove(path_, stays);
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  const std::filesystem::path& path() const noexcept { return path_; }

 private:
  static std::filesystem::path new_path()
  {
    static int count = 0;
    const std::filesystem::path in_memory = "/dev/shm";
    return (std::filesystem::is_directory(in_memory) ? in_memory : std::filesystem::temp_directory_path()) /
           ("talus_fuzz_" + std::to_string(::getpid()) + "_" + std::to_string(count++));
  }

  std::filesystem::path path_;
};

}  // namespace talus
