#pragma once
// The ground: the upper side of the cells of a mesh that contain material.
#include <functional>
#include <vector>

#include "mesh/mesh.hpp"

namespace talus {

/// The elevation of the ground over the plan.  The last coordinate points up, the others are the plan; in 2-D the second plan coordinate is
/// ignored.  Where no cell contains material the ground is the lowest side of the mesh, on which arriving material comes to lie.
template <int D>
class Ground {
 public:
  using Place = std::array<Real, 2>;

  /// `holds(cell)` returns whether the cell contains material.
  Ground(const Mesh<D>& mesh, const std::function<bool(Index)>& holds);

  /// The elevation [m]; outside of the mesh that of the nearest side.
  Real operator()(const Place& place) const;

  /// A piece of the ground that is not covered by other cells.
  struct Piece {
    std::array<Vec<D>, D> corners;
    Real area;  ///< plan area [m^(D-1)]
  };
  /// The pieces of the ground on cells with material, without the lower side of the mesh.
  std::vector<Piece> pieces() const;

  static Place plan(const Vec<D>& x) noexcept
  {
    if constexpr (D == 2)
      return {x[0], 0};
    else
      return {x[0], x[1]};
  }

 private:
  /// Sides that face up, or down, sorted by their position in the plan.
  class Sides {
   public:
    explicit Sides(std::vector<Piece> pieces);
    std::span<const Piece> pieces() const noexcept { return pieces_; }
    /// Calls f(elevation) for each side above or below a position.
    template <class F>
    void at(const Place& place, F&& f) const;
    Real nearest(const Place& place) const;

   private:
    std::size_t bucket(std::size_t axis, Real coordinate) const noexcept;

    std::vector<Piece> pieces_;
    Place low_{}, width_{1, 1};  // size of the grid of buckets and of one bucket [m]
    std::array<std::size_t, 2> n_{1, 1};
    std::vector<std::vector<std::size_t>> buckets_;
  };
  static std::vector<Piece> sides(const Mesh<D>& mesh, const std::function<bool(Index)>& holds, bool up);

  Sides top_, bottom_;
};

extern template class Ground<2>;
extern template class Ground<3>;

}  // namespace talus
