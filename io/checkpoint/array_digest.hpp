#pragma once
// Digests of arrays, by which a reader detects every change of a value since it was written.
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/parallel/slices.hpp"
#include "io/checkpoint/array_file.hpp"
#include "io/files/byte_digest.hpp"

namespace talus {

struct Extents {
  std::uint64_t rows = 0;
  std::uint64_t columns = 1;
};

/// The digest of everything that defines the meaning of values; it enters the digest of each piece of them.
std::uint64_t digest_of(const std::string& path, const std::string& type, const Extents& shape, const std::string& unit);

/// The pieces of an array and their digests.
struct Pieces {
  Slice all;  // all rows, from row 0 on
  std::vector<std::uint64_t> digests;

  /// The words to be stored: the digest of each piece; if there are several pieces, preceded by their size and lead.
  std::vector<std::uint64_t> words() const
  {
    std::vector<std::uint64_t> stored;
    if (digests.size() > 1)
      stored = {static_cast<std::uint64_t>(all.piece), static_cast<std::uint64_t>(all.lead)};
    stored.insert(stored.end(), digests.begin(), digests.end());
    return stored;
  }
  std::uint64_t digest(std::uint64_t meaning) const { return digest_of(std::as_bytes(std::span<const std::uint64_t>(words())), meaning); }
};

/// Copies rows of an array, from row number `from` on, as many as fit.
void pack(const SharedArray& array, std::size_t from, std::size_t row_bytes, std::span<std::byte> to);

/// The digests of the pieces of an array on this rank.
std::vector<std::uint64_t> digests_of(const SharedArray& array, std::size_t number_bytes, std::uint64_t meaning);

}  // namespace talus
