#pragma once
// A digest of bytes: 64 bits that change with every byte, for files and arrays.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace talus {

/// Adds a word to a digest.  Each step is one-to-one, so a change within one word is always detected; other changes are missed with a
/// probability of 2^-64.
inline std::uint64_t digest_step(std::uint64_t h, std::uint64_t word) noexcept { return std::rotl((h ^ word) * 0x9e3779b97f4a7c15U, 29); }

// HDF5 has checksums of chunks only, which are equal for words 0 and 65535, and so for a lost page (zeros) and entries of -1, and do not
// depend on the array.  This digest has neither weakness.  Eight lanes make it as fast as memory.  It is part of file formats and must not
// change.
class Digest {
 public:
  static constexpr std::size_t lanes = 8, block = lanes * sizeof(std::uint64_t);
  /// Starts a digest for a number of bytes.
  Digest(std::uint64_t seed, std::size_t bytes) noexcept : h_(digest_step(seed, bytes))
  {
    for (std::size_t k = 0; k < lanes; ++k)
      lane_[k] = digest_step(seed, k);
  }
  /// Adds bytes; every call but the last needs whole blocks.
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

inline std::uint64_t digest_of(std::span<const std::byte> bytes, std::uint64_t seed) noexcept
{
  Digest digest(seed, bytes.size());
  digest.add(bytes);
  return digest.value();
}

}  // namespace talus
