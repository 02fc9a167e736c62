#include "solver/loads/loads.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace talus {

template <int D>
ParticleTraction<D> carried_by_particles(const Mesh<D>& mesh, std::span<const Facet> facets, const Particles<D>& particles)
{
  std::map<Index, std::vector<Index>> in_cell;  // only cells behind the facets
  for (const Facet facet : facets)
    in_cell[facet.cell];
  for (Index p = 0; p < particles.size(); ++p)
    if (const auto found = in_cell.find(particles.cell[static_cast<std::size_t>(p)]); found != in_cell.end())
      found->second.push_back(p);

  std::map<std::int64_t, Vec<D>> subdomain;  // by id, so that a particle behind several facets has one entry
  for (const Facet facet : facets) {
    const auto& behind = in_cell[facet.cell];
    for (const Index p : behind) {
      auto& area = subdomain.try_emplace(particles.id[static_cast<std::size_t>(p)], Vec<D>::Zero()).first->second;
      area += mesh.area_vector(facet) / static_cast<Real>(behind.size());
    }
  }
  ParticleTraction<D> load;
  for (const auto& [id, area] : subdomain) {
    load.id.push_back(id);
    load.area.push_back(area);
  }
  return load;
}

template <int D>
MeshTraction<D> carried_by_mesh(const Mesh<D>& mesh, std::span<const Facet> facets)
{
  std::map<Index, std::pair<Vec<D>, Real>> subdomain;
  for (const Facet facet : facets) {
    const Vec<D> area = mesh.area_vector(facet);
    for (const Index n : mesh.nodes_of(facet)) {
      auto& [sum, measure] = subdomain.try_emplace(n, Vec<D>::Zero(), 0.0).first->second;
      sum += area / D;
      measure += area.norm() / D;
    }
  }
  MeshTraction<D> load;
  for (const auto& [node, both] : subdomain) {
    load.node.push_back(node);
    load.area.push_back(both.first);
    load.measure.push_back(both.second);
  }
  return load;
}

template <int D>
void restrict_to(const Subdomain& subdomain, MeshTraction<D>& load)
{
  std::size_t count = 0;
  for (std::size_t k = 0; k < load.node.size(); ++k)
    if (const Index node = subdomain.local_node(load.node[k]); node != none) {
      load.node[count] = node;
      load.area[count] = load.area[k];
      if (!load.height.empty())
        load.height[count] = load.height[k];
      load.measure[count++] = load.measure[k];
    }
  load.height.resize(load.height.empty() ? 0 : count);
  load.node.resize(count), load.area.resize(count), load.measure.resize(count);
}

namespace {

/// Force of a traction on particle i of a strip that carries the area [m^(D-1)].
template <int D>
Vec<D> force_of(const ParticleTraction<D>& load, const Vec<D>& area0, const Mat3& deformation) noexcept
{
  const Mat<D> F = deformation.template topLeftCorner<D, D>();
  const Vec<D> area = deformation.determinant() * F.inverse().transpose() * area0;
  return area0.norm() * load.traction - load.pressure * area;
}

}  // namespace

template <int D>
void find_forces(const Loads<D>& loads, Real time, Real ramp, const TrackedIds& carriers, const StripColumns<D>& columns, std::size_t n)
{
  const auto add = [&](std::size_t i, const Vec<D>& force) { columns.applied.set(i, columns.applied.of(i) + force); };
  for (std::size_t i = 0; i < n; ++i) {
    columns.applied.set(i, Vec<D>::Zero());
    if (!carriers.place(columns.id[i]))
      continue;
    for (const auto& load : loads.on_particles)
      if (const auto found = std::lower_bound(load.id.begin(), load.id.end(), columns.id[i]);
          found != load.id.end() && *found == columns.id[i])
        add(i, ramp * load.table(time) * force_of(load, load.area[static_cast<std::size_t>(found - load.id.begin())], columns.F.of(i)));
  }
  for (const auto& load : loads.of_place) {
    const StripColumn<Vec<D>>& place = load.at_start ? columns.x0 : columns.x;
    constexpr std::size_t at_once = 64;
    std::array<Vec<D>, at_once> places, accelerations;
    for (std::size_t begin = 0; begin < n; begin += at_once) {
      const std::size_t count = std::min(at_once, n - begin);
      for (std::size_t i = 0; i < count; ++i)
        places[i] = place.of(begin + i);
      load.acceleration(std::span(places).first(count), time, std::span(accelerations).first(count));
      for (std::size_t i = 0; i < count; ++i)
        add(begin + i, ramp * columns.mass.of(begin + i) * accelerations[i]);
    }
  }
}

namespace {

/// Calls f(node, force) for every node of every mesh traction.
template <int D, class F>
void for_each_mesh_force(const Loads<D>& loads, Real time, Real ramp, F&& f)
{
  for (const auto& load : loads.on_mesh) {
    const Real factor = ramp * load.table(time);
    for (std::size_t k = 0; k < load.node.size(); ++k)
      f(static_cast<std::size_t>(load.node[k]),
        Vec<D>(factor * (load.measure[k] * load.traction - load.pressure_at(k, time) * load.area[k])));
  }
}

}  // namespace

template <int D>
void apply(const Loads<D>& loads, Real time, Real ramp, const Mesh<D>& mesh, const OwnNodes& own, std::span<NodeSum<D>> sum,
           ExactSums<ForceAndMoment<D>>& total)
{
  for_each_mesh_force(loads, time, ramp, [&](std::size_t node, const Vec<D>& force) {
    if (sum[node].mass <= 0)
      return;
    sum[node].force += force;
    if (own.has(static_cast<Index>(node)))
      total.add(ForceAndMoment<D>::at(mesh.node(static_cast<Index>(node)), force));
  });
}

template <int D>
void add_work(const Loads<D>& loads, Real time, Real ramp, const OwnNodes& own, const Nodes<D>& nodes, ExactSums<Real>& total)
{
  for_each_mesh_force(loads, time, ramp, [&](std::size_t node, const Vec<D>& force) {
    if (nodes.sum[node].mass > 0 && own.has(static_cast<Index>(node)))
      total.add(nodes.kick * force.dot(nodes.motion[node].v - 0.5 * nodes.motion[node].change));
  });
}

template ParticleTraction<2> carried_by_particles<2>(const Mesh<2>&, std::span<const Facet>, const Particles<2>&);
template MeshTraction<2> carried_by_mesh<2>(const Mesh<2>&, std::span<const Facet>);
template void restrict_to<2>(const Subdomain&, MeshTraction<2>&);
template void restrict_to<3>(const Subdomain&, MeshTraction<3>&);
template void find_forces<2>(const Loads<2>&, Real, Real, const TrackedIds&, const StripColumns<2>&, std::size_t);
template void apply<2>(const Loads<2>&, Real, Real, const Mesh<2>&, const OwnNodes&, std::span<NodeSum<2>>, ExactSums<ForceAndMoment<2>>&);
template void add_work<2>(const Loads<2>&, Real, Real, const OwnNodes&, const Nodes<2>&, ExactSums<Real>&);
template ParticleTraction<3> carried_by_particles<3>(const Mesh<3>&, std::span<const Facet>, const Particles<3>&);
template MeshTraction<3> carried_by_mesh<3>(const Mesh<3>&, std::span<const Facet>);
template void find_forces<3>(const Loads<3>&, Real, Real, const TrackedIds&, const StripColumns<3>&, std::size_t);
template void apply<3>(const Loads<3>&, Real, Real, const Mesh<3>&, const OwnNodes&, std::span<NodeSum<3>>, ExactSums<ForceAndMoment<3>>&);
template void add_work<3>(const Loads<3>&, Real, Real, const OwnNodes&, const Nodes<3>&, ExactSums<Real>&);

}  // namespace talus
