#include "app/commands/report/report_rigid.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "core/error.hpp"
#include "io/output/vtk.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_triangles = 200'000;  // of all bodies: a few megabytes of page

/// The numbers of the first corners of the bodies, and of one more after the last.
std::vector<Index> first_corners(const fs::path& file)
{
  const StoredMeshFields stored = read_mesh_fields(file);
  const auto body = std::ranges::find(stored.nodes, "rigid", &StoredField::name);
  if (body == stored.nodes.end() || body->components != 1)
    throw EnvironmentError(fmt::format("{} has no field \"rigid\"", file.string()));
  std::vector<Index> first;
  for (std::size_t n = 0; n < body->values.size(); ++n)
    if (n == 0 || body->values[n] != body->values[n - 1])
      first.push_back(static_cast<Index>(n));
  first.push_back(static_cast<Index>(body->values.size()));
  return first;
}

/// The quaternion w, x, y, z, w >= 0, of the rotation that brings the corners nearest to where they are now, both from their centres (Horn,
/// Journal of the Optical Society of America A 4 (1987) 629).
Eigen::Vector4d rotation_between(const RigidCorners& then, const RigidCorners& now)
{
  const Eigen::Matrix3d sums = then * now.transpose();
  Eigen::Matrix4d products;
  products(0, 0) = sums.trace();
  for (Index i = 0; i < 3; ++i) {
    const Index j = (i + 1) % 3, k = (i + 2) % 3;
    products(0, i + 1) = products(i + 1, 0) = sums(j, k) - sums(k, j);
    products(i + 1, i + 1) = sums(i, i) - sums(j, j) - sums(k, k);
    products(i + 1, j + 1) = products(j + 1, i + 1) = sums(i, j) + sums(j, i);
  }
  const Eigen::Vector4d quaternion = Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(products).eigenvectors().col(3);
  return quaternion[0] < 0 ? Eigen::Vector4d(-quaternion) : quaternion;
}

RigidCorners from(const Vec3& centre, const RigidCorners& corners) { return corners.colwise() - centre; }

}  // namespace

RigidFrames::RigidFrames(const fs::path& folder, std::span<const RigidSpec> bodies, Page& page)
{
  try {
    add_surfaces(folder, bodies, page);
  } catch (const EnvironmentError& e) {
    page.notes.push_back(fmt::format("rigid bodies are not shown: {}", e.what()));
  }
}

void RigidFrames::add_surfaces(const fs::path& folder, std::span<const RigidSpec> bodies, Page& page)
{
  if (!fs::exists(folder / "rigid.pvd"))
    return;
  files_ = read_pvd(folder / "rigid.pvd");
  if (files_.empty())
    return;
  const StoredMesh mesh = read_mesh(files_.front().second);
  const std::vector<Index> first = first_corners(files_.front().second);
  nodes_ = mesh.nodes.size();
  for (std::size_t b = 0; b < std::min(bodies.size(), first.size() - 1); ++b)
    add_surface(bodies[b].name, mesh, first[b], first[b + 1], page);
}

void RigidFrames::add_surface(std::string name, const StoredMesh& mesh, Index first, Index last, Page& page)
{
  std::vector<std::uint32_t> triangles;
  for (const Index corner : mesh.corners)
    if (corner >= first && corner < last)
      triangles.push_back(static_cast<std::uint32_t>(corner - first));
  if (triangles_ + triangles.size() / 3 > most_triangles) {
    page.notes.push_back(fmt::format("rigid bodies: {} is not shown: with its {} triangles there would be more than {}", name,
                                     triangles.size() / 3, most_triangles));
    return;
  }
  triangles_ += triangles.size() / 3;
  const RigidCorners places =
      Eigen::Map<const RigidCorners>(mesh.nodes.data(), 3, static_cast<Index>(mesh.nodes.size() / 3)).middleCols(first, last - first);
  PageRigid shown{
      std::move(name), last - first, {places.rowwise().minCoeff(), places.rowwise().maxCoeff(), {}}, page.add(packed(triangles))};
  for (Index d = 0; d < page.dimension; ++d) {
    const std::vector<Real> values(places.row(d).begin(), places.row(d).end());
    shown.x.axes.push_back(page.add(packed(quantised(values, shown.x.low[d], shown.x.high[d]))));
  }
  const Vec3 centre = places.rowwise().mean();
  bodies_.push_back({first, from(centre, places), centre, 0.5 * (shown.x.low + shown.x.high) - centre});
  page.rigid.push_back(std::move(shown));
}

std::optional<BlockId> RigidFrames::add(Real time, Page& page) const
try {
  const auto file = std::ranges::find(files_, time, &std::pair<Real, fs::path>::first);
  if (!any() || file == files_.end())
    return std::nullopt;
  const StoredMesh mesh = read_mesh(file->second);
  if (mesh.nodes.size() != nodes_)
    return std::nullopt;
  const Eigen::Map<const RigidCorners> places(mesh.nodes.data(), 3, static_cast<Index>(nodes_ / 3));
  std::vector<float> motion;
  for (const Body& body : bodies_) {
    const RigidCorners now = places.middleCols(body.first, body.at_start.cols());
    const Vec3 centre = now.rowwise().mean();
    const Eigen::Vector4d q = rotation_between(body.at_start, from(centre, now));
    const Vec3 axis = q.tail<3>(), turned = body.middle + 2 * axis.cross(q[0] * body.middle + axis.cross(body.middle));
    const Vec3 moved = centre - body.centre + turned - body.middle;
    for (const Real number : {moved[0], moved[1], moved[2], q[1], q[2], q[3], q[0]})
      motion.push_back(static_cast<float>(number));
  }
  return page.add(packed(motion));
} catch (const EnvironmentError&) {
  return std::nullopt;
}

void note_frames_without_rigid(Page& page)
{
  if (page.rigid.empty() || !page.particles)
    return;
  const auto& frames = page.particles->frames;
  const auto missing = std::ranges::count_if(frames, [](const PageFrame& frame) { return !frame.rigid; });
  if (missing > 0)
    page.notes.push_back(fmt::format("rigid bodies: their files of {} of {} times are missing or damaged", missing, frames.size()));
}

}  // namespace talus
