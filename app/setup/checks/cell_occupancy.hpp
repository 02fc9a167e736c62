#pragma once
// Where material is, and from which side of a facet it is seen.
#include <limits>
#include <vector>

#include "core/parallel/communicator.hpp"
#include "core/particles.hpp"
#include "mesh/mesh.hpp"

namespace talus {

/// Which cells have material, on any rank, where bodies are placed.  Every rank has to ask.
template <int D>
class CellOccupancy {
 public:
  /// By the bodies that are `there`, by their names.
  template <class There>
  CellOccupancy(const Mesh<D>& mesh, const Particles<D>& particles, const std::vector<Body>& bodies, Communicator& ranks, There&& there)
      : mesh_(mesh), filled_(static_cast<std::size_t>(mesh.n_cells() / cells_in_word + 1), 0)
  {
    for (const Body& body : bodies)
      for (Index row = body.begin; there(body.name) && row < body.end; ++row) {
        const Index c = particles.cell[static_cast<std::size_t>(row)];
        filled_[word_of(c)] |= bit_of(c);
      }
    ranks.sum(filled_);  // no cell is filled by two ranks
  }
  bool operator()(Index cell) const { return (filled_[word_of(cell)] & bit_of(cell)) != 0; }
  /// Facets of a group inside the mesh belong to the side that has material, if only one has; where neither has, to that which material
  /// reaches first, from cell to cell and not through the group: so it comes to an obstacle from outside.
  std::vector<Facet> orient_facets(std::vector<Facet> facets) const
  {
    std::vector<Index> way;  // found when it is needed
    for (Facet& facet : facets) {
      const Index other = across(facet);
      if (other == none || ((*this)(facet.cell) && (*this)(other)))
        continue;
      if (way.empty() && !(*this)(facet.cell) && !(*this)(other))
        way = cells_from_material(facets);
      const auto far = [&](Index cell) { return (*this)(cell) ? 0 : way.empty() ? 1 : way[static_cast<std::size_t>(cell)]; };
      if (far(other) < far(facet.cell))
        facet = back(facet);
    }
    return facets;
  }
  /// Facets with material on both sides.
  Index inside_material(const std::vector<Facet>& facets) const
  {
    return static_cast<Index>(std::count_if(
        facets.begin(), facets.end(), [&](Facet facet) { return across(facet) != none && (*this)(facet.cell) && (*this)(across(facet)); }));
  }

 private:
  Index across(Facet facet) const { return mesh_.neighbours(facet.cell)[static_cast<std::size_t>(facet.local)]; }
  /// The same facet, seen from its other cell.
  Facet back(Facet facet) const
  {
    const auto& neighbours = mesh_.neighbours(across(facet));
    return {across(facet), static_cast<Index>(std::find(neighbours.begin(), neighbours.end(), facet.cell) - neighbours.begin())};
  }
  /// Of each cell how many cells away the nearest material is, the facets being closed.
  std::vector<Index> cells_from_material(const std::vector<Facet>& closed) const
  {
    std::vector<std::uint8_t> shut(static_cast<std::size_t>(mesh_.n_cells()), 0);
    const auto shut_one = [&](Facet facet) { shut[static_cast<std::size_t>(facet.cell)] |= static_cast<std::uint8_t>(1 << facet.local); };
    for (const Facet facet : closed) {
      shut_one(facet);
      if (across(facet) != none)
        shut_one(back(facet));
    }
    std::vector<Index> far(shut.size(), std::numeric_limits<Index>::max()), next;
    for (Index c = 0; c < mesh_.n_cells(); ++c)
      if ((*this)(c))
        far[static_cast<std::size_t>(c)] = 0, next.push_back(c);
    for (std::size_t i = 0; i < next.size(); ++i)
      for (Index local = 0; local <= D; ++local) {
        const auto c = static_cast<std::size_t>(next[i]);
        const Index other = across({next[i], local});
        if (other == none || (shut[c] >> local & 1) != 0 || far[static_cast<std::size_t>(other)] <= far[c] + 1)
          continue;
        far[static_cast<std::size_t>(other)] = far[c] + 1;
        next.push_back(other);
      }
    return far;
  }

  static constexpr Index cells_in_word = 32;
  static std::size_t word_of(Index cell) { return static_cast<std::size_t>(cell / cells_in_word); }
  static std::int64_t bit_of(Index cell) { return std::int64_t{1} << (cell % cells_in_word); }

  const Mesh<D>& mesh_;
  std::vector<std::int64_t> filled_;
};

}  // namespace talus
