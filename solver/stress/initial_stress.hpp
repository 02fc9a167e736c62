#pragma once
// Stress at the start: of a geostatic stage, and of bodies that come from another run.
#include <algorithm>
#include <functional>
#include <optional>
#include <type_traits>
#include <vector>

#include "core/parallel/communicator.hpp"
#include "core/particles.hpp"
#include "core/time_table.hpp"
#include "materials/interface/material.hpp"
#include "mesh/part.hpp"
#include "solver/state/cell_order.hpp"

namespace talus {

/// What a body begins with: the stress itself, or how it follows from the weight above.
struct StartStress {
  Table k0{};                   ///< stress across gravity over the one along it, by the depth [m] below the ground
  std::optional<Mat3> given{};  ///< instead: the stress that the law sees, tension positive [Pa]
};

/// Each body begins with the stress that `start` has for it.  K0 state: the stress along gravity carries the weight of all mass above the
/// particle; less the pore pressure, of bodies that have one, it is the effective stress that the law sees, and the one across gravity is k0
/// times as large; without gravity such bodies keep the stress that they have.  "Above" is followed cell by cell against gravity, so any surface
/// and any layering is right.  To a stress that is given the pore pressure comes as well.  Throws SceneErrors, with the place of the body, if
/// its law cannot start from a stress.  Every rank has to ask; `order` is that of the particles.  `on_ground`: the pressure on the ground at a
/// place [Pa], as of open water, which is a weight above too; none: zero.
template <int D>
void set_start_stress(const Mesh<D>& mesh, const Subdomain& subdomain, Communicator& ranks, const Vec<D>& gravity,
                      std::span<const StartStress> start, const CellOrder& order, const std::vector<Body>& bodies,
                      std::vector<Material>& materials, Particles<D>& particles,
                      const std::type_identity_t<std::function<Real(const Vec<D>&)>>& on_ground = {});

/// The body keeps its stress and forgets the deformation that led to it: F = I, and its history is that of the stress.  For laws that can
/// start from a stress.
template <int D>
void start_from_stress(const Body& body, Material& material, Particles<D>& particles);

/// How the stress of a body compares to what its law makes of the same state, nothing moving on.
struct StressFit {
  Real largest = 0;  ///< stress, by its Frobenius norm [Pa]
  Real apart = 0;    ///< largest difference, by the same norm [Pa]
  StressFit& operator+=(const StressFit& other) noexcept
  {
    largest = std::max(largest, other.largest), apart = std::max(apart, other.apart);
    return *this;
  }
};
/// `dt`: of the step that led to the state [s].  Laws that can start from a stress are asked without yielding, which is for the next step to do.
/// `take_over`: the stress becomes that of the law, less the viscous and the pore pressure; otherwise nothing changes.
template <int D>
StressFit fit_stress(const Body& body, const Material& material, Real dt, bool take_over, Particles<D>& particles);

}  // namespace talus
