#include "io/mesh/gmsh_regions.hpp"

#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "io/files/atomic_file.hpp"
#include "io/mesh/gmsh_session.hpp"

namespace talus {

namespace {

/// Adds one shape to the OpenCASCADE model and returns its entities of dimension D; messages name the region.
template <int D>
class ShapeMaker {
 public:
  explicit ShapeMaker(const RegionSpec& region) : region_(region) {}

  gmsh::vectorpair operator()(const Box& box) const
  {
    const Vec3 low = point(box.low, "low"), size = point(box.high, "high") - low;
    if (!(size.head<D>().array() > 0).all())
      refuse("low is not below high");
    if constexpr (D == 2)
      return one(gmsh::model::occ::addRectangle(low[0], low[1], 0, size[0], size[1]));
    else
      return one(gmsh::model::occ::addBox(low[0], low[1], low[2], size[0], size[1], size[2]));
  }

  gmsh::vectorpair operator()(const Sphere& sphere) const
  {
    const Vec3 centre = point(sphere.centre, "centre");
    if (!(sphere.radius > 0))
      refuse("the radius is not positive");
    if constexpr (D == 2)
      return one(gmsh::model::occ::addDisk(centre[0], centre[1], 0, sphere.radius, sphere.radius));
    else
      return turned(gmsh::model::occ::addSphere(centre[0], centre[1], centre[2], sphere.radius), centre, {1, 2, 3});
  }

  gmsh::vectorpair operator()(const Cylinder& cylinder) const
  {
    if constexpr (D == 2) {
      refuse("a cylinder needs a scene of dimension 3; in 2-D a sphere is a disk");
    } else {
      const Vec3 from = point(cylinder.from, "from"), axis = point(cylinder.to, "to") - from;
      if (!(axis.norm() > 0) || !(cylinder.radius > 0))
        refuse("a cylinder needs two different ends and a positive radius");
      return turned(gmsh::model::occ::addCylinder(from[0], from[1], from[2], axis[0], axis[1], axis[2], cylinder.radius), from, axis);
    }
  }

  gmsh::vectorpair operator()(const Polygon& polygon) const
  {
    const Real bottom = bottom_of(polygon);
    std::vector<int> loops{loop_of(polygon.points, bottom)};
    for (const auto& hole : polygon.holes)
      loops.push_back(loop_of(hole, bottom));
    const int face = gmsh::model::occ::addPlaneSurface(loops);
    if constexpr (D == 2)
      return one(face);
    gmsh::vectorpair swept;
    gmsh::model::occ::extrude({{2, face}}, 0, 0, polygon.extrude[1] - bottom, swept);
    std::erase_if(swept, [](const auto& entity) { return entity.first != 3; });
    return swept;
  }

  gmsh::vectorpair operator()(const Ring& ring) const
  {
    if (!(ring.inner_radius < ring.radius))
      refuse("inner_radius is not smaller than radius");
    return cut((*this)(Sphere{ring.centre, ring.radius}), (*this)(Sphere{ring.centre, ring.inner_radius}));
  }

  gmsh::vectorpair operator()(const Difference& difference) const
  {
    gmsh::vectorpair taken;
    for (const SimpleShape& part : difference.without) {
      const gmsh::vectorpair more = std::visit(*this, part);
      taken.insert(taken.end(), more.begin(), more.end());
    }
    return cut(std::visit(*this, difference.of), taken);
  }

  gmsh::vectorpair operator()(const Union& all) const
  {
    gmsh::vectorpair sum = std::visit(*this, all.of.front()), joined;
    std::vector<gmsh::vectorpair> unused;
    for (std::size_t i = 1; i < all.of.size(); ++i) {
      gmsh::model::occ::fuse(sum, std::visit(*this, all.of[i]), joined, unused);
      sum = std::exchange(joined, {});
    }
    return sum;
  }

  gmsh::vectorpair operator()(const Intersection& all) const
  {
    gmsh::vectorpair common = std::visit(*this, all.of.front()), left;
    std::vector<gmsh::vectorpair> unused;
    for (std::size_t i = 1; i < all.of.size(); ++i) {
      gmsh::model::occ::intersect(common, std::visit(*this, all.of[i]), left, unused);
      common = std::exchange(left, {});
      if (common.empty())
        refuse("the shapes have nothing in common");
    }
    return common;
  }

 private:
  gmsh::vectorpair cut(const gmsh::vectorpair& whole, const gmsh::vectorpair& taken) const
  {
    gmsh::vectorpair left;
    std::vector<gmsh::vectorpair> unused;
    gmsh::model::occ::cut(whole, taken, left, unused);
    if (left.empty())
      refuse("nothing is left of the shape without the others");
    return left;
  }

  int loop_of(const std::vector<std::vector<Real>>& ring, Real z) const
  {
    std::vector<int> points, lines;
    for (const Vec<2>& x : checked_corners(ring))
      points.push_back(gmsh::model::occ::addPoint(x[0], x[1], z));
    for (std::size_t i = 0; i < points.size(); ++i)
      lines.push_back(gmsh::model::occ::addLine(points[i], points[(i + 1) % points.size()]));
    return gmsh::model::occ::addCurveLoop(lines);
  }

  [[noreturn]] void refuse(const std::string& why) const
  {
    throw SceneErrors(region_.where, fmt::format("region \"{}\": {}", region_.name, why));
  }
  static gmsh::vectorpair one(int tag) { return {{D, tag}}; }

  /// A round solid, rotated about its axis so that its seam does not lie in the plane of a face of another region: gmsh 4.8 cannot mesh a
  /// seam that was cut away.
  static gmsh::vectorpair turned(int tag, const Vec3& centre, const Vec3& axis)
  {
    gmsh::model::occ::rotate({{3, tag}}, centre[0], centre[1], centre[2], axis[0], axis[1], axis[2], 0.7);
    return one(tag);
  }

  Vec3 point(const std::vector<Real>& numbers, std::string_view key) const
  {
    if (numbers.size() != D)
      refuse(fmt::format("{} has {} numbers; the scene has dimension {}", key, numbers.size(), D));
    Vec3 x = Vec3::Zero();
    x.head<D>() = Eigen::Map<const Vec<D>>(numbers.data());
    return x;
  }

  Real bottom_of(const Polygon& polygon) const
  {
    if (D == 2 && !polygon.extrude.empty())
      refuse("extrude is for scenes of dimension 3");
    if (D == 3 && (polygon.extrude.size() != 2 || !(polygon.extrude[0] < polygon.extrude[1])))
      refuse("a polygon needs extrude: [z from, z to] in a scene of dimension 3");
    return D == 2 ? 0 : polygon.extrude[0];
  }

  /// The corners of a polygon; throws if it intersects itself, which OpenCASCADE does not detect.
  std::vector<Vec<2>> checked_corners(const std::vector<std::vector<Real>>& ring) const
  {
    std::vector<Vec<2>> corners;
    for (const auto& numbers : ring) {
      if (numbers.size() != 2)
        refuse("every point of a polygon has two numbers");
      corners.emplace_back(numbers[0], numbers[1]);
    }
    const std::size_t n = corners.size();
    if (n < 3)
      refuse("a polygon needs three points or more");
    const auto side = [&](std::size_t i, std::size_t p) {
      const Vec<2> a = corners[(i + 1) % n] - corners[i], b = corners[p] - corners[i];
      return a[0] * b[1] - a[1] * b[0];
    };
    const auto apart = [&](std::size_t i, std::size_t j) {  // collinear sides do not separate anything
      const Vec<2>&a = corners[i], &b = corners[(i + 1) % n], &p = corners[j], &q = corners[(j + 1) % n];
      return (a.cwiseMax(b).array() < p.cwiseMin(q).array()).any() || (p.cwiseMax(q).array() < a.cwiseMin(b).array()).any();
    };
    for (std::size_t i = 0; i < n; ++i) {
      if (corners[i] == corners[(i + 1) % n])
        refuse(fmt::format("the point ({}, {}) stands twice in a row", corners[i][0], corners[i][1]));
      for (std::size_t j = i + 2; j < n; ++j)
        if ((j + 1) % n != i && !apart(i, j) && side(i, j) * side(i, (j + 1) % n) <= 0 && side(j, i) * side(j, (i + 1) % n) <= 0)
          refuse(fmt::format("the polygon crosses itself: its sides {} and {} meet", i + 1, j + 1));
    }
    return corners;
  }

  const RegionSpec& region_;
};

/// Solids with the name of their cell group.
struct Named {
  std::string name;
  gmsh::vectorpair solids;
};

/// Cuts solids along each other so that they share faces, and makes physical groups of them.  Returns the name of a solid of which nothing
/// is left, or an empty text.
std::string share_faces(int dimension, const std::vector<Named>& parts)
{
  gmsh::vectorpair all, unused;
  std::vector<std::size_t> part_of;  // entry for each solid
  for (std::size_t p = 0; p < parts.size(); ++p) {
    all.insert(all.end(), parts[p].solids.begin(), parts[p].solids.end());
    part_of.resize(all.size(), p);
  }
  std::vector<gmsh::vectorpair> pieces;  // entry for each solid
  if (all.size() > 1)
    gmsh::model::occ::fragment({all.front()}, {all.begin() + 1, all.end()}, unused, pieces);
  else
    pieces = {all};
  gmsh::model::occ::synchronize();

  std::set<int> taken;
  std::vector<std::vector<int>> tags(parts.size());
  for (std::size_t i = 0; i < all.size(); ++i)
    for (const auto& [piece_dimension, tag] : pieces[i])
      if (piece_dimension == dimension && taken.insert(tag).second)  // a piece belongs to the first solid that contains it
        tags[part_of[i]].push_back(tag);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (tags[p].empty())
      return parts[p].name;
    gmsh::model::setPhysicalName(dimension, gmsh::model::addPhysicalGroup(dimension, tags[p]), parts[p].name);
  }
  return {};
}

/// The solids of an imported file by their names; "Shapes/Part/soil" is "soil".
std::vector<Named> imported_solids(int dimension)
{
  gmsh::vectorpair solids;
  gmsh::model::getEntities(solids, dimension);
  std::map<std::string, Named> by_name;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    std::string name;
    gmsh::model::getEntityName(solids[i].first, solids[i].second, name);
    name = name.substr(name.rfind('/') + 1);
    if (name.empty() || name.starts_with("Open CASCADE"))  // the default name of OpenCASCADE
      name = fmt::format("part_{}", i + 1);
    by_name[name].name = name;
    by_name[name].solids.push_back(solids[i]);
  }
  std::vector<Named> parts;
  for (const auto& [name, part] : by_name)
    parts.push_back(part);
  return parts;
}

}  // namespace

template <int D>
MeshData<D> mesh_geometry(const MeshSpec& spec, const std::filesystem::path& file)
{
  if (const auto why = not_ordinary(file))
    throw SceneErrors(spec.where, fmt::format("geometry \"{}\" {}", file.string(), *why));
  const std::string kind = file.extension().string();
  const std::set<std::string> imported{".step", ".stp", ".brep", ".iges", ".igs"};
  if (kind != ".geo" && !imported.contains(kind))
    throw SceneErrors(spec.where, fmt::format("geometry \"{}\" is neither .geo nor .step; meshes are given with file", file.string()));
  GmshSession session(spec.where);
  return session.run([&] {
    gmsh::open(file.string());
    session.check(fmt::format("opening \"{}\"", file.string()));
    if (imported.contains(kind)) {
      const std::vector<Named> parts = imported_solids(D);
      if (parts.empty())
        session.fail(fmt::format("\"{}\" holds no {}", file.string(), D == 3 ? "solids" : "surfaces"));
      share_faces(D, parts);
    }
    session.set_sizes<D>(spec, kind == ".geo");
    session.generate(D);
    return session.take<D>();
  });
}

template <int D>
MeshData<D> mesh_regions(const MeshSpec& spec)
{
  GmshSession session(spec.where);
  return session.run([&] {
    gmsh::model::add("regions");
    std::vector<Named> parts;
    for (const RegionSpec& region : spec.regions) {
      if (std::any_of(parts.begin(), parts.end(), [&](const Named& part) { return part.name == region.name; }))
        throw SceneErrors(region.where, fmt::format("two regions have the name \"{}\"", region.name));
      parts.push_back({region.name, std::visit(ShapeMaker<D>(region), region.shape)});
    }
    const std::string hidden = share_faces(D, parts);
    session.check("cutting the regions along each other");
    for (const RegionSpec& region : spec.regions)
      if (region.name == hidden)
        throw SceneErrors(region.where, fmt::format("nothing is left of region \"{}\": earlier regions cover it", hidden));
    session.set_sizes<D>(spec, false);
    session.generate(D);
    return session.take<D>();
  });
}

MeshData<2> mesh_plan(const std::vector<Polygon>& polygons, const std::function<Real(const Vec<2>&)>& size, Real largest,
                      const SourceLocation& where)
{
  GmshSession session(where);
  return session.run([&] {
    gmsh::model::add("plan");
    std::vector<Named> parts;
    for (const Polygon& polygon : polygons) {
      const RegionSpec region{fmt::format("polygon {}", parts.size() + 1), polygon, where};
      parts.push_back({region.name, ShapeMaker<2>(region)(polygon)});
    }
    share_faces(2, parts);
    session.check("cutting polygons along each other");
    session.set_sizes([&size](Real x, Real y) { return size(Vec<2>(x, y)); }, largest);
    session.generate(2);
    return session.take<2>();
  });
}

template MeshData<2> mesh_geometry<2>(const MeshSpec&, const std::filesystem::path&);
template MeshData<3> mesh_geometry<3>(const MeshSpec&, const std::filesystem::path&);
template MeshData<2> mesh_regions<2>(const MeshSpec&);
template MeshData<3> mesh_regions<3>(const MeshSpec&);

}  // namespace talus
