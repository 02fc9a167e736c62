#pragma once
// The soil column of a free field: level ground of infinite extent, whose motion depends on height and time only.
#include <optional>
#include <vector>

#include "core/fields.hpp"
#include "mesh/conditions/dashpot.hpp"

namespace talus {

/// The motion of a column.
struct ColumnMotion {
  std::vector<Real> velocity;  ///< velocity of each level, D numbers [m/s]
  std::vector<Real> traction;  ///< traction on horizontal planes of each layer minus its value at rest, D numbers [Pa]
  static constexpr auto fields()
  {
    return std::tuple{saved("velocity", &ColumnMotion::velocity), saved("traction", &ColumnMotion::traction)};
  }
};

/// Layers between levels, from the base to the ground surface.  Mass and stiffness of a partly filled layer are multiplied by the filled
/// fraction, as in the cells of the model.
template <int D>
struct SoilColumn {
  struct Layer {
    Halfspace ground;
    Real filled = 1;  ///< filled fraction of the volume
  };
  Vec<D> up = Vec<D>::Unit(D - 1);
  std::vector<Real> level;  ///< heights [m], ascending; one more than layers
  std::vector<Layer> layer;

  /// The index of the layer at a height [m]; the lowest or highest layer beyond the levels.
  std::size_t layer_at(Real height) const noexcept;
  /// The velocity at a height [m/s], linear between levels.
  Vec<D> velocity_at(Real height, const ColumnMotion& motion) const noexcept;
  /// The force [N] that the waves of the column exert on an upright facet at the height of a layer; the area vector points out of the model.
  Vec<D> force_on(const Vec<D>& area, std::size_t at_layer, const ColumnMotion& motion) const noexcept;
  ColumnMotion at_rest() const { return {std::vector<Real>(D * level.size(), 0), std::vector<Real>(D * layer.size(), 0)}; }
};

/// The ground or motion below a column.
template <int D>
struct ColumnBase {
  Vec<D> velocity = Vec<D>::Zero();    ///< velocity of the base, or of the incident wave in the halfspace [m/s]
  std::optional<Halfspace> halfspace;  ///< set for a compliant base
};

/// Advances the column by dt [s] with central differences, in as many substeps as stability needs.
template <int D>
void advance(const SoilColumn<D>& column, const ColumnBase<D>& base, Real dt, ColumnMotion& motion);

}  // namespace talus
