// Unstructured moving least squares: tables, and the two sweeps over the stencil of one particle.
#include "kernels/umls.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "core/parallel.hpp"
#include "kernels/pack.hpp"
#include "kernels/symmetric.hpp"

namespace talus {
namespace {

/// S gets this share of its trace on the diagonal: a guard against division by zero that costs linear fields no digit.
constexpr Real regularisation = 1e-14;
/// Raised radii, tried in this order.
constexpr Real radius_factors[] = {1.25, 1.5};

/// bits_of[mask][a] = bit a of the mask, as a number.
constexpr auto bits_of = [] {
  std::array<std::array<Real, 4>, 16> bits{};
  for (unsigned mask = 0; mask < 16; ++mask)
    for (unsigned a = 0; a < 4; ++a)
      bits[mask][a] = (mask >> a) & 1U;
  return bits;
}();

/// Moments of the sample weights.
template <int D>
struct Moments {
  Real sum;             ///< W0
  Real first[D];        ///< W0 c, about the particle
  Symmetric<D> spread;  ///< W0^2 S, about the centroid of the weights
};

/// A particle in its cell.
template <int D>
struct Place {
  Real x[D], from_origin[D];
  Pack hat;  ///< barycentric coordinates, one vertex per lane
};
template <int D>
[[gnu::always_inline]] inline Place<D> place_of(const typename Umls<D>::Cell& cell, const Vec<D>& x) noexcept
{
  Place<D> at;
  at.hat = Pack{1, 0, 0, 0};
  for (int d = 0; d < D; ++d) {
    at.x[d] = x[d];
    at.from_origin[d] = x[d] - cell.origin[d];
    at.hat += at.from_origin[d] * load(cell.slope[d]);
  }
  return at;
}

/// 2 R^2 times the quadratic B-spline d(q), q = distance / R: 3/4 - q^2 up to 1/2, (3/2 - q)^2 / 2 up to 3/2, then 0; written with
/// truncated powers, without branch or division.  The common factor of all samples cancels in the estimate.
[[gnu::always_inline]] inline Pack profile(const Pack& distance, Real radius) noexcept
{
  const Real outer_end = 1.5 * radius, inner_end = 0.5 * radius;
  const Pack outer = outer_end - smaller(distance, outer_end), inner = inner_end - smaller(distance, inner_end);
  return outer * outer - 3 * inner * inner;
}

/// Sample weights 2 R^2 W.
template <int D>
[[gnu::always_inline]] inline void sample(const typename Umls<D>::Cell& cell, const Place<D>& at, Real* weight) noexcept
{
  Real radius = cell.radius;
  for (int d = 0; d < D; ++d)
    radius += cell.radius_slope[d] * at.from_origin[d];
  for (int i = 0; i < cell.padded_size; i += pack_size) {
    Pack r2{}, eta = at.hat[0] * load(cell.adjacent[0] + i);
    for (int d = 0; d < D; ++d) {
      const Pack r = load(cell.x[d] + i) - at.x[d];
      r2 = d == 0 ? r * r : r2 + r * r;
    }
    for (int a = 1; a <= D; ++a)
      eta += at.hat[a] * load(cell.adjacent[a] + i);
    store(weight + i, eta * profile(square_root(r2), radius));
  }
}

/// Their moments.  A loop of its own: in one with the square roots these sums would queue behind them.
template <int D>
[[gnu::always_inline]] inline Moments<D> moments(const typename Umls<D>::Cell& cell, const Place<D>& at, const Real* weight) noexcept
{
  Pack w0{}, first[3]{}, second[6]{};
  for (int i = 0; i < cell.padded_size; i += pack_size) {
    const Pack w = load(weight + i);
    Pack r[D];
    for (int d = 0; d < D; ++d)
      r[d] = load(cell.x[d] + i) - at.x[d];
    w0 += w;
    for (int d = 0; d < D; ++d) {
      const Pack wr = w * r[d];
      first[d] += wr;
      for (int e = d; e < D; ++e)
        second[Symmetric<D>::place(d, e)] += wr * r[e];
    }
  }
  const Pack low = sums(w0, first[0], first[1], first[2]);
  const Pack middle = sums(second[0], second[1], second[2], second[3]);
  const Pack high = sums(second[4], second[5], second[4], second[5]);

  Moments<D> m;
  m.sum = low[0];
  for (int d = 0; d < D; ++d)
    m.first[d] = low[d + 1];
  for (int k = 0; k < Symmetric<D>::size; ++k)
    m.spread.entry[k] = m.sum * (k < pack_size ? middle[k] : high[k - pack_size]);
  for (int d = 0; d < D; ++d)
    for (int e = d; e < D; ++e)
      m.spread.entry[Symmetric<D>::place(d, e)] -= m.first[d] * m.first[e];
  return m;
}

/// The hats of the cell, in the room of the whole stencil.
template <int D>
void hats_instead(const typename Umls<D>::Cell& cell, const Place<D>& at, Weights<D, Umls<D>::max_nodes>& out) noexcept
{
  std::fill_n(out.w, cell.padded_size, 0.0);
  store(out.w, at.hat);
  for (int d = 0; d < D; ++d) {
    std::fill_n(out.dw[d], cell.padded_size, 0.0);
    store(out.dw[d], load(cell.slope[d]));
  }
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
  const Index* nodes = cell.nodes.data();
  const std::uint8_t* adjacency = adjacency_.data() + stencil_.begin[static_cast<std::size_t>(c)];
  for (int i = 0; i < cell.padded_size; ++i) {
    const bool real = i < cell.size;
    const Vec<D>& x = mesh.node(nodes[real ? i : 0]);
    for (int d = 0; d < D; ++d)
      cell.x[d][i] = x[d];
    const auto& bits = bits_of[real ? adjacency[i] : 0];
    for (std::size_t a = 0; a <= D; ++a)
      cell.adjacent[a][i] = bits[a];
  }
  cell.origin = mesh.node(cell.nodes[0]);
  const auto gradients = mesh.gradients(c);
  cell.radius = radius(cell.nodes[0]);
  for (int d = 0; d < D; ++d) {
    cell.radius_slope[d] = 0;
    std::fill_n(cell.slope[d], pack_size, 0.0);
    for (std::size_t a = 0; a <= D; ++a) {
      cell.slope[d][a] = gradients[a][d];
      cell.radius_slope[d] += radius(cell.nodes[a]) * gradients[a][d];
    }
  }
}

template <int D>
void Umls<D>::evaluate(const Cell& cell, const Vec<D>& x, Weights<D, max_nodes>& out) const noexcept
{
  const Place<D> at = place_of<D>(cell, x);
  sample<D>(cell, at, out.w);
  Moments<D> m = moments<D>(cell, at, out.w);
  const Real diagonal = regularisation * m.spread.trace();
  for (int d = 0; d < D; ++d)
    m.spread.entry[d] += diagonal;
  const Symmetric<D> adjoint = adjugate(m.spread);
  const Real det = determinant(m.spread, adjoint);
  if (!(det > unusable_roundness * round_determinant(m.spread))) {  // NaN too
    hats_instead<D>(cell, at, out);
    return;
  }

  // With k = S^-1 c:  G_v = W_v (S^-1 r_v - k)  and  w_v = W_v (1/W0 + k . c - k . r_v)
  const Real per_det = 1 / det, share = 1 / m.sum;
  Pack inverse[Symmetric<D>::size], k[D], at_x = broadcast(share);
  for (int j = 0; j < Symmetric<D>::size; ++j)
    inverse[j] = adjoint.entry[j] * broadcast(per_det * m.sum);
  for (int d = 0; d < D; ++d) {
    Real sum = 0;
    for (int e = 0; e < D; ++e)
      sum += adjoint(d, e) * m.first[e];
    k[d] = broadcast(sum * per_det);
    at_x += k[d] * (m.first[d] * share);
  }
  for (int i = 0; i < cell.padded_size; i += pack_size) {
    Pack r[D], value = at_x;
    for (int d = 0; d < D; ++d) {
      r[d] = load(cell.x[d] + i) - at.x[d];
      value -= k[d] * r[d];
    }
    const Pack w = load(out.w + i);
    store(out.w + i, w * value);
    for (int d = 0; d < D; ++d) {
      Pack g = -k[d];
      for (int e = 0; e < D; ++e)
        g += inverse[Symmetric<D>::place(d, e)] * r[e];
      store(out.dw[d] + i, w * g);
    }
  }
}

template <int D>
Real Umls<D>::roundness(const Cell& cell, const Vec<D>& x) const noexcept
{
  alignas(64) Real weight[max_nodes];
  const Place<D> at = place_of<D>(cell, x);
  sample<D>(cell, at, weight);
  const Symmetric<D> spread = moments<D>(cell, at, weight).spread;
  const Real round = determinant(spread, adjugate(spread)) / round_determinant(spread);
  return round > 0 ? round : 0;
}

template class Umls<2>;
template class Umls<3>;

}  // namespace talus
