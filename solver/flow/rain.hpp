#pragma once
// Rain on the surface of bodies.
#include "solver/flow/pore_pressure.hpp"

namespace talus {

/// The outward area vector of a node's share in the surface of the bodies is the integral of the gradient of its shape function over them.
/// Cells a little fuller or emptier than they should be would let rain in inside, so only nodes near half-empty cells count.
template <int D>
class Rain {
 public:
  static constexpr Real full_cell = 0.5;  ///< cells that are less full, as a share of their volume, are at the surface

  explicit Rain(std::size_t nodes) : open_(nodes) {}

  /// Adds the volume of a step to those of nodes that see water.  send(flags): to the ranks that use the nodes.  Collective.
  template <class SeesWater, class Send>
  void add(const FlowModel<D>& m, const FlowCells<D>& cells, const FlowStep<D>& step, SeesWater&& sees_water, std::vector<Real>& inflow,
           Send&& send)
  {
    const Mesh<D>& mesh = m.mesh;
    const NodesInUse& in_use = m.field.nodes.in_use;
    const Real volume = step.dt * m.flow.pace(step.end) * (*m.flow.rain)(step.end), weight = step.weight.norm();
    const auto filled = [&](Index c) { return std::min(cells[c].filled / mesh.volume(c), Real{1}); };
    in_use.for_each([&](Index n) {
      const auto is_open = [&](Index c) { return filled(c) < full_cell; };
      open_[to_size(n)] = m.own.has(n) && std::ranges::any_of(mesh.cells_of_node()[n], is_open) ? 1 : 0;
    });
    send(open_);
    const auto beside_surface = [&](Index c) {  // vertices of cells with particles are in use
      return filled(c) < full_cell || std::ranges::any_of(mesh.cell(c), [&](Index n) { return open_[to_size(n)] != 0; });
    };
    in_use.for_each([&](Index n) {
      if (!sees_water(n) || weight == 0 || std::ranges::none_of(mesh.cells_of_node()[n], beside_surface))
        return;
      Vec<D> area = Vec<D>::Zero();
      for (const Index c : mesh.cells_of_node()[n]) {
        const auto a = static_cast<std::size_t>(std::ranges::find(mesh.cell(c), n) - mesh.cell(c).begin());
        area += filled(c) * mesh.volume(c) * mesh.gradients(c)[a];
      }
      inflow[to_size(n)] += volume * std::max(-area.dot(step.weight) / weight, Real{0});
    });
  }

 private:
  std::vector<std::uint8_t> open_;  ///< nodes of cells that are half empty
};

}  // namespace talus
