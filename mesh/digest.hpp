#pragma once
// Whether two meshes are the same.
#include <cstdint>
#include <span>
#include <string_view>

#include "mesh/mesh.hpp"

namespace talus {

/// Of nodes and cells, to the last bit and in their order, and of the groups by name: other meshes have another number but once in 2^64.
template <int D>
std::uint64_t digest(const Mesh<D>& mesh);

/// Of a text.
std::uint64_t digest(std::string_view text);
/// Of numbers, to the last bit.
std::uint64_t digest(std::span<const Real> numbers);

extern template std::uint64_t digest<2>(const Mesh<2>&);
extern template std::uint64_t digest<3>(const Mesh<3>&);

}  // namespace talus
