#include "app/setup/rigid_of_scene.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <set>

#include "io/terrain/stl_file.hpp"
#include "solver/rigid/rigid_contacts.hpp"

namespace talus {

namespace {

/// Sides of the polygon that stands for the circle of a cylinder; its area is 2e-4 smaller.
constexpr int sides_of_circle = 96;

/// A surface in the places of the scene, as corners and facets whose fronts are outside.
template <int D>
struct Facets {
  std::vector<Vec<D>> corners;
  std::vector<std::array<Index, D>> facets;
};

/// The prism over a counterclockwise convex polygon, or the polygon itself in 2-D; lift(corner, 0 or 1) places its corners.
template <int D, class Lift>
Facets<D> prism(std::size_t n, Lift&& lift)
{
  Facets<D> all;
  const auto count = static_cast<Index>(n);
  for (std::size_t end = 0; end < (D == 2 ? 1 : 2); ++end)
    for (std::size_t i = 0; i < n; ++i)
      all.corners.push_back(lift(i, end));
  for (Index i = 0; i < count; ++i) {
    const Index next = (i + 1) % count;
    if constexpr (D == 2) {
      all.facets.push_back({i, next});
    } else {
      all.facets.push_back({i, next, count + next});
      all.facets.push_back({i, count + next, count + i});
      if (i > 0 && next > 0) {
        all.facets.push_back({0, next, i});
        all.facets.push_back({count, count + i, count + next});
      }
    }
  }
  return all;
}

template <int D>
Facets<D> facets_of(const Box& box)
{
  constexpr std::array<std::array<std::size_t, 2>, 4> around{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  const std::array<const std::vector<Real>*, 2> corner{&box.low, &box.high};
  return prism<D>(4, [&](std::size_t i, std::size_t end) {
    Vec<D> x;
    x[0] = (*corner[around[i][0]])[0], x[1] = (*corner[around[i][1]])[1];
    if constexpr (D == 3)
      x[2] = (*corner[end])[2];
    return x;
  });
}

Facets<3> facets_of(const Cylinder& cylinder)
{
  const Vec3 from(cylinder.from.data()), to(cylinder.to.data());
  const Eigen::Matrix<Real, 3, 1> axis = (to - from).normalized();
  const Eigen::Matrix<Real, 3, 1> first = axis.unitOrthogonal(), second = axis.cross(first);
  return prism<3>(sides_of_circle, [&](std::size_t i, std::size_t end) {
    const Real angle = 2 * std::numbers::pi * static_cast<Real>(i) / sides_of_circle;
    return Vec3((end == 0 ? from : to) + cylinder.radius * (std::cos(angle) * first + std::sin(angle) * second));
  });
}

template <int D>
Facets<D> facets_of(const Polygon& polygon)
{
  std::vector<std::vector<Real>> points = polygon.points;
  Real area = 0;
  const auto turn = [&](std::size_t i) {
    const auto &a = points[i], &b = points[(i + 1) % points.size()], &c = points[(i + 2) % points.size()];
    return (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]);
  };
  for (std::size_t i = 0; i < points.size(); ++i)
    area += points[i][0] * points[(i + 1) % points.size()][1] - points[i][1] * points[(i + 1) % points.size()][0];
  if (area < 0)
    std::ranges::reverse(points);
  for (std::size_t i = 0; D == 3 && i < points.size(); ++i)
    if (turn(i) < 0)
      throw std::invalid_argument("a rigid polygon in 3 dimensions has to be convex; take a file for other solids");
  return prism<D>(points.size(), [&](std::size_t i, std::size_t end) {
    Vec<D> x;
    x[0] = points[i][0], x[1] = points[i][1];
    if constexpr (D == 3)
      x[2] = polygon.extrude[end];
    return x;
  });
}

/// The line through points, whose front lies to the right of the way along it; or the flat convex polygon of these corners, which turn
/// counterclockwise for who sees its front.
template <int D>
Facets<D> facets_of_sheet(const std::vector<std::vector<Real>>& points)
{
  Facets<D> all;
  for (const std::vector<Real>& point : points)
    all.corners.push_back(vector_of<D>(point));
  const auto n = static_cast<Index>(all.corners.size());
  if constexpr (D == 2) {
    for (Index i = 0; i + 1 < n; ++i)
      all.facets.push_back({i, i + 1});
  } else {
    const auto area = [&](Index i, Index j, Index k) {
      const std::array<Vec3, 3> at{all.corners[to_size(i)], all.corners[to_size(j)], all.corners[to_size(k)]};
      return area_of<3>(at.data());
    };
    Vec3 total = Vec3::Zero();
    for (Index i = 1; i + 1 < n; ++i) {
      all.facets.push_back({0, i, i + 1});
      total += area(0, i, i + 1);
    }
    const Real size = total.norm();
    Real longest = 0;  // squared
    for (const Vec3& corner : all.corners)
      longest = std::max(longest, (corner - all.corners[0]).squaredNorm());
    constexpr Real thin = 1e-9;
    if (!(size > thin * longest))
      throw std::invalid_argument("the corners of a sheet lie on a line: it has no area");
    constexpr Real flat = 1e-6;
    for (Index i = 0; i < n; ++i) {
      const Vec3 turn = area(i, (i + 1) % n, (i + 2) % n);
      if (!(turn.dot(total) >= 0) || std::abs((all.corners[to_size(i)] - all.corners[0]).dot(total)) > flat * size * std::sqrt(size))
        throw std::invalid_argument("the corners of a sheet have to be those of a flat convex polygon; take a file for others");
    }
  }
  return all;
}

/// Throws SceneErrors of the file, std::invalid_argument for a shape that cannot be.
template <int D>
Facets<D> facets_of(const Scene& scene, const RigidSpec& spec)
{
  if (spec.shape)
    return std::visit(
        [](const auto& shape) -> Facets<D> {
          if constexpr (requires { facets_of<D>(shape); })
            return facets_of<D>(shape);
          else if constexpr (D == 3 && std::is_same_v<std::decay_t<decltype(shape)>, Cylinder>)
            return facets_of(shape);
          else
            throw std::invalid_argument("is no shape of a rigid body");
        },
        *spec.shape);
  if (!spec.sheet.empty())
    return facets_of_sheet<D>(spec.sheet);
  if constexpr (D == 3) {
    const TriangleSheet sheet = read_stl((folder_of(scene) / (spec.file.empty() ? spec.sheet_file : spec.file)).lexically_normal());
    const Vec3 at = vector_of<3>(spec.at);
    Facets<3> all;
    for (const auto& corner : sheet.corners)
      all.corners.push_back(at + Vec3(corner.data()));
    all.facets = sheet.triangles;
    if (all.facets.empty())
      throw std::invalid_argument("has no triangles");
    return all;
  }
  return {};
}

Vec3 spin_of(const std::vector<Real>& numbers, int dimension)
{
  if (numbers.empty())
    return Vec3::Zero();
  return dimension == 2 ? Vec3(0, 0, numbers[0]) : Vec3(numbers.data());
}

template <int D>
class RigidBuilder {
 public:
  RigidBuilder(const Scene& scene, SceneErrorCollector& errors, Setup<D>& setup) : scene_(scene), errors_(errors), setup_(setup) {}

  void add(const RigidSpec& spec)
  {
    const std::string_view key = spec.key_of_shape();
    EnclosedSolid<D> solid;
    RigidBody<D> body{.name = spec.name, .shape = {}, .mass = 0, .friction = spec.friction, .motion = {}};
    try {
      body.shape = shape_of(spec, solid);
    } catch (const std::invalid_argument& e) {
      return errors_.add(spec.where, key, e.what());
    } catch (const SceneErrors& e) {
      return errors_.add(spec.where, key, e);
    } catch (const EnvironmentError& e) {  // there is no such file
      return errors_.add(spec.where, key, e.what());
    }
    body.mass = spec.mass.value_or(spec.density.value_or(0) * solid.volume);
    body.inertia = body.mass / solid.volume * solid.inertia;
    if (!spec.inertia.empty())
      body.inertia = D == 2 ? Mat3(spec.inertia[0] * Mat3::Identity()) : Mat3(Vec3(spec.inertia.data()).asDiagonal());
    RigidState<D> state;
    state.x = solid.centre, state.v = vector_of<D>(spec.velocity), state.spin = spin_of(spec.angular_velocity, D);
    if (spec.motion == RigidMotionKind::given)
      body.motion = RigidMotion<D>{state.v, state.spin, spec.table};
    setup_.notes.push_back(fmt::format("rigid body \"{}\": {}{}, friction {:.6g}", body.name,
                                       body.is_free() ? fmt::format("{:.6g} kg, free", body.mass) : std::string("with given motion"),
                                       body.shape->is_ball() ? ""
                                                             : fmt::format(", {}{} facets", body.shape->is_sheet() ? "a sheet of " : "",
                                                                           body.shape->facets()->facets().size()),
                                       body.friction));
    setup_.conditions.rigid.bodies.push_back(std::move(body));
    setup_.state.rigid.push_back(state);
  }

 private:
  std::shared_ptr<const RigidShape<D>> shape_of(const RigidSpec& spec, EnclosedSolid<D>& solid)
  {
    if (const Sphere* ball = spec.shape ? std::get_if<Sphere>(&*spec.shape) : nullptr) {
      const Real r = ball->radius;
      solid.centre = vector_of<D>(ball->centre);
      solid.volume = D == 2 ? std::numbers::pi * r * r : 4 * std::numbers::pi / 3 * r * r * r;
      solid.inertia = (D == 2 ? 0.5 : 0.4) * solid.volume * r * r * Mat3::Identity();
      return std::make_shared<const RigidShape<D>>(r);
    }
    Facets<D> facets = facets_of<D>(scene_, spec);
    const FacetSurface<D> in_scene(facets.corners, facets.facets);
    if (const std::string fault = spec.is_sheet() ? in_scene.fault_of_sheet() : in_scene.fault(); !fault.empty())
      throw std::invalid_argument("the surface " + fault);
    solid = spec.is_sheet() ? in_scene.sheet() : in_scene.solid();
    if (!(solid.volume > 0))
      throw std::invalid_argument("the surface has no area");
    for (Vec<D>& corner : facets.corners)
      corner -= solid.centre;
    return std::make_shared<const RigidShape<D>>(FacetSurface<D>(std::move(facets.corners), std::move(facets.facets)),
                                                 spec.is_sheet() ? FacetsOf::sheet : FacetsOf::solid);
  }

  const Scene& scene_;
  SceneErrorCollector& errors_;
  Setup<D>& setup_;
};

/// The boundary facets of groups with conditions, each group once.
template <int D>
std::vector<RigidWall<D>> walls_of(const Scene& scene, const Mesh<D>& mesh)
{
  std::vector<RigidWall<D>> walls;
  std::set<std::string> known;
  for (const BoundaryOptions& boundary : scene.boundaries) {
    const std::string& group = common_of(boundary).on;
    const auto facets = mesh.facet_set(group);
    if (!facets || !known.insert(group).second)
      continue;
    Facets<D> wall;
    for (const Facet facet : *facets) {
      if (mesh.neighbours(facet.cell)[static_cast<std::size_t>(facet.local)] != none)
        continue;
      std::array<Index, D> corners;
      for (std::size_t k = 0; k < D; ++k) {
        corners[k] = static_cast<Index>(wall.corners.size());
        wall.corners.push_back(mesh.node(mesh.nodes_of(facet)[k]));
      }
      if (area_of<D>(wall.corners.data() + corners[0]).dot(mesh.area_vector(facet)) > 0)
        std::swap(corners[0], corners[1]);
      wall.facets.push_back(corners);
    }
    if (!wall.facets.empty())
      walls.push_back({group, FacetSurface<D>(std::move(wall.corners), std::move(wall.facets))});
  }
  return walls;
}

/// Of two rigid bodies, a sheet is felt by a solid at points of the sheet alone: what fits between these may pass through it.
template <int D>
void warn_of_small_solids(const Scene& scene, Setup<D>& setup)
{
  const std::vector<RigidBody<D>>& bodies = setup.conditions.rigid.bodies;
  for (const RigidBody<D>& sheet : bodies) {
    if (!sheet.shape->is_sheet())
      continue;
    const Real spacing = spacing_of_samples(sheet.shape->radius());
    for (std::size_t r = 0; r < bodies.size(); ++r) {
      const RigidShape<D>& shape = *bodies[r].shape;
      if (shape.is_ball() || shape.is_sheet() || (!bodies[r].is_free() && !sheet.is_free()))
        continue;
      if (const Real width = std::pow(shape.facets()->solid().volume, 1.0 / D); width < spacing)
        setup.warnings.push_back(fmt::format(
            "{}: \"{}\", {:.3g} m wide, may pass through the sheet \"{}\", which rigid bodies feel at points up to {:.3g} m apart: make "
            "the sheet of several smaller ones, or the body a sphere",
            to_string(scene.rigid[r].where), bodies[r].name, width, sheet.name, spacing));
    }
  }
}

/// Bodies that begin inside material or inside each other.
template <int D>
void check_rigid_places(const Scene& scene, Communicator& ranks, const Setup<D>& setup, SceneErrorCollector& errors)
{
  const RigidScene<D>& rigid = setup.conditions.rigid;
  const State<D>& state = setup.state;
  for (std::size_t r = 0; r < rigid.bodies.size(); ++r) {
    const SourceLocation& where = scene.rigid[r].where;
    for (const Body& body : state.bodies) {
      if (rigid.bodies[r].shape->is_sheet() || presence_of(body.name, scene.stages).from != 0)
        continue;
      std::int64_t inside = 0;
      for (Index row = body.begin; row < body.end; ++row) {
        const Vec<D>& x = state.particles.x[static_cast<std::size_t>(row)];
        const Real radius = rigid.bodies[r].shape->radius();
        inside += (x - state.rigid[r].x).squaredNorm() < radius * radius && state.rigid[r].distance(*rigid.bodies[r].shape, x).distance < 0
                      ? 1
                      : 0;
      }
      if (inside = ranks.sum(inside); inside > 0)
        errors.add(
            where, "name",
            fmt::format("{} particle{} of \"{}\" begin{} inside \"{}\": move one of them, or cut it out of the other by a shape of type "
                        "difference",
                        inside, inside == 1 ? "" : "s", body.name, inside == 1 ? "s" : "", rigid.bodies[r].name));
    }
  }
  constexpr Real seen = 1e-3;  // of the radius
  std::set<std::pair<Index, Index>> known;
  for (const RigidContact<D>& at : find_contacts<D>(rigid, state.rigid, 0)) {
    const auto first = static_cast<std::size_t>(at.first);
    if (at.gap > -seen * rigid.bodies[first].shape->radius() || !known.insert({at.first, at.second}).second)
      continue;
    if (at.second == none)
      errors.add(
          scene.rigid[first].where, "name",
          fmt::format("\"{}\" begins {:.3g} m inside a wall of the mesh: move it away from there", rigid.bodies[first].name, -at.gap));
    else
      errors.add(scene.rigid[static_cast<std::size_t>(at.second)].where, "name",
                 fmt::format("\"{}\" begins {:.3g} m inside \"{}\": move one of them",
                             rigid.bodies[static_cast<std::size_t>(at.second)].name, -at.gap, rigid.bodies[first].name));
  }
}

}  // namespace

template <int D>
void add_rigid_bodies(const Scene& scene, const Mesh<D>& mesh, Communicator& ranks, SceneErrorCollector& errors, Setup<D>& setup)
{
  if (scene.rigid.empty())
    return;
  RigidBuilder<D> builder(scene, errors, setup);
  for (const RigidSpec& spec : scene.rigid)
    builder.add(spec);
  if (setup.state.rigid.size() != scene.rigid.size())
    return;  // one of them is wrong
  setup.conditions.rigid.walls = walls_of(scene, mesh);
  check_rigid_places(scene, ranks, setup, errors);
  warn_of_small_solids(scene, setup);
}

template void add_rigid_bodies(const Scene&, const Mesh<2>&, Communicator&, SceneErrorCollector&, Setup<2>&);
template void add_rigid_bodies(const Scene&, const Mesh<3>&, Communicator&, SceneErrorCollector&, Setup<3>&);

}  // namespace talus
