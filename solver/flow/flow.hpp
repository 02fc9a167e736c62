#pragma once
// Flow of water through pores: what a scene says of it, and what has flowed so far.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

#include "core/fields.hpp"
#include "core/time_table.hpp"
#include "mesh/part.hpp"

namespace talus {

/// The pores of a body, saturated with water.
struct FlowOfBody {
  bool flows = false;
  Real porosity{};             ///< volume of pores over volume, at the start [-]
  Real permeability{};         ///< hydraulic conductivity at that porosity [m/s]
  Real bulk_modulus{};         ///< of the water [Pa]
  Real biot = 1;               ///< share of the pore pressure that the skeleton does not feel [-]
  bool follows_pores = false;  ///< whether the permeability changes with the porosity [Kozeny 1927, Carman 1937]

  /// The porosity after the volume of the body has changed to `ratio` times what it was; the grains keep theirs.
  Real porosity_at(Real ratio) const noexcept { return std::clamp(1 - (1 - porosity) / ratio, Real{1e-3}, Real{0.999}); }
  /// k = k_0 n^3 / (1 - n)^2 over the same of n_0 [m/s].
  Real permeability_at(Real n) const noexcept
  {
    const auto of = [](Real x) { return x * x * x / ((1 - x) * (1 - x)); };
    return follows_pores ? permeability * of(n) / of(porosity) : permeability;
  }
};

/// Nodes of a boundary at which the pressure is that of open water with a level, or zero.
struct HeadBoundary {
  std::string on;
  std::vector<Index> nodes;
  bool drained = true;  ///< zero, instead of that below a level
  Table level;          ///< elevation of the level in time [m]
};
/// Nodes of a boundary through which a given volume flows in.
struct InflowBoundary {
  std::string on;
  std::vector<Index> nodes;
  std::vector<Real> area;  ///< share of each node [m^(D-1)]
  Table rate;              ///< volume per area and time [m/s]
};

struct Flow {
  std::vector<FlowOfBody> bodies;  ///< empty without flow
  std::vector<HeadBoundary> heads;
  std::vector<InflowBoundary> inflows;
  bool surface_drains = true;  ///< whether the pressure is zero at the surface of the bodies
  Real unit_weight{};          ///< of water [N/m^3]

  bool any() const noexcept { return !bodies.empty(); }
  bool flows(Index body) const noexcept { return any() && bodies[static_cast<std::size_t>(body)].flows; }
};

/// The part on one of several ranks, with its numbers of nodes.
inline void restrict_to(const Subdomain& subdomain, Flow& flow)
{
  const auto keep = [&](auto& boundary, auto&& keep_area) {
    std::vector<Index> nodes;
    for (std::size_t k = 0; k < boundary.nodes.size(); ++k)
      if (const Index here = subdomain.local_node(boundary.nodes[k]); here != none) {
        nodes.push_back(here);
        keep_area(k);
      }
    boundary.nodes = std::move(nodes);
  };
  for (HeadBoundary& head : flow.heads)
    keep(head, [](std::size_t) {});
  for (InflowBoundary& inflow : flow.inflows) {
    std::vector<Real> area;
    keep(inflow, [&](std::size_t k) { area.push_back(inflow.area[k]); });
    inflow.area = std::move(area);
  }
}

/// The balance of water since the start of the run [m^D], and what the last step took to find the pressure.
struct FlowLedger {
  bool begun = false;                      ///< whether water has flowed in any stage
  Real inflow{};                           ///< through boundaries with a rate
  Real drained{};                          ///< out of boundaries with a pressure, the surface included
  Real stored{};                           ///< by compression of water, at constant pore volume
  Real squeezed{};                         ///< growth of the pore volume
  Real seepage{};                          ///< energy that the flow has dissipated [J]
  Real iterations{};                       ///< of the solver in the last step
  Real total_iterations{};                 ///< since the start
  Real residual{};                         ///< of the last step, over its right-hand side [-]
  static constexpr Real tolerance = 1e-9;  ///< of that residual
  static constexpr auto fields()
  {
    return std::tuple{saved("begun", &FlowLedger::begun),           saved("inflow", &FlowLedger::inflow),
                      saved("drained", &FlowLedger::drained),       saved("stored", &FlowLedger::stored),
                      saved("squeezed", &FlowLedger::squeezed),     saved("seepage", &FlowLedger::seepage),
                      saved("iterations", &FlowLedger::iterations), saved("total_iterations", &FlowLedger::total_iterations),
                      saved("residual", &FlowLedger::residual)};
  }
  /// What has come in and has neither been stored nor gone out [m^D]: zero to the accuracy of the solver.
  Real defect() const noexcept { return inflow - drained - stored - squeezed; }
};

}  // namespace talus
