#pragma once
// Meshes to try kernels on, points to try them at, and the weights of one point by node number.
#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>

#include "kernels/kernels.hpp"
#include "mesh/generate/generate.hpp"
#include "mesh/quadrature.hpp"

namespace talus::test {

template <int D>
struct Named {
  std::string name;
  Mesh<D> mesh;
};

template <int D>
MeshData<D> unit_box(Index n)
{
  Vec<D> high = Vec<D>::Ones();
  std::array<Index, D> cells;
  cells.fill(n);
  return box<D>(Vec<D>::Zero(), high, cells);
}

inline constexpr Real sliver_angle = 0.02;  // about one degree

/// Regular, jittered by 20 % of the shortest edge, graded 10:1 and jittered, with slivers.
template <int D>
const std::vector<Named<D>>& meshes()
{
  constexpr Index n = D == 2 ? 12 : 5;
  static const std::vector<Named<D>> all = [] {
    std::vector<Named<D>> made;
    made.push_back({"regular", Mesh<D>(unit_box<D>(n))});
    made.push_back({"jittered", Mesh<D>(jittered<D>(unit_box<D>(n), 0.2, 1))});
    made.push_back({"graded", Mesh<D>(graded<D>(jittered<D>(unit_box<D>(n), 0.1, 2), 10))});
    made.push_back({"slivers", Mesh<D>(slivered<D>(unit_box<D>(n), sliver_angle, 4, 3))});
    return made;
  }();
  return all;
}

template <int D>
const Mesh<D>& jittered_mesh()
{
  return meshes<D>()[1].mesh;
}

template <int D>
Vec<D> place(const Mesh<D>& mesh, Index c, const std::array<Real, D + 1>& barycentric)
{
  Vec<D> x = Vec<D>::Zero();
  for (std::size_t a = 0; a <= D; ++a)
    x += barycentric[a] * mesh.node(mesh.cell(c)[a]);
  return x;
}

/// Vertices, middles of edges, centroids of facets (3-D), the centroid, and four random points, in barycentric coordinates.
template <int D>
std::vector<std::array<Real, D + 1>> trial_points(std::uint32_t seed)
{
  std::vector<std::array<Real, D + 1>> points;
  const auto middle_of = [&](auto holds) {
    std::array<Real, D + 1> b{};
    Real count = 0;
    for (std::size_t a = 0; a <= D; ++a)
      count += holds(a);
    for (std::size_t a = 0; a <= D; ++a)
      b[a] = holds(a) / count;
    points.push_back(b);
  };
  for (unsigned corners = 1; corners < (2U << D); ++corners)
    middle_of([&](std::size_t a) { return static_cast<Real>((corners >> a) & 1U); });
  std::mt19937 random(seed);
  std::exponential_distribution<Real> share;  // normalised exponentials are uniform on the simplex
  for (int i = 0; i < 4; ++i) {
    std::array<Real, D + 1> b{};
    Real total = 0;
    for (auto& x : b)
      total += x = share(random);
    for (auto& x : b)
      x /= total;
    points.push_back(b);
  }
  return points;
}

/// The weights of one point over the nodes that matter to it.  With a node part these are the rings of the cell's vertices, and the
/// weights are those of the linear shape functions carried on by the operators.
template <class K, int D>
class Probe {
 public:
  Probe(const K& kernel, const Mesh<D>& mesh) : kernel_(kernel), mesh_(mesh) {}
  void enter(Index c)
  {
    kernel_.open(mesh_, c, cell);
    nodes_.assign(cell.nodes.begin(), cell.nodes.end());
    if constexpr (HasNodeOperators<K, D>) {
      for (const Index n : mesh_.cell(c))
        nodes_.insert(nodes_.end(), mesh_.ring_of_node()[n].begin(), mesh_.ring_of_node()[n].end());
      std::sort(nodes_.begin(), nodes_.end());
      nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
    }
  }
  void evaluate(const Vec<D>& x)
  {
    Pack at[D];
    for (int d = 0; d < D; ++d)
      at[d] = broadcast(x[d]);
    kernel_.evaluate(cell, at, 1, factors_);
    factors_.spell_out(0, weights);
    values_.assign(nodes_.size(), 0);
    gradients_.assign(nodes_.size(), Vec<D>::Zero());
    for (int a = 0; a < cell.size; ++a)
      add(a);
  }
  int size() const { return static_cast<int>(nodes_.size()); }
  Real value(int i) const { return values_[static_cast<std::size_t>(i)]; }
  Vec<D> gradient(int i) const { return gradients_[static_cast<std::size_t>(i)]; }
  Vec<D> node(int i) const { return mesh_.node(number(i)); }
  Index number(int i) const { return nodes_[static_cast<std::size_t>(i)]; }

  typename K::Cell cell;
  NodeWeights<D, K::max_nodes> weights;  ///< what the kernel itself answers, over the stencil of the cell

 private:
  void add(int a)
  {
    const auto i = static_cast<std::size_t>(a);
    if constexpr (HasNodeOperators<K, D>) {
      add_row(cell.nodes[i], weights.w[a]);
    } else {
      values_[i] = weights.w[a];
      for (int d = 0; d < D; ++d)
        gradients_[i][d] = weights.dw[d][a];
    }
  }

  std::size_t entry(Index v) const { return static_cast<std::size_t>(std::lower_bound(nodes_.begin(), nodes_.end(), v) - nodes_.begin()); }
  /// The rows of n, times its linear shape function, in S and D.
  void add_row(Index n, Real shape_value)
  {
    kernel_.node_operators().for_each_in_row(n, [&](Index v, Real S, const Vec<D>& gradient) {
      values_[entry(v)] += shape_value * S;
      gradients_[entry(v)] += shape_value * gradient;
    });
  }

  Weights<D, K::max_nodes> factors_;
  std::vector<Index> nodes_;
  std::vector<Real> values_;
  std::vector<Vec<D>> gradients_;
  const K& kernel_;
  const Mesh<D>& mesh_;
};

template <int D>
struct ByNode {
  std::map<Index, Real> value;
  std::map<Index, Vec<D>> gradient;
};
template <class K, int D>
ByNode<D> by_node(const Probe<K, D>& probe)
{
  ByNode<D> all;
  for (int i = 0; i < probe.size(); ++i) {
    all.value[probe.number(i)] = probe.value(i);
    all.gradient[probe.number(i)] = probe.gradient(i);
  }
  return all;
}

}  // namespace talus::test
