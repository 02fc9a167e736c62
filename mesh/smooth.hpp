#pragma once
// Smoothing: interior nodes move to the centres of their stars.
#include "mesh/mesh.hpp"

namespace talus {

/// No cell falls below this mean ratio by smoothing, except where a star is worse already and then gets no worse.  gmsh improves
/// tetrahedra below the same value (its option Mesh.OptimizeThreshold).
inline constexpr Real smoothed_mean_ratio = 0.3;

/// Moves each free node in turn to the centroid of the cells around it, so many times over all nodes (Gauss-Seidel, in the order of the
/// nodes, on one thread: equal data give equal meshes).  A move that would invert a cell, make an altitude smaller than the smallest of the
/// given mesh, or make a cell worse than `smoothed_mean_ratio` is halved up to three times, then left out.  So the time step of a run does
/// not fall.  Nodes of boundaries, of named groups of nodes and facets, and between cells of different groups stay: every shape and volume
/// is kept.  Throws std::invalid_argument for invalid nodes or cells.
template <int D>
MeshData<D> smoothed(MeshData<D> data, Index sweeps);

}  // namespace talus
