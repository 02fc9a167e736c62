#pragma once
// Which other kernel or transfer suits better what a scene does.
#include <string>
#include <vector>

#include "core/particles.hpp"
#include "io/scene/scene.hpp"
#include "materials/interface/material.hpp"
#include "solver/model/model.hpp"

namespace talus {

/// What the advice depends on beside the scene.
struct KernelUse {
  bool flows = false;               ///< a body has a law that dissipates, in any stage, see any_flows()
  bool moves = false;               ///< a stage does not seek rest
  Real uneven_mesh = 0;             ///< median distance of nodes from the centres of their cells, see StarOffsets [h]
  std::vector<Real> slenderness{};  ///< of each body, see slenderness()
};

/// Whether one of the laws dissipates: `at_first` those of the bodies at the start, `later` those of each stage.
bool any_flows(const std::vector<Material>& at_first, const std::vector<std::vector<Material>>& later);

/// Length over thickness of each body: square root of the ratio of the largest to the smallest second moment of its particles about their
/// centre, which of a straight beam is its length over its height; 1 for bodies without particles.
template <int D>
std::vector<Real> slenderness(const Particles<D>& particles, const std::vector<Body>& bodies);

/// A sentence for each choice of kernel or transfer that a benchmark has shown to be worse than another one for what the scene does, with the
/// figures.  They are those of docs/guide/choosing_a_kernel.md.
std::vector<std::string> advice_on_kernel(const Scene& scene, const KernelUse& use);

}  // namespace talus
