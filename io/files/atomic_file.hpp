#pragma once
// Atomic writing of files: written to a temporary file, flushed to the disk, then renamed.
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace talus {

class Communicator;

/// Calls write(temporary) with a path in the folder of `file`, then fsync, rename to `file`, fsync of the folder.  A missing folder is
/// made.  After a failure the temporary file is removed and an existing `file` is unchanged; EnvironmentError names `file`.  Exceptions of
/// `write` are passed on.
void write_whole(const std::filesystem::path& file, const std::function<void(const std::filesystem::path& temporary)>& write);

/// Writes a text in this way.
void write_whole(const std::filesystem::path& file, std::string_view text);

/// Writes a text that is short-lived: readers see a complete file, but the disk is not flushed.  If it fails, nothing is changed and
/// nothing is thrown.
void write_for_now(const std::filesystem::path& file, std::string_view text);

/// Writes bytes at a position of a file.  It throws nothing but keeps the first error, because other ranks are waiting.
using PutBytes = std::function<void(std::uint64_t at, std::span<const std::byte> bytes)>;

/// As write_whole(), by all ranks: begin(temporary) on the root, which may write some of the file, then write(put) on all ranks, each its
/// bytes.  An error on one rank is thrown on all, except for exceptions of `write` itself.
void write_together(Communicator& ranks, const std::filesystem::path& file,
                    const std::function<void(const std::filesystem::path& temporary)>& begin,
                    const std::function<void(const PutBytes& put)>& write);

/// The reason why a path is not an ordinary file, such as "is a folder"; nothing for an ordinary file.  A pipe would block its reader, a
/// device has no end.
std::optional<std::string> not_ordinary(const std::filesystem::path& file);

/// All bytes of an ordinary file; throws EnvironmentError with its name if it cannot be read.
std::string read_whole(const std::filesystem::path& file);

}  // namespace talus
