#pragma once
// Digests of arrays: what a file says of its values, so that none that changed is ever taken for one that was written.
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "core/slices.hpp"
#include "io/array_file.hpp"

namespace talus {

struct Extents {
  std::uint64_t rows = 0;
  std::uint64_t columns = 1;
};

/// Changes with every word: each step is one to one, so a change inside one word is always noticed, any other but once in 2^64.
inline std::uint64_t digest_step(std::uint64_t h, std::uint64_t word) noexcept { return std::rotl((h ^ word) * 0x9e3779b97f4a7c15U, 29); }

// HDF5 has checksums of chunks only, which take words 0 and 65535 for the same, and with them a lost page (zeros) for entries of -1, and do not
// know which array they stand in.  This digest does.  Eight lanes: as fast as memory.  Files are read by it: it must not change.
class Digest {
 public:
  static constexpr std::size_t lanes = 8, block = lanes * sizeof(std::uint64_t);
  /// Of so many bytes.
  Digest(std::uint64_t seed, std::size_t bytes) noexcept : h_(digest_step(seed, bytes))
  {
    for (std::size_t k = 0; k < lanes; ++k)
      lane_[k] = digest_step(seed, k);
  }
  /// All but the last time whole blocks.
  void add(std::span<const std::byte> bytes) noexcept
  {
    std::size_t done = 0;
    for (; done + block <= bytes.size(); done += block) {
      std::array<std::uint64_t, lanes> word{};
      std::memcpy(word.data(), bytes.data() + done, block);
      for (std::size_t k = 0; k < lanes; ++k)
        lane_[k] = digest_step(lane_[k], word[k]);
    }
    if (done < bytes.size())
      std::memcpy(rest_.data(), bytes.data() + done, bytes.size() - done);
  }
  std::uint64_t value() const noexcept
  {
    std::uint64_t h = h_;
    for (std::size_t k = 0; k < lanes; ++k)
      h = digest_step(digest_step(h, lane_[k]), rest_[k]);
    return h ^ (h >> 32);
  }

 private:
  std::uint64_t h_;
  std::array<std::uint64_t, lanes> lane_{}, rest_{};
};

std::uint64_t digest_of(std::span<const std::byte> bytes, std::uint64_t seed) noexcept;

/// Of all that says what values mean: it goes into the digest of each piece of them.
std::uint64_t digest_of(const std::string& path, const std::string& type, const Extents& shape, const std::string& unit);

/// The pieces of an array and their digests.
struct Pieces {
  Slice all;  // from row 0 on
  std::vector<std::uint64_t> digests;

  /// As they are kept; of one piece, or none, there is no more to say.
  std::vector<std::uint64_t> words() const
  {
    std::vector<std::uint64_t> kept;
    if (digests.size() > 1)
      kept = {static_cast<std::uint64_t>(all.piece), static_cast<std::uint64_t>(all.lead)};
    kept.insert(kept.end(), digests.begin(), digests.end());
    return kept;
  }
  std::uint64_t digest(std::uint64_t meaning) const { return digest_of(std::as_bytes(std::span<const std::uint64_t>(words())), meaning); }
};

/// Copies rows of an array from the one of that number on, as many as there is room for.
void pack(const SharedArray& array, std::size_t from, std::size_t row_bytes, std::span<std::byte> to);

/// Of the pieces of an array that are here.
std::vector<std::uint64_t> digests_of(const SharedArray& array, std::size_t number_bytes, std::uint64_t meaning);

}  // namespace talus
