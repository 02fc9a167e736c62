#pragma once
// The plan over which columns of terrain stand.
#include "core/error.hpp"
#include "io/terrain_input.hpp"
#include "mesh/columns.hpp"

namespace talus {

/// A strip in which cells are smaller.
struct Strip {
  Line along;   ///< on the map
  Real width;   ///< [m]
  Real inside;  ///< edge length [m]
};

/// Edge lengths over the map [m].
struct PlanSizes {
  Real size;
  std::vector<Strip> strips;
  Real operator()(const Place& place) const noexcept;
};

/// Place on the map of a node of the plan.
template <int D>
Place on_map(const MapFrame& frame, const Vec<D - 1>& x) noexcept
{
  if constexpr (D == 2)
    return frame.to_map(x[0]);
  else
    return frame.to_map(x[0], x[1]);
}

/// Intervals or triangles of these sizes over the domain, with nodes or edges along the outlines of all areas.
template <int D>
Plan<D> make_plan(const TerrainInput& input, const PlanSizes& sizes, const Where& where);

extern template Plan<2> make_plan<2>(const TerrainInput&, const PlanSizes&, const Where&);
extern template Plan<3> make_plan<3>(const TerrainInput&, const PlanSizes&, const Where&);

}  // namespace talus
