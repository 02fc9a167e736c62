#pragma once
// Flow of water through pores: what a scene says of it, and what has flowed so far.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "core/fields.hpp"
#include "core/time_table.hpp"
#include "mesh/part.hpp"

namespace talus {

/// How much water pores hold under suction, and how well they conduct it [van Genuchten 1980, Mualem 1976].
struct Retention {
  Real entry{};       ///< suction at which they begin to drain [Pa]; 0: they stay full
  Real exponent = 2;  ///< n of the curve [-]
  Real residual{};    ///< saturation that no suction removes [-]

  /// The effective saturation (1 + (s/entry)^n)^-m, m = 1 - 1/n, at a pressure [Pa].
  Real effective(Real p) const noexcept
  {
    return entry > 0 && p < 0 ? std::pow(1 + std::pow(-p / entry, exponent), 1 / exponent - 1) : Real{1};
  }
  Real saturation(Real p) const noexcept { return residual + (1 - residual) * effective(p); }
  /// dS/dp [1/Pa].
  Real capacity(Real p) const noexcept
  {
    if (!(entry > 0 && p < 0))
      return 0;
    const Real ratio = std::pow(-p / entry, exponent), m = 1 - 1 / exponent;
    return (1 - residual) * m * exponent * ratio / (-p) * std::pow(1 + ratio, -m - 1);
  }
  /// What takes the place of dS/dp where the pressure went from one value to another: the larger one of the slopes of the chord and at its end,
  /// as the slope alone vanishes where pores begin to drain.
  Real capacity(Real from, Real to) const noexcept
  {
    const Real change = to - from, chord = std::abs(change) > Real{1e-6} * entry ? (saturation(to) - saturation(from)) / change : 0;
    return std::max(capacity(to), chord);
  }
  /// The permeability over that of full pores.
  Real conductance(Real p) const noexcept
  {
    constexpr Real least = 1e-6;  // keeps the system of equations regular
    const Real e = effective(p), m = 1 - 1 / exponent, root = 1 - std::pow(1 - std::pow(e, 1 / m), m);
    return e < 1 ? std::max(std::sqrt(e) * root * root, least) : Real{1};
  }
};

/// The pores of a body.
struct FlowOfBody {
  bool flows = false;
  Real porosity{};      ///< volume of pores over volume, at the start [-]
  Real permeability{};  ///< hydraulic conductivity at that porosity [m/s]
  Real bulk_modulus{};  ///< of the water [Pa]
  Real biot = 1;        ///< share of the pore pressure that the skeleton does not feel [-]
  Retention retention;
  bool follows_pores = false;  ///< whether the permeability changes with the porosity [Kozeny 1927, Carman 1937]

  /// The porosity after the volume of the body has changed to `ratio` times what it was; the grains keep theirs.
  Real porosity_at(Real ratio) const noexcept { return std::clamp(1 - (1 - porosity) / ratio, Real{1e-3}, Real{0.999}); }
  /// The part of total stress that a pressure of the water makes [Pa]: Biot's coefficient and, as Bishop's, the saturation times the pressure.
  Real stress_of(Real p) const noexcept { return biot * retention.saturation(p) * p; }
  /// The volume of water that a volume of a porosity takes up [-] while the pressure goes from one value to another, and its slope [1/Pa].
  Real stored(Real porosity_now, Real from, Real to) const noexcept
  {
    const Real full = retention.saturation(from);
    return porosity_now * (retention.saturation(to) - full + full / bulk_modulus * (to - from));
  }
  /// `last`: the pressure before the one that it goes to in the search for it.
  Real storage(Real porosity_now, Real from, Real last, Real to) const noexcept
  {
    return porosity_now * (retention.saturation(from) / bulk_modulus + retention.capacity(last, to));
  }
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
  std::optional<Table> rain;   ///< volume per horizontal area and time on the surface of the bodies [m/s]
  std::optional<Table> pond;   ///< elevation in time of the level of open water on the surface of the bodies [m]
  Table pace;                  ///< how many times faster water flows, in time
  bool surface_drains = true;  ///< whether the pressure is zero at the surface of the bodies
  Real unit_weight{};          ///< of water [N/m^3]

  bool any() const noexcept { return !bodies.empty(); }
  bool any_retention() const noexcept
  {
    return std::ranges::any_of(bodies, [](const FlowOfBody& one) { return one.flows && one.retention.entry > 0; });
  }
  bool flows(Index body) const noexcept { return any() && bodies[static_cast<std::size_t>(body)].flows; }
  /// The pores of a body through which water flows, or nullptr.
  const FlowOfBody* pores_of(std::size_t body) const noexcept { return any() && bodies[body].flows ? &bodies[body] : nullptr; }
  /// The pressure of the pond [Pa] at an elevation [m], while a share of gravity acts.
  Real pond_pressure(Real elevation, Real time, Real share) const noexcept
  {
    return pond ? share * unit_weight * std::max((*pond)(time)-elevation, Real{0}) : 0;
  }
  /// The part of total stress that a pressure of the water in a body makes [Pa].
  Real stress_of(Index body, Real p) const noexcept { return flows(body) ? bodies[static_cast<std::size_t>(body)].stress_of(p) : p; }
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
  bool begun = false;       ///< whether water has flowed in any stage
  Real inflow{};            ///< through boundaries with a rate
  Real drained{};           ///< out of boundaries with a pressure, the surface included
  Real stored{};            ///< by compression of water, at constant pore volume
  Real squeezed{};          ///< growth of the pore volume
  Real seepage{};           ///< energy that the flow has dissipated [J]
  Real iterations{};        ///< of the solver in the last step
  Real total_iterations{};  ///< since the start
  Real residual{};          ///< of the last step, over its right-hand side; with a retention the share of water that its equations lack [-]
  bool found = true;        ///< whether the system of the last step was solved
  Real unsettled{};         ///< number of steps whose contents did not become those of the pressures
  Real missing{};           ///< the largest share of water that the equations of such a step lacked [-]
  static constexpr Real tolerance = 1e-6;  ///< of the residual
  static constexpr auto fields()
  {
    return std::tuple{saved("begun", &FlowLedger::begun),           saved("inflow", &FlowLedger::inflow),
                      saved("drained", &FlowLedger::drained),       saved("stored", &FlowLedger::stored),
                      saved("squeezed", &FlowLedger::squeezed),     saved("seepage", &FlowLedger::seepage),
                      saved("iterations", &FlowLedger::iterations), saved("total_iterations", &FlowLedger::total_iterations),
                      saved("residual", &FlowLedger::residual),     saved("found", &FlowLedger::found),
                      saved("unsettled", &FlowLedger::unsettled),   saved("missing", &FlowLedger::missing)};
  }
  /// What has come in and has neither been stored nor gone out [m^D]: zero to the accuracy of the solver.
  Real defect() const noexcept { return inflow - drained - stored - squeezed; }
};

}  // namespace talus
