#include "io/files/byte_digest.hpp"

namespace talus {

std::uint64_t digest_of(std::span<const std::byte> bytes, std::uint64_t seed) noexcept
{
  Digest digest(seed, bytes.size());
  digest.add(bytes);
  return digest.value();
}

}  // namespace talus
