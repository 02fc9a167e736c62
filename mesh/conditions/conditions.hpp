#pragma once
// The list of boundary conditions: the types that a scene may name and that the contract tests check.  A new condition is one line here.

#include "core/type_list.hpp"
#include "mesh/conditions/compliant_base.hpp"
#include "mesh/conditions/fixed.hpp"
#include "mesh/conditions/free_field.hpp"
#include "mesh/conditions/friction.hpp"
#include "mesh/conditions/prescribed_velocity.hpp"
#include "mesh/conditions/roller.hpp"

namespace talus {

/// All conditions.  Where several prescribe all components of a node, the first one of this list does.
// clang-format off
template <int D>
using Conditions = TypeList<
    Fixed<D>,
    Roller<D>,
    PrescribedVelocity<D>,
    Friction<D>,
    CompliantBase<D>,
    FreeField<D>>;
// clang-format on

/// A condition C<D> is made from its options, which are the keys of a scene: `using Options` and `static C make(const Options&, const
/// ConditionSetup<D>&)`.  Its other members form the groups below; a condition has one group or several.

/// Concept: the condition prescribes all components of the velocity of nodes.
///   Vec<D> velocity(const DynamicPhase&, Real time) const   the prescribed velocity [m/s] at a time [s]
///   void hold(const DynamicPhase&, Node&) const             gives a node that velocity
/// A Node has a velocity `v` [m/s], the times `kick.from` and `kick.to` [s] of its old and its new velocity, and three functions by which
/// conditions change it.  They differ in how the energy balance counts the work:
///   push(dv)            an impulse; its work is kinetic energy lost by mass that does not move as the condition does
///   apply_friction(dv)  a tangential impulse; its work is heat
///   carry(velocity)     the condition moves with this mean velocity over the step; the impulses do work with it
template <class C>
concept HoldsNodes = requires(const C condition, const DynamicPhase& phase)
{
  condition.velocity(phase, Real{});
};

/// Concept: the condition acts on planes through nodes.
///   static constexpr bool two_sided                            whether the normal velocity vanishes in both directions, or only outwards
///   void act(Node&, const Vec<D>& normal) const                changes the velocity; the unit normal points out of the mesh
///   static void constrain(Vec<D>& v, const Vec<D>& normal)     the kinematic part only
///   bool gap                                                   of one-sided ones, if there: it acts only where material touches the plane
/// Two-sided planes of all conditions at a node get orthonormal normals.
template <class C>
concept ActsOnPlanes = requires
{
  C::two_sided;
};

/// Concept: the condition absorbs waves by dashpots.  In the dynamic phase they replace its other actions, and the force that it exerted at
/// rest continues.
///   DashpotsOfNodes<D> dashpots(const Mesh<D>&, std::span<const Facet>) const
///   Vec<D> free_velocity(const Dashpot<D>&, const Vec<D>& place, const DynamicPhase&, Real time) const
///                                          the velocity [m/s] of the incident wave, or of the ground beside the model
///   Vec<D> force_at_rest(const Dashpot<D>&, const Vec<D>& free_velocity) const   the force on a node that does not move [N]
template <class C>
concept HasDashpots = requires
{
  &C::force_at_rest;
};

/// Conditions on facets: those that act on planes or have dashpots.  All others are conditions on nodes.
template <class C>
inline constexpr bool is_on_facets = ActsOnPlanes<C> || HasDashpots<C>;

/// Concept: the condition contains ground with its own motion, on another condition, its `base`, which is added before it.
///   Index base;   void advance(const ColumnBase<D>& below, Real dt)
template <class C>
concept MovesOnBase = requires
{
  &C::base;
};

/// Concept: the condition can be the base of such ground.
///   ColumnBase<D> column_base(const DynamicPhase&, Real time) const
template <class C>
concept CarriesColumn = requires(const C condition, const DynamicPhase& phase)
{
  condition.column_base(phase, Real{});
};

/// Optional members: fields() lists the data that a restart needs, and requires reset(), which returns to the state at rest, and fits(),
/// which checks the sizes of data read from a checkpoint; Real peak_speed() const, if it differs from that of `motion`; and std::string
/// note(const Options&) const, which is printed before a run.
template <int D>
using AnyCondition = variant_of<Conditions<D>, std::type_identity_t>;

namespace detail {
template <class C>
using OptionsOf = typename C::Options;
}  // namespace detail

/// A condition as a scene declares it.
using BoundaryOptions = variant_of<Conditions<2>, detail::OptionsOf>;

inline const BoundaryCommon& common_of(const BoundaryOptions& boundary)
{
  return std::visit([](const BoundaryCommon& options) -> const BoundaryCommon& { return options; }, boundary);
}

/// Calls f.template operator()<C>() for the condition with these options.
template <class Options, int D, class F>
void with_condition_of(F&& f)
{
  for_each_type(Conditions<D>{}, [&]<class C>() {
    if constexpr (std::is_same_v<typename C::Options, Options>)
      f.template operator()<C>();
  });
}

inline bool has_dashpots(const BoundaryOptions& boundary)
{
  return std::visit(
      []<class Options>(const Options&) {
        bool has = false;
        with_condition_of<Options, 2>([&]<class C>() { has = HasDashpots<C>; });
        return has;
      },
      boundary);
}

}  // namespace talus
