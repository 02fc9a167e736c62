#pragma once
// Digests of meshes, to detect whether two meshes are equal.
#include <cstdint>
#include <span>
#include <string_view>

#include "mesh/mesh.hpp"

namespace talus {

/// The digest of nodes and cells, bitwise and in order, and of the groups with their names.  Different meshes have equal digests with a
/// probability of 2^-64.
template <int D>
std::uint64_t digest(const Mesh<D>& mesh);

/// The digest of a text.
std::uint64_t digest(std::string_view text);
/// The digest of the bits of numbers.
std::uint64_t digest(std::span<const Real> numbers);

}  // namespace talus
