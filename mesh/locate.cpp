#include "mesh/locate.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

#include "mesh/simplex.hpp"

namespace talus {

namespace {

constexpr int longest_walk = 32;  // most steps of a walk; a search in the tree costs about as much

template <int D>
Extent<D> tolerant_box(const Simplex<D>& s, Real tolerance)
{
  Extent<D> box;
  for (const Vec<D>& corner : s)
    box.take(corner);
  box.low.array() -= tolerance;
  box.high.array() += tolerance;
  return box;
}

template <int D>
Extent<D> cell_box(const Mesh<D>& mesh, Index c)
{
  const Simplex<D> s = mesh.corners(c);
  return tolerant_box<D>(s, location_tolerance * longest_edge<D>(s));
}

template <int D>
std::array<Vec<D>, D> facet_corners(const Mesh<D>& mesh, Facet f)
{
  return facet<D>(mesh.corners(f.cell), f.local);
}

template <int D>
Extent<D> facet_box(const Mesh<D>& mesh, Facet f)
{
  Extent<D> box;
  for (const Vec<D>& corner : facet_corners(mesh, f))
    box.take(corner);
  return box;
}

enum class Position : std::uint8_t { deep, within, outside };

/// The position of x relative to one cell: distances to its facets, and to its bounding box, because beyond a sharp corner the former are
/// small.
template <int D>
Position position(const Mesh<D>& mesh, Index c, const Vec<D>& x, Real margin) noexcept
{
  const Simplex<D> s = mesh.corners(c);
  const Real tolerance = location_tolerance * longest_edge<D>(s);
  if (!tolerant_box<D>(s, tolerance).holds(x))
    return Position::outside;
  const std::array<Real, D + 1> lambda = barycentric<D>(s, x), height = altitudes<D>(s);
  Real depth = lambda[0] * height[0];
  for (int a = 1; a <= D; ++a)
    depth = std::min(depth, lambda[a] * height[a]);
  return depth > margin ? Position::deep : depth >= -tolerance ? Position::within : Position::outside;
}

}  // namespace

template <int D>
Locator<D>::Locator(const Mesh<D>& mesh)
    : margin_(2 * location_tolerance * mesh.largest_edge()),
      cells_(mesh.n_cells(), [&](Index c) { return cell_box(mesh, c); }),
      facets_(static_cast<Index>(mesh.boundary_facets().size()), [&](Index i) { return facet_box(mesh, mesh.boundary_facets()[i]); })
{}

template <int D>
std::optional<Index> Locator<D>::operator()(const Mesh<D>& mesh, const Vec<D>& x, Index hint) const noexcept
{
  assert(hint >= none && hint < mesh.n_cells());
  for (int step = 0; step < longest_walk && hint != none; ++step) {
    const std::array<Real, D + 1> lambda = mesh.barycentric(hint, x);
    const auto worst = std::min_element(lambda.begin(), lambda.end());
    if (*worst * mesh.altitude(hint) > margin_)
      return hint;
    if (!(*worst < 0))  // near a facet, or NaN
      break;
    hint = mesh.neighbours(hint)[worst - lambda.begin()];
  }
  return search(mesh, x);
}

template <int D>
std::optional<Index> Locator<D>::search(const Mesh<D>& mesh, const Vec<D>& x) const noexcept
{
  std::optional<Index> found;
  cells_.around(x, [&](Index c) {
    const Position where = position(mesh, c, x, margin_);
    if (where == Position::deep || (where == Position::within && !found))
      found = c;
    return where == Position::deep;
  });
  return found;
}

template <int D>
typename Locator<D>::Nearest Locator<D>::nearest(const Mesh<D>& mesh, const Vec<D>& x) const noexcept
{
  const std::span<const Facet> facets = mesh.boundary_facets();
  if (facets.empty())
    return {Vec<D>::Constant(std::numeric_limits<Real>::infinity()), 0, {0, 0}};
  const Index i = facets_.nearest(x, [&](Index f) { return (closest_point(facet_corners(mesh, facets[f]), x) - x).squaredNorm(); });
  return {closest_point(facet_corners(mesh, facets[i]), x), facets[i].cell, facets[i]};
}

template class Locator<2>;
template class Locator<3>;

}  // namespace talus
