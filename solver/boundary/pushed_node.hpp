#pragma once
// The change of velocity of a node by its conditions, and the impulse and work of each.
#include "solver/boundary/boundary_conditions.hpp"

namespace talus {

/// A mass at a node while conditions act on it one after the other.  Consecutive impulses of one condition are added up before they are
/// stored.
template <int D>
class BoundaryConditions<D>::PushedNode {
 public:
  Vec<D> v;
  const Kick& kick;
  Index condition = none;  ///< condition that acts at present
  bool pushed = false, sliding = false;

  PushedNode(const NodeRule& rule, const Kick& times, Real mass, const Vec<D>& v_free, std::vector<ExactSums<Impulse>>& pushed_by)
      : v(v_free), kick(times), rule_(rule), mass_(mass), v_free_(v_free), pushed_by_(pushed_by)
  {}
  void push(const Vec<D>& dv)
  {
    if (condition != pushing_) {
      keep();
      pushing_ = condition;
      sum_.setZero();
    }
    sum_ += dv;
    v += dv;
    pushed = true;
  }
  void apply_friction(const Vec<D>& dv)
  {
    push(dv);
    friction_ += dv;
    sliding = true;
  }
  void carry(const Vec<D>& velocity) { carried_ = velocity; }
  /// Stores the impulses and returns their work.
  BoundaryWork finish(const Vec<D>& v_old)
  {
    keep();
    const Vec<D> v_mid = 0.5 * (v_old + v);
    const Real friction = mass_ * friction_.dot(v_mid), all = mass_ * (v - v_free_).dot(v_mid), moved = mass_ * (v - v_free_).dot(carried_);
    return {friction, moved, all - friction - moved, 0, mass_ * moment<D>(rule_.place, v - v_free_)};
  }

 private:
  void keep()
  {
    if (rule_.counted && pushing_ != none)
      pushed_by_[static_cast<std::size_t>(pushing_)].add({mass_ * sum_, mass_ * moment<D>(rule_.place, sum_)});
  }

  const NodeRule& rule_;
  Real mass_;
  Vec<D> v_free_;
  std::vector<ExactSums<Impulse>>& pushed_by_;
  Index pushing_ = none;  ///< condition of the last impulse
  Vec<D> sum_ = Vec<D>::Zero(), friction_ = Vec<D>::Zero(), carried_ = Vec<D>::Zero();
};

}  // namespace talus
