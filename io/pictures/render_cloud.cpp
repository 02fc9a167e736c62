// Geometry of a cloud of points: bounding box, and directions of its surface.
#include <algorithm>
#include <unordered_map>

#include "io/pictures/render_data.hpp"

namespace talus::render {

namespace {

constexpr Real surface_share = 0.12;  // offset of the centre of mass over the reach above which a particle counts as a surface particle

/// Particles sorted into cubes as wide as the reach, so that neighbours are in the 27 cubes around.
class Cubes {
 public:
  Cubes(const std::vector<Vec3>& x, const Vec3& low, Real width) : low_(low), width_(width)
  {
    for (std::size_t p = 0; p < x.size(); ++p)
      cubes_[key(place(x[p]))].push_back(static_cast<Index>(p));
  }
  template <class F>
  void for_neighbours(const Vec3& x, F&& f) const
  {
    const auto centre = place(x);
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j)
        for (int k = -1; k <= 1; ++k) {
          const auto found = cubes_.find(key({centre[0] + i, centre[1] + j, centre[2] + k}));
          if (found != cubes_.end())
            for (const Index q : found->second)
              f(static_cast<std::size_t>(q));
        }
  }

 private:
  using Place = std::array<std::int64_t, 3>;
  Place place(const Vec3& x) const
  {
    const Vec3 scaled = (x - low_) / width_;
    return {static_cast<std::int64_t>(scaled[0]) + 1, static_cast<std::int64_t>(scaled[1]) + 1, static_cast<std::int64_t>(scaled[2]) + 1};
  }
  static std::int64_t key(const Place& p) { return p[0] | (p[1] << 21) | (p[2] << 42); }  // two million cubes along each axis

  Vec3 low_;
  Real width_;
  std::unordered_map<std::int64_t, std::vector<Index>> cubes_;
};

}  // namespace

std::optional<Bounds> bounds_of(const std::vector<Vec3>& x)
{
  if (x.empty())
    return std::nullopt;
  Bounds bounds{x.front(), x.front()};
  for (const Vec3& point : x) {
    bounds.low = bounds.low.cwiseMin(point);
    bounds.high = bounds.high.cwiseMax(point);
  }
  return bounds;
}

std::vector<Real> facing(const Cloud& cloud, const Vec3& light, Real reach)
{
  const auto bounds = bounds_of(cloud.x);
  if (!bounds)
    return {};
  const Cubes cubes(cloud.x, bounds->low, reach);
  std::vector<Real> share(cloud.x.size());
  for (std::size_t p = 0; p < share.size(); ++p) {
    Vec3 pull = Vec3::Zero();
    Real weight = 0;
    cubes.for_neighbours(cloud.x[p], [&](std::size_t q) {
      const Vec3 to = cloud.x[q] - cloud.x[p];
      const Real w = std::max(0.0, 1 - to.squaredNorm() / (reach * reach));
      pull += w * to;
      weight += w;
    });
    const Real offset = pull.norm();
    if (offset > 0)
      share[p] = -pull.dot(light) / offset * std::min(1.0, offset / (weight * reach * surface_share));
  }
  return share;
}

}  // namespace talus::render
