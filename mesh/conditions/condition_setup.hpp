#pragma once
// Information for a boundary condition while it is made from its options.
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
  std::span<const Facet> facets;  ///< facets of the group, with normals out of the material; empty for a condition on nodes
  Vec<D> up;                      ///< unit vector against gravity
  std::optional<Record> record;   ///< motion in the file that the options name
  /// The index of an earlier condition that prescribes all components of a node, or none.
  std::function<Index(Index node)> holder_of;
  /// The ground behind the facets as a column of layers; nothing if there is none, or none with a shear modulus.  Collective.
  std::function<std::optional<SoilColumn<D>>()> column_beside;
};

}  // namespace talus
