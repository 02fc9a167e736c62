#pragma once
// The free field: level ground beside a model that goes on without end, as a column of layers whose motion depends on the height alone.
#include <optional>
#include <span>
#include <vector>

#include "core/fields.hpp"
#include "core/parallel/communicator.hpp"
#include "core/particles.hpp"
#include "materials/batch.hpp"
#include "mesh/mesh.hpp"

namespace talus {

/// Elastic ground as its waves see it.
struct Halfspace {
  Real density{};           ///< [kg/m^3]
  Real s_wave{}, p_wave{};  ///< speeds of its waves [m/s]
};

/// Dashpots of a facet's area against plane waves that leave through it [Lysmer & Kuhlemeyer 1969], force per velocity [N s/m]: density
/// times the speed of the wave, p across the facet and s along it.
template <int D>
Mat<D> impedance(const Halfspace& ground, const Vec<D>& area)
{
  const Real size = area.norm();
  const Vec<D> n = area / size;
  return ground.density * size * (ground.s_wave * Mat<D>::Identity() + (ground.p_wave - ground.s_wave) * n * n.transpose());
}

/// What moves in a column.
struct ColumnMotion {
  std::vector<Real> velocity;  ///< of each level, D numbers [m/s]
  std::vector<Real> traction;  ///< on horizontal planes of each layer, beyond that at rest, D numbers [Pa]
  static constexpr auto fields()
  {
    return std::tuple{saved("velocity", &ColumnMotion::velocity), saved("traction", &ColumnMotion::traction)};
  }
};

/// Layers between levels, from the foot to the ground.  A layer that is filled in part has that part of the mass and of the stiffness, as a
/// cell of the model has.
template <int D>
struct SoilColumn {
  struct Layer {
    Halfspace ground;
    Real filled = 1;
  };
  Vec<D> up = Vec<D>::Unit(D - 1);
  std::vector<Real> level;  ///< heights [m], ascending, one more than layers
  std::vector<Layer> layer;

  /// The layer at a height; the lowest or the highest beyond them.
  std::size_t layer_at(Real height) const noexcept;
  /// The velocity there, between levels by straight lines [m/s].
  Vec<D> velocity_at(Real height, const ColumnMotion& motion) const noexcept;
  /// What the ground beside exerts by its waves on an upright facet that is as high as a layer [N]: area is the facet's, out of the model.
  Vec<D> force_on(const Vec<D>& area, std::size_t at_layer, const ColumnMotion& motion) const noexcept;
  ColumnMotion at_rest() const { return {std::vector<Real>(D * level.size(), 0), std::vector<Real>(D * layer.size(), 0)}; }
};

/// What moves the foot of a column.
template <int D>
struct Foot {
  Vec<D> velocity = Vec<D>::Zero();    ///< of the foot, or of the wave that comes up [m/s]
  std::optional<Halfspace> halfspace;  ///< below a foot that gives way
};

/// A step of length dt [s] by central differences, in as many parts as are stable.
template <int D>
void advance(const SoilColumn<D>& column, const Foot<D>& foot, Real dt, ColumnMotion& motion);

/// The column beside upright facets, from the particles in the cells behind them: a level at each height that nodes have there, a layer's
/// ground being the mean of what is in it, up to where there is none.  Elastic stiffness is that of the laws for small strains.  Nothing
/// without particles there, or where one has a law without a shear modulus.  Every rank has to ask.
template <int D>
std::optional<SoilColumn<D>> column_beside(const Mesh<D>& mesh, std::span<const Facet> facets, const Vec<D>& up,
                                           const Particles<D>& particles, std::span<const AnyBatch> materials, Communicator& ranks);

}  // namespace talus
