#pragma once
// The water that pores take up while the pressure changes, in the linear system of a step.
#include "solver/flow/pore_pressure.hpp"
#include "solver/state/sums.hpp"

namespace talus {

/// What the pores of a node take up: slope times its change of pressure, and a surplus [m^D].
struct NodeStorage {
  Real slope{};    ///< [m^D/Pa]
  Real surplus{};  ///< [m^D]
  Real content{};  ///< what they have taken up with the pressures last found [m^D]
};

/// Slopes are lumped at nodes, which keeps fronts of water free of oscillations; what the sum over a cell then lacks of what its pores take up
/// goes to its vertices, and the system is solved again until that is small, so that no water is lost [Celia, Bouloutas & Zarba 1990].
template <int D>
class PoreStorage {
 public:
  explicit PoreStorage(std::size_t nodes) : at_(nodes) {}
  const NodeStorage& operator[](Index n) const noexcept { return at_[to_size(n)]; }

  /// Takes slope and surplus of node n from cells whose contents belong to these changes of pressure.
  void find(const Mesh<D>& mesh, const FlowCells<D>& cells, const std::vector<Real>& change, Index n)
  {
    const NodeStorage now = storage_at(mesh, cells, change, n);
    at_[to_size(n)].slope = now.slope, at_[to_size(n)].surplus = now.surplus;
  }
  /// Finds the contents of the nodes that see water; returns whether they are those of the system, compared with themselves and the volume
  /// that the weight of water moves in the step.  Collective.
  template <class SeesWater>
  bool has_contents_of(const FlowModel<D>& m, const FlowCells<D>& cells, const std::vector<Real>& change, const std::vector<Real>& weight,
                       SeesWater&& sees_water)
  {
    constexpr Real enough = 1e-6;
    ExactSums<Sums> sums;
    add_ranges(m.field.nodes.in_use.own(), sums, [&](Index n) {
      if (!sees_water(n))
        return Sums{};
      const NodeStorage now = storage_at(m.mesh, cells, change, n);
      NodeStorage& here = at_[to_size(n)];
      here.content = now.slope * change[to_size(n)] + now.surplus;
      const Real in_system = here.slope * change[to_size(n)] + here.surplus;
      return Sums{std::abs(here.content - in_system), std::abs(here.content) + std::abs(weight[to_size(n)])};
    });
    m.ranks.sum(sums);
    return sums.value().difference <= enough * sums.value().scale;
  }

 private:
  struct Sums {
    Real difference{}, scale{};
    Sums& operator+=(const Sums& other) noexcept
    {
      difference += other.difference, scale += other.scale;
      return *this;
    }
  };
  static NodeStorage storage_at(const Mesh<D>& mesh, const FlowCells<D>& cells, const std::vector<Real>& change, Index n)
  {
    NodeStorage sum;
    for (const Index c : mesh.cells_of_node()[n]) {
      const FlowCell<D>& row = cells[c];
      if (!row.flows())
        continue;
      const auto& corners = mesh.cell(c);
      const auto a = static_cast<std::size_t>(std::ranges::find(corners, n) - corners.begin());
      Real lumped = 0, total = 0;
      for (std::size_t b = 0; b <= D; ++b)
        lumped += row.storage[b] * change[to_size(corners[b])], total += row.storage[b];
      sum.slope += row.storage[a];
      sum.surplus += (row.content - lumped) * (row.storage[a] / total);
    }
    return sum;
  }

  std::vector<NodeStorage> at_;
};

}  // namespace talus
