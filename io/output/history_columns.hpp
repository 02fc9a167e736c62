#pragma once
// Columns of history.csv, as rows of tables.  The function of a column is called with what app/observers/history.cpp knows of its subject
// at the time of a row (RunNow, PointNow, ...).
#include <fmt/format.h>

#include "core/field_component.hpp"
#include "io/output/csv.hpp"
#include "io/output/quantity.hpp"

namespace talus {

/// Columns of every history.  Works are those done on the bodies since the start of the run; losses are positive.
constexpr auto run_columns()
{
  using enum QuantityKind;
  return std::tuple{
      quantity<number>("time", "s", "time", [](const auto& now) { return now.run.state.clock.time; }),
      quantity<number>("step", "-", "number of the step", [](const auto& now) { return now.run.state.clock.step; }),
      quantity<number>("dt", "s", "length of the step", [](const auto& now) { return now.run.state.clock.dt; }),
      quantity<number>("stage", "-", "number of the stage, from 0", [](const auto& now) { return now.run.state.stage.number; }),
      quantity<number>("mass", "kg", "mass of all particles", [](const auto& now) { return now.totals.mass; }),
      quantity<vector>("momentum_", "kg m/s", "momentum of all particles", [](const auto& now) { return now.totals.momentum; }),
      quantity<moment>("angular_momentum_", "kg m^2/s", "moment of momentum about the origin",
                       [](const auto& now) { return now.totals.angular; }),
      quantity<vector>("centre_", "m", "centre of mass", [](const auto& now) { return now.centre; }),
      quantity<number>("kinetic", "J", "kinetic energy", [](const auto& now) { return now.energy.kinetic; }),
      quantity<number>("strain", "J", "strain energy", [](const auto& now) { return now.energy.strain; }),
      quantity<number>("plastic", "J", "energy that laws have dissipated", [](const auto& now) { return now.energy.plastic; }),
      quantity<number>("friction", "J", "energy lost by friction at walls and between bodies in contact",
                       [](const auto& now) { return now.energy.friction; }),
      quantity<number>("damping", "J", "energy taken by the damping of stages", [](const auto& now) { return now.energy.damping; }),
      quantity<number>("carried_away", "J", "kinetic energy of what was deleted", [](const auto& now) { return now.energy.carried_away; }),
      quantity<number>("gravity_work", "J", "work of gravity", [](const auto& now) { return now.energy.gravity; }),
      quantity<number>("load_work", "J", "work of the other loads", [](const auto& now) { return now.energy.loads; }),
      quantity<number>("wall_work", "J", "work of walls that move", [](const auto& now) { return now.energy.walls; }),
      quantity<number>("transfer_loss", "J", "kinetic energy lost between particles and nodes",
                       [](const auto& now) { return now.energy.transfer; }),
      quantity<number>("energy_defect", "J", "what the terms of the balance leave unexplained",
                       [](const auto& now) { return now.energy.defect; }),
      quantity<number>("residual", "-", "unbalanced force over the forces there are",
                       [](const auto& now) { return now.run.state.residual; })};
}

/// Columns of each wall: its reaction.
constexpr auto reaction_columns()
{
  using enum QuantityKind;
  return std::tuple{quantity<vector>("reaction_{}_", "N", "mean force of the wall on the bodies since the row before",
                                     [](const auto& wall) { return wall.reaction; })};
}

/// Columns of each contact, named by its two bodies.
constexpr auto contact_columns()
{
  using enum QuantityKind;
  return std::tuple{quantity<vector>("contact_{}_", "N", "mean force on the first body since the row before",
                                     [](const auto& contact) { return contact.force; }),
                    quantity<number>("contact_friction_{}", "J", "energy lost by friction between the bodies",
                                     [](const auto& contact) { return contact.friction; }),
                    quantity<number>("contact_loss_{}", "J", "energy lost where the bodies meet, a part of transfer_loss",
                                     [](const auto& contact) { return contact.loss; })};
}

/// Columns of each cut, named by its group.
constexpr auto cut_columns()
{
  using enum QuantityKind;
  return std::tuple{
      quantity<vector>("cut_{}_", "N", "mean force on the first side since the row before", [](const auto& cut) { return cut.force; }),
      quantity<number>("cut_friction_{}", "J", "energy lost by friction between the sides", [](const auto& cut) { return cut.friction; }),
      quantity<number>("cut_loss_{}", "J", "energy lost where nodes of the sides meet, a part of transfer_loss",
                       [](const auto& cut) { return cut.loss; })};
}

/// Columns of water that flows through pores.
constexpr auto flow_columns()
{
  using enum QuantityKind;
  return std::tuple{
      quantity<number>("water_inflow", "m^D", "volume of water that boundaries with a rate have let in",
                       [](const auto& flow) { return flow.inflow; }),
      quantity<number>("water_drained", "m^D", "volume that has left through the surface and boundaries with a pressure",
                       [](const auto& flow) { return flow.drained; }),
      quantity<number>("water_stored", "m^D", "volume by which the water in the pores was compressed",
                       [](const auto& flow) { return flow.stored; }),
      quantity<number>("pores_grown", "m^D", "growth of the volume of the pores", [](const auto& flow) { return flow.squeezed; }),
      quantity<number>("water_defect", "m^D", "what the four terms leave unexplained", [](const auto& flow) { return flow.defect(); }),
      quantity<number>("seepage", "J", "energy that the flow has dissipated, a part of strain",
                       [](const auto& flow) { return flow.seepage; }),
      quantity<number>("pressure_iterations", "-", "of the solver of the pore pressure in the last step",
                       [](const auto& flow) { return flow.iterations; }),
      quantity<number>("pressure_residual", "-",
                       "of that solver, over its right-hand side; with a retention the share of water that is missing",
                       [](const auto& flow) { return flow.residual; })};
}

/// Columns of particles that are split and merged.
constexpr auto resample_columns()
{
  using enum QuantityKind;
  return std::tuple{
      quantity<number>("splits", "-", "particles that were split so far", [](const auto& now) { return now.ledger.splits; }),
      quantity<number>("merges", "-", "particles that were merged into others so far", [](const auto& now) { return now.ledger.merges; }),
      quantity<number>("resampled", "J", "kinetic energy lost where particles are merged, less what splitting gains",
                       [](const auto& now) { return now.energy.resampled; })};
}

/// Columns of stages that solve for equilibrium.
constexpr auto solve_columns()
{
  using enum QuantityKind;
  return std::tuple{quantity<number>("newton_iterations", "-", "of the last increment of a stage that solves for equilibrium",
                                     [](const auto& solve) { return solve.last_iterations; }),
                    quantity<number>("linear_iterations", "-", "of the linear systems in them",
                                     [](const auto& solve) { return solve.last_linear_iterations; }),
                    quantity<number>("solve_residual", "-", "what is left of the equations that the increment solved, over the loads",
                                     [](const auto& solve) { return solve.last_residual; }),
                    quantity<number>("increment_cuts", "-", "increments of the stage that were not solved and were cut in halves",
                                     [](const auto& solve) { return solve.cuts; })};
}

/// Columns of each rigid body.
constexpr auto rigid_columns()
{
  using enum QuantityKind;
  return std::tuple{quantity<vector>("rigid_{}_", "m", "its centre of mass", [](const auto& rigid) { return rigid.state.x; }),
                    quantity<vector>("rigid_{}_v", "m/s", "velocity of the centre", [](const auto& rigid) { return rigid.state.v; }),
                    quantity<moment>("rigid_{}_w", "rad/s", "angular velocity", [](const auto& rigid) { return rigid.state.spin; }),
                    quantity<vector>("rigid_{}_f", "N", "mean force of material on it since the row before",
                                     [](const auto& rigid) { return rigid.force; }),
                    quantity<moment>("rigid_{}_m", "N m", "mean moment of these forces about its centre since the row before",
                                     [](const auto& rigid) { return rigid.moment; }),
                    quantity<number>("kinetic_rigid_{}", "J", "its kinetic energy, no part of that of all particles",
                                     [](const auto& rigid) { return rigid.kinetic; }),
                    quantity<number>("friction_rigid_{}", "J", "energy lost by friction between it and material",
                                     [](const auto& rigid) { return rigid.friction; })};
}

constexpr auto point_columns()
{
  using enum QuantityKind;
  return std::tuple{quantity<vector>("{}_", "m", "position", [](const auto& point) { return point.x; }),
                    quantity<vector>("{}_u", "m", "displacement", [](const auto& point) { return point.u; }),
                    quantity<vector>("{}_v", "m/s", "velocity", [](const auto& point) { return point.v; }),
                    quantity<symmetric>("{}_s", "Pa", "Cauchy stress", [](const auto& point) { return point.stress; })};
}

/// Of the water at a point where it flows.
constexpr auto point_water_columns()
{
  using enum QuantityKind;
  return std::tuple{quantity<number>("{}_p", "Pa", "pore pressure, where water flows", [](const auto& water) { return water.pressure; }),
                    quantity<number>("{}_excess", "Pa", "pore pressure less that of water at rest below water.table",
                                     [](const auto& water) { return water.pressure - water.at_rest; })};
}

constexpr auto front_columns()
{
  using enum QuantityKind;
  return std::tuple{quantity<number>("{}", "m", "coordinate that the share of the mass does not pass", [](const auto& at) { return at; })};
}

/// Columns of the action of bodies on a wall.
constexpr auto wall_columns()
{
  using enum QuantityKind;
  return std::tuple{
      quantity<number>("push_{}", "N", "mean force along the normal of the wall since the row before",
                       [](const auto& wall) { return wall.push; }),
      quantity<number>("shear_{}", "N", "mean force along the wall since the row before", [](const auto& wall) { return wall.shear; }),
      quantity<number>("touched_{}", "m^(D-1)", "area of the wall with mass at its nodes", [](const auto& wall) { return wall.touched; }),
      quantity<number>("pressure_{}", "Pa", "push over the area touched", [](const auto& wall) { return wall.pressure; }),
      quantity<vector>("attack_{}_", "m", "where the line of action of the force crosses the wall",
                       [](const auto& wall) { return wall.attack; })};
}

constexpr auto moved_columns()
{
  using enum QuantityKind;
  return std::tuple{
      quantity<number>("{}", "m", "displacement that the share of the mass does not exceed", [](const auto& way) { return way; })};
}

constexpr auto body_columns()
{
  using enum QuantityKind;
  return std::tuple{
      quantity<number>("mass_{}", "kg", "mass of the body", [](const auto& body) { return body.mass; }),
      quantity<vector>("momentum_{}_", "kg m/s", "momentum of the body", [](const auto& body) { return body.momentum; }),
      quantity<number>("kinetic_{}", "J", "kinetic energy of the body", [](const auto& body) { return body.kinetic; }),
      quantity<number>("plastic_{}", "J", "energy that its law has dissipated", [](const auto& body) { return body.plastic; }),
      quantity<vector>("force_{}_", "N", "mean force of walls and other bodies on it since the row before",
                       [](const auto& body) { return body.force; })};
}

/// The columns of a quantity with the name of its subject inserted: one for each of its components.
inline std::vector<CsvColumn> csv_columns(std::string_view pattern, std::string_view unit, QuantityKind kind, std::string_view owner,
                                          int dimension)
{
  const std::string name = fmt::format(fmt::runtime(pattern), owner);
  std::vector<std::string> components = component_names(components_of(kind));
  if (dimension == 2 && kind == QuantityKind::vector)
    components = {"x", "y"};
  if (dimension == 2 && kind == QuantityKind::moment)
    components = {"z"};
  if (kind == QuantityKind::number)
    components = {""};
  std::vector<CsvColumn> all;
  for (const std::string& component : components)
    all.push_back({name + component, unit_in(dimension, unit)});
  return all;
}

template <class Table>
std::vector<CsvColumn> csv_columns(const Table& table, std::string_view owner, int dimension)
{
  std::vector<CsvColumn> all;
  for_each_quantity(table, [&](const auto& row) {
    const auto more = csv_columns(row.name, row.unit, row.kind, owner, dimension);
    all.insert(all.end(), more.begin(), more.end());
  });
  return all;
}

}  // namespace talus
