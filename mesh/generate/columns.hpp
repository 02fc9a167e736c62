#pragma once
// Meshes of cells in columns over a plan, between surfaces that may meet: terrain with the layers below it and the space above.
#include <array>
#include <vector>

#include "mesh/mesh.hpp"

namespace talus {

/// A mesh of the plan: intervals of a line (D = 2) or triangles (D = 3).
template <int D>
struct Plan {
  std::vector<Vec<D - 1>> nodes;            ///< positions in the plan [m]
  std::vector<std::array<Index, D>> cells;  ///< node numbers, in either orientation
};

/// A layer between two surfaces over a plan.
struct Slab {
  /// Elevation of the top at each plan node [m]; nowhere below the top of the slab underneath, and equal to it where the slab has no
  /// thickness.
  std::vector<Real> top;
  std::vector<Real> height;  ///< desired height of cells at each plan node [m]
  std::vector<Index> group;  ///< group of the cells over each plan cell, or `none` where they are left out
};

/// Slabs in order from the bottom to the top.
template <int D>
struct Stack {
  Plan<D> plan;
  std::vector<Real> bottom;  ///< elevation of the lowest slab's bottom at each plan node [m]
  std::vector<Slab> slabs;
};

/// A mesh of columns, with the positions of its facets.
template <int D>
struct Columns {
  std::vector<Vec<D>> nodes;
  std::vector<std::array<Index, D + 1>> cells;
  std::vector<Index> group;  ///< group of each cell

  /// Facets over a plan cell between cells of different groups.  The slabs are the nearest ones that have cells here, left out or not.
  struct Front {
    std::array<Index, D> nodes;
    Index plan_cell;
    Index slab_below, slab_above;    ///< `none` below the lowest and above the highest slab
    Index group_below, group_above;  ///< `none` where cells are left out
  };
  std::vector<Front> fronts;

  /// Upright facets with cells on one side only.
  struct Side {
    std::array<Index, D> nodes;
    Index plan_cell, slab;  ///< position of the cells left out behind it; `none` at the boundary of the plan
  };
  std::vector<Side> sides;
};

/// The number of cells that fill_columns() will make, including those left out.
template <int D>
Real cells_of(const Stack<D>& stack);

/// Fills the stack with cells.  A column of nodes stands over each plan node; the number of nodes in each slab follows from its thickness
/// there, and both ends of a slab without thickness are one node.  The columns over a plan cell are joined in a fixed order: the next node
/// by slab, fraction of the slab's thickness and number of the column forms a cell with the uppermost nodes so far.  The division of a side
/// between two columns depends on these two only, so neighbouring columns fit together.  Every cell has an upright edge, so none is flat,
/// and volumes between surfaces that are linear over plan cells are exact.  With equal intervals in all columns the result is H. W. Kuhn's
/// (1960) division of prisms.
template <int D>
Columns<D> fill_columns(const Stack<D>& stack);

}  // namespace talus
