// Unstructured moving least squares: tables, and the two sweeps over the stencil of one particle.
#include "kernels/umls.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "core/parallel.hpp"
#include "kernels/pack.hpp"

namespace talus {
namespace {

/// S gets this share of its trace on the diagonal: a guard against division by zero that costs linear fields no digit.
constexpr Real regularisation = 1e-14;
/// Raised radii, tried in this order.
constexpr Real radius_factors[] = {1.25, 1.5};

/// Entries of a symmetric D x D matrix: xx, yy, xy or xx, yy, zz, xy, yz, xz.
template <int D>
using Symmetric = std::array<Real, D*(D + 1) / 2>;
template <int D>
constexpr std::size_t entry(int d, int e)
{
  return static_cast<std::size_t>(d == e ? d : D == 2 ? 2 : d + e == 1 ? 3 : d + e == 3 ? 4 : 5);
}

/// det(A) A^-1
template <int D>
Symmetric<D> adjugate(const Symmetric<D>& s) noexcept
{
  if constexpr (D == 2) {
    return {s[1], s[0], -s[2]};
  } else {
    const auto [xx, yy, zz, xy, yz, xz] = s;
    return {yy * zz - yz * yz, xx * zz - xz * xz, xx * yy - xy * xy, xz * yz - xy * zz, xy * xz - xx * yz, xy * yz - xz * yy};
  }
}
template <int D>
Real determinant(const Symmetric<D>& s, const Symmetric<D>& adjugate_of_s) noexcept
{
  Real det = 0;
  for (int d = 0; d < D; ++d)
    det += s[entry<D>(0, d)] * adjugate_of_s[entry<D>(0, d)];
  return det;
}
template <int D>
Real trace(const Symmetric<D>& s) noexcept
{
  return D == 2 ? s[0] + s[1] : s[0] + s[1] + s[2];
}

/// Moments of the sample weights.
template <int D>
struct Moments {
  Real sum;                      ///< W0
  std::array<Real, D> first;     ///< W0 c, about the particle
  Symmetric<D> spread;           ///< W0 S, about the centroid of the weights
};

/// Barycentric coordinates of x, given r = x - origin.
template <int D>
std::array<Real, D + 1> hats(const typename Umls<D>::Cell& cell, const std::array<Real, D>& r) noexcept
{
  std::array<Real, D + 1> b;
  b[0] = 1;
  for (std::size_t a = 1; a <= D; ++a) {
    b[a] = 0;
    for (std::size_t d = 0; d < D; ++d)
      b[a] += cell.slope[a][d] * r[d];
    b[0] -= b[a];
  }
  return b;
}
template <int D>
std::array<Real, D> from_origin(const typename Umls<D>::Cell& cell, const Vec<D>& x) noexcept
{
  std::array<Real, D> r;
  for (int d = 0; d < D; ++d)
    r[static_cast<std::size_t>(d)] = x[d] - cell.origin[d];
  return r;
}

/// R^2 times the quadratic B-spline d(q), q = distance / R: 3/4 - q^2 up to 1/2, (3/2 - q)^2 / 2 up to 3/2, then 0; written with
/// truncated powers, without branch or division.  The common factor R^2 of all samples cancels in the estimate.
[[gnu::always_inline]] inline Pack profile(const Pack& distance, Real radius) noexcept
{
  const Pack outer = positive_part(1.5 * radius - distance), inner = positive_part(0.5 * radius - distance);
  return 0.5 * (outer * outer) - 1.5 * (inner * inner);
}

/// Sample weights R^2 W into `weight`, and their moments: the first sweep over the stencil.
template <int D>
[[gnu::always_inline]] inline Moments<D> sample(const typename Umls<D>::Cell& cell, const Vec<D>& x, Real* weight) noexcept
{
  const auto from = from_origin<D>(cell, x);
  const auto b = hats<D>(cell, from);
  Real radius = cell.radius;
  for (std::size_t d = 0; d < D; ++d)
    radius += cell.radius_slope[d] * from[d];

  constexpr std::size_t pairs = D * (D + 1) / 2;
  Pack w0{}, first[3]{}, second[6]{};
  for (int i = 0; i < cell.padded_size; i += pack_size) {
    Pack r[D], r2{}, eta{};
    for (int d = 0; d < D; ++d) {
      r[d] = load(cell.x[d] + i) - x[d];
      r2 += r[d] * r[d];
    }
    for (std::size_t a = 0; a <= D; ++a)
      eta += b[a] * load(cell.adjacent[a] + i);
    const Pack w = eta * profile(square_root(r2), radius);
    store(weight + i, w);
    w0 += w;
    for (int d = 0; d < D; ++d) {
      const Pack wr = w * r[d];
      first[d] += wr;
      for (int e = d; e < D; ++e)
        second[entry<D>(d, e)] += wr * r[e];
    }
  }
  const Pack low = sums(w0, first[0], first[1], first[2]);
  const Pack middle = sums(second[0], second[1], second[2], second[3]);
  const Pack high = sums(second[4], second[5], second[4], second[5]);

  Moments<D> m{.sum = low[0], .first = {}, .spread = {}};
  for (std::size_t d = 0; d < D; ++d)
    m.first[d] = low[d + 1];
  for (std::size_t k = 0; k < pairs; ++k)
    m.spread[k] = m.sum * (k < 4 ? middle[k] : high[k - 4]);
  for (int d = 0; d < D; ++d)
    for (int e = d; e < D; ++e)
      m.spread[entry<D>(d, e)] -= m.first[static_cast<std::size_t>(d)] * m.first[static_cast<std::size_t>(e)];
  return m;
}

/// (tr A / D)^D: what det A would be if A were round.
template <int D>
Real round_determinant(const Symmetric<D>& s) noexcept
{
  const Real mean = trace<D>(s) * (1.0 / D);
  return D == 2 ? mean * mean : mean * mean * mean;
}

}  // namespace

template <int D>
Umls<D>::Umls(const Mesh<D>& mesh)
{
  build_stencils(mesh);
  choose_radii(mesh);
}

template <int D>
void Umls<D>::build_stencils(const Mesh<D>& mesh)
{
  const auto n_nodes = static_cast<std::size_t>(mesh.n_nodes());
  std::vector<Index> seen_by(n_nodes, none);
  std::vector<std::size_t> entry(n_nodes);
  for (Index c = 0; c < mesh.n_cells(); ++c) {
    const auto add = [&](Index v, std::uint8_t vertices) {
      const auto i = static_cast<std::size_t>(v);
      if (seen_by[i] != c) {
        seen_by[i] = c;
        entry[i] = adjacency_.size();
        stencil_.item.push_back(v);
        adjacency_.push_back(0);
      }
      adjacency_[entry[i]] = static_cast<std::uint8_t>(adjacency_[entry[i]] | vertices);
    };
    for (const Index v : mesh.cell(c))
      add(v, 0);
    for (std::size_t a = 0; a <= D; ++a)
      for (const Index v : mesh.ring_of_node()[mesh.cell(c)[a]])
        add(v, static_cast<std::uint8_t>(1U << a));
    stencil_.begin.push_back(static_cast<Index>(stencil_.item.size()));
    if (const auto size = stencil_[c].size(); size > max_nodes) {
      Vec<D> at = Vec<D>::Zero();
      for (const Index v : mesh.cell(c))
        at += mesh.node(v) / (D + 1);
      std::string place;
      for (int d = 0; d < D; ++d)
        place += fmt::format("{}{:.6g}", d ? ", " : "", at[d]);
      throw std::invalid_argument(fmt::format("kernel umls: cell {} at ({}) sees {} nodes around its vertices; there is room for {}", c, place, size, max_nodes));
    }
  }
  stencil_.item.shrink_to_fit();
  adjacency_.shrink_to_fit();
}

template <int D>
void Umls<D>::choose_radii(const Mesh<D>& mesh)
{
  radius_.resize(static_cast<std::size_t>(mesh.n_nodes()));
  for (Index v = 0; v < mesh.n_nodes(); ++v)
    radius_[static_cast<std::size_t>(v)] = mesh.node_size(v);

  std::vector<std::uint8_t> suspect(static_cast<std::size_t>(mesh.n_cells()), 1);
  for (const Real factor : radius_factors) {
    parallel_for(mesh.n_cells(), [&](Index c) {
      auto& flag = suspect[static_cast<std::size_t>(c)];
      flag = flag && poor(mesh, c);
    });
    for (Index c = 0; c < mesh.n_cells(); ++c)
      if (suspect[static_cast<std::size_t>(c)])
        for (const Index v : mesh.cell(c))
          radius_[static_cast<std::size_t>(v)] = factor * mesh.node_size(v);
  }
}

/// S is tried at the vertices, at the middles of the edges and at the centroid.
template <int D>
bool Umls<D>::poor(const Mesh<D>& mesh, Index c) const noexcept
{
  Cell cell;
  open(mesh, c, cell);
  const auto round = [&](const Vec<D>& x) { return roundness(cell, x) >= poor_roundness; };
  const auto& vertices = mesh.cell(c);
  Vec<D> centroid = Vec<D>::Zero();
  for (std::size_t a = 0; a <= D; ++a) {
    centroid += mesh.node(vertices[a]) / (D + 1);
    for (std::size_t b = a; b <= D; ++b)
      if (!round(0.5 * (mesh.node(vertices[a]) + mesh.node(vertices[b]))))
        return true;
  }
  return !round(centroid);
}

template <int D>
void Umls<D>::open(const Mesh<D>& mesh, Index c, Cell& cell) const noexcept
{
  cell.cell = c;
  cell.nodes = stencil_[c];
  cell.size = static_cast<int>(cell.nodes.size());
  cell.padded_size = padded(cell.size);
  const std::uint8_t* adjacency = adjacency_.data() + stencil_.begin[static_cast<std::size_t>(c)];
  for (int i = 0; i < cell.padded_size; ++i) {
    const bool real = i < cell.size;
    const Vec<D>& x = mesh.node(cell.nodes[real ? static_cast<std::size_t>(i) : 0]);
    for (int d = 0; d < D; ++d)
      cell.x[d][i] = x[d];
    const unsigned mask = real ? adjacency[i] : 0;
    for (int a = 0; a <= D; ++a)
      cell.adjacent[a][i] = static_cast<Real>((mask >> a) & 1U);
  }
  cell.origin = mesh.node(cell.nodes[0]);
  const auto gradients = mesh.gradients(c);
  cell.radius = radius(cell.nodes[0]);
  Vec<D> slope = Vec<D>::Zero();
  for (std::size_t a = 0; a <= D; ++a) {
    slope += radius(cell.nodes[a]) * gradients[a];
    for (int d = 0; d < D; ++d)
      cell.slope[a][d] = gradients[a][d];
  }
  for (int d = 0; d < D; ++d)
    cell.radius_slope[d] = slope[d];
}

template <int D>
void Umls<D>::evaluate(const Cell& cell, const Vec<D>& x, Weights<D, max_nodes>& out) const noexcept
{
  Moments<D> m = sample<D>(cell, x, out.w);
  const Real share_of_trace = regularisation * trace<D>(m.spread);
  for (std::size_t d = 0; d < D; ++d)
    m.spread[d] += share_of_trace;
  const Symmetric<D> adjoint = adjugate<D>(m.spread);
  const Real det = determinant<D>(m.spread, adjoint);
  if (!(det > unusable_roundness * round_determinant<D>(m.spread))) {  // NaN too
    hats_instead(cell, x, out);
    return;
  }
  // With k = S^-1 c:  G_v = W_v (S^-1 r_v - k)  and  w_v = W_v (1/W0 + k . c - k . r_v)
  const Real per_det = 1 / det, share = 1 / m.sum;
  Real at_x = share;
  Symmetric<D> inverse;
  std::array<Real, D> k{};
  for (std::size_t j = 0; j < inverse.size(); ++j)
    inverse[j] = adjoint[j] * per_det * m.sum;
  for (int d = 0; d < D; ++d) {
    const auto i = static_cast<std::size_t>(d);
    for (int e = 0; e < D; ++e)
      k[i] += adjoint[entry<D>(d, e)] * m.first[static_cast<std::size_t>(e)];
    k[i] *= per_det;
    at_x += k[i] * m.first[i] * share;
  }
  for (int i = 0; i < cell.padded_size; i += pack_size) {
    Pack r[D], value = at_x - Pack{};
    for (int d = 0; d < D; ++d) {
      r[d] = load(cell.x[d] + i) - x[d];
      value -= k[static_cast<std::size_t>(d)] * r[d];
    }
    const Pack w = load(out.w + i);
    store(out.w + i, w * value);
    for (int d = 0; d < D; ++d) {
      Pack g = Pack{} - k[static_cast<std::size_t>(d)];
      for (int e = 0; e < D; ++e)
        g += inverse[entry<D>(d, e)] * r[e];
      store(out.dw[d] + i, w * g);
    }
  }
}

template <int D>
void Umls<D>::hats_instead(const Cell& cell, const Vec<D>& x, Weights<D, max_nodes>& out) noexcept
{
  for (int i = 0; i < cell.padded_size; ++i) {
    out.w[i] = 0;
    for (int d = 0; d < D; ++d)
      out.dw[d][i] = 0;
  }
  const auto b = hats<D>(cell, from_origin<D>(cell, x));
  for (std::size_t a = 0; a <= D; ++a) {
    out.w[a] = b[a];
    for (int d = 0; d < D; ++d)
      out.dw[d][a] = cell.slope[a][d];
  }
}

template <int D>
Real Umls<D>::roundness(const Cell& cell, const Vec<D>& x) const noexcept
{
  alignas(64) Real unused[max_nodes];
  const Symmetric<D> spread = sample<D>(cell, x, unused).spread;
  const Real round = determinant<D>(spread, adjugate<D>(spread)) / round_determinant<D>(spread);
  return round > 0 ? round : 0;
}

template class Umls<2>;
template class Umls<3>;

}  // namespace talus
