#pragma once
// Surfaces of segments in 2-D and of triangles in 3-D: distances to them, and what they enclose.
#include <array>
#include <string>
#include <vector>

#include "mesh/geometry/box_tree.hpp"

namespace talus {

/// The distance from a surface [m], negative behind it, and its gradient there: a unit vector that points away from what is behind.
template <int D>
struct SurfaceDistance {
  Real distance{};
  Vec<D> normal = Vec<D>::Zero();
  bool on_rim = false;  ///< the nearest point lies on the rim of an open surface; behind is then what its facet there has behind
  Vec<D> rim_normal = Vec<D>::Zero();  ///< unit normal of the front of the facets at that point of the rim; zero elsewhere
};

/// Volume [m^D], centre [m] and moments of inertia of what a closed surface encloses, for a density of 1.
template <int D>
struct EnclosedSolid {
  Real volume{};
  Vec<D> centre = Vec<D>::Zero();
  Mat3 inertia = Mat3::Zero();  ///< about the centre [m^(D+2)]; in 2-D only zz counts, of unit thickness
};

/// Area times unit normal of the front of a facet with these D corners; length times unit normal in 2-D [m^(D-1)].
template <int D>
Vec<D> area_of(const Vec<D>* corners) noexcept;

/// Facets, each with D corners, that show one side: in 2-D what is behind a segment lies to the left of the way from its first corner to its
/// second; in 3-D the corners of a triangle turn counterclockwise for who sees its front.
template <int D>
class FacetSurface {
 public:
  using Corners = std::vector<Vec<D>>;
  using Facets = std::vector<std::array<Index, D>>;
  /// Corners at one place [m] are one corner; facets two of whose corners are one are left out, unless all are such.  There is at least one.
  FacetSurface(Corners corners, Facets facets);

  /// The distance to the nearest point of the surface; what is behind is decided by the mean normal of the facets that meet there, weighted by
  /// their angles (Baerentzen and Aanaes, Signed distance computation using the angle weighted pseudonormal, 2005).
  SurfaceDistance<D> distance(const Vec<D>& x) const;

  /// What is wrong with it as the surface of a solid, in words; empty if it is closed and its facets show their fronts.
  std::string fault() const;
  /// What is wrong with it as a sheet, in words; empty if its facets show the same side wherever two meet, at most two at each edge, and it
  /// has a rim.
  std::string fault_of_sheet() const;
  /// Of a surface without fault.
  EnclosedSolid<D> solid() const;
  /// The same of a sheet of unit thickness.
  EnclosedSolid<D> sheet() const;
  /// Points on the surface that are nowhere farther apart than `spacing` [m]: corners, and points of edges and facets.
  std::vector<Vec<D>> samples(Real spacing) const;

  const Corners& corners() const noexcept { return corners_; }
  const Facets& facets() const noexcept { return facets_; }

 private:
  struct Nearest {
    Vec<D> place;
    std::array<Real, D> share;  // of the corners
  };
  /// What is at a point of the surface: the mean normal of the facets that meet there, and whether the surface ends there.
  struct Place {
    Vec<D> normal;
    bool on_rim;
  };
  Nearest nearest_of(Index facet, const Vec<D>& x) const noexcept;
  Place place_at(std::size_t facet, const std::array<Real, D>& share) const noexcept;
  std::array<Vec<D>, D> corners_of(std::size_t facet) const noexcept;

  Corners corners_;
  Facets facets_;
  std::vector<Vec<D>> normal_;          // of facets
  std::vector<Vec<D>> normal_of_node_;  // of corners
  /// 3-D: of the edge opposite each corner of a facet.
  std::vector<std::array<Vec<D>, D>> normal_of_edge_;
  std::vector<std::array<bool, D>> edge_on_rim_;  // 3-D: likewise
  std::vector<bool> node_on_rim_;                 // of corners
  Real size_ = 0;                                 // diagonal of the bounding box [m]
  BoxTree<D> tree_;
};

extern template class FacetSurface<2>;
extern template class FacetSurface<3>;

}  // namespace talus
