// POSIX calls of write_whole: C++ streams cannot flush to the disk.
#include "io/files/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/error.hpp"
#include "core/parallel/communicator.hpp"
#include "io/files/file_descriptor.hpp"
#include "io/files/manifest.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, std::string_view verb, int code)
{
  throw EnvironmentError(fmt::format("cannot {} {}: {}", verb, file.string(), std::strerror(code)));
}

void sync(const fs::path& path, int flags, const fs::path& file)
{
  const FileDescriptor opened(path, flags);
  // Some network file systems do not support fsync of a folder and return EINVAL; the rename is done nevertheless.
  if (!opened.is_open() || (::fsync(opened.number()) != 0 && errno != EINVAL))
    fail(file, "write", errno);
}

fs::path temporary_of(const fs::path& file) { return file.string() + ".tmp"; }
fs::path folder_of_file(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : fs::path("."); }

/// Removes the temporary file unless it has been renamed.
class Temporary {
 public:
  explicit Temporary(const fs::path& file) : path_(temporary_of(file)) {}
  ~Temporary()
  {
    std::error_code ignored;
    if (!kept_)
      fs::remove(path_, ignored);
  }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
  const fs::path& path() const noexcept { return path_; }
  void keep() noexcept { kept_ = true; }

 private:
  fs::path path_;
  bool kept_ = false;
};

/// Makes the folder if it does not exist.
void make_folder_of(const fs::path& file)
{
  const fs::path folder = folder_of_file(file);
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed)
    fail(folder, "make the folder", failed.value());
}

/// Renames a file that is already on the disk to its final name.
void put_in_place(Temporary& temporary, const fs::path& file)
{
  set_aside_unless_proved(file);
  note_result(file, temporary.path());  // before the rename: a killed run leaves no file that is not in the list
  if (::rename(temporary.path().c_str(), file.c_str()) != 0)
    fail(file, "write", errno);
  temporary.keep();
  sync(folder_of_file(file), O_RDONLY | O_DIRECTORY, file);
}

/// The part of one rank in a file that all ranks write.
class Shared {
 public:
  Shared(const fs::path& path, const fs::path& file) : file_(file), opened_(path, O_WRONLY)
  {
    if (!opened_.is_open())
      fail(file, "write", errno);
  }
  void put(std::uint64_t at, std::span<const std::byte> bytes) noexcept
  {
    while (failure_ == 0 && !bytes.empty()) {
      const ssize_t written = ::pwrite(opened_.number(), bytes.data(), bytes.size(), static_cast<off_t>(at));
      if (written == 0 || (written < 0 && errno != EINTR))
        failure_ = written == 0 ? EIO : errno;
      if (written > 0) {
        bytes = bytes.subspan(static_cast<std::size_t>(written));
        at += static_cast<std::uint64_t>(written);
      }
    }
  }
  /// Returns when the bytes of this rank are on the disk.
  void finish() const
  {
    if (failure_ != 0)
      fail(file_, "write", failure_);
    if (::fsync(opened_.number()) != 0 && errno != EINVAL)
      fail(file_, "write", errno);
  }

 private:
  const fs::path& file_;
  FileDescriptor opened_;
  int failure_ = 0;
};

void write_text(const fs::path& path, std::string_view text, const fs::path& file)
{
  const FileDescriptor opened(path, O_WRONLY | O_CREAT | O_TRUNC);
  if (!opened.is_open())
    fail(file, "write", errno);
  while (!text.empty()) {
    const ssize_t written = ::write(opened.number(), text.data(), text.size());
    if (written < 0 && errno != EINTR)
      fail(file, "write", errno);
    if (written > 0)
      text.remove_prefix(static_cast<std::size_t>(written));
  }
}

}  // namespace

void write_whole(const fs::path& file, const std::function<void(const fs::path&)>& write)
{
  make_folder_of(file);
  Temporary temporary(file);
  write(temporary.path());
  sync(temporary.path(), O_RDONLY, file);
  put_in_place(temporary, file);
}

void write_whole(const fs::path& file, std::string_view text)
{
  write_whole(file, [&](const fs::path& temporary) { write_text(temporary, text, file); });
}

void write_for_now(const fs::path& file, std::string_view text)
try {
  Temporary temporary(file);
  write_text(temporary.path(), text, file);
  if (::rename(temporary.path().c_str(), file.c_str()) == 0)
    temporary.keep();
} catch (const EnvironmentError&) {  // for example a full disk: the next write reports it
}

void write_together(Communicator& ranks, const fs::path& file, const std::function<void(const fs::path&)>& begin,
                    const std::function<void(const PutBytes&)>& write)
{
  std::optional<Temporary> temporary;  // on the root only
  ranks.together([&] {
    make_folder_of(file);
    temporary.emplace(file);
    write_text(temporary->path(), "", file);
    begin(temporary->path());
  });
  std::optional<Shared> shared;
  ranks.agree(Communicator::caught([&] { shared.emplace(temporary_of(file), file); }));
  write([&](std::uint64_t at, std::span<const std::byte> bytes) { shared->put(at, bytes); });
  ranks.agree(Communicator::caught([&] { shared->finish(); }));
  shared.reset();
  ranks.together([&] { put_in_place(*temporary, file); });
}

std::optional<std::string> not_ordinary(const fs::path& file)
{
  std::error_code failed;
  const fs::file_status status = fs::status(file, failed);
  if (status.type() == fs::file_type::not_found)
    return "does not exist";
  if (failed)
    return fmt::format("cannot be read: {}", failed.message());
  if (fs::is_directory(status))
    return "is a folder";
  if (!fs::is_regular_file(status))
    return "is not an ordinary file";
  return std::nullopt;
}

std::string read_whole(const fs::path& file)
{
  if (std::error_code unknown; fs::is_other(fs::status(file, unknown)))
    throw EnvironmentError(fmt::format("cannot read {}: it is not an ordinary file", file.string()));
  const FileDescriptor opened(file, O_RDONLY);
  if (!opened.is_open())
    fail(file, "read", errno);
  std::string text;
  std::string block(1 << 16, '\0');
  for (;;) {
    const ssize_t got = ::read(opened.number(), block.data(), block.size());
    if (got == 0)
      return text;
    if (got < 0 && errno != EINTR)
      fail(file, "read", errno);
    if (got > 0)
      text.append(block, 0, static_cast<std::size_t>(got));
  }
}

}  // namespace talus
