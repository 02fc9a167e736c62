#pragma once
// What a boundary condition may ask for while it is made from its options.
#include <functional>
#include <optional>
#include <span>

#include "core/recorded_motion.hpp"
#include "mesh/conditions/soil_column.hpp"
#include "mesh/mesh.hpp"

namespace talus {

/// A condition is made by `static C make(const C::Options&, const ConditionSetup<D>&)`, which throws std::invalid_argument with a message
/// about the key `on` if it is impossible on this mesh.
template <int D>
struct ConditionSetup {
  const Mesh<D>& mesh;
  std::span<const Facet> facets;  ///< of the group, seen from the material; none for a condition on nodes
  Vec<D> up;                      ///< unit vector against gravity
  std::optional<Record> record;   ///< the motion of the file that the options name
  /// The condition that holds or moves a node in all directions, of those made before, or none.
  std::function<Index(Index node)> holder_of;
  /// The ground behind the facets as a column of layers; nothing if there is none, or none with a shear modulus.  Every rank has to call.
  std::function<std::optional<SoilColumn<D>>()> column_beside;
};

}  // namespace talus
