#pragma once
// An upright side of a model with level ground beyond it: the free field.
#include <fmt/format.h>

#include <cmath>
#include <span>
#include <stdexcept>

#include "mesh/conditions/boundary_common.hpp"
#include "mesh/conditions/dashpot.hpp"
#include "mesh/conditions/dynamic_phase.hpp"
#include "mesh/conditions/roller.hpp"
#include "mesh/conditions/soil_column.hpp"

namespace talus {

struct FreeFieldOptions : BoundaryCommon {
  static constexpr std::string_view name = "free_field";
  static constexpr auto fields()
  {
    return std::tuple{
        on_key("facet group of an upright side: a roller in geostatic stages, then level ground like that beside the side "
               "goes on behind it, moved by the base of the model, and waves leave through it")};
  }
};

/// The ground beside the model is a column of layers that moves independently of the model, on the same base.  Its stress acts on the side,
/// and dashpots absorb the difference between the two motions [Zienkiewicz, Bicanic & Shen 1988].
template <int D>
struct FreeField : Roller<D> {  // a roller until the dynamic phase begins
  using Options = FreeFieldOptions;
  SoilColumn<D> column;
  Index base = none;        ///< index of the condition below the column
  ColumnMotion motion{};    ///< present motion of the column
  ColumnMotion previous{};  ///< motion of the column at the beginning of the step

  static FreeField make(const Options& options, const ConditionSetup<D>& setup)
  {
    constexpr Real vertical = 0.01;  // largest vertical component of the unit normal of an upright facet
    Index lowest = none;
    for (const Facet facet : setup.facets) {
      const Vec<D> area = setup.mesh.area_vector(facet);
      if (std::abs(area.dot(setup.up)) > vertical * area.norm())
        throw std::invalid_argument(fmt::format("the facets of \"{}\" are not all upright", options.on));
      for (const Index n : setup.mesh.nodes_of(facet))
        if (lowest == none || setup.mesh.node(n).dot(setup.up) < setup.mesh.node(lowest).dot(setup.up))
          lowest = n;
    }
    const auto column = setup.column_beside();
    if (!column)
      throw std::invalid_argument(
          fmt::format("behind the facets of \"{}\", from their foot up, there must be particles of laws that have an elastic shear modulus",
                      options.on));
    const Index base = lowest == none ? none : setup.holder_of(lowest);
    if (base == none)
      throw std::invalid_argument(
          fmt::format("no boundary of type fixed, velocity or compliant_base holds the foot of \"{}\"", options.on));
    return {*column, base};
  }
  FreeField() = default;
  FreeField(SoilColumn<D> column_, Index base_) : column(std::move(column_)), base(base_) { reset(); }

  std::string note(const Options& options) const
  {
    return fmt::format("free field \"{}\": {} layers over {:.4g} m, shear waves {:.4g} m/s at the foot and {:.4g} m/s at the ground",
                       options.on, column.layer.size(), column.level.back() - column.level.front(), column.layer.front().ground.s_wave,
                       column.layer.back().ground.s_wave);
  }

  /// The dashpots of the nodes.  A facet above the ground surface of the column has none.
  DashpotsOfNodes<D> dashpots(const Mesh<D>& mesh, std::span<const Facet> facets) const
  {
    DashpotsOfNodes<D> all;
    for (const Facet facet : facets) {
      Real height = 0;
      for (const Index n : mesh.nodes_of(facet))
        height += column.up.dot(mesh.node(n)) / D;
      if (height > column.level.back())
        continue;
      const std::size_t layer = column.layer_at(height);
      const Vec<D> share = mesh.area_vector(facet) / D;
      for (const Index n : mesh.nodes_of(facet)) {
        Dashpot<D>& dashpot = all[n];
        dashpot.resistance += column.layer[layer].filled * impedance<D>(column.layer[layer].ground, share);
        dashpot.face.emplace_back(layer, share);
      }
    }
    return all;
  }
  /// The velocity [m/s] relative to which the dashpot of a node acts, and the force [N] on a node that does not move.  The stress of the
  /// column is that at the beginning of the step, like the stress of the particles; its velocity is that of the middle of the step.
  Vec<D> free_velocity(const Dashpot<D>&, const Vec<D>& place, const DynamicPhase&, Real) const noexcept
  {
    return column.velocity_at(column.up.dot(place), motion);
  }
  Vec<D> force_at_rest(const Dashpot<D>& dashpot, const Vec<D>& field) const noexcept
  {
    Vec<D> force = dashpot.resistance * field;
    for (const auto& [layer, area] : dashpot.face)
      force += column.force_on(area, layer, previous);
    return force;
  }

  /// Moves the ground beside the model by a step of length dt [s].
  void advance(const ColumnBase<D>& below, Real dt)
  {
    previous = motion;
    talus::advance(column, below, dt, motion);
  }
  void reset() { motion = column.at_rest(); }
  /// Whether a motion read from a checkpoint has the sizes of this column.
  bool fits() const { return motion.velocity.size() == D * column.level.size() && motion.traction.size() == D * column.layer.size(); }
  static constexpr auto fields() { return std::tuple{saved("motion", &FreeField::motion)}; }
};

}  // namespace talus
