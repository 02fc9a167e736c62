#pragma once
// Files that are there as a whole or not at all: written beside their place, flushed to the disk, then renamed.
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

/// Calls write(temporary) with a path in the folder of `file`, then fsync, rename to `file`, fsync of the folder.  The folder is
/// made if it is missing.  On any failure the temporary is removed and an older `file` is left as it was; EnvironmentError names
/// `file`.  What `write` throws passes through.
void write_whole(const std::filesystem::path& file, const std::function<void(const std::filesystem::path& temporary)>& write);

/// The same for a text.
void write_whole(const std::filesystem::path& file, std::string_view text);

/// A text of the moment: whole for whoever reads it, but nobody waits for the disk.  Where that fails nothing has happened.
void write_for_now(const std::filesystem::path& file, std::string_view text);

/// Writes bytes to their place in a file.  It throws nothing but keeps the first error: other ranks are waiting.
using PutBytes = std::function<void(std::uint64_t at, std::span<const std::byte> bytes)>;

/// As write_whole(), by all ranks: begin(temporary) on the root, which may write some of it or nothing, then write(put) on all of them, each
/// its bytes.  What goes wrong on one every rank throws, but for what `write` itself throws.
void write_together(Communicator& ranks, const std::filesystem::path& file,
                    const std::function<void(const std::filesystem::path& temporary)>& begin,
                    const std::function<void(const PutBytes& put)>& write);

/// Why no bytes come out of a file, such as "is a folder"; nothing for an ordinary file.  A pipe would keep its reader waiting, a device
/// has no end.
std::optional<std::string> not_ordinary(const std::filesystem::path& file);

/// All bytes of an ordinary file; EnvironmentError names the file if it cannot be read.
std::string read_whole(const std::filesystem::path& file);

}  // namespace talus
