#include "io/mesh/gmsh_session.hpp"

#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/parallel/threads.hpp"
#include "io/mesh/cell_count.hpp"
#include "io/mesh/msh_assembler.hpp"

namespace talus {

namespace {
constexpr int delaunay = 1, hxt = 10;  // values of Mesh.Algorithm3D
}  // namespace

GmshSession::GmshSession(SourceLocation asked_by) : asked_by_(std::move(asked_by)), threads_(threads())
{
  try {
    gmsh::initialize(0, nullptr, false);  // without configuration files, which would change the mesh of a scene
    gmsh::option::setNumber("General.Terminal", 0);
    gmsh::logger::start();
    // An exception in the threads of the mesher would end the program: errors are collected, and checked after meshing.
    gmsh::option::setNumber("General.AbortOnError", 0);
    gmsh::option::setNumber("General.NumThreads", 1);
    gmsh::option::setNumber("Mesh.RandomSeed", 1);
    gmsh::option::setNumber("Mesh.Algorithm", 6);  // Frontal-Delaunay
    // HXT is several times faster, but in 4.8 it keeps its random state between meshes and orders volumes by their addresses, so no two
    // meshes are equal.
    gmsh::option::setNumber("Mesh.Algorithm3D", delaunay);
    gmsh::option::setString("Geometry.OCCTargetUnit", "M");
  } catch (const std::string& complaint) {
    throw EnvironmentError("gmsh does not start: " + complaint);
  }
}

GmshSession::~GmshSession()
{
  try {
    gmsh::finalize();
  } catch (...) {  // NOLINT(bugprone-empty-catch): nothing is left to be lost
  }
  set_threads(threads_);
}

std::vector<std::string> GmshSession::errors() const
{
  std::vector<std::string> lines;
  gmsh::logger::get(lines);
  std::erase_if(lines, [](const std::string& line) { return !line.starts_with("Error"); });
  return lines;
}

void GmshSession::fail(const std::string& complaint) const
{
  constexpr std::size_t enough = 5;
  std::string text = "gmsh cannot make this mesh: " + complaint;
  std::vector<std::string> lines = errors();
  lines.resize(std::min(lines.size(), enough));
  for (const std::string& line : lines)
    text += "\n  gmsh: " + line;
  throw SceneErrors(asked_by_, text);
}

void GmshSession::check(const std::string& doing) const
{
  if (!errors().empty())
    fail(doing + " failed");
}

template <int D>
void GmshSession::set_sizes(const MeshSpec& spec, bool points_count)
{
  if (!spec.size) {
    if (!spec.refine.empty() || !points_count)
      throw SceneErrors(spec.where, "the mesh needs a size");
    return;
  }
  Vec3 low, high;
  gmsh::model::getBoundingBox(-1, -1, low[0], low[1], low[2], high[0], high[1], high[2]);
  constexpr Real cells_of_cube = D == 2 ? 2.3 : 7;  // number of triangles in a square, or tetrahedra in a cube, of their edge length
  Real cells = cells_of_cube;
  for (int d = 0; d < D; ++d)
    cells *= (high[d] - low[d]) / *spec.size;
  check_cells<D>(cells, fmt::format("size {} m", *spec.size), spec);
  gmsh::option::setNumber("Mesh.MeshSizeMax", *spec.size);
  gmsh::option::setNumber("Mesh.MeshSizeFromPoints", points_count ? 1 : 0);
  gmsh::option::setNumber("Mesh.MeshSizeExtendFromBoundary", points_count ? 1 : 0);
  std::vector<double> fields;
  for (const auto& [within, size] : spec.refine) {
    const auto n = static_cast<std::size_t>(D);
    if (within.low.size() != n || within.high.size() != n)
      throw SceneErrors(spec.where, fmt::format("a box of refine needs {} numbers for low and for high", n));
    Real finer = cells_of_cube;
    for (int d = 0; d < D; ++d)
      finer *= std::max(Real{0}, std::min(high[d], within.high[d]) - std::max(low[d], within.low[d])) / size;
    check_cells<D>(finer, fmt::format("size {} m in a box of refine", size), spec);
    const int field = gmsh::model::mesh::field::add("Box");
    const auto set = [&](const std::string& option, Real value) { gmsh::model::mesh::field::setNumber(field, option, value); };
    constexpr Real all_of = 1e22;
    for (std::size_t d = 0; d < 3; ++d) {
      const char axis = "XYZ"[d];
      set(fmt::format("{}Min", axis), d < n ? within.low[d] : -all_of);
      set(fmt::format("{}Max", axis), d < n ? within.high[d] : all_of);
    }
    set("VIn", size);
    set("VOut", std::max(size, *spec.size));
    set("Thickness", 3 * std::max(0.0, *spec.size - size));  // neighbouring edges differ by at most a third
    fields.push_back(field);
  }
  if (fields.empty())
    return;
  const int smallest = gmsh::model::mesh::field::add("Min");
  gmsh::model::mesh::field::setNumbers(smallest, "FieldsList", fields);
  gmsh::model::mesh::field::setAsBackgroundMesh(smallest);
}

template void GmshSession::set_sizes<2>(const MeshSpec&, bool);
template void GmshSession::set_sizes<3>(const MeshSpec&, bool);

void GmshSession::set_sizes(const std::function<Real(Real x, Real y)>& size, Real largest)
{
  gmsh::option::setNumber("Mesh.MeshSizeMax", largest);
  gmsh::option::setNumber("Mesh.MeshSizeFromPoints", 0);
  gmsh::option::setNumber("Mesh.MeshSizeExtendFromBoundary", 0);
  gmsh::model::mesh::setSizeCallback([size](int, int, double x, double y, double) { return size(x, y); });
}

void GmshSession::generate(int dimension)
{
  const auto generated = [&] {
    const std::size_t before = errors().size();
    gmsh::model::mesh::generate(dimension);
    return errors().size() == before;
  };
  if (generated())
    return;
  if (dimension == 3) {
    gmsh::model::mesh::clear();
    gmsh::option::setNumber("Mesh.Algorithm3D", hxt);
    if (generated())
      return;
  }
  fail("meshing failed");
}

template <int D>
MeshData<D> GmshSession::take()
{
  MshAssembler<D> assembler;
  std::vector<std::size_t> node_tags;
  std::vector<double> coordinates, parameters;
  gmsh::model::mesh::getNodes(node_tags, coordinates, parameters);
  for (std::size_t n = 0; n < node_tags.size(); ++n)
    assembler.add_node(static_cast<std::int64_t>(node_tags[n]), Eigen::Map<const Vec3>(&coordinates[3 * n]));
  assembler.close_nodes();

  std::map<std::pair<int, int>, std::vector<std::int64_t>> groups_of;
  bool groups_choose_cells = false;
  gmsh::vectorpair groups;
  gmsh::model::getPhysicalGroups(groups);
  for (const auto& [dimension, group] : groups) {
    std::string name;
    gmsh::model::getPhysicalName(dimension, group, name);
    assembler.name_group(dimension, group, name);
    groups_choose_cells = groups_choose_cells || dimension == D;
    std::vector<int> entities;
    gmsh::model::getEntitiesForPhysicalGroup(dimension, group, entities);
    for (const int entity : entities)
      groups_of[{dimension, std::abs(entity)}].push_back(group);
  }

  gmsh::vectorpair entities;
  gmsh::model::getEntities(entities);
  for (const auto& entity : entities) {
    const auto found = groups_of.find(entity);
    if (found == groups_of.end() && (entity.first != D || groups_choose_cells))
      continue;
    const std::span<const std::int64_t> in_groups = found == groups_of.end() ? std::span<const std::int64_t>{} : found->second;
    std::vector<int> types;
    std::vector<std::vector<std::size_t>> tags, nodes;
    gmsh::model::mesh::getElements(types, tags, nodes, entity.first, entity.second);
    for (std::size_t t = 0; t < types.size(); ++t) {
      const int dimension = dimension_of_element(types[t], 3);
      if (dimension > D)
        continue;
      const auto per_element = static_cast<std::size_t>(dimension) + 1;
      for (std::size_t e = 0; e < tags[t].size(); ++e) {
        std::array<std::int64_t, 4> corners{};
        for (std::size_t a = 0; a < per_element; ++a)
          corners[a] = static_cast<std::int64_t>(nodes[t][e * per_element + a]);
        assembler.add_element(static_cast<std::int64_t>(tags[t][e]), dimension, in_groups, corners);
      }
    }
  }
  return assembler.finish(false);
}

template MeshData<2> GmshSession::take<2>();
template MeshData<3> GmshSession::take<3>();

}  // namespace talus
