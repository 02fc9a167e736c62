#pragma once
// Nodes that move with a prescribed velocity.
#include "mesh/conditions/boundary_common.hpp"
#include "mesh/conditions/condition_setup.hpp"
#include "mesh/conditions/dynamic_phase.hpp"
#include "mesh/conditions/prescribed_motion.hpp"

namespace talus {

struct PrescribedVelocityOptions : BoundaryCommon, MotionOptions {
  static constexpr std::string_view name = "velocity";
  static constexpr auto fields()
  {
    return std::tuple{
        on_key("node, facet or cell group moved"),
        required("velocity", &MotionOptions::velocity, any, "m/s", "one number per dimension; with a record its direction"),
        optional("table", &MotionOptions::table, any, "-", "factor in time: list of [time, factor]"),
        group(
            "record", &MotionOptions::record,
            "motion from a file in the place of a table; it begins with the first stage with inertia (type run), and before there is none"),
        during_key()};
  }
  void check(std::vector<std::string>& problems) const { check_motion(problems); }
};

template <int D>
struct PrescribedVelocity {
  using Options = PrescribedVelocityOptions;
  PrescribedMotion<D> motion;
  static PrescribedVelocity make(const Options& options, const ConditionSetup<D>& setup) { return {motion_of<D>(options, setup.record)}; }

  /// The velocity [m/s].  A table counts time from the start of the run, a record from the beginning of the dynamic phase.
  Vec<D> velocity(const DynamicPhase& phase, Real time) const noexcept
  {
    if (motion.record && !phase.begun)
      return Vec<D>::Zero();
    return motion(motion.record ? time - phase.begin : time);
  }
  /// Gives a node the velocity; the work is the impulse times the mean velocity of the condition over the step.
  template <class Node>
  void hold(const DynamicPhase& phase, Node& node) const noexcept
  {
    node.push(velocity(phase, node.kick.to) - node.v);
    node.carry(0.5 * (velocity(phase, node.kick.from) + velocity(phase, node.kick.to)));
  }
  ColumnBase<D> column_base(const DynamicPhase& phase, Real time) const noexcept { return {velocity(phase, time), {}}; }
};

}  // namespace talus
