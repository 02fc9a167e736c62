// The list is a text with one line per file: proof, digest, bytes, time of modification [ns], name.  Lines are only appended, each by one
// write.
#include "io/files/manifest.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <mutex>

#include "core/error.hpp"
#include "core/print.hpp"
#include "io/files/atomic_file.hpp"
#include "io/files/byte_digest.hpp"
#include "io/files/file_descriptor.hpp"
#include "io/files/result_files.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

fs::path list_in(const fs::path& folder) { return folder / own_folder / "files.txt"; }

struct Looks {
  std::uint64_t bytes;
  std::int64_t modified;  // time of modification [ns]
};

/// Size and time of an ordinary file; symbolic links are not followed.
std::optional<Looks> looks_of(const fs::path& file)
{
  struct ::stat found {};
  if (::lstat(file.c_str(), &found) != 0 || !S_ISREG(found.st_mode))
    return std::nullopt;
  return Looks{static_cast<std::uint64_t>(found.st_size), std::int64_t{found.st_mtim.tv_sec} * 1'000'000'000 + found.st_mtim.tv_nsec};
}

/// Reads bytes from `at` on; false if there are not as many.
bool read_at(const FileDescriptor& file, std::uint64_t at, std::span<std::byte> bytes)
{
  while (!bytes.empty()) {
    const ssize_t got = ::pread(file.number(), bytes.data(), bytes.size(), static_cast<off_t>(at));
    if (got == 0 || (got < 0 && errno != EINTR))
      return false;
    if (got > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(got));
      at += static_cast<std::uint64_t>(got);
    }
  }
  return true;
}

/// The digest of the first bytes of a file.  For a large file 1024 evenly spread pieces are read, including both ends, so that a checkpoint
/// of many gigabytes is not read back as a whole.
std::optional<std::uint64_t> digest_of_file(const fs::path& file, std::uint64_t bytes)
{
  constexpr std::uint64_t piece = 65536, most_pieces = 1024;
  const FileDescriptor opened(file, O_RDONLY | O_NOFOLLOW);
  if (!opened.is_open())
    return std::nullopt;
  Digest digest(0, bytes);
  std::vector<std::byte> block(piece);
  const bool all = bytes <= piece * most_pieces;
  const std::uint64_t pieces = all ? (bytes + piece - 1) / piece : most_pieces;
  for (std::uint64_t k = 0; k < pieces; ++k) {
    const std::uint64_t at =
        all ? k * piece : (bytes - piece) / (most_pieces - 1) * k + (k + 1 == pieces ? (bytes - piece) % (most_pieces - 1) : 0);
    const std::span<std::byte> part(block.data(), std::min(piece, bytes - at));
    if (!read_at(opened, at, part))
      return std::nullopt;
    digest.add(part);
  }
  return digest.value();
}

/// Whether the bytes from `at` on contain only characters of a table of numbers.
bool only_numbers(const fs::path& file, std::uint64_t at)
{
  const std::string text = read_whole(file);
  return text.size() >= at && text.find_first_not_of("0123456789+-.,einfa\n", at) == text.npos;
}

/// The length of the constant beginning of progress.json, its first key.
constexpr std::uint64_t bytes_of_beginning = 12;

/// A results folder, and the name of a file relative to it.
struct PlaceInFolder {
  fs::path folder;
  std::string name;
};

std::optional<PlaceInFolder> place_of(const fs::path& file)
{
  std::error_code unknown;
  const fs::path whole = fs::absolute(file, unknown).lexically_normal();
  const fs::path folder = whole.parent_path();
  const std::string name = whole.filename().string(), within = (folder.filename() / name).string();
  if (unknown || name.find('\n') != name.npos)
    return std::nullopt;
  if (is_result(name) && fs::exists(list_in(folder), unknown))
    return PlaceInFolder{folder, name};
  if (is_result(within) && fs::exists(list_in(folder.parent_path()), unknown))
    return PlaceInFolder{folder.parent_path(), within};
  return std::nullopt;
}

/// The next word of a line as a number; nothing if it is not one.
template <class T>
std::optional<T> number(std::string_view& line, int base = 10)
{
  T value{};
  const auto [end, trouble] = std::from_chars(line.data(), line.data() + line.size(), value, base);
  if (trouble != std::errc{} || end == line.data() + line.size() || *end != ' ')
    return std::nullopt;
  line.remove_prefix(static_cast<std::size_t>(end - line.data()) + 1);
  return value;
}

std::string line_of(Proof proof, std::uint64_t digest, std::uint64_t bytes, std::int64_t modified, const std::string& name)
{
  return fmt::format("{} {:016x} {} {} {}\n", static_cast<char>(proof), digest, bytes, modified, name);
}

void append_line(const fs::path& list, const std::string& line, const fs::path& file)
{
  const auto fail = [&] { throw EnvironmentError(fmt::format("cannot write {}: {}", file.string(), std::strerror(errno))); };
  static std::mutex one_line_at_a_time;  // frames are written on a thread of their own
  const std::scoped_lock lock(one_line_at_a_time);
  const FileDescriptor opened(list, O_RDWR | O_APPEND);
  if (!opened.is_open())
    fail();
  // Starts a new line if the last one was truncated, for example by a full disk.
  const off_t end = ::lseek(opened.number(), 0, SEEK_END);
  char last = '\n';
  const bool cut_short = end > 0 && ::pread(opened.number(), &last, 1, end - 1) == 1 && last != '\n';
  const std::string text = (cut_short ? "\n" : "") + line;
  std::string_view left = text;
  while (!left.empty()) {
    const ssize_t written = ::write(opened.number(), left.data(), left.size());
    if (written < 0 && errno != EINTR)
      fail();
    if (written > 0)
      left.remove_prefix(static_cast<std::size_t>(written));
  }
}

}  // namespace

std::optional<Manifest> Manifest::of(const fs::path& folder)
{
  std::error_code unknown;
  if (!fs::exists(list_in(folder), unknown))
    return std::nullopt;
  Manifest manifest;
  manifest.folder_ = folder;
  const std::string text = read_whole(list_in(folder));
  for (std::size_t begin = 0, end = text.find('\n'); end != text.npos; begin = end + 1, end = text.find('\n', begin)) {
    std::string_view line = std::string_view(text).substr(begin, end - begin);
    if (line.size() < 2 || std::string_view("wbg").find(line[0]) == std::string_view::npos || line[1] != ' ')
      continue;  // truncated or written by someone else: not a proof
    const auto proof = static_cast<Proof>(line[0]);
    line.remove_prefix(2);
    const auto digest = number<std::uint64_t>(line, 16);
    const auto bytes = digest ? number<std::uint64_t>(line) : std::nullopt;
    const auto modified = bytes ? number<std::int64_t>(line) : std::nullopt;
    if (modified && is_result(line))
      manifest.entries_[std::string(line)].push_back({proof, *digest, *bytes, *modified});
  }
  return manifest;
}

bool Manifest::proves(const std::string& name) const
{
  const auto found = entries_.find(name);
  const fs::path file = folder_ / name;
  const auto now = looks_of(file);
  if (found == entries_.end() || !now)
    return false;
  const auto& entries = found->second;
  const auto is_whole = [&](const Entry& e) { return e.proof == Proof::whole && e.bytes == now->bytes; };
  if (std::any_of(entries.begin(), entries.end(), [&](const Entry& e) { return is_whole(e) && e.modified == now->modified; }))
    return true;
  const auto has_its_bytes = [&](const Entry& e) { return digest_of_file(file, e.bytes) == e.digest; };
  if (std::any_of(entries.begin(), entries.end(), is_whole)) {
    const auto digest = digest_of_file(file, now->bytes);
    if (digest && std::any_of(entries.begin(), entries.end(), [&](const Entry& e) { return is_whole(e) && e.digest == *digest; }))
      return true;
  }
  const Entry& last = entries.back();
  if (last.proof == Proof::whole || last.bytes > now->bytes || !has_its_bytes(last))
    return false;
  return last.proof == Proof::begins || only_numbers(file, last.bytes);
}

std::vector<std::string> Manifest::names() const
{
  std::vector<std::string> all;
  for (const auto& [name, entries] : entries_)
    all.push_back(name);
  return all;
}

std::string Manifest::lines_of(const std::string& name) const
{
  std::string text;
  if (const auto found = entries_.find(name); found != entries_.end())
    for (const Entry& e : found->second)
      text += line_of(e.proof, e.digest, e.bytes, e.modified, name);
  return text;
}

std::string Manifest::text() const
{
  std::string all;
  for (const auto& [name, entries] : entries_)
    all += lines_of(name);
  return all;
}

void begin_manifest(const fs::path& folder)
{
  if (std::error_code unknown; !fs::exists(list_in(folder), unknown))
    replace_manifest(folder, "");
}

void replace_manifest(const fs::path& folder, const std::string& text) { write_whole(list_in(folder), text); }

void note_result(const fs::path& file, const fs::path& content, Proof proof)
{
  const auto place = place_of(file);
  if (!place)
    return;
  auto looks = looks_of(content);
  if (looks && proof == Proof::begins)
    looks->bytes = std::min(looks->bytes, bytes_of_beginning);
  const auto digest = looks ? digest_of_file(content, looks->bytes) : std::nullopt;
  if (!digest)
    throw EnvironmentError(fmt::format("cannot read {} back: {}", file.string(), std::strerror(errno)));
  append_line(list_in(place->folder), line_of(proof, *digest, looks->bytes, looks->modified, place->name), file);
}

fs::path name_aside(const fs::path& file)
{
  fs::path aside = file.string() + ".aside";
  std::error_code unknown;
  for (int n = 2; fs::exists(fs::symlink_status(aside, unknown)); ++n)
    aside = fmt::format("{}.aside.{}", file.string(), n);
  return aside;
}

void set_aside_unless_proved(const fs::path& file)
{
  const auto place = place_of(file);
  std::error_code trouble;
  const fs::file_status there = fs::symlink_status(file, trouble);
  if (!place || !fs::exists(there) || fs::is_directory(there))
    return;
  const auto manifest = Manifest::of(place->folder);
  if (!manifest || manifest->proves(place->name))
    return;
  const fs::path aside = name_aside(file);
  fs::rename(file, aside, trouble);
  if (trouble)
    throw EnvironmentError(
        fmt::format("cannot write {}: it is there, Talus did not write it or it was changed since, and it cannot be renamed: {}",
                    file.string(), trouble.message()));
  say(stderr, "warning: {} was there, and Talus did not write it or it was changed since: its name is now {}\n", file.string(),
      aside.filename().string());
}

}  // namespace talus
