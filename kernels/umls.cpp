// Unstructured moving least squares: tables, and the two passes over the stencil of a particle.
#include "kernels/umls_samples.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "core/parallel/threads.hpp"
#include "kernels/symmetric.hpp"

namespace talus {
namespace {

/// This fraction of the trace of S is added to its diagonal, to avoid division by zero; it does not change results for linear fields.
constexpr Real regularisation = 1e-14;
/// Factors of enlarged radii, tried in this order.
constexpr Real radius_factors[] = {1.25, 1.5};

/// bits_of[mask][a] is bit a of the mask, as a number.
constexpr auto bits_of = [] {
  std::array<std::array<Real, 4>, 16> bits{};
  for (unsigned mask = 0; mask < 16; ++mask)
    for (unsigned a = 0; a < 4; ++a)
      bits[mask][a] = (mask >> a) & 1U;
  return bits;
}();

/// Moments of the sample weights of four particles, about the origin of the cell.
template <int D>
struct Moments {
  Pack sum;                   ///< W0
  Pack first[D];              ///< W0 c
  Symmetric<D, Pack> spread;  ///< W0^2 S about the centroid of the weights
};

/// Sums of W, W y and W y (x) y of one particle, four nodes per pack.
template <int D>
struct RawMoments {
  static constexpr int size = 1 + D + Symmetric<D>::size;
  Pack entry[size];
};
/// A separate loop: together with the square roots these sums would have to wait for them.
template <int D>
[[gnu::always_inline]] inline RawMoments<D> raw_moments(const typename Umls<D>::Cell& cell, const Real* weight) noexcept
{
  Pack w0{}, first[D]{}, second[Symmetric<D>::size]{};
  for (int i = 0; i < cell.padded_size; i += pack_size) {
    const Pack w = load(weight + i);
    w0 += w;
    for (int d = 0; d < D; ++d) {
      const Pack wy = w * load(cell.x[d] + i);
      first[d] += wy;
      for (int e = d; e < D; ++e)
        second[Symmetric<D>::place(d, e)] += wy * load(cell.x[e] + i);
    }
  }
  RawMoments<D> raw;
  raw.entry[0] = w0;
  std::copy_n(first, D, raw.entry + 1);
  std::copy_n(second, Symmetric<D>::size, raw.entry + 1 + D);
  return raw;
}

/// Computes sample weights of `count` particles in `weight`, and their moments.
template <int D>
[[gnu::always_inline]] inline Moments<D> moments(const typename Umls<D>::Cell& cell, const Pack (&x)[D], int count,
                                                 Real (*weight)[Umls<D>::max_nodes]) noexcept
{
  RawMoments<D> raw[pack_size];
  for (int lane = 0; lane < count; ++lane) {
    sample<D>(cell, place_of<D>(cell, x, lane), weight[lane]);
    raw[lane] = raw_moments<D>(cell, weight[lane]);
  }
  for (int lane = count; lane < pack_size; ++lane)
    raw[lane] = raw[count - 1];

  Pack total[RawMoments<D>::size];
  for (int k = 0; k < RawMoments<D>::size; ++k)
    total[k] = sums(raw[0].entry[k], raw[1].entry[k], raw[2].entry[k], raw[3].entry[k]);
  Moments<D> m;
  m.sum = total[0];
  std::copy_n(total + 1, D, m.first);
  for (int d = 0; d < D; ++d)
    for (int e = d; e < D; ++e) {
      const int k = Symmetric<D>::place(d, e);
      m.spread.entry[k] = m.sum * total[1 + D + k] - m.first[d] * m.first[e];
    }
  return m;
}

/// The linear shape functions of the cell in one lane, as factors (see Linear).
template <int D>
void linear_instead(const typename Umls<D>::Cell& cell, const Pack (&x)[D], int lane, Weights<D, Umls<D>::max_nodes>& out) noexcept
{
  store(out.s[lane], D == 2 ? Pack{1, 1, 1, 0} : broadcast(1));
  out.padded_size[lane] = pack_size;
  out.value[lane] = 1.0 / (D + 1);
  for (int j = 0; j < Symmetric<D>::size; ++j)
    out.H.entry[j][lane] = j < D ? 1 : 0;
  for (int d = 0; d < D; ++d) {
    out.y[lane][d] = cell.slope[d];
    out.slope[d][lane] = cell.origin[d] - x[d][lane];
    out.shift[d][lane] = 0;
  }
}

}  // namespace

template <int D>
Umls<D>::Umls(const Mesh<D>& mesh, const Options& options) : gradient_(options.gradient)
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
      throw std::invalid_argument(
          fmt::format("kernel umls: cell {} at ({}) sees {} nodes around its vertices; there is room for {}", c, place, size, max_nodes));
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

/// Checks S at the vertices, the midpoints of the edges and the centroid.
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
  cell.origin = centroid(mesh, c);
  const Index* nodes = cell.nodes.data();
  const std::uint8_t* adjacency = adjacency_.data() + stencil_.begin[static_cast<std::size_t>(c)];
  for (int i = 0; i < cell.padded_size; ++i) {
    const bool real = i < cell.size;
    const Vec<D>& x = mesh.node(nodes[real ? i : 0]);
    for (int d = 0; d < D; ++d)
      cell.x[d][i] = x[d] - cell.origin[d];
    const auto& bits = bits_of[real ? adjacency[i] : 0];
    for (std::size_t a = 0; a <= D; ++a)
      cell.adjacent[a][i] = bits[a];
  }
  const auto& gradients = mesh.gradients(c);
  cell.radius = 0;
  for (std::size_t a = 0; a <= D; ++a)
    cell.radius += radius(cell.nodes[a]) / (D + 1);
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
void Umls<D>::evaluate(const Cell& cell, const Pack (&x)[D], int count, Weights<D, max_nodes>& out) const noexcept
{
  Moments<D> m = moments<D>(cell, x, count, out.s);
  const Pack diagonal = regularisation * m.spread.trace();
  for (int d = 0; d < D; ++d)
    m.spread.entry[d] += diagonal;
  const auto adjoint = adjugate(m.spread);
  const Pack det = determinant(m.spread, adjoint), least = unusable_roundness * round_determinant(m.spread);

  // Relative to the origin, with k = S^-1 (c - x):  G_v = W_v (S^-1 y_v - S^-1 c)  and  w_v = W_v (1/W0 + k . c - k . y_v)
  const Pack per_det = 1 / det, share = 1 / m.sum;
  out.value = share;
  for (int j = 0; j < Symmetric<D>::size; ++j)
    out.H.entry[j] = adjoint.entry[j] * (per_det * m.sum);
  for (int d = 0; d < D; ++d) {
    Pack k{}, shift{};
    for (int e = 0; e < D; ++e) {
      k += adjoint(d, e) * (m.first[e] - m.sum * (x[e] - cell.origin[e]));
      shift += adjoint(d, e) * m.first[e];
    }
    out.slope[d] = k * per_det;
    out.shift[d] = shift * per_det;
    out.value += out.slope[d] * (m.first[d] * share);
  }
  for (int lane = 0; lane < count; ++lane) {
    out.padded_size[lane] = cell.padded_size;
    for (int d = 0; d < D; ++d)
      out.y[lane][d] = cell.x[d];
    if (!(det[lane] > least[lane]))  // true for NaN too
      linear_instead<D>(cell, x, lane, out);
  }
}

template <int D>
Real Umls<D>::roundness(const Cell& cell, const Vec<D>& x) const noexcept
{
  alignas(64) Real weight[1][max_nodes];
  Pack at[D];
  for (int d = 0; d < D; ++d)
    at[d] = broadcast(x[d]);
  const auto spread = moments<D>(cell, at, 1, weight).spread;
  const Real round = (determinant(spread, adjugate(spread)) / round_determinant(spread))[0];
  return round > 0 ? round : 0;
}

template class Umls<2>;
template class Umls<3>;

}  // namespace talus
