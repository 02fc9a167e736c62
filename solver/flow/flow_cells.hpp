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
  Real content{};                      ///< volume of water that the pores take up until the pressures of find_contents() [m^D]
  Real mobility{};                     ///< volume times permeability over the weight of water [m^(D+4)/(N s)]
  Real compliance{};                   ///< volume over the stiffness of the skeleton [m^D/Pa]
  std::array<Real, D + 1> storage{};   ///< volume of water that a pressure at its vertices stores [m^D/Pa]
  std::array<Real, D + 1> weight{};    ///< sum of V N at its vertices [m^D]
  std::array<Real, D + 1> pressure{};  ///< sum of V N times the pore pressure there [m^D Pa]

  bool drained = false;               ///< whether a pressure of the particles is negative
  Real resting{};                     ///< volume of water that their pressures store, as if all were full [m^D]
  std::array<Real, D + 1> elastic{};  ///< `storage` if all are full [m^D/Pa]

  bool flows() const noexcept { return volume > 0; }
  bool is_seen() const noexcept { return filled != 0; }
  template <class Self>
  static auto parts(Self& row) noexcept
  {
    return std::tie(row.filled, row.volume, row.biot, row.content, row.mobility, row.compliance, row.storage, row.weight, row.pressure);
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

  /// `pace`: how many times faster water flows than its permeabilities say.  Collective.
  void sum(const Mesh<D>& mesh, const Flow& flow, const std::vector<Material>& materials, const ParticleStrips<D>& strips, Real pace)
  {
    parallel_for_uneven(strips.blocks(), [&](Index block) {
      for (Index c = block * block_cells; c < std::min(mesh.n_cells(), (block + 1) * block_cells); ++c)
        if (FlowCell<D>& row = cells_[static_cast<std::size_t>(c)]; row.is_seen())
          row = {};
      for (Index group = 0; group < strips.groups(); ++group)
        flow.flows(strips.body_of(group)) ? add_wet(mesh, flow, materials, strips, group, block, pace) : add_dry(strips, group, block);
    });
    copies_.send(cells_, Whole{});
    copies_.take(cells_, Whole{});
  }

  /// Finds anew what pores take up, and what a change of pressure stores, if the nodes get these pressures [Pa], after they were tried with
  /// the last ones.  Collective.
  void find_contents(const Mesh<D>& mesh, const Flow& flow, const ParticleStrips<D>& strips, const std::vector<Real>& pressure,
                     const std::vector<Real>& last)
  {
    parallel_for_uneven(strips.blocks(), [&](Index block) {
      for (Index c = block * block_cells; c < std::min(mesh.n_cells(), (block + 1) * block_cells); ++c)
        if (FlowCell<D>& row = cells_[static_cast<std::size_t>(c)]; row.flows()) {
          row.content = 0, row.storage = {};
          if (!stays_full(mesh, c, pressure, last))
            continue;
          row.content = -row.resting, row.storage = row.elastic;
          for (std::size_t a = 0; a <= D; ++a)
            row.content += row.elastic[a] * pressure[static_cast<std::size_t>(mesh.cell(c)[a])];
        }
      for (Index group = 0; group < strips.groups(); ++group)
        if (flow.flows(strips.body_of(group)))
          add_contents(mesh, flow.bodies[static_cast<std::size_t>(strips.body_of(group))], strips, group, block, pressure, last);
    });
    copies_.send(cells_, Whole{});
    copies_.take(cells_, Whole{});
  }

 private:
  /// Whether the pores of a cell were full, and are with these pressures: particles need not be asked then.
  bool stays_full(const Mesh<D>& mesh, Index c, const std::vector<Real>& pressure, const std::vector<Real>& last) const noexcept
  {
    return !cells_[static_cast<std::size_t>(c)].drained && std::ranges::all_of(mesh.cell(c), [&](Index n) {
      return pressure[static_cast<std::size_t>(n)] >= 0 && last[static_cast<std::size_t>(n)] >= 0;
    });
  }
  void add_contents(const Mesh<D>& mesh, const FlowOfBody& pores, const ParticleStrips<D>& strips, Index group, Index block,
                    const std::vector<Real>& pressure, const std::vector<Real>& last)
  {
    for_each_cell_of(strips, std::span(&group, 1), block, [&](Index c, auto&& runs) {
      if (stays_full(mesh, c, pressure, last))
        return;
      FlowCell<D>& row = cells_[static_cast<std::size_t>(c)];
      runs([&](const ParticlesInCell<D>& run) {
        for_each_shape(mesh, c, run, [&](std::size_t p, const Pack& shape) {
          const Real volume = run.columns.volume.of(p), n = pores.porosity_at(volume / run.columns.volume0.of(p));
          const Real before = run.columns.water.of(p);
          Real after = 0, previous = 0;
          for (std::size_t a = 0; a <= D; ++a) {
            after += shape[static_cast<int>(a)] * pressure[static_cast<std::size_t>(mesh.cell(c)[a])];
            previous += shape[static_cast<int>(a)] * last[static_cast<std::size_t>(mesh.cell(c)[a])];
          }
          row.content += volume * pores.stored(n, before, after);
          const Real storage = volume * pores.storage(n, before, previous, after);
          for (std::size_t a = 0; a <= D; ++a)
            row.storage[a] += shape[static_cast<int>(a)] * storage;
        });
      });
    });
  }
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
               Index block, Real pace)
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
          row.mobility += pace * volume * pores.permeability_at(n) * pores.retention.conductance(p_p) / flow.unit_weight;
          row.drained = row.drained || p_p < 0;
          row.resting += volume * n / pores.bulk_modulus * p_p;
          row.compliance += volume * volume / (run.columns.mass.of(p) * speed * speed);
          const Vec<D> slope = run.columns.water_gradient.of(p), x = run.columns.x.of(p);
          for (std::size_t a = 0; a <= D; ++a) {
            const Real share = volume * shape[static_cast<int>(a)];
            row.storage[a] += share * pores.storage(n, p_p, p_p, p_p);
            row.elastic[a] += share * n / pores.bulk_modulus;
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
