// Value stencils of node operators: weights of maximum entropy.
#include "kernels/value_stencils.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/node_operators.hpp"

namespace talus {
namespace {

/// The positions of the ring about node n in units of the node's size, and the beginning of its row.
template <int D>
struct RingOf {
  RingOf(const Mesh<D>& mesh, Index n)
      : nodes(mesh.ring_of_node()[n]), first(static_cast<std::size_t>(mesh.ring_of_node().begin[static_cast<std::size_t>(n)]))
  {
    for (const Index v : nodes)
      r.push_back((mesh.node(v) - mesh.node(n)) / mesh.node_size(n));
  }
  std::span<const Index> nodes;
  std::size_t first;
  std::vector<Vec<D>> r;
};

/// The directions along the boundary facets of a node: all if there are none, one along an edge, none in a corner.  Normals count as equal
/// where they differ by less than 30 degrees, as for walls.
template <int D>
Eigen::Matrix<Real, D, Eigen::Dynamic> directions_along(const Mesh<D>& mesh, const std::vector<Facet>& facets)
{
  if (facets.empty())
    return Mat<D>::Identity();
  Mat<D> spread = Mat<D>::Zero();
  for (const Facet facet : facets) {
    const Vec<D> normal = mesh.area_vector(facet);
    spread += normal * normal.transpose() / normal.norm();
  }
  const Real one_normal = 0.067;  // (1 - cos 30 degrees) / 2: second eigenvalue of two equal facets at 30 degrees
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<Real, D, D>> axes(spread / spread.trace());  // eigenvalues ascend
  Index count = 0;
  while (count < D && axes.eigenvalues()[count] <= one_normal)
    ++count;
  return axes.eigenvectors().leftCols(count);
}

/// Whether the row of n may contain v: any neighbour if n is an interior node, otherwise neighbours that lie on all walls of n, found by
/// common facets.
template <int D>
bool reaches(const Mesh<D>& mesh, const std::vector<Facet>& of_n, const std::vector<Facet>& of_v, Eigen::Index free)
{
  if (of_n.empty())
    return true;
  std::vector<Facet> shared;
  for (const Facet facet : of_n)
    if (std::any_of(of_v.begin(), of_v.end(), [&](const Facet& other) { return other.cell == facet.cell && other.local == facet.local; }))
      shared.push_back(facet);
  return !shared.empty() && directions_along(mesh, shared).cols() == free;
}

/// The weights a_v exp(lambda . y_v) / Z whose weighted sum of y is zero; empty if Newton's method does not find them.
std::vector<Real> of_largest_entropy(const std::vector<Real>& prior, const Eigen::MatrixXd& y)
{
  const auto d = y.rows();
  Eigen::VectorXd lambda = Eigen::VectorXd::Zero(d), mean(d);
  Eigen::VectorXd at(d), weighted(d);  // these and `product` exist once, so that the sums over the neighbours allocate nothing
  Eigen::MatrixXd second(d, d), product(d, d);
  std::vector<Real> weights(prior.size());
  for (int iteration = 0; iteration < 200; ++iteration) {
    Real total = 0;
    mean.setZero();
    second.setZero();
    for (std::size_t i = 0; i < prior.size(); ++i) {
      at = y.col(static_cast<Index>(i));
      const Real w = weights[i] = prior[i] * std::exp(lambda.dot(at));
      total += w;
      mean += w * at;
      weighted = w * at;
      product.noalias() = weighted * at.transpose();
      second += product;
    }
    mean /= total;
    for (Real& w : weights)
      w /= total;
    if (mean.norm() < 1e-15)  // positions are of order one
      return weights;
    Eigen::VectorXd step = (second / total - mean * mean.transpose()).ldlt().solve(-mean);
    if (!step.allFinite())
      return {};
    const Real longest = 1.5;  // the objective is convex, but not nearly quadratic where the neighbours of a node are one-sided
    if (step.norm() > longest)
      step *= longest / step.norm();
    else if (mean.norm() < 1e-13 && step.norm() < 1e-13)
      return weights;  // converged to round-off
    lambda += step;
  }
  return {};
}

}  // namespace

template <int D>
MaxentValues maxent_values(const Mesh<D>& mesh, Real alpha)
{
  std::vector<std::vector<Facet>> facets(static_cast<std::size_t>(mesh.n_nodes()));
  for (const Facet facet : mesh.boundary_facets())
    for (const Index v : mesh.nodes_of(facet))
      facets[static_cast<std::size_t>(v)].push_back(facet);
  // A side of a cut is a boundary too; its tips are neighbours along it, but have cells all around.
  std::vector<std::size_t> bounding(facets.size(), std::numeric_limits<std::size_t>::max());
  for (const Index v : mesh.cuts().tips)
    bounding[static_cast<std::size_t>(v)] = facets[static_cast<std::size_t>(v)].size();
  for (const Facet facet : mesh.cuts().facets)
    for (const Index v : mesh.nodes_of(facet))
      facets[static_cast<std::size_t>(v)].push_back(facet);

  MaxentValues values;
  values.S.assign(mesh.ring_of_node().item.size(), 0);
  std::vector<std::uint8_t> as_corner(static_cast<std::size_t>(mesh.n_nodes()), 0);
  parallel_for(mesh.n_nodes(), [&](Index n) {
    if (!mesh.is_whole(n))
      return;  // computed by another rank
    const RingOf<D> ring(mesh, n);
    std::vector<Facet> here = facets[static_cast<std::size_t>(n)];
    here.resize(std::min(here.size(), bounding[static_cast<std::size_t>(n)]));
    const auto along = directions_along(mesh, here);
    Eigen::MatrixXd y(along.cols(), static_cast<Index>(ring.r.size()));
    std::vector<Real> prior(ring.r.size());
    for (std::size_t i = 0; i < ring.r.size(); ++i) {
      const Index v = ring.nodes[i];
      y.col(static_cast<Index>(i)) = along.transpose() * ring.r[i];
      prior[i] = v == n ? 1 : reaches(mesh, here, facets[static_cast<std::size_t>(v)], along.cols()) ? alpha : 0;
    }
    const auto weights = of_largest_entropy(prior, y);
    const auto row = values.S.begin() + static_cast<std::ptrdiff_t>(ring.first);
    if (weights.empty()) {
      as_corner[static_cast<std::size_t>(n)] = 1;
      std::transform(ring.nodes.begin(), ring.nodes.end(), row, [n](Index v) { return v == n ? Real{1} : Real{0}; });
    } else {
      std::copy(weights.begin(), weights.end(), row);
    }
  });
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    if (as_corner[static_cast<std::size_t>(n)] != 0)
      values.as_corners.push_back(n);
  return values;
}

template MaxentValues maxent_values<2>(const Mesh<2>&, Real);
template MaxentValues maxent_values<3>(const Mesh<3>&, Real);

}  // namespace talus
