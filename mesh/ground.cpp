#include "mesh/ground.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace talus {

namespace {

/// A side is upright if its plan area is a smaller fraction of its area.
constexpr Real upright = 1e-9;
/// The smallest barycentric coordinate of a position inside a side; negative to allow for round-off.
constexpr Real on_the_rim = -1e-9;

/// The barycentric coordinates of a position of the plan in a side.
std::array<Real, 2> shares(const std::array<Vec<2>, 2>& corners, const std::array<Real, 2>& place) noexcept
{
  const Real t = (place[0] - corners[0][0]) / (corners[1][0] - corners[0][0]);
  return {1 - t, t};
}
std::array<Real, 3> shares(const std::array<Vec<3>, 3>& corners, const std::array<Real, 2>& place) noexcept
{
  const auto twice = [&](const std::array<Real, 2>& a, const std::array<Real, 2>& b) {
    return (a[0] - place[0]) * (b[1] - place[1]) - (a[1] - place[1]) * (b[0] - place[0]);
  };
  const auto plan = [&](std::size_t k) { return std::array{corners[k][0], corners[k][1]}; };
  const std::array<Real, 3> part{twice(plan(1), plan(2)), twice(plan(2), plan(0)), twice(plan(0), plan(1))};
  const Real whole = part[0] + part[1] + part[2];
  return {part[0] / whole, part[1] / whole, part[2] / whole};
}

/// The elevation of a side at a position, if it contains the position.
template <int D>
std::optional<Real> elevation(const std::array<Vec<D>, D>& corners, const std::array<Real, 2>& place) noexcept
{
  const auto share = shares(corners, place);
  Real z = 0;
  for (std::size_t k = 0; k < D; ++k) {
    if (!(share[k] >= on_the_rim))
      return std::nullopt;
    z += share[k] * corners[k][D - 1];
  }
  return z;
}

}  // namespace

template <int D>
std::vector<typename Ground<D>::Piece> Ground<D>::sides(const Mesh<D>& mesh, const std::function<bool(Index)>& holds, bool up)
{
  std::vector<Piece> found;
  for (Index c = 0; c < mesh.n_cells(); ++c) {
    if (up && !holds(c))
      continue;
    for (Index k = 0; k <= D; ++k) {
      const Index other = mesh.neighbours(c)[static_cast<std::size_t>(k)];
      if (up ? other != none && holds(other) : other != none)
        continue;
      const Vec<D> area = mesh.area_vector({c, k});
      const Real plan = up ? area[D - 1] : -area[D - 1];
      if (plan <= upright * area.norm())
        continue;
      Piece piece{{}, plan};
      const auto nodes = mesh.nodes_of({c, k});
      for (std::size_t a = 0; a < D; ++a)
        piece.corners[a] = mesh.node(nodes[a]);
      found.push_back(piece);
    }
  }
  return found;
}

template <int D>
Ground<D>::Ground(const Mesh<D>& mesh, const std::function<bool(Index)>& holds)
    : top_(sides(mesh, holds, true)), bottom_(sides(mesh, holds, false))
{}

template <int D>
Real Ground<D>::operator()(const Place& place) const
{
  constexpr Real none_there = std::numeric_limits<Real>::infinity();
  Real top = -none_there, bottom = none_there;
  top_.at(place, [&](Real z) { top = std::max(top, z); });
  if (top > -none_there)
    return top;
  bottom_.at(place, [&](Real z) { bottom = std::min(bottom, z); });
  return bottom < none_there ? bottom : bottom_.nearest(place);
}

template <int D>
std::vector<typename Ground<D>::Piece> Ground<D>::pieces() const
{
  std::vector<Piece> visible;
  for (const Piece& piece : top_.pieces()) {
    Vec<D> middle = Vec<D>::Zero();
    for (const Vec<D>& corner : piece.corners)
      middle += corner / D;
    Real highest = middle[D - 1];
    top_.at(plan(middle), [&](Real z) { highest = std::max(highest, z); });
    if (highest <= middle[D - 1] + upright * (1 + std::abs(highest)))
      visible.push_back(piece);
  }
  return visible;
}

template <int D>
Ground<D>::Sides::Sides(std::vector<Piece> pieces) : pieces_(std::move(pieces))
{
  if (pieces_.empty())
    return;
  Place high;
  low_.fill(std::numeric_limits<Real>::infinity()), high.fill(-std::numeric_limits<Real>::infinity());
  for (const Piece& piece : pieces_)
    for (const Vec<D>& corner : piece.corners)
      for (std::size_t axis = 0; axis < 2; ++axis) {
        low_[axis] = std::min(low_[axis], plan(corner)[axis]);
        high[axis] = std::max(high[axis], plan(corner)[axis]);
      }
  const auto along = static_cast<std::size_t>(std::ceil(std::pow(static_cast<Real>(pieces_.size()), Real{1} / (D - 1))));
  n_ = {along, D == 3 ? along : 1};
  for (std::size_t axis = 0; axis < 2; ++axis)
    width_[axis] = high[axis] > low_[axis] ? (high[axis] - low_[axis]) / static_cast<Real>(n_[axis]) : 1;
  buckets_.resize(n_[0] * n_[1]);
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    std::array<std::size_t, 2> first{n_[0], n_[1]}, last{0, 0};
    for (const Vec<D>& corner : pieces_[i].corners)
      for (std::size_t axis = 0; axis < 2; ++axis) {
        const Real at = plan(corner)[axis], rim = 1e-6 * width_[axis];  // a position on the boundary may be assigned to either side
        first[axis] = std::min(first[axis], bucket(axis, at - rim));
        last[axis] = std::max(last[axis], bucket(axis, at + rim));
      }
    for (std::size_t y = first[1]; y <= last[1]; ++y)
      for (std::size_t x = first[0]; x <= last[0]; ++x)
        buckets_[y * n_[0] + x].push_back(i);
  }
}

template <int D>
std::size_t Ground<D>::Sides::bucket(std::size_t axis, Real coordinate) const noexcept
{
  const Real at = (coordinate - low_[axis]) / width_[axis];
  return at > 0 ? std::min(static_cast<std::size_t>(at), n_[axis] - 1) : 0;
}

template <int D>
template <class F>
void Ground<D>::Sides::at(const Place& place, F&& f) const
{
  if (pieces_.empty())
    return;
  for (const std::size_t i : buckets_[bucket(1, place[1]) * n_[0] + bucket(0, place[0])])
    if (const auto z = elevation<D>(pieces_[i].corners, place))
      f(*z);
}

template <int D>
Real Ground<D>::Sides::nearest(const Place& place) const
{
  Real least = std::numeric_limits<Real>::infinity(), z = 0;
  for (const Piece& piece : pieces_)
    for (const Vec<D>& corner : piece.corners) {
      const Place there = plan(corner);
      if (const Real distance = std::hypot(there[0] - place[0], there[1] - place[1]); distance < least)
        least = distance, z = corner[D - 1];
    }
  return z;
}

template class Ground<2>;
template class Ground<3>;

}  // namespace talus
