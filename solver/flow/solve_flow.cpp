// The solution of the system of the pore pressure.
#include "solver/flow/flow_system.hpp"
#include "solver/state/sums.hpp"

namespace talus {

namespace {

constexpr int most_iterations = 2000;
/// Where the system is solved again, the residual of each is this share of what it begins with: more would be lost on contents that change.
constexpr Real share_of_begin = 1e-2;
constexpr Real least = 1e-9;  ///< of the right-hand side, below which rounding errors are not far

}  // namespace

/// image_ = A x; returns x . image_ over unknown pressures.
template <int D>
Real FlowSystem<D>::multiply(const FlowModel<D>& m, Real dt, std::vector<Real>& x)
{
  push(m, x);
  ExactSums<Real> sum;
  add_ranges(m.field.nodes.in_use.own(), sum, [&](Index u) {
    Real image = 0;
    if (sees_water(u)) {
      auto k = to_size(m.mesh.ring_of_node().begin[to_size(u)]);
      for (const Index n : m.mesh.ring_of_node()[u]) {
        image += matrix_[k] * x[to_size(n)] + dt * divergence_[k].dot(velocity_[to_size(n)]);
        ++k;
      }
    }
    image_[to_size(u)] = image;
    return is_unknown(u) ? x[to_size(u)] * image : 0;
  });
  m.ranks.sum(sum);
  return sum.value();
}

/// conditioned_ = what the preconditioner makes of residual_; returns their product.
template <int D>
Real FlowSystem<D>::precondition(const FlowModel<D>& m)
{
  coarse_.find(m.ranks, m.own, at_, residual_);
  ExactSums<Real> sum;
  add_ranges(m.field.nodes.in_use.own(), sum, [&](Index n) {
    if (!is_unknown(n))
      return Real{0};
    conditioned_[to_size(n)] = residual_[to_size(n)] / diagonal_[to_size(n)] + coarse_.at(n);
    return residual_[to_size(n)] * conditioned_[to_size(n)];
  });
  m.ranks.sum(sum);
  return sum.value();
}

/// The residual follows, as that of the changes of pressure last found.
template <int D>
void FlowSystem<D>::take_contents(const FlowModel<D>& m, const FlowCells<D>& cells, const FlowStep<D>& step, bool slopes)
{
  storage_.renew(m.mesh, cells, slopes);
  m.field.nodes.in_use.for_each([&](Index n) {
    if (!m.own.has(n) || !sees_water(n))
      return;
    const auto ring = m.mesh.ring_of_node()[n];
    const auto first = to_size(m.mesh.ring_of_node().begin[to_size(n)]);
    const Real surplus = storage_.surplus(n);
    const Real more = storage_.renew_row(m.mesh, cells, change_, n, [&](Index u, Real by) {
      matrix_[first + to_size(static_cast<Index>(std::ranges::lower_bound(ring, u) - ring.begin()))] += by;
      if (u == n)
        diagonal_[to_size(n)] += by;
    });
    right_[to_size(n)] -= storage_.surplus(n) - surplus;
    if (is_unknown(n))
      residual_[to_size(n)] -= more;
  });
  if (slopes)
    prepare_coarse(m, step);
}

template <int D>
void FlowSystem<D>::find_residual(const FlowModel<D>& m, const FlowStep<D>& step)
{
  multiply(m, step.dt, change_);
  m.field.nodes.in_use.for_each([&](Index n) { residual_[to_size(n)] = is_unknown(n) ? right_[to_size(n)] - image_[to_size(n)] : 0; });
}

/// Newton's method, with the slopes of PoreStorage.  Pressures that come no nearer are met half-way.
template <int D>
void FlowSystem<D>::solve_for_contents(const FlowModel<D>& m, const FlowStep<D>& step, FlowLedger& ledger,
                                       const std::function<const FlowCells<D>&()>& find_contents)
{
  constexpr int most = 60, renewals = 2, straight = 4;
  const NodesInUse& in_use = m.field.nodes.in_use;
  in_use.for_each([&](Index n) { before_[to_size(n)] = 0; });
  Real last = 0;
  for (int again = 0; ledger.found; ++again) {
    send(change_);
    const FlowCells<D>* cells = &find_contents();
    const auto find_missing = [&] {
      return storage_.missing(
          m, *cells, change_, residual_, weight_, [&](Index n) { return sees_water(n); }, [&](Index n) { return is_unknown(n); });
    };
    Real missing = find_missing();
    ledger.residual = missing;
    if (missing <= FlowLedger::tolerance)
      return;
    if (again == most) {
      ledger.unsettled += 1, ledger.missing = std::max(ledger.missing, missing);
      return;
    }
    if (again >= straight && missing > 0.5 * last) {
      in_use.for_each([&](Index n) { change_[to_size(n)] = (change_[to_size(n)] + before_[to_size(n)]) / 2; });
      find_residual(m, step);
      cells = &find_contents();
      missing = find_missing();
    }
    last = missing;
    in_use.for_each([&](Index n) { before_[to_size(n)] = change_[to_size(n)]; });
    take_contents(m, *cells, step, again < renewals || again % 8 == 7);
    iterate(m, step, true, ledger);
  }
}

template <int D>
std::vector<Real>& FlowSystem<D>::solve(const FlowModel<D>& m, const FlowStep<D>& step, FlowLedger& ledger)
{
  m.field.nodes.in_use.for_each([&](Index n) { change_[to_size(n)] = at_[to_size(n)] == NodePressure::given ? given_[to_size(n)] : 0; });
  find_residual(m, step);
  iterate(m, step, false, ledger);
  return change_;
}

/// Conjugate gradients [Hestenes & Stiefel 1952] from change_ and its residual_ on.
template <int D>
void FlowSystem<D>::iterate(const FlowModel<D>& m, const FlowStep<D>& step, bool again, FlowLedger& ledger)
{
  const NodesInUse& in_use = m.field.nodes.in_use;
  const auto square = [](Real x) { return x * x; };
  Real now = precondition(m);
  if (!again)
    begin_ = now, ledger.iterations = 0;
  const Real enough = m.flow.any_retention() ? std::max(square(share_of_begin) * now, square(least) * begin_)
                                             : square(0.9 * FlowLedger::tolerance) * begin_;
  in_use.for_each([&](Index n) { direction_[to_size(n)] = is_unknown(n) ? conditioned_[to_size(n)] : 0; });
  int iterations = 0;
  for (; now > enough && iterations < most_iterations; ++iterations) {
    const Real length = now / multiply(m, step.dt, direction_);
    in_use.for_each([&](Index n) {
      if (!is_unknown(n))
        return;
      change_[to_size(n)] += length * direction_[to_size(n)];
      residual_[to_size(n)] -= length * image_[to_size(n)];
    });
    const Real next = precondition(m), share = next / now;
    now = next;
    in_use.for_each([&](Index n) {
      if (is_unknown(n))
        direction_[to_size(n)] = conditioned_[to_size(n)] + share * direction_[to_size(n)];
    });
  }
  ledger.iterations += iterations, ledger.total_iterations += iterations;
  if (!m.flow.any_retention()) {  // what the sum over a block of nodes still lacks would add up over the steps
    coarse_.find(m.ranks, m.own, at_, residual_);
    in_use.for_each([&](Index n) {
      if (is_unknown(n))
        change_[to_size(n)] += coarse_.at(n);
    });
  }
  ledger.residual = begin_ > 0 ? std::sqrt(now / begin_) : begin_;
  ledger.found = std::abs(now) <= enough;
}

#define TALUS_INSTANTIATE(D)                                                                                      \
  template Real FlowSystem<D>::multiply(const FlowModel<D>&, Real, std::vector<Real>&);                           \
  template Real FlowSystem<D>::precondition(const FlowModel<D>&);                                                 \
  template void FlowSystem<D>::take_contents(const FlowModel<D>&, const FlowCells<D>&, const FlowStep<D>&, bool); \
  template void FlowSystem<D>::find_residual(const FlowModel<D>&, const FlowStep<D>&);                            \
  template void FlowSystem<D>::solve_for_contents(const FlowModel<D>&, const FlowStep<D>&, FlowLedger&,           \
                                                  const std::function<const FlowCells<D>&()>&);                   \
  template std::vector<Real>& FlowSystem<D>::solve(const FlowModel<D>&, const FlowStep<D>&, FlowLedger&);         \
  template void FlowSystem<D>::iterate(const FlowModel<D>&, const FlowStep<D>&, bool, FlowLedger&);
TALUS_INSTANTIATE(2)
TALUS_INSTANTIATE(3)
#undef TALUS_INSTANTIATE

}  // namespace talus
