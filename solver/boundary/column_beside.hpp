#pragma once
// The soil column of a free field, made from the particles beside it.
#include <optional>
#include <span>

#include "core/parallel/communicator.hpp"
#include "core/particles.hpp"
#include "materials/interface/material.hpp"
#include "mesh/conditions/soil_column.hpp"
#include "mesh/mesh.hpp"

namespace talus {

/// The column beside upright facets, from the particles in the cells behind them: a level at each height with nodes, and in each layer the
/// mean of its particles, up to the first layer without any.  The elastic stiffness is that at small strains.  Nothing without particles,
/// or if one of them has a law without a shear modulus.  Collective.
template <int D>
std::optional<SoilColumn<D>> column_beside(const Mesh<D>& mesh, std::span<const Facet> facets, const Vec<D>& up,
                                           const Particles<D>& particles, std::span<const Material> materials, Communicator& ranks);

}  // namespace talus
