#pragma once
// Sums over particles for loads on surfaces that cut cells, and the forces of nodes that follow from them.
#include <algorithm>
#include <tuple>
#include <vector>

#include "kernels/node_operators.hpp"
#include "solver/halo/halo.hpp"
#include "solver/loads/surface_load.hpp"
#include "solver/state/sums.hpp"
#include "solver/strips/reference.hpp"
#include "solver/transfer/strip_scratch.hpp"

namespace talus {

/// Sums over the particles of a loaded body on a linear shape function or a node.
template <int D>
struct SurfaceSum {
  Mat<D> tension = Mat<D>::Zero();  ///< sum N V S [N m], for kernels with node operators
  Vec<D> force = Vec<D>::Zero();    ///< sum V S G [N], for the others
  Real volume{}, depth{};           ///< sum |w| V [m^D], sum |w| V d [m^(D+1)]
  bool is_seen() const noexcept { return volume > 0; }
  template <class Self>
  static auto parts(Self& sum) noexcept
  {
    return std::tie(sum.tension, sum.force, sum.volume, sum.depth);
  }
  SurfaceSum& operator+=(const SurfaceSum& other) noexcept
  {
    tension += other.tension, force += other.force, volume += other.volume, depth += other.depth;
    return *this;
  }
};

/// Adds the n particles of a strip that stay in their cells to the rows of their block, through the vertices of the cells.
template <bool projects, int D>
TALUS_ONE_COPY void add_virtual_stress(const SurfaceLoad<D>& load, const StripColumns<D>& columns, const StripScratch<D>& scratch,
                                       Index block, BlockRows<D, SurfaceSum<D>>& blocks) noexcept
{
  const std::span<SurfaceSum<D>> rows = blocks.rows(block);
  for (const CellRun<D>& run : scratch.runs) {
    SurfaceSum<D> corner[D + 1];
    for (std::size_t i = run.begin; i < run.end; ++i) {
      if (scratch.stays[i] == 0)
        continue;
      const Real volume = columns.volume.of(i);
      VirtualStress<D> stress =
          virtual_stress<D>(load, columns.id[i], columns.F.of(i).template topLeftCorner<D, D>(), columns.volume0.of(i), volume);
      pull_back(columns, i, stress.tension);
      for (std::size_t a = 0; a <= D; ++a) {
        const Real share = scratch.share[a][i];
        if constexpr (projects)
          corner[a].tension += share * stress.tension;
        else
          for (int d = 0; d < D; ++d)
            corner[a].force += stress.tension.col(d) * run.frame->slope[d][a];
        corner[a].volume += share * volume;
        corner[a].depth += share * volume * stress.depth;
      }
    }
    const std::span<const std::uint16_t> slots = blocks.slots(run.frame->cell);
    for (std::size_t a = 0; a <= D; ++a)
      rows[slots[a]] += corner[a];
  }
}

/// The rows of a load, and what becomes of them.
template <int D>
struct RowsOfLoad {
  std::size_t load;  ///< its number
  BlockRows<D, SurfaceSum<D>> blocks;
  Halo<SurfaceSum<D>> halo;
  SparseRows<SurfaceSum<D>> sum;  ///< by node
  SparseRows<Vec<D>> force;       ///< by node [N]; zero at nodes that no step has visited
};

/// The rows of the loads on the bodies of a velocity field.  Empty in scenes without such loads.
template <int D>
class SurfaceRows {
 public:
  /// Makes the rows, with the tables of those of the kernel, for the loads on bodies of which is_of_field(body) holds.  Collective.
  template <class IsOfField, class Sum>
  void begin(const std::vector<SurfaceLoad<D>>& loads, IsOfField&& is_of_field, const BlockRows<D, Sum>& tables, Communicator& ranks,
             const Mesh<D>& mesh, const Subdomain& subdomain)
  {
    if (!all_.empty())
      return;
    if (std::ranges::any_of(loads, [&](const SurfaceLoad<D>& load) { return load.ends_at_walls && is_of_field(load.body); }))
      find_walls(mesh);
    for (std::size_t k = 0; k < loads.size(); ++k) {
      if (!is_of_field(loads[k].body))
        continue;
      RowsOfLoad<D>& one = all_.emplace_back();
      one.load = k;
      one.blocks = {tables.begin, tables.slot, tables.slot_begin, tables.rows_of_node, tables.block_of_row, tables.occupied, {}};
      one.blocks.row.resize(tables.row.size());
      one.halo = subdomain.alone() ? Halo<SurfaceSum<D>>(one.blocks.size())
                                   : Halo<SurfaceSum<D>>(ranks, mesh, subdomain, one.blocks, MessageTag::surfaces);
      one.sum.resize(static_cast<std::size_t>(mesh.n_nodes()));
      one.force.resize(one.sum.size());
    }
  }
  void clear(Index block) noexcept
  {
    for (RowsOfLoad<D>& one : all_) {
      const auto rows = one.blocks.rows(block);
      std::fill(rows.begin(), rows.end(), SurfaceSum<D>{});
    }
  }
  std::span<RowsOfLoad<D>> all() noexcept { return all_; }
  /// Takes from the force of an own node what a load that ends at walls would exert on them, which are all of the boundary of the mesh: the
  /// part along the mean normal there, as the area vector of a full node is that of its share of the boundary.
  Vec<D> off_walls(Index v, const Vec<D>& force) const noexcept
  {
    const Vec<D>& normal = wall_[static_cast<std::size_t>(v)];
    return force - normal.dot(force) * normal;
  }
  /// Sums the rows on nodes.  `occupied`: of the blocks, of all ranks.  Collective.
  void assemble(std::span<const std::uint8_t> occupied, const OwnNodes& own, HaloExchange& copies, const NodesInUse& in_use)
  {
    for (RowsOfLoad<D>& one : all_) {
      one.blocks.occupied.assign(occupied.begin(), occupied.end());
      one.halo.template send_rows<Whole>(one.blocks);
      talus::assemble<Whole>(one.blocks, own, one.halo, copies, in_use, one.sum, [] {});
    }
  }
  std::size_t bytes() const noexcept
  {
    std::size_t bytes = 0;
    for (const RowsOfLoad<D>& one : all_)
      bytes += (one.blocks.row.size() + one.sum.size()) * sizeof(SurfaceSum<D>) + one.force.size() * sizeof(Vec<D>);
    return bytes + wall_.size() * sizeof(Vec<D>);
  }

 private:
  void find_walls(const Mesh<D>& mesh)
  {
    wall_.assign(static_cast<std::size_t>(mesh.n_nodes()), Vec<D>::Zero());
    for (const Facet facet : mesh.boundary_facets())
      for (const Index n : mesh.nodes_of(facet))
        wall_[static_cast<std::size_t>(n)] += mesh.area_vector(facet);
    for (Vec<D>& normal : wall_)
      normal.normalize();  // zero stays zero
  }

  std::vector<RowsOfLoad<D>> all_;
  std::vector<Vec<D>> wall_;  ///< by node: mean normal of the boundary of the mesh, zero inside; empty if all loads act there too
};

/// Adds the forces of loads on surfaces to own nodes, and those of each load to its `total`; the sum of all loads is left in
/// nodes.surface_loads.  `operators` is null for kernels without.
template <int D>
void apply_surface_loads(const std::vector<SurfaceLoad<D>>& loads, Real time, Real ramp, const Mesh<D>& mesh, const OwnNodes& own,
                         const NodeOperators<D>* operators, SurfaceRows<D>& rows, Nodes<D>& nodes,
                         std::vector<ExactSums<ForceAndMoment<D>>>& total)
{
  /// Weight of nodes of the ring whose values the operators do not use, as beside a wall: only so that no node is without a depth.
  constexpr Real least_weight = 0.01;
  const auto force = [&](const SurfaceLoad<D>& load, const SparseRows<SurfaceSum<D>>& sums, Index v) -> Vec<D> {
    if (!own.has(v))
      return Vec<D>::Zero();
    Vec<D> pull = Vec<D>::Zero();
    Real volume = 0, depth = 0;
    if (operators != nullptr) {
      operators->for_each_in_column(v, [&](Index n, Real S, const Vec<D>& gradient) {
        const SurfaceSum<D>& sum = sums[static_cast<std::size_t>(n)];
        pull += sum.tension * gradient;
        volume += (S + least_weight) * sum.volume;
        depth += (S + least_weight) * sum.depth;
      });
    } else {
      const SurfaceSum<D>& sum = sums[static_cast<std::size_t>(v)];
      pull = sum.force, volume = sum.volume, depth = sum.depth;
    }
    if (!(volume > 0))
      return Vec<D>::Zero();
    if (load.ends_at_walls)
      pull = rows.off_walls(v, pull);
    return load.factor(mesh.node(v), time, ramp) * load.cut_off(depth / volume) * pull;
  };
  nodes.surface_loads.resize(nodes.sum.size());
  nodes.in_use.for_each([&](Index v) { nodes.surface_loads[static_cast<std::size_t>(v)].setZero(); });
  for (RowsOfLoad<D>& of : rows.all()) {
    nodes.in_use.for_each([&](Index v) {
      const auto i = static_cast<std::size_t>(v);
      of.force[i] = force(loads[of.load], of.sum, v);
      nodes.surface_loads[i] += of.force[i];
      nodes.sum[i].force += of.force[i];
    });
    total[of.load].clear();
    add_ranges(nodes.in_use.own(), total[of.load],
               [&](Index v) { return ForceAndMoment<D>::at(mesh.node(v), of.force[static_cast<std::size_t>(v)]); });
  }
}

}  // namespace talus
