// FNV-1a, four bytes at a time.
#include "mesh/digest.hpp"

#include <algorithm>
#include <cstring>

namespace talus {

namespace {

constexpr std::uint64_t start = 0xcbf29ce484222325;

void digest_bytes(std::span<const std::byte> bytes, std::uint64_t& sum)
{
  for (std::size_t at = 0; at < bytes.size(); at += 4) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + at, std::min<std::size_t>(4, bytes.size() - at));
    sum = (sum ^ word) * 0x100000001b3;
  }
}

}  // namespace

template <int D>
std::uint64_t digest(const Mesh<D>& mesh)
{
  std::uint64_t sum = start;
  digest_bytes(std::as_bytes(mesh.nodes()), sum);
  digest_bytes(std::as_bytes(mesh.cells()), sum);
  return sum;
}

std::uint64_t digest(std::string_view text)
{
  std::uint64_t sum = start;
  digest_bytes(std::as_bytes(std::span(text)), sum);
  return sum;
}

template std::uint64_t digest<2>(const Mesh<2>&);
template std::uint64_t digest<3>(const Mesh<3>&);

}  // namespace talus
