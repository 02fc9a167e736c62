#pragma once
// The base of a model on an elastic halfspace: an incident wave enters through it, and waves leave through it.
#include <fmt/format.h>

#include <cmath>
#include <span>

#include "mesh/conditions/boundary_common.hpp"
#include "mesh/conditions/condition_setup.hpp"
#include "mesh/conditions/dashpot.hpp"
#include "mesh/conditions/dynamic_phase.hpp"
#include "mesh/conditions/prescribed_motion.hpp"

namespace talus {

struct CompliantBaseOptions : BoundaryCommon, MotionOptions {
  static constexpr std::string_view name = "compliant_base";
  Real density{}, s_wave{}, p_wave{};
  static constexpr auto fields()
  {
    return std::tuple{
        on_key("facet group above a halfspace: held in geostatic stages, then it carries what it carried, waves leave through it and one "
               "comes up"),
        required("density", &CompliantBaseOptions::density, positive, "kg/m^3", "of the halfspace"),
        required("s_wave", &CompliantBaseOptions::s_wave, positive, "m/s", "speed of shear waves in the halfspace"),
        required("p_wave", &CompliantBaseOptions::p_wave, positive, "m/s", "speed of pressure waves in the halfspace"),
        optional("velocity", &MotionOptions::velocity, any, "m/s",
                 "of the particles in the wave that comes up, half of what an outcrop of the halfspace would show: one number per "
                 "dimension; with a record its direction; default none"),
        optional("table", &MotionOptions::table, any, "-",
                 "factor of velocity in time: list of [time, factor], from the beginning of the first stage with inertia (type run)"),
        group("record", &MotionOptions::record, "motion from a file in the place of a table, from the same time on")};
  }
  void check(std::vector<std::string>& problems) const
  {
    check_motion(problems);
    if (velocity.empty() && (!table.points.empty() || record))
      problems.emplace_back("missing key \"velocity\" [m/s]: which way the wave moves the particles");
    if (p_wave * p_wave * 3 < s_wave * s_wave * 4)  // the bulk modulus is density (p_wave^2 - 4/3 s_wave^2)
      problems.push_back(fmt::format("p_wave {} m/s belongs to no elastic ground with s_wave {} m/s: at least {:.4g} m/s", p_wave, s_wave,
                                     std::sqrt(4.0 / 3) * s_wave));
  }
};

/// The halfspace resists a node with velocity v by C v and drives it by 2 C v_up, where v_up is the velocity of the incident wave: one half
/// is that wave, the other half its reflection [Joyner & Chen 1975].
template <int D>
struct CompliantBase {
  using Options = CompliantBaseOptions;
  Halfspace halfspace;
  PrescribedMotion<D> motion;  ///< velocity of the incident wave
  static CompliantBase make(const Options& options, const ConditionSetup<D>& setup)
  {
    return {{options.density, options.s_wave, options.p_wave}, motion_of<D>(options, setup.record)};
  }

  /// The velocity of the nodes before the dynamic phase begins: zero.
  static Vec<D> velocity(const DynamicPhase&, Real) noexcept { return Vec<D>::Zero(); }
  template <class Node>
  void hold(const DynamicPhase&, Node& node) const noexcept
  {
    node.push(Vec<D>::Zero() - node.v);
  }

  DashpotsOfNodes<D> dashpots(const Mesh<D>& mesh, std::span<const Facet> facets) const
  {
    DashpotsOfNodes<D> all;
    for (const Facet facet : facets)
      for (const Index n : mesh.nodes_of(facet))
        all[n].resistance += impedance<D>(halfspace, mesh.area_vector(facet)) / D;
    return all;
  }
  Vec<D> wave(const DynamicPhase& phase, Real time) const noexcept
  {
    return phase.begun ? motion(time - phase.begin) : Vec<D>(Vec<D>::Zero());
  }
  /// The velocity [m/s] relative to which the dashpot of a node acts, and the force [N] on a node that does not move.
  Vec<D> free_velocity(const Dashpot<D>&, const Vec<D>&, const DynamicPhase& phase, Real time) const noexcept { return wave(phase, time); }
  Vec<D> force_at_rest(const Dashpot<D>& dashpot, const Vec<D>& up) const noexcept { return dashpot.resistance * (2 * up); }

  ColumnBase<D> column_base(const DynamicPhase& phase, Real time) const noexcept { return {wave(phase, time), halfspace}; }
  Real peak_speed() const { return 2 * motion.peak_speed(); }  // incident and reflected wave together
};

}  // namespace talus
