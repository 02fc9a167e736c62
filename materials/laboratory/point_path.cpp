#include "materials/laboratory/point_path.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>

namespace talus {

namespace {

constexpr std::array<std::array<int, 2>, 6> places{{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}}};
constexpr std::array<std::string_view, 6> names{"xx", "yy", "zz", "xy", "yz", "xz"};

using Unknowns = Eigen::Matrix<Real, Eigen::Dynamic, 1, 0, 6, 1>;
using Tangent = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;

/// The norm of a vector of at most six numbers.  The compiler cannot know how many there are at most; where it takes eight at a time it would warn
/// that these reach beyond the end.
Real norm_of(const Unknowns& x)
{
  if (x.size() > Unknowns::MaxRowsAtCompileTime)
    __builtin_unreachable();
  return x.norm();
}

struct PointState {
  Mat3 F = Mat3::Identity(), stress = Mat3::Zero();
  std::vector<Real> history{};
  Real time = 0;
};

/// One step of a path: finds the strain increments of the components whose stress is prescribed.
class StepSolver {
 public:
  StepSolver(const ConstitutiveLaw& law, const std::array<Control, 6>& controls, Real dt) : law_(law), dt_(dt)
  {
    for (std::size_t k = 0; k < 6; ++k) {
      const auto [i, j] = places[k];
      const auto& [quantity, value] = controls[k];
      if (quantity == Controlled::stress)
        free_.push_back(k);
      else
        rate_(i, j) = value;
      if (quantity == Controlled::strain_rate)
        rate_(j, i) = value;
    }
    last_rate_ = Unknowns::Zero(static_cast<Eigen::Index>(free_.size()));
  }

  /// The next state, or why there is none.  `target`: stresses at the end of the step, used where stress is controlled.  A step that
  /// is too long to be solved is cut into more and more parts.
  std::optional<std::string> advance(PointState& state, const Sym3& target)
  {
    const Sym3 start = pack(state.stress);
    std::optional<std::string> problem;
    constexpr Index most_parts = 256;
    for (Index parts = 1; parts <= most_parts; parts *= 4) {
      PointState end = state;
      for (Index part = 1; part <= parts; ++part)
        if (problem = advance(end, start + (target - start) * part / parts, dt_ / parts); problem)
          break;
      if (!problem) {
        state = end;
        break;
      }
    }
    return problem;
  }

 private:
  std::optional<std::string> advance(PointState& state, const Sym3& target, Real dt)
  {
    Unknowns x = last_rate_ * dt;
    PointState end = deform(state, x, dt);
    if (!end.stress.allFinite())
      end = deform(state, x.setZero(), dt);
    const Real stiffness = law_.density() * std::pow(law_.wave_speed(state.F), 2);
    Unknowns residual = missing(end, target);
    // Aimed at 1e-12 of the stress; what rounding of a stress made of stiffness times differences from one allows is good enough.
    const auto relative = [&] { return norm_of(residual) / std::max(target.norm(), end.stress.norm()); };
    const auto good_enough = [&] { return norm_of(residual) <= 1e-14 * stiffness || relative() <= 1e-10; };
    constexpr int newton_steps = 60;
    for (int iteration = 0; iteration < newton_steps && norm_of(residual) > 0 && relative() > 1e-12; ++iteration)
      if (!improve(state, target, dt, x, residual, end, end.stress.norm() / stiffness))
        break;
    if (!end.stress.allFinite())
      return no_answer_of_law();
    if (!good_enough())
      return unreachable(residual, target);
    state = end;
    last_rate_ = x / dt;
    return std::nullopt;
  }

  PointState deform(const PointState& from, const Unknowns& x, Real dt) const
  {
    Mat3 H = rate_ * dt;
    for (std::size_t a = 0; a < free_.size(); ++a) {
      const auto [i, j] = places[free_[a]];
      H(i, j) = H(j, i) = x[static_cast<Eigen::Index>(a)];
    }
    PointState to = from;
    to.F += H * from.F;
    to.time += dt;
    to.stress =
        law_.update(Increment{.F = to.F, .L = H / dt, .stress = from.stress, .dt = dt, .viscous = 0, .elastic = false, .time = to.time},
                    to.history.data());
    if (const auto averaging = law_.strain_averaging())  // one point stands for a body that deforms evenly
      to.history[static_cast<std::size_t>(averaging->mean)] = to.history[static_cast<std::size_t>(averaging->strain)];
    return to;
  }

  Unknowns missing(const PointState& at, const Sym3& target) const
  {
    Unknowns r(static_cast<Eigen::Index>(free_.size()));
    for (std::size_t a = 0; a < free_.size(); ++a)
      r[static_cast<Eigen::Index>(a)] = pack(at.stress)[static_cast<Eigen::Index>(free_[a])] - target[static_cast<Eigen::Index>(free_[a])];
    return r;
  }

  /// One Newton step, halved until the residual falls.  The tangent is probed over a small part of the strain the stress stands for.
  bool improve(const PointState& from, const Sym3& target, Real dt, Unknowns& x, Unknowns& residual, PointState& end, Real strain) const
  {
    const Real probe = std::clamp(1e-4 * strain, 1e-15, 1e-6);
    Tangent tangent(x.size(), x.size());
    for (Eigen::Index a = 0; a < x.size(); ++a) {
      Unknowns ahead = x, behind = x;
      ahead[a] += probe;
      behind[a] -= probe;
      tangent.col(a) = (missing(deform(from, ahead, dt), target) - missing(deform(from, behind, dt), target)) / (2 * probe);
    }
    const Unknowns direction = -tangent.fullPivLu().solve(residual);
    constexpr int halvings = 30;
    Real share = 1;
    for (int i = 0; i < halvings; ++i, share /= 2) {
      const Unknowns trial = x + share * direction;
      const PointState reached = deform(from, trial, dt);
      const Unknowns left = missing(reached, target);
      if (norm_of(left) < norm_of(residual)) {
        x = trial;
        residual = left;
        end = reached;
        return true;
      }
    }
    return false;
  }

  std::string no_answer_of_law() const
  {
    const std::string complaint = law_.complaint(-1);
    return complaint.empty() ? "the law has no answer" : complaint;
  }

  std::string unreachable(const Unknowns& residual, const Sym3& target) const
  {
    Eigen::Index worst = 0;
    residual.cwiseAbs().maxCoeff(&worst);
    const std::size_t k = free_[static_cast<std::size_t>(worst)];
    return fmt::format("stress {} cannot reach {:.6g} Pa, it is off by {:.3g} Pa", names[k], target[static_cast<Eigen::Index>(k)],
                       residual[worst]);
  }

  const ConstitutiveLaw& law_;
  Real dt_;
  Mat3 rate_ = Mat3::Zero();  ///< prescribed part of the velocity gradient [1/s]
  std::vector<std::size_t> free_;
  Unknowns last_rate_;  ///< of the components with prescribed stress [1/s]
};

PointRow row_of(Real time, const ConstitutiveLaw& law, const PointState& state)
{
  PointRow row{time, state.F, state.stress, -state.stress.trace() / 3, von_mises(state.stress), {}};
  for (const HistoryVariable& variable : law.variables())
    row.history.insert(row.history.end(), state.history.begin() + variable.first,
                       state.history.begin() + variable.first + variable.components);
  return row;
}

std::vector<std::string> history_names(const ConstitutiveLaw& law)
{
  std::vector<std::string> all;
  for (const HistoryVariable& variable : law.variables())
    if (variable.components == 1)
      all.push_back(fmt::format("{} [{}]", variable.key, variable.unit));
    else
      for (const std::string_view name : names)
        all.push_back(fmt::format("{}_{} [{}]", variable.key, name, variable.unit));
  return all;
}

}  // namespace

PointTable drive(Material material, std::span<const PointPath> paths, const Mat3& initial_stress)
{
  const ConstitutiveLaw& law = material.law();
  if (material.history.size() == 0)
    throw RunError("a path needs one particle to drive");
  if (!initial_stress.isZero(0) && !material.prestress(0, initial_stress))
    throw RunError(fmt::format("{} cannot start from a stress: reach it by a path", law.name()));
  PointState state{.stress = initial_stress,
                   .history = {material.history.row(0), material.history.row(0) + law.description().history_width}};
  PointTable table{history_names(law), {row_of(0, law, state)}};
  Real time = 0;
  for (std::size_t n = 0; n < paths.size(); ++n) {
    const PointPath& path = paths[n];
    const auto controls = path.controls.all();
    const Real dt = path.time / path.steps;
    StepSolver solver(law, controls, dt);
    const Sym3 start = pack(state.stress);
    for (Index step = 1; step <= path.steps; ++step) {
      Sym3 target = start;
      for (std::size_t k = 0; k < 6; ++k)
        if (controls[k].quantity == Controlled::stress)
          target[static_cast<Eigen::Index>(k)] += (controls[k].value - start[static_cast<Eigen::Index>(k)]) * step / path.steps;
      if (const auto problem = solver.advance(state, target)) {
        const std::string place = to_string(path.where);
        throw RunError(fmt::format("{}{}path {}, step {} of {}, t = {:.6g} s: {} ({})", place, place.empty() ? "" : ": ", n + 1, step,
                                   path.steps, time + step * dt, *problem, law.name()));
      }
      table.rows.push_back(row_of(time + step * dt, law, state));
    }
    time += path.time;
  }
  return table;
}

}  // namespace talus
