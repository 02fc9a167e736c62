#pragma once
// A mesh that is shared out among ranks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <set>
#include <tuple>

#include "mesh/digest.hpp"
#include "mesh/locate.hpp"
#include "mesh/part.hpp"
#include "mesh/partition.hpp"
#include "mesh/simplex.hpp"
#include "tests/mesh/rough_box.hpp"

namespace talus::part_test {

using ::testing::ElementsAreArray;

inline std::size_t z(Index i) { return static_cast<std::size_t>(i); }

/// A mesh of 17 or 94 blocks, the last one short, and its ranks.
template <int D>
struct Shared {
  static constexpr int rings = 2;
  Mesh<D> whole{rough_box<D>(D == 2 ? 23 : 10)};
  std::vector<int> ranks;
  std::vector<Part<D>> parts;

  explicit Shared(int n = 3) : ranks(partition<D>(whole, std::vector<std::int64_t>(z(blocks_of(whole.n_cells())), 500), n))
  {
    for (int rank = 0; rank < n; ++rank)
      parts.push_back(cut<D>(whole, ranks, rank, rings));
  }
};

/// Numbers of the whole mesh for numbers of cells or nodes of a part.
template <int D>
inline std::vector<Index> whole_cells(const Part<D>& part, std::span<const Index> local)
{
  std::vector<Index> result;
  for (const Index c : local)
    result.push_back(c == none ? none : part.subdomain.whole_cell(c));
  return result;
}
template <int D>
inline std::vector<Index> whole_nodes(const Part<D>& part, std::span<const Index> local)
{
  std::vector<Index> result;
  for (const Index n : local)
    result.push_back(part.subdomain.node[z(n)]);
  return result;
}

}  // namespace talus::part_test
