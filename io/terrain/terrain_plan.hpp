#pragma once
// The plan over which columns of terrain stand.
#include <cstdint>
#include <optional>

#include "core/error.hpp"
#include "io/terrain/terrain_input.hpp"
#include "mesh/generate/columns.hpp"

namespace talus {

/// A strip in which cells are smaller.
struct Strip {
  MapLine along;  ///< on the map
  Real width;     ///< [m]
  Real inside;    ///< edge length [m]
};

/// Edge lengths over the map [m].
struct PlanSizes {
  Real size;
  std::vector<Strip> strips;
  Real operator()(const MapPlace& place) const noexcept;
};

/// On the map, of a place of the plan.
template <int D>
MapPlace on_map(const MapFrame& frame, const Vec<D - 1>& x) noexcept
{
  return frame.to_map(x[0], D == 2 ? 0 : x[D - 2]);
}

/// Intervals or triangles of these sizes over the domain, with nodes or edges along the outlines of all areas.
template <int D>
Plan<D> make_plan(const TerrainInput& input, const PlanSizes& sizes, const SourceLocation& where);

/// One for each plan cell or node, whether it belongs to something.
using Marks = std::vector<std::uint8_t>;

/// A plan and what is known at its nodes.
template <int D>
struct SurveyedPlan {
  Plan<D> plan;
  std::vector<MapPlace> place;  ///< on the map
  std::vector<Real> extent;     ///< around each node: area, in 2-D length [m^(D-1)]
  Real usual_size;              ///< edge length without strips [m]
  std::vector<Real> size;       ///< the one wanted at each node [m]
  std::vector<Real> ground;     ///< [m]; NaN where it is not known

  Index n_nodes() const noexcept { return static_cast<Index>(plan.nodes.size()); }
  std::size_t n_cells() const noexcept { return plan.cells.size(); }
  Marks nodes_of(const Marks& cells) const;
  /// Height of cells over a node [m]: like edges on the plan, or as large as said for places without strips.
  Real height_of_cells(const std::optional<Real>& said, Index n) const { return said.value_or(usual_size) * size[n] / usual_size; }
};
template <int D>
SurveyedPlan<D> survey(Plan<D> plan, const TerrainInput& input, const PlanSizes& sizes);

/// Plan cells whose centre lies in the area.
template <int D>
Marks cells_in(const Area& area, const SurveyedPlan<D>& plan);

extern template struct SurveyedPlan<2>;
extern template struct SurveyedPlan<3>;
extern template SurveyedPlan<2> survey<2>(Plan<2>, const TerrainInput&, const PlanSizes&);
extern template SurveyedPlan<3> survey<3>(Plan<3>, const TerrainInput&, const PlanSizes&);
extern template Marks cells_in<2>(const Area&, const SurveyedPlan<2>&);
extern template Marks cells_in<3>(const Area&, const SurveyedPlan<3>&);
extern template Plan<2> make_plan<2>(const TerrainInput&, const PlanSizes&, const SourceLocation&);
extern template Plan<3> make_plan<3>(const TerrainInput&, const PlanSizes&, const SourceLocation&);

}  // namespace talus
