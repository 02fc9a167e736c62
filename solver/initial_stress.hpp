#pragma once
// Stress at the start of a geostatic stage.
#include "core/particles.hpp"
#include "materials/batch.hpp"
#include "mesh/mesh.hpp"

namespace talus {

/// K0 state: the stress along gravity carries the weight of all mass above the particle, the stress across it is k0 times as
/// large.  "Above" is followed cell by cell against gravity, so any surface and any layering is right.  Throws SceneErrors, with
/// the place of the body, if its law cannot start from a stress.
template <int D>
void set_k0_stress(const Mesh<D>& mesh, const Vec<D>& gravity, Real k0, const std::vector<Body>& bodies, std::vector<AnyBatch>& materials,
                   Particles<D>& particles);

/// Mass per area [kg/m^(D-1)] met on the way from x in cell c along the unit vector `up` to the boundary of the mesh, for the mean
/// density of each cell [kg/m^D].
template <int D>
Real mass_above(const Mesh<D>& mesh, std::span<const Real> density, Vec<D> x, Index c, const Vec<D>& up) noexcept;

}  // namespace talus
