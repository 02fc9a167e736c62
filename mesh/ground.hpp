#pragma once
// The ground: the upper side of the cells of a mesh that hold something.
#include <functional>
#include <vector>

#include "mesh/mesh.hpp"

namespace talus {

/// Elevation of the ground over the plan.  The last coordinate points up, the others are the plan; in 2-D the second one counts for nothing.
/// Where nothing is held it is the lowest side of the mesh: what comes there later lies on that.
template <int D>
class Ground {
 public:
  using Place = std::array<Real, 2>;

  /// `holds(cell)`: whether there is something in it.
  Ground(const Mesh<D>& mesh, const std::function<bool(Index)>& holds);

  /// [m]; of places beside the mesh that of the nearest side.
  Real operator()(const Place& place) const;

  /// A piece of the ground that nothing lies above.
  struct Piece {
    std::array<Vec<D>, D> corners;
    Real area;  ///< of its plan [m^(D-1)]
  };
  /// Pieces of what is held, without the lower side of the mesh.
  std::vector<Piece> pieces() const;

  static Place plan(const Vec<D>& x) noexcept
  {
    if constexpr (D == 2)
      return {x[0], 0};
    else
      return {x[0], x[1]};
  }

 private:
  /// Sides that look up, or down, by where they are in the plan.
  class Sides {
   public:
    explicit Sides(std::vector<Piece> pieces);
    std::span<const Piece> pieces() const noexcept { return pieces_; }
    /// f(elevation) of each side above or below a place.
    template <class F>
    void at(const Place& place, F&& f) const;
    Real nearest(const Place& place) const;

   private:
    std::size_t bucket(std::size_t axis, Real coordinate) const noexcept;

    std::vector<Piece> pieces_;
    Place low_{}, width_{1, 1};  // of the buckets' rectangle and of one bucket [m]
    std::array<std::size_t, 2> n_{1, 1};
    std::vector<std::vector<std::size_t>> buckets_;
  };
  static std::vector<Piece> sides(const Mesh<D>& mesh, const std::function<bool(Index)>& holds, bool up);

  Sides top_, bottom_;
};

extern template class Ground<2>;
extern template class Ground<3>;

}  // namespace talus
