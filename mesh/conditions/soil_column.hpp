#pragma once
// The soil column of a free field: level ground of infinite extent, whose motion depends on the height alone.
#include <optional>
#include <vector>

#include "core/fields.hpp"
#include "mesh/conditions/dashpot.hpp"

namespace talus {

/// The motion of a column.
struct ColumnMotion {
  std::vector<Real> velocity;  ///< of each level, D numbers [m/s]
  std::vector<Real> traction;  ///< on horizontal planes of each layer, without that at rest, D numbers [Pa]
  static constexpr auto fields()
  {
    return std::tuple{saved("velocity", &ColumnMotion::velocity), saved("traction", &ColumnMotion::traction)};
  }
};

/// Layers between levels, from the base to the ground surface.  A layer that is partly filled has that fraction of its mass and stiffness,
/// as a cell of the model has.
template <int D>
struct SoilColumn {
  struct Layer {
    Halfspace ground;
    Real filled = 1;  ///< fraction of its volume
  };
  Vec<D> up = Vec<D>::Unit(D - 1);
  std::vector<Real> level;  ///< heights [m], ascending, one more than layers
  std::vector<Layer> layer;

  /// The layer at a height [m]; beyond the levels the lowest or the highest layer.
  std::size_t layer_at(Real height) const noexcept;
  /// The velocity at a height [m/s], linear between levels.
  Vec<D> velocity_at(Real height, const ColumnMotion& motion) const noexcept;
  /// The force [N] that the waves of the column exert on an upright facet at the height of a layer; the area vector points out of the model.
  Vec<D> force_on(const Vec<D>& area, std::size_t at_layer, const ColumnMotion& motion) const noexcept;
  ColumnMotion at_rest() const { return {std::vector<Real>(D * level.size(), 0), std::vector<Real>(D * layer.size(), 0)}; }
};

/// The base of a column.
template <int D>
struct ColumnBase {
  Vec<D> velocity = Vec<D>::Zero();    ///< of the base, or of the wave that comes up through the halfspace [m/s]
  std::optional<Halfspace> halfspace;  ///< below a compliant base
};

/// A step of length dt [s] by central differences, in as many substeps as stability needs.
template <int D>
void advance(const SoilColumn<D>& column, const ColumnBase<D>& base, Real dt, ColumnMotion& motion);

}  // namespace talus
