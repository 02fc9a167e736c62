#pragma once
// The plan of the columns of a terrain mesh.
#include <cstdint>
#include <optional>

#include "core/error.hpp"
#include "io/terrain/terrain_input.hpp"
#include "mesh/generate/columns.hpp"

namespace talus {

/// A strip with smaller cells.
struct Strip {
  MapLine along;  ///< line on the map
  Real width;     ///< width [m]
  Real inside;    ///< edge length in the strip [m]
};

/// The edge length over the map [m].
struct PlanSizes {
  Real size;
  std::vector<Strip> strips;
  Real operator()(const MapPlace& place) const noexcept;
};

/// The map coordinates of a position of the plan.
template <int D>
MapPlace on_map(const MapFrame& frame, const Vec<D - 1>& x) noexcept
{
  return frame.to_map(x[0], D == 2 ? 0 : x[D - 2]);
}

/// Intervals or triangles of these sizes over the domain, with nodes or edges along the outlines of all areas.
template <int D>
Plan<D> make_plan(const TerrainInput& input, const PlanSizes& sizes, const SourceLocation& where);

/// A flag for each plan cell or node.
using Marks = std::vector<std::uint8_t>;

/// A plan with values at its nodes.
template <int D>
struct SurveyedPlan {
  Plan<D> plan;
  std::vector<MapPlace> place;  ///< positions on the map
  std::vector<Real> extent;     ///< plan area around each node, in 2-D length [m^(D-1)]
  Real usual_size;              ///< edge length outside of strips [m]
  std::vector<Real> size;       ///< desired edge length at each node [m]
  std::vector<Real> ground;     ///< elevation of the ground [m]; NaN where unknown

  Index n_nodes() const noexcept { return static_cast<Index>(plan.nodes.size()); }
  std::size_t n_cells() const noexcept { return plan.cells.size(); }
  Marks nodes_of(const Marks& cells) const;
  /// The height of cells over a node [m]: equal to the edge length in the plan, or the given height, which is scaled in strips.
  Real height_of_cells(const std::optional<Real>& said, Index n) const { return said.value_or(usual_size) * size[n] / usual_size; }
};
template <int D>
SurveyedPlan<D> survey(Plan<D> plan, const TerrainInput& input, const PlanSizes& sizes);

/// Marks the plan cells whose centre lies in the area.
template <int D>
Marks cells_in(const Area& area, const SurveyedPlan<D>& plan);

extern template struct SurveyedPlan<2>;
extern template struct SurveyedPlan<3>;

}  // namespace talus
