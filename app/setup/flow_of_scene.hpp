#pragma once
// The group `flow` of the block `water` of a scene -> how water flows through the pores of bodies.
#include "app/setup/checks/cell_occupancy.hpp"
#include "app/setup/checks/scene_error_collector.hpp"
#include "mesh/mesh.hpp"
#include "solver/flow/flow.hpp"
#include "solver/loads/loads.hpp"

namespace talus {

/// Complains of groups that the mesh does not have; warns of permeabilities in other units, of water that nowhere can leave, and of ground on
/// the boundary of the mesh, on which no pond stands.
template <int D>
Flow flow_of(const Scene& scene, const Mesh<D>& mesh, const CellOccupancy<D>& at_start, const std::vector<Body>& bodies,
             SceneErrorCollector& errors, std::vector<std::string>& warnings);

/// The weight of the open water at heads, a load on the same facets; groups that the mesh does not have are left out.
template <int D>
std::vector<MeshTraction<D>> open_water_of(const Scene& scene, const Mesh<D>& mesh, const CellOccupancy<D>& at_start);

/// The weight of a pond: a pressure on the surface of each body.
template <int D>
std::vector<SurfaceLoad<D>> pond_of(const Scene& scene, const Flow& flow, const std::vector<Body>& bodies);

}  // namespace talus
