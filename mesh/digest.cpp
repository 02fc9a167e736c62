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

/// Adds values after their number, so that a value cannot move from one list to the next without a change of the digest.
template <class T>
void digest_counted(std::span<const T> items, std::uint64_t& sum)
{
  const std::uint64_t count = items.size();
  digest_bytes(std::as_bytes(std::span(&count, 1)), sum);
  digest_bytes(std::as_bytes(items), sum);
}

/// Adds the groups of one kind in the order of their names; members(name) returns the members of each.
template <class Members>
void digest_sets(const std::vector<std::string>& names, Members&& members, std::uint64_t& sum)
{
  const std::uint64_t count = names.size();
  digest_bytes(std::as_bytes(std::span(&count, 1)), sum);
  for (const std::string& name : names) {
    const auto set = members(name);
    digest_counted(std::span<const char>(name), sum);
    digest_counted(std::span<const typename decltype(set)::value_type::value_type>(*set), sum);
  }
}

}  // namespace

template <int D>
std::uint64_t digest(const Mesh<D>& mesh)
{
  std::uint64_t sum = start;
  digest_bytes(std::as_bytes(mesh.nodes()), sum);
  digest_bytes(std::as_bytes(mesh.cells()), sum);
  digest_sets(
      mesh.node_set_names(), [&](const std::string& name) { return mesh.node_set(name); }, sum);
  digest_sets(
      mesh.facet_set_names(), [&](const std::string& name) { return mesh.facet_set(name); }, sum);
  digest_sets(
      mesh.cell_set_names(), [&](const std::string& name) { return mesh.cell_set(name); }, sum);
  return sum;
}

std::uint64_t digest(std::string_view text)
{
  std::uint64_t sum = start;
  digest_bytes(std::as_bytes(std::span(text)), sum);
  return sum;
}

std::uint64_t digest(std::span<const Real> numbers)
{
  std::uint64_t sum = start;
  digest_bytes(std::as_bytes(numbers), sum);
  return sum;
}

template std::uint64_t digest<2>(const Mesh<2>&);
template std::uint64_t digest<3>(const Mesh<3>&);

}  // namespace talus
