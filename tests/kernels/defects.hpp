#pragma once
// How far a kernel is from each property of kernels/kernel.hpp `Claims`, on one mesh; zero up to round-off where the property holds.
#include <algorithm>

#include "tests/kernels/probe.hpp"

namespace talus::test {

/// f(probe, c, x) at the trial points of every cell, weights evaluated.
template <class K, int D, class F>
void for_each_trial(const K& kernel, const Mesh<D>& mesh, F&& f)
{
  Probe<K, D> probe(kernel, mesh);
  for (Index c = 0; c < mesh.n_cells(); ++c) {
    probe.enter(c);
    for (const auto& b : trial_points<D>(static_cast<std::uint32_t>(c))) {
      const Vec<D> x = place(mesh, c, b);
      probe.evaluate(x);
      f(probe, c, x);
    }
  }
}

/// Most negative value.
template <class K, int D>
Real negativity(const K& kernel, const Mesh<D>& mesh)
{
  Real worst = 0;
  for_each_trial(kernel, mesh, [&](const auto& probe, Index, const Vec<D>&) {
    for (int i = 0; i < probe.size(); ++i)
      worst = std::max(worst, -probe.value(i));
  });
  return worst;
}

/// |sum w_v x_v - x| / altitude of the cell
template <class K, int D>
Real linear_value_defect(const K& kernel, const Mesh<D>& mesh)
{
  Real worst = 0;
  for_each_trial(kernel, mesh, [&](const auto& probe, Index c, const Vec<D>& x) {
    Vec<D> off = Vec<D>::Zero();
    for (int i = 0; i < probe.size(); ++i)
      off += probe.value(i) * (probe.node(i) - x);
    worst = std::max(worst, off.norm() / mesh.altitude(c));
  });
  return worst;
}

/// |sum (x_v - x) (x) G_v - I|, relative to the sum of the sizes of its terms
template <class K, int D>
Real linear_gradient_defect(const K& kernel, const Mesh<D>& mesh)
{
  Real worst = 0;
  for_each_trial(kernel, mesh, [&](const auto& probe, Index, const Vec<D>& x) {
    Mat<D> off = -Mat<D>::Identity();
    Real size = 1;
    for (int i = 0; i < probe.size(); ++i) {
      const Vec<D> r = probe.node(i) - x, g = probe.gradient(i);
      off += r * g.transpose();
      size += r.norm() * g.norm();
    }
    worst = std::max(worst, off.norm() / size);
  });
  return worst;
}

/// Largest jump across interior facets: of the values, and of the gradients times the smaller altitude of the two cells.
struct Jumps {
  Real value = 0, gradient = 0;
};
template <class K, int D>
Jumps jumps(const K& kernel, const Mesh<D>& mesh)
{
  Jumps worst;
  Probe<K, D> here(kernel, mesh), there(kernel, mesh);
  for (Index c = 0; c < mesh.n_cells(); ++c) {
    here.enter(c);
    for (Index local = 0; local <= D; ++local) {
      const Index other = mesh.neighbours(c)[static_cast<std::size_t>(local)];
      if (other <= c)  // boundary, or seen from the other side
        continue;
      there.enter(other);
      const Real h = std::min(mesh.altitude(c), mesh.altitude(other));
      for (auto b : trial_points<D>(static_cast<std::uint32_t>(c))) {
        if (b[static_cast<std::size_t>(local)] >= 1)
          continue;
        const Real rest = 1 - b[static_cast<std::size_t>(local)];
        for (auto& share : b)
          share /= rest;
        b[static_cast<std::size_t>(local)] = 0;
        const Vec<D> x = place(mesh, c, b);
        here.evaluate(x);
        there.evaluate(x);
        auto one = by_node(here);
        for (const auto& [v, w] : by_node(there).value)
          one.value[v] -= w;
        for (const auto& [v, g] : by_node(there).gradient)
          one.gradient.try_emplace(v, Vec<D>::Zero()).first->second -= g;
        for (const auto& [v, jump] : one.value)
          worst.value = std::max(worst.value, std::abs(jump));
        for (const auto& [v, jump] : one.gradient)
          worst.gradient = std::max(worst.gradient, jump.norm() * h);
      }
    }
  }
  return worst;
}

/// |dw_v/dx - G_v| times the altitude of the cell, at the centroids, by central differences.
template <class K, int D>
Real slope_defect(const K& kernel, const Mesh<D>& mesh)
{
  Real worst = 0;
  Probe<K, D> probe(kernel, mesh), before(kernel, mesh), after(kernel, mesh);
  std::array<Real, D + 1> centre;
  centre.fill(1.0 / (D + 1));
  for (Index c = 0; c < mesh.n_cells(); ++c) {
    const Vec<D> x = place(mesh, c, centre);
    const Real h = mesh.altitude(c), step = 1e-5 * h;
    probe.enter(c);
    probe.evaluate(x);
    before.enter(c);
    after.enter(c);
    for (int d = 0; d < D; ++d) {
      before.evaluate(x - step * Vec<D>::Unit(d));
      after.evaluate(x + step * Vec<D>::Unit(d));
      for (int i = 0; i < probe.size(); ++i) {
        const Real slope = (after.value(i) - before.value(i)) / (2 * step);
        worst = std::max(worst, h * std::abs(slope - probe.gradient(i)[d]));
      }
    }
  }
  return worst;
}

/// |int G_v dx| h_v / int w_v dx for every interior node v that lies farther than `margin` [m] inside the bounding box: mean and
/// largest.  Quadrature with 54 (2-D) or 56 (3-D) points a cell.
struct PatchDefect {
  Real mean = 0, largest = 0;
};
template <class K, int D>
PatchDefect patch_defect(const K& kernel, const Mesh<D>& mesh, Real margin)
{
  const auto points = seeding_points<D>(D == 2 ? 54 : 56).value();
  std::vector<Vec<D>> force(static_cast<std::size_t>(mesh.n_nodes()), Vec<D>::Zero());
  std::vector<Real> share(force.size(), 0);
  Probe<K, D> probe(kernel, mesh);
  for (Index c = 0; c < mesh.n_cells(); ++c) {
    probe.enter(c);
    const Real volume = mesh.volume(c) / static_cast<Real>(points.size());
    for (const auto& b : points) {
      probe.evaluate(place(mesh, c, b));
      for (int i = 0; i < probe.size(); ++i) {
        force[static_cast<std::size_t>(probe.number(i))] += volume * probe.gradient(i);
        share[static_cast<std::size_t>(probe.number(i))] += volume * probe.value(i);
      }
    }
  }
  PatchDefect defect;
  Real interior = 0;
  for (Index v = 0; v < mesh.n_nodes(); ++v) {
    const Vec<D> from_low = mesh.node(v) - mesh.low(), from_high = mesh.high() - mesh.node(v);
    if (mesh.on_boundary(v) || std::min(from_low.minCoeff(), from_high.minCoeff()) < margin)
      continue;
    const auto i = static_cast<std::size_t>(v);
    const Real here = force[i].norm() * mesh.node_size(v) / share[i];
    defect.mean += here;
    defect.largest = std::max(defect.largest, here);
    ++interior;
  }
  defect.mean /= interior;
  return defect;
}

/// Largest weight, on a boundary facet, of a node that is not the facet's.
template <class K, int D>
Real wall_leak(const K& kernel, const Mesh<D>& mesh)
{
  Real worst = 0;
  Probe<K, D> probe(kernel, mesh);
  for (const Facet facet : mesh.boundary_facets()) {
    probe.enter(facet.cell);
    const auto own = mesh.nodes_of(facet);
    Vec<D> x = Vec<D>::Zero();
    for (const Index v : own)
      x += mesh.node(v) / D;
    probe.evaluate(x);
    for (int i = 0; i < probe.size(); ++i)
      if (std::find(own.begin(), own.end(), probe.number(i)) == own.end())
        worst = std::max(worst, std::abs(probe.value(i)));
  }
  return worst;
}

}  // namespace talus::test
