#pragma once
// The forces of walls and other bodies on each body, from the balance of its momentum.
#include "solver/each_particle.hpp"

namespace talus {

/// Sums over the particles of a body at one time.
template <int D>
struct BodySums {
  Real mass{}, kinetic{};            ///< [kg], [J]
  Vec<D> momentum = Vec<D>::Zero();  ///< [kg m/s]
  static constexpr auto fields()
  {
    return std::tuple{saved("mass", &BodySums::mass), saved("kinetic", &BodySums::kinetic), saved("momentum", &BodySums::momentum)};
  }
  BodySums& operator+=(const BodySums& other) noexcept
  {
    mass += other.mass, kinetic += other.kinetic, momentum += other.momentum;
    return *this;
  }
};

/// The impulse on a body since the start of the run, without gravity and loads carried by its particles or on its surface.
template <int D>
struct BodyImpulse {
  Vec<D> given = Vec<D>::Zero();  ///< impulse [N s]
  /// Duration of steps that are not included, because particles that left the mesh cannot be assigned to bodies [s].
  Real unknown{};
  static constexpr auto fields() { return std::tuple{saved("given", &BodyImpulse::given), saved("unknown", &BodyImpulse::unknown)}; }
};

/// Tracks the momentum of every body through each step.  Bodies of one velocity field share the velocity of a node without a contact force.
/// The change of the momentum of a body in a step, minus gravity on its mass and the loads on its particles and surface, is that of walls and
/// other bodies on it:
///
///     I_b += P_b(new) - P_b(old) + (momentum of its particles that were deleted) - kick (m_b g + f_b)
///
/// with the time `kick` over which forces act in the step (docs/theory/algorithm.md).
/// The sum over all bodies is the impulse of walls, including mesh tractions and the damping of stages, to round-off.  Changes between
/// steps are not included: bodies that appear, and the motion that is removed where a stage ends in equilibrium.  Does nothing unless it is
/// `wanted`.
template <int D>
class BodyForces {
 public:
  explicit BodyForces(bool wanted) noexcept : wanted_(wanted) {}
  /// To be called at every event of a run, on every rank.
  void see(const RunView<D>& view, RunEvent event);

  /// The sums of each body at the last event.
  const std::vector<BodySums<D>>& sums() const noexcept { return sums_; }
  const std::vector<BodyImpulse<D>>& impulses() const noexcept { return impulses_; }
  /// Whether fields() read from a checkpoint have the size for this number of bodies.
  bool fits(std::size_t bodies) const noexcept { return sums_.size() == (wanted_ ? bodies : 0) && impulses_.size() == sums_.size(); }
  static constexpr auto fields()
  {
    return std::tuple{saved("sums", &BodyForces::sums_), saved("impulses", &BodyForces::impulses_), saved("deleted", &BodyForces::deleted_),
                      saved("failed", &BodyForces::failed_)};
  }

 private:
  void add_step(const RunView<D>& view, const std::vector<BodySums<D>>& now);

  bool wanted_;
  std::vector<BodySums<D>> sums_;
  std::vector<BodyImpulse<D>> impulses_;
  Vec<D> deleted_ = Vec<D>::Zero();  // momentum of all particles deleted so far
  Real failed_ = 0;                  // mass of those that failed
};

extern template class BodyForces<2>;
extern template class BodyForces<3>;

}  // namespace talus
