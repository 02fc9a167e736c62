#pragma once
// The water that pores take up while the pressure changes, in the linear system of a step.
#include "solver/flow/pore_pressure.hpp"
#include "solver/state/sums.hpp"

namespace talus {

/// What the pores of a cell take up, W, goes to its vertices a as s_a d_a + s_a/s (W - sum_b s_b d_b), for changes of pressure d, with slopes
/// s_a and their sum s.  So slopes are lumped, which keeps fronts of water free of oscillations, and no water is lost, whatever the slopes are.
/// In the system W is linear around the changes last found, with the slope j: W + j/s sum_b s_b (x_b - d_b).  The system is solved again until
/// what it lacks is small [Celia, Bouloutas & Zarba 1990].
template <int D>
class PoreStorage {
 public:
  PoreStorage(std::size_t nodes, std::size_t cells) : surplus_(nodes), content_(nodes), in_cell_(cells), before_(cells) {}
  /// What the pores of node n take up without changes of pressure, as the system says [m^D].
  Real surplus(Index n) const noexcept { return surplus_[to_size(n)]; }
  /// What they have taken up with the changes of pressure last found [m^D].
  Real content(Index n) const noexcept { return content_[to_size(n)]; }

  /// Begins with the slopes of cells whose contents are those without a change of pressure.
  void begin(const Mesh<D>& mesh, const FlowCells<D>& cells)
  {
    parallel_for(mesh.n_cells(), [&](Index c) {
      if (cells[c].flows())
        in_cell_[to_size(c)] = {cells[c].storage, 0};
    });
  }
  void find_surplus(const Mesh<D>& mesh, const FlowCells<D>& cells, Index n)
  {
    Real sum = 0;
    for_each_cell(mesh, cells, n, [&](const FlowCell<D>& row, const InCell& in, const auto&, std::size_t a) {
      sum += in.slope[a] / total(in.slope) * row.content;
    });
    surplus_[to_size(n)] = sum;
  }
  /// What a change of pressure at all nodes stores at node n, as the system says [m^D].
  Real stored(const Mesh<D>& mesh, const FlowCells<D>& cells, const std::vector<Real>& change, Index n) const
  {
    Real sum = 0;
    for_each_cell(mesh, cells, n, [&](const FlowCell<D>&, const InCell& in, const auto& corners, std::size_t a) {
      sum += in.slope[a] * (change[to_size(n)] + in.coupling * lumped(in, corners, change));
    });
    return sum;
  }
  /// Finds the contents of the nodes that see water; returns what the equations of unknown pressures lack, as a share of the contents and the
  /// volume that the weight of water moves in the step; `residual` is that of the system.  Collective.
  template <class SeesWater, class IsUnknown>
  Real missing(const FlowModel<D>& m, const FlowCells<D>& cells, const std::vector<Real>& change, const std::vector<Real>& residual,
               const std::vector<Real>& weight, SeesWater&& sees_water, IsUnknown&& is_unknown)
  {
    ExactSums<Sums> sums;
    add_ranges(m.field.nodes.in_use.own(), sums, [&](Index n) {
      if (!sees_water(n))
        return Sums{};
      const auto [content, more] = content_at(m.mesh, cells, change, n);
      content_[to_size(n)] = content;
      const Real lack = is_unknown(n) ? residual[to_size(n)] - more : 0;
      return Sums{std::abs(lack), std::abs(content) + std::abs(weight[to_size(n)])};
    });
    m.ranks.sum(sums);
    return sums.value().scale > 0 ? sums.value().lack / sums.value().scale : 0;
  }
  /// Takes slopes from cells whose contents belong to the changes of pressure last found: those of W, and of vertices if `all`.
  void renew(const Mesh<D>& mesh, const FlowCells<D>& cells, bool all)
  {
    parallel_for(mesh.n_cells(), [&](Index c) {
      const FlowCell<D>& row = cells[c];
      if (!row.flows())
        return;
      InCell& in = in_cell_[to_size(c)];
      before_[to_size(c)] = in;
      if (all)
        in.slope = row.storage;
      const Real s = total(in.slope);
      in.coupling = all ? 0 : (total(row.storage) - s) / (s * s);
    });
  }
  /// After renew(): returns what the system at node n then says that pores take up, less what it said before, with these changes; calls
  /// change_entry(b, by) for all entries of the row that change.
  template <class F>
  Real renew_row(const Mesh<D>& mesh, const FlowCells<D>& cells, const std::vector<Real>& change, Index n, F&& change_entry)
  {
    Real more = 0, surplus = 0;
    for_each_cell(mesh, cells, n, [&](const FlowCell<D>& row, const InCell& in, const auto& corners, std::size_t a) {
      const InCell& old = before_[static_cast<std::size_t>(&in - in_cell_.data())];
      const Real s = total(in.slope), mean = lumped(in, corners, change);
      const Real linear = in.slope[a] * (change[to_size(n)] + in.coupling * mean);
      const Real now = in.slope[a] * change[to_size(n)] + in.slope[a] / s * (row.content - mean);
      surplus += now - linear;
      more += now - old.slope[a] * (change[to_size(n)] + old.coupling * lumped(old, corners, change));
      if (in.slope == old.slope && in.coupling == old.coupling)
        return;
      for (std::size_t b = 0; b <= D; ++b)
        if (const Real by = in.entry(a, b) - old.entry(a, b); by != 0)
          change_entry(corners[b], by);
    });
    more -= surplus_[to_size(n)];
    surplus_[to_size(n)] = surplus;
    return more;
  }

 private:
  struct Sums {
    Real lack{}, scale{};
    Sums& operator+=(const Sums& other) noexcept
    {
      lack += other.lack, scale += other.scale;
      return *this;
    }
  };
  struct InCell {
    std::array<Real, D + 1> slope{};  ///< s_a [m^D/Pa]
    Real coupling{};                  ///< (j - s)/s^2 [Pa/m^D]
    Real entry(std::size_t a, std::size_t b) const noexcept { return (a == b ? slope[a] : 0) + coupling * slope[a] * slope[b]; }
  };
  static Real total(const std::array<Real, D + 1>& slope) noexcept
  {
    Real sum = 0;
    for (const Real one : slope)
      sum += one;
    return sum;
  }
  static Real lumped(const InCell& in, const auto& corners, const std::vector<Real>& change) noexcept
  {
    Real sum = 0;
    for (std::size_t b = 0; b <= D; ++b)
      sum += in.slope[b] * change[to_size(corners[b])];
    return sum;
  }
  /// f(sums of the cell, its part in the system, its vertices, which of them is n) for the cells around node n.
  template <class F>
  void for_each_cell(const Mesh<D>& mesh, const FlowCells<D>& cells, Index n, F&& f) const
  {
    for (const Index c : mesh.cells_of_node()[n])
      if (const FlowCell<D>& row = cells[c]; row.flows()) {
        const auto& corners = mesh.cell(c);
        f(row, in_cell_[to_size(c)], corners, static_cast<std::size_t>(std::ranges::find(corners, n) - corners.begin()));
      }
  }
  /// What pores of node n take up, and what the system does not say of it.
  std::pair<Real, Real> content_at(const Mesh<D>& mesh, const FlowCells<D>& cells, const std::vector<Real>& change, Index n) const
  {
    Real content = 0, said = surplus_[to_size(n)];
    for_each_cell(mesh, cells, n, [&](const FlowCell<D>& row, const InCell& in, const auto& corners, std::size_t a) {
      const Real mean = lumped(in, corners, change);
      content += in.slope[a] * change[to_size(n)] + in.slope[a] / total(in.slope) * (row.content - mean);
      said += in.slope[a] * (change[to_size(n)] + in.coupling * mean);
    });
    return {content, content - said};
  }

  std::vector<Real> surplus_, content_;
  std::vector<InCell> in_cell_, before_;
};

}  // namespace talus
