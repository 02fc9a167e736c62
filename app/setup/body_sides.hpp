#pragma once
// The sides of the shape that a body fills, by their names, as loads use them.
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/scene/shape.hpp"
#include "solver/loads/surface_load.hpp"

namespace talus {

/// A flat or round piece of the surface of a shape.
template <int D>
struct SidePiece {
  /// The side as seen from x in the undeformed body.  The carrier field is zero beside the columns that stand on the piece.
  std::function<NearSide<D>(const Vec<D>& x)> near;
  /// How deep the body is behind the piece, as far as it matters: no deeper than `far` [m].
  std::function<Real(Real far)> thickness;
};

/// A side: what a load names.
template <int D>
struct BodySide {
  bool is_whole = false;   ///< the whole surface; then there are no pieces
  bool is_closed = false;  ///< without an edge
  std::vector<SidePiece<D>> pieces;

  NearSide<D> near(const Vec<D>& x) const
  {
    NearSide<D> nearest = pieces.front().near(x);
    Real of_column = nearest.carrier.isZero(0) ? std::numeric_limits<Real>::infinity() : nearest.depth;
    for (std::size_t k = 1; k < pieces.size(); ++k) {
      const NearSide<D> other = pieces[k].near(x);
      if (!other.carrier.isZero(0) && other.depth < of_column)
        of_column = other.depth, nearest.normal = other.normal, nearest.carrier = other.carrier;
      nearest.depth = std::min(nearest.depth, other.depth);
    }
    return nearest;
  }
  Real thickness(Real far) const
  {
    for (const SidePiece<D>& piece : pieces)
      far = std::min(far, piece.thickness(far));
    return far;
  }
};

/// The names of the sides of a shape, `boundary` for the whole surface among them.
template <int D>
std::vector<std::string> side_names(const Shape& shape);
/// The side of that name; nothing if there is none.
template <int D>
std::optional<BodySide<D>> side_of(const Shape& shape, std::string_view name);

}  // namespace talus
