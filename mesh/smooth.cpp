#include "mesh/smooth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/check.hpp"
#include "mesh/connectivity.hpp"
#include "mesh/quality.hpp"
#include "mesh/simplex.hpp"

namespace talus {

namespace {

/// The nodes that must stay: on the boundary, in a named group of nodes or facets, or at cells inside and outside of a group.
template <int D>
std::vector<std::uint8_t> fixed_nodes(const MeshData<D>& data, const Csr& cells_of_node)
{
  const auto n_nodes = static_cast<Index>(data.nodes.size());
  std::vector<std::uint8_t> fixed(data.nodes.size(), 0);
  const auto fix = [&](Index n) {
    if (n >= 0 && n < n_nodes)  // Mesh refuses other numbers
      fixed[static_cast<std::size_t>(n)] = 1;
  };
  const FacetMatch<D> match = match_facets<D>(data.cells, cells_of_node);
  for (std::size_t c = 0; c < data.cells.size(); ++c)
    for (std::size_t a = 0; a <= D; ++a)
      if (match.neighbours[c][a] == none)
        for (const int local : facet_locals<D>[a])
          fix(data.cells[c][static_cast<std::size_t>(local)]);
  for (const auto& [name, nodes] : data.node_sets)
    std::ranges::for_each(nodes, fix);
  for (const auto& [name, facets] : data.facet_sets)
    for (const auto& facet : facets)
      std::ranges::for_each(facet, fix);
  for (const auto& [name, cells] : data.cell_sets) {
    std::vector<std::uint8_t> inside(data.cells.size(), 0);
    for (const Index c : cells)
      if (c >= 0 && static_cast<std::size_t>(c) < inside.size())
        inside[static_cast<std::size_t>(c)] = 1;
    for (Index n = 0; n < n_nodes; ++n) {
      const auto star = cells_of_node[n];
      const auto in = std::ranges::count_if(star, [&](Index c) { return inside[static_cast<std::size_t>(c)] != 0; });
      if (in > 0 && static_cast<std::size_t>(in) < star.size())
        fix(n);
    }
  }
  return fixed;
}

/// The worst of some cells.
struct Worst {
  Real ratio = std::numeric_limits<Real>::infinity();     ///< mean_ratio()
  Real altitude = std::numeric_limits<Real>::infinity();  ///< smallest altitude [m]
};

/// Moves nodes one at a time, within the limits that smoothed() states.
template <int D>
class Smoother {
 public:
  explicit Smoother(MeshData<D>& data)
      : data_(data),
        cells_of_node_(cells_at_nodes<D>(data.cells, static_cast<Index>(data.nodes.size()))),
        fixed_(fixed_nodes(data, cells_of_node_)),
        negative_(data.cells.size())
  {
    for (Index c = 0; c < static_cast<Index>(data.cells.size()); ++c) {
      const Simplex<D> s = corners(c);
      negative_[static_cast<std::size_t>(c)] = signed_volume<D>(s) < 0 ? 1 : 0;
      least_altitude_ = std::min(least_altitude_, std::ranges::min(altitudes<D>(s)));
    }
  }

  void sweep()
  {
    for (Index n = 0; n < static_cast<Index>(fixed_.size()); ++n)
      if (fixed_[static_cast<std::size_t>(n)] == 0 && !cells_of_node_[n].empty())
        move(n);
  }

 private:
  Simplex<D> corners(Index c) const
  {
    Simplex<D> s;
    for (std::size_t a = 0; a <= D; ++a)
      s[a] = data_.nodes[static_cast<std::size_t>(data_.cells[static_cast<std::size_t>(c)][a])];
    return s;
  }

  /// The worst cell at n; a ratio and an altitude of 0 if a cell is inverted.
  Worst worst_at(Index n) const
  {
    Worst worst;
    for (const Index c : cells_of_node_[n]) {
      const Simplex<D> s = corners(c);
      if (const Real volume = signed_volume<D>(s); !(negative_[static_cast<std::size_t>(c)] != 0 ? volume < 0 : volume > 0))
        return {0, 0};
      worst.ratio = std::min(worst.ratio, mean_ratio<D>(s));
      worst.altitude = std::min(worst.altitude, std::ranges::min(altitudes<D>(s)));
    }
    return worst;
  }

  void move(Index n)
  {
    constexpr int tries = 4;  // the whole way, a half, a quarter, an eighth
    Vec<D>& x = data_.nodes[static_cast<std::size_t>(n)];
    const Vec<D> start = x;
    Vec<D> way = star_offset<D>(data_.nodes, data_.cells, cells_of_node_[n], n);
    Real least_ratio = smoothed_mean_ratio;
    for (int i = 0; i < tries; ++i, way /= 2) {
      x = start + way;
      const Worst worst = worst_at(n);
      if (worst.altitude >= least_altitude_ && worst.ratio >= least_ratio)
        return;
      if (i == 0) {  // only now, as few moves come here
        x = start;
        least_ratio = std::min(least_ratio, worst_at(n).ratio);
      }
    }
    x = start;
  }

  MeshData<D>& data_;
  Csr cells_of_node_;
  std::vector<std::uint8_t> fixed_, negative_;
  Real least_altitude_ = std::numeric_limits<Real>::infinity();
};

}  // namespace

template <int D>
MeshData<D> smoothed(MeshData<D> data, Index sweeps)
{
  check_nodes_and_cells(data);
  Smoother<D> smoother(data);
  for (Index i = 0; i < sweeps; ++i)
    smoother.sweep();
  return data;
}

template MeshData<2> smoothed<2>(MeshData<2>, Index);
template MeshData<3> smoothed<3>(MeshData<3>, Index);

}  // namespace talus
