#pragma once
// The block `water` of a scene -> the table at the nodes, and particles whose pores are full.
#include "app/setup/checks/scene_error_collector.hpp"
#include "mesh/mesh.hpp"
#include "solver/loads/water.hpp"

namespace talus {

/// Where the table is, cut at the ground, which is the upper side of the cells that are `filled` on any rank.  Complains of a table that is not
/// known where there is material or lies above most of the ground, and of gravity that does not point down; warns of what is cut.
template <int D>
Water water_of(const Scene& scene, const Mesh<D>& mesh, const std::vector<Body>& bodies, const std::function<bool(Index)>& filled,
               SceneErrorCollector& errors, std::vector<std::string>& warnings);

/// The elevation of the table of a later stage at each node, found in the same way with the cells that are filled then.
template <int D>
std::vector<Real> table_of_stage(const Scene& scene, const StageWaterSpec& spec, const Mesh<D>& mesh,
                                 const std::function<bool(Index)>& filled, SceneErrorCollector& errors, std::vector<std::string>& warnings);

/// Of the bodies that are there from the stage of that number on: the mass of particles below the table becomes that of their body's saturated
/// density, where it has one.
template <int D>
void saturate(const Scene& scene, Index stage, const Mesh<D>& mesh, const Water& water, const std::vector<Body>& bodies,
              Particles<D>& particles);

/// Particles of a body, of this rank, that lie below the table.
template <int D>
Index count_wet(const Mesh<D>& mesh, const Water& water, const Body& body, const Particles<D>& particles);

}  // namespace talus
