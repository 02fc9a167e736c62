#pragma once
// Sums over the particles of each cell through which water flows.
#include "materials/interface/material.hpp"
#include "solver/flow/flow.hpp"
#include "solver/halo/halo_exchange.hpp"
#include "solver/stress/node_patch_sums.hpp"

namespace talus {

/// Sums over the particles of a cell, which are those that it had when they last moved.
template <int D>
struct FlowCell {
  Real filled{};                       ///< volume of all particles, also those through which no water flows [m^D]
  Real volume{};                       ///< of those through which it does [m^D]
  Real biot{};                         ///< volume times Biot's coefficient and the saturation [m^D]
  Real storage{};                      ///< volume of water that a pressure stores [m^D/Pa]
  Real mobility{};                     ///< volume times permeability over the weight of water [m^(D+4)/(N s)]
  Real compliance{};                   ///< volume over the stiffness of the skeleton [m^D/Pa]
  std::array<Real, D + 1> weight{};    ///< sum of V N at its vertices [m^D]
  std::array<Real, D + 1> pressure{};  ///< sum of V N times the pore pressure there [m^D Pa]

  bool flows() const noexcept { return volume > 0; }
  bool is_seen() const noexcept { return filled != 0; }
  template <class Self>
  static auto parts(Self& row) noexcept
  {
    return std::tie(row.filled, row.volume, row.biot, row.storage, row.mobility, row.compliance, row.weight, row.pressure);
  }
};

/// The sums of all cells.
template <int D>
class FlowCells {
 public:
  explicit FlowCells(const Mesh<D>& mesh) : cells_(static_cast<std::size_t>(mesh.n_cells())) {}
  FlowCells(Communicator& ranks, const Mesh<D>& mesh, const Subdomain& subdomain)
      : cells_(static_cast<std::size_t>(mesh.n_cells())), copies_(copies_of_cells(ranks, subdomain, MessageTag::flow_cells, mesh.n_cells()))
  {}

  const FlowCell<D>& operator[](Index cell) const noexcept { return cells_[static_cast<std::size_t>(cell)]; }

  /// Collective.
  void sum(const Mesh<D>& mesh, const Flow& flow, const std::vector<Material>& materials, const ParticleStrips<D>& strips)
  {
    parallel_for_uneven(strips.blocks(), [&](Index block) {
      for (Index c = block * block_cells; c < std::min(mesh.n_cells(), (block + 1) * block_cells); ++c)
        if (FlowCell<D>& row = cells_[static_cast<std::size_t>(c)]; row.is_seen())
          row = {};
      for (Index group = 0; group < strips.groups(); ++group)
        flow.flows(strips.body_of(group)) ? add_wet(mesh, flow, materials, strips, group, block) : add_dry(strips, group, block);
    });
    copies_.send(cells_, Whole{});
    copies_.take(cells_, Whole{});
  }

 private:
  void add_dry(const ParticleStrips<D>& strips, Index group, Index block)
  {
    for_each_cell_of(strips, std::span(&group, 1), block, [&](Index c, auto&& runs) {
      runs([&](const ParticlesInCell<D>& run) {
        for (std::size_t p = run.begin; p < run.end; ++p)
          cells_[static_cast<std::size_t>(c)].filled += run.columns.volume.of(p);
      });
    });
  }
  void add_wet(const Mesh<D>& mesh, const Flow& flow, const std::vector<Material>& materials, const ParticleStrips<D>& strips, Index group,
               Index block)
  {
    const auto body = static_cast<std::size_t>(strips.body_of(group));
    const FlowOfBody& pores = flow.bodies[body];
    const Real speed = materials[body].law().wave_speed(Mat3::Identity());
    for_each_cell_of(strips, std::span(&group, 1), block, [&](Index c, auto&& runs) {
      FlowCell<D>& row = cells_[static_cast<std::size_t>(c)];
      runs([&](const ParticlesInCell<D>& run) {
        for_each_shape(mesh, c, run, [&](std::size_t p, const Pack& shape) {
          const Real volume = run.columns.volume.of(p), n = pores.porosity_at(volume / run.columns.volume0.of(p));
          row.filled += volume;
          row.volume += volume;
          const Real p_p = run.columns.water.of(p), full = pores.retention.saturation(p_p);
          row.biot += volume * pores.biot * full;
          row.storage += volume * n * (full / pores.bulk_modulus + pores.retention.capacity(p_p));
          row.mobility += volume * pores.permeability_at(n) * pores.retention.conductance(p_p) / flow.unit_weight;
          row.compliance += volume * volume / (run.columns.mass.of(p) * speed * speed);
          const Vec<D> slope = run.columns.water_gradient.of(p), x = run.columns.x.of(p);
          for (std::size_t a = 0; a <= D; ++a) {
            const Real share = volume * shape[static_cast<int>(a)];
            row.weight[a] += share;
            row.pressure[a] += share * (p_p + slope.dot(mesh.node(mesh.cell(c)[a]) - x));
          }
        });
      });
    });
  }

  SparseRows<FlowCell<D>> cells_;
  HaloExchange copies_;
};

}  // namespace talus
