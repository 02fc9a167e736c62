// The exact gradients of the values of moving least squares.
#include "kernels/umls_samples.hpp"

namespace talus {

/// With the linear function l_v = value - slope . y_v of the given weights, w_v = W_v l_v, and M the moments of P_v = (1, y_v),
///
///     grad_j w_v = (grad_j W_v) l_v + W_v P_v . M^-1 (e_j - sum_u (grad_j W_u) l_u P_u).
///
/// The factor 2 R^2 of the samples, which depends on x, cancels as in the values, which do not change if all W are multiplied by a factor.
template <int D>
void Umls<D>::slopes_of_values(const Cell& cell, const Pack (&x)[D], int lane, const Weights<D, max_nodes>& weights,
                               Real (&slopes)[D][max_nodes]) const noexcept
{
  const Real* const* y = weights.y[lane];
  if (y[0] != cell.x[0]) {  // linear shape functions
    for (int d = 0; d < D; ++d)
      store(slopes[d], load(y[d]));
    return;
  }
  const auto at = place_of<D>(cell, x, lane);
  const Real radius = radius_at<D>(cell, at);
  Pack w0{}, first[D]{}, change0[D]{}, change[D][D]{};  // sums of W P_v, and of (grad_j W_v) l_v P_v
  for (int i = 0; i < cell.padded_size; i += pack_size) {
    const Pack s = load(weights.s[lane] + i);
    Pack line = broadcast(weights.value[lane]), slope[D];
    sample_slope<D>(cell, at, radius, i, slope);
    w0 += s;
    for (int d = 0; d < D; ++d) {
      first[d] += s * load(y[d] + i);
      line -= weights.slope[d][lane] * load(y[d] + i);
    }
    for (int j = 0; j < D; ++j) {
      const Pack part = slope[j] * line;
      store(slopes[j] + i, part);
      change0[j] += part;
      for (int d = 0; d < D; ++d)
        change[j][d] += part * load(y[d] + i);
    }
  }
  for (int j = 0; j < D; ++j) {
    Real b[D], a = -sum(change0[j]);  // M^-1 (...) = (a, b)
    for (int d = 0; d < D; ++d) {
      b[d] = weights.shift[d][lane] * sum(change0[j]);
      for (int e = 0; e < D; ++e)
        b[d] += weights.H(d, e)[lane] * ((e == j ? 1 : 0) - sum(change[j][e]));
      a -= b[d] * sum(first[d]);
    }
    a /= sum(w0);
    for (int i = 0; i < cell.padded_size; i += pack_size) {
      Pack line = broadcast(a);
      for (int d = 0; d < D; ++d)
        line += b[d] * load(y[d] + i);
      store(slopes[j] + i, load(slopes[j] + i) + load(weights.s[lane] + i) * line);
    }
  }
}

template void Umls<2>::slopes_of_values(const Cell&, const Pack (&)[2], int, const Weights<2, max_nodes>&,
                                        Real (&)[2][max_nodes]) const noexcept;
template void Umls<3>::slopes_of_values(const Cell&, const Pack (&)[3], int, const Weights<3, max_nodes>&,
                                        Real (&)[3][max_nodes]) const noexcept;

}  // namespace talus
