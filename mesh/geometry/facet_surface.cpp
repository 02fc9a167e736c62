#include "mesh/geometry/facet_surface.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

namespace talus {

namespace {

/// A share of a corner below this means that a nearest point lies on the opposite edge.
constexpr Real on_edge = 1e-9;
/// A point nearer than this times the size of the surface lies on it.
constexpr Real round_off = 1e-10;

Vec<3> cross_of(const Vec<3>& a, const Vec<3>& b) noexcept
{
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Gives corners at one place one number, and orders facets by the place of their centres, so that neighbours have close numbers.
template <int D>
void merge_corners(std::vector<Vec<D>>& corners, std::vector<std::array<Index, D>>& facets)
{
  const auto before = [](const Vec<D>& a, const Vec<D>& b) { return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end()); };
  std::map<Vec<D>, Index, decltype(before)> number(before);
  std::vector<Vec<D>> merged;
  for (auto& facet : facets)
    for (Index& corner : facet) {
      const Vec<D>& place = corners[static_cast<std::size_t>(corner)];
      const auto [known, is_new] = number.try_emplace(place, static_cast<Index>(merged.size()));
      if (is_new)
        merged.push_back(place);
      corner = known->second;
    }
  corners = std::move(merged);
}

/// Orders facets along the bits of the coordinates of their centres, so that every range is compact.
template <int D>
void sort_facets(const std::vector<Vec<D>>& corners, std::vector<std::array<Index, D>>& facets)
{
  Extent<D> all;
  for (const Vec<D>& corner : corners)
    all.take(corner);
  const Real size = std::max((all.high - all.low).maxCoeff(), std::numeric_limits<Real>::min());
  constexpr int bits = 20;
  const auto key = [&](const std::array<Index, D>& facet) {
    Vec<D> centre = Vec<D>::Zero();
    for (const Index corner : facet)
      centre += corners[static_cast<std::size_t>(corner)] / D;
    const Vec<D> place = (centre - all.low) / size * ((1 << bits) - 1);
    std::uint64_t mixed = 0;
    for (int bit = bits; bit-- > 0;)
      for (int d = 0; d < D; ++d)
        mixed = mixed << 1 | (static_cast<std::uint64_t>(place[d]) >> bit & 1);
    return mixed;
  };
  std::vector<std::pair<std::uint64_t, std::array<Index, D>>> sorted;
  for (const auto& facet : facets)
    sorted.emplace_back(key(facet), facet);
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t f = 0; f < facets.size(); ++f)
    facets[f] = sorted[f].second;
}

/// Files of surfaces may have triangles two of whose corners are at one place: they cover nothing, and their edges would have no neighbours.
template <int D>
void drop_collapsed(const std::vector<Vec<D>>& corners, std::vector<std::array<Index, D>>& facets)
{
  const auto is_collapsed = [&](const std::array<Index, D>& facet) {
    for (std::size_t k = 0; k < D; ++k)
      for (std::size_t l = k + 1; l < D; ++l)
        if (corners[static_cast<std::size_t>(facet[k])] == corners[static_cast<std::size_t>(facet[l])])
          return true;
    return false;
  };
  if (!std::ranges::all_of(facets, is_collapsed))
    std::erase_if(facets, is_collapsed);
}

template <int D>
std::vector<std::array<Index, D>> prepared(std::vector<Vec<D>>& corners, std::vector<std::array<Index, D>> facets)
{
  drop_collapsed<D>(corners, facets);
  merge_corners<D>(corners, facets);
  sort_facets<D>(corners, facets);
  return facets;
}

}  // namespace

template <int D>
FacetSurface<D>::FacetSurface(Corners corners, Facets facets)
    : corners_(std::move(corners)),
      facets_(prepared<D>(corners_, std::move(facets))),
      tree_(static_cast<Index>(facets_.size()), [this](Index f) {
        Extent<D> box;
        for (const Vec<D>& corner : corners_of(static_cast<std::size_t>(f)))
          box.take(corner);
        return box;
      })
{
  Extent<D> all;
  for (const Vec<D>& corner : corners_)
    all.take(corner);
  size_ = (all.high - all.low).norm();
  normal_.resize(facets_.size());
  normal_of_node_.assign(corners_.size(), Vec<D>::Zero());
  normal_of_edge_.resize(D == 3 ? facets_.size() : 0);
  std::map<std::array<Index, 2>, Vec<D>> of_edge;
  std::map<std::array<Index, 2>, int> facets_of_edge;
  std::vector<int> facets_of_node(corners_.size(), 0);
  const auto edge = [&](std::size_t f, std::size_t opposite) {
    std::array<Index, 2> ends{facets_[f][(opposite + 1) % D], facets_[f][(opposite + 2) % D]};
    std::ranges::sort(ends);
    return ends;
  };
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    normal_[f] = area_of<D>(corners_of(f).data()).stableNormalized();
    const auto at = corners_of(f);
    for (std::size_t k = 0; k < D; ++k) {
      Real angle = 1;
      if constexpr (D == 3) {
        const Vec<3> a = at[(k + 1) % 3] - at[k], b = at[(k + 2) % 3] - at[k];
        angle = std::atan2(cross_of(a, b).norm(), a.dot(b));
        of_edge.try_emplace(edge(f, k), Vec<D>::Zero()).first->second += normal_[f];
        ++facets_of_edge[edge(f, k)];
      }
      ++facets_of_node[static_cast<std::size_t>(facets_[f][k])];
      normal_of_node_[static_cast<std::size_t>(facets_[f][k])] += angle * normal_[f];
    }
  }
  node_on_rim_.assign(corners_.size(), false);
  if constexpr (D == 2)
    for (std::size_t n = 0; n < corners_.size(); ++n)
      node_on_rim_[n] = facets_of_node[n] == 1;
  edge_on_rim_.resize(normal_of_edge_.size());
  for (std::size_t f = 0; f < normal_of_edge_.size(); ++f)
    for (std::size_t k = 0; k < D; ++k) {
      normal_of_edge_[f][k] = of_edge.at(edge(f, k));
      edge_on_rim_[f][k] = facets_of_edge.at(edge(f, k)) == 1;
      if (edge_on_rim_[f][k])
        for (const Index end : edge(f, k))
          node_on_rim_[static_cast<std::size_t>(end)] = true;
    }
}

template <int D>
std::array<Vec<D>, D> FacetSurface<D>::corners_of(std::size_t facet) const noexcept
{
  std::array<Vec<D>, D> all;
  for (std::size_t k = 0; k < D; ++k)
    all[k] = corners_[static_cast<std::size_t>(facets_[facet][k])];
  return all;
}

template <int D>
Vec<D> area_of(const Vec<D>* at) noexcept
{
  if constexpr (D == 2)
    return {at[1][1] - at[0][1], at[0][0] - at[1][0]};
  else
    return 0.5 * cross_of(at[1] - at[0], at[2] - at[0]);
}

// In 3-D after Ericson, Real-Time Collision Detection, 5.1.5: the region of the plane that the foot point lies in decides.
template <int D>
typename FacetSurface<D>::Nearest FacetSurface<D>::nearest_of(Index facet, const Vec<D>& x) const noexcept
{
  const auto at = corners_of(static_cast<std::size_t>(facet));
  const Vec<D> along = at[1] - at[0], from = x - at[0];
  std::array<Real, D> share{};
  const auto on_segment = [&](std::size_t a, std::size_t b) {
    const Vec<D> way = at[b] - at[a];
    const Real length = way.squaredNorm(), t = length > 0 ? std::clamp((x - at[a]).dot(way) / length, Real{0}, Real{1}) : 0;
    share.fill(0);
    share[a] = 1 - t, share[b] = t;
    return Vec<D>(at[a] + t * way);
  };
  if constexpr (D == 2) {
    const Vec<D> place = on_segment(0, 1);
    return {place, share};
  } else {
    const Vec<D> other = at[2] - at[0];
    const Real aa = along.squaredNorm(), ab = along.dot(other), bb = other.squaredNorm(), determinant = aa * bb - ab * ab;
    if (determinant > 1e-30 * aa * bb) {
      const Real p = from.dot(along), q = from.dot(other);
      const Real second = (bb * p - ab * q) / determinant, third = (aa * q - ab * p) / determinant;
      if (second >= 0 && third >= 0 && second + third <= 1)
        return {at[0] + second * along + third * other, {1 - second - third, second, third}};
    }
    Nearest best{};
    Real least = std::numeric_limits<Real>::infinity();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec<D> place = on_segment((k + 1) % 3, (k + 2) % 3);
      if (const Real distance = (x - place).squaredNorm(); distance < least)
        least = distance, best = {place, share};
    }
    return best;
  }
}

template <int D>
typename FacetSurface<D>::Place FacetSurface<D>::place_at(std::size_t facet, const std::array<Real, D>& share) const noexcept
{
  std::size_t away = 0, last = 0;  // corners that the point is not at, and one of these
  for (std::size_t k = 0; k < D; ++k)
    if (share[k] < on_edge)
      ++away, last = k;
  if (away == 0)
    return {normal_[facet], false};
  if constexpr (D == 3)
    if (away == 1)
      return {normal_of_edge_[facet][last], edge_on_rim_[facet][last]};
  const auto corner = static_cast<std::size_t>(facets_[facet][static_cast<std::size_t>(std::ranges::max_element(share) - share.begin())]);
  return {normal_of_node_[corner], node_on_rim_[corner]};
}

template <int D>
SurfaceDistance<D> FacetSurface<D>::distance(const Vec<D>& x) const
{
  const Index facet = tree_.nearest(x, [&](Index f) { return (x - nearest_of(f, x).place).squaredNorm(); });
  const Nearest nearest = nearest_of(facet, x);
  const Place at = place_at(static_cast<std::size_t>(facet), nearest.share);
  const Vec<D>& outward = at.normal;
  const Vec<D> away = x - nearest.place;
  const Real distance = away.norm();
  const bool behind = away.dot(outward) < 0;
  const Vec<D> rim_normal = at.on_rim ? Vec<D>(outward.stableNormalized()) : Vec<D>(Vec<D>::Zero());
  if (distance <= round_off * (size_ + x.norm()))  // its direction would be that of round-off
    return {behind ? -distance : distance, outward.stableNormalized(), at.on_rim, rim_normal};
  return {behind ? -distance : distance, (behind ? -1 : 1) / distance * away, at.on_rim, rim_normal};
}

namespace {

/// Calls f(border, sense) for the ends of segments, or the edges of triangles with their lower corner first; the sense is that in which the
/// facet passes them.
template <int D, class F>
void for_each_border(const std::vector<std::array<Index, D>>& facets, F&& f)
{
  for (const auto& facet : facets)
    if constexpr (D == 2) {
      f(std::array<Index, 1>{facet[0]}, -1);
      f(std::array<Index, 1>{facet[1]}, 1);
    } else {
      for (std::size_t k = 0; k < 3; ++k) {
        const Index from = facet[k], to = facet[(k + 1) % 3];
        f(std::array<Index, 2>{std::min(from, to), std::max(from, to)}, from < to ? 1 : -1);
      }
    }
}

}  // namespace

template <int D>
std::string FacetSurface<D>::fault() const
{
  std::map<std::array<Index, D - 1>, int> borders;  // how often each is passed in one sense minus the other
  for_each_border<D>(facets_, [&](const auto& border, int sense) { borders.try_emplace(border, 0).first->second += sense; });
  for (const auto& [border, surplus] : borders)
    if (surplus != 0) {
      const Vec<D>& at = corners_[static_cast<std::size_t>(border[0])];
      return fmt::format("is open, or its facets do not all show the same side, at ({:.6g})", fmt::join(at.begin(), at.end(), ", "));
    }
  const Real volume = solid().volume;
  if (!(volume > 0))
    return volume < 0 ? "is inside out: turn the order of the corners of its facets around" : "encloses nothing";
  return {};
}

// Sums over the simplices between the facets and one corner, whose integrals of 1, x and x x^T are exact.
template <int D>
EnclosedSolid<D> FacetSurface<D>::solid() const
{
  const Vec<D> from = corners_.front();  // near the surface, against round-off far from the origin
  EnclosedSolid<D> solid;
  Vec<D> first = Vec<D>::Zero();
  Mat<D> second = Mat<D>::Zero();  // integral of x x^T
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    auto at = corners_of(f);
    Vec<D> sum = Vec<D>::Zero();
    Mat<D> products = Mat<D>::Zero();
    for (Vec<D>& corner : at) {
      corner -= from;
      sum += corner;
      products += corner * corner.transpose();
    }
    const Real volume = at[0].dot(area_of<D>(at.data())) / D;
    solid.volume += volume;
    first += volume / (D + 1) * sum;
    second += volume / ((D + 1) * (D + 2)) * (products + sum * sum.transpose());
  }
  const Vec<D> centre = first / solid.volume;
  second -= solid.volume * centre * centre.transpose();
  solid.centre = from + centre;
  Mat3 spread = Mat3::Zero();
  spread.template topLeftCorner<D, D>() = second;
  solid.inertia = spread.trace() * Mat3::Identity() - spread;
  return solid;
}

template <int D>
std::string FacetSurface<D>::fault_of_sheet() const
{
  std::map<std::array<Index, D - 1>, std::pair<int, int>> borders;  // how often each is passed, and in one sense minus the other
  for_each_border<D>(facets_, [&](const auto& border, int sense) {
    auto& [passes, surplus] = borders[border];
    ++passes, surplus += sense;
  });
  bool has_rim = false;
  for (const auto& [border, passed] : borders) {
    has_rim |= passed.first == 1;
    if (passed.first <= 2 && std::abs(passed.second) == passed.first % 2)
      continue;
    const Vec<D>& at = corners_[static_cast<std::size_t>(border[0])];
    return fmt::format("{} at ({:.6g})", passed.first > 2 ? "branches" : "has facets that show different sides",
                       fmt::join(at.begin(), at.end(), ", "));
  }
  return has_rim ? std::string() : std::string("is closed: it is that of a solid");
}

template <int D>
EnclosedSolid<D> FacetSurface<D>::sheet() const
{
  const Vec<D> from = corners_.front();  // as in solid()
  EnclosedSolid<D> sheet;
  Vec<D> centre = Vec<D>::Zero();
  Mat<D> second = Mat<D>::Zero();  // integral of x x^T
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    auto at = corners_of(f);
    const Real area = area_of<D>(at.data()).norm();
    Vec<D> sum = Vec<D>::Zero();
    Mat<D> products = Mat<D>::Zero();
    for (Vec<D>& corner : at) {
      corner -= from;
      sum += corner;
      products += corner * corner.transpose();
    }
    sheet.volume += area;
    centre += area / D * sum;
    second += area / (D * (D + 1)) * (products + sum * sum.transpose());
  }
  centre /= sheet.volume;
  second -= sheet.volume * centre * centre.transpose();
  sheet.centre = from + centre;
  Mat3 spread = Mat3::Zero();
  spread.template topLeftCorner<D, D>() = second;
  sheet.inertia = spread.trace() * Mat3::Identity() - spread;
  return sheet;
}

template <int D>
std::vector<Vec<D>> FacetSurface<D>::samples(Real spacing) const
{
  std::vector<Vec<D>> all = corners_;
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    const auto at = corners_of(f);
    Real longest = 0;
    for (std::size_t k = 0; k < D; ++k)
      longest = std::max(longest, (at[(k + 1) % D] - at[k]).norm());
    const auto parts = static_cast<int>(std::ceil(longest / spacing));
    for (int i = 0; i <= parts; ++i)
      if constexpr (D == 2) {
        if (i > 0 && i < parts)
          all.push_back(at[0] + (at[1] - at[0]) * i / parts);
      } else {
        for (int j = 0; j <= parts - i; ++j)
          if (std::max({i, j, parts - i - j}) < parts)
            all.push_back(at[0] + (at[1] - at[0]) * i / parts + (at[2] - at[0]) * j / parts);
      }
  }
  const auto before = [](const Vec<D>& a, const Vec<D>& b) { return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end()); };
  std::sort(all.begin(), all.end(), before);  // points of edges come from both of their facets
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

template Vec<2> area_of(const Vec<2>*) noexcept;
template Vec<3> area_of(const Vec<3>*) noexcept;
template class FacetSurface<2>;
template class FacetSurface<3>;

}  // namespace talus
