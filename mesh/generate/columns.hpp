#pragma once
// Cells in columns over a plan, between surfaces that may meet: terrain and what lies below and above it.
#include <array>
#include <vector>

#include "mesh/mesh.hpp"

namespace talus {

/// A mesh seen from above: intervals of a line (D = 2) or triangles (D = 3).
template <int D>
struct Plan {
  std::vector<Vec<D - 1>> nodes;            ///< [m]
  std::vector<std::array<Index, D>> cells;  ///< node numbers, either way round
};

/// What lies between two surfaces over a plan.
struct Slab {
  std::vector<Real> top;  ///< by plan node [m]; nowhere below the top of the slab underneath, and the same where the slab has no thickness
  std::vector<Real> height;  ///< by plan node [m]: what its cells should be high
  std::vector<Index> group;  ///< by plan cell: what its cells are called, or `none` where they are left out
};

/// Slabs one upon another, from the bottom up.
template <int D>
struct Stack {
  Plan<D> plan;
  std::vector<Real> bottom;  ///< by plan node [m]
  std::vector<Slab> slabs;
};

/// A mesh of columns and where its facets lie.
template <int D>
struct Columns {
  std::vector<Vec<D>> nodes;
  std::vector<std::array<Index, D + 1>> cells;
  std::vector<Index> group;  ///< of each cell

  /// Facets over a plan cell between cells of different groups; the slabs are those that have cells here, left out or not.
  struct Front {
    std::array<Index, D> nodes;
    Index plan_cell;
    Index slab_below, slab_above;    ///< `none` below and above everything
    Index group_below, group_above;  ///< `none` where there are no cells
  };
  std::vector<Front> fronts;

  /// Upright facets behind which there are no cells.
  struct Side {
    std::array<Index, D> nodes;
    Index plan_cell, slab;  ///< of the cells left out behind it; `none` at the rim of the plan
  };
  std::vector<Side> sides;
};

/// How many cells fill_columns() will make, those left out included.
template <int D>
Real cells_of(const Stack<D>& stack);

/// Fills the stack.  Over each plan node stands a column of nodes, so many in each slab as its thickness there asks for, one for both ends of a
/// slab without thickness.  The columns over a plan cell are closed like a zipper: the next node in the order of slab, share of the slab's
/// thickness and number of the column makes a cell with the uppermost nodes so far.  How a side between two columns is cut depends on these two
/// alone, so neighbours fit whatever they hold; every cell has an upright edge, so none is flat, and volumes between surfaces that are linear over
/// plan cells are exact.
///
/// Equal in all slabs, the result is H. W. Kuhn's (1960) division of prisms.
template <int D>
Columns<D> fill_columns(const Stack<D>& stack);

extern template Real cells_of<2>(const Stack<2>&);
extern template Real cells_of<3>(const Stack<3>&);
extern template Columns<2> fill_columns<2>(const Stack<2>&);
extern template Columns<3> fill_columns<3>(const Stack<3>&);

}  // namespace talus
