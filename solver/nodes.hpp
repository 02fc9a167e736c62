#pragma once
// Nodal rows: what particles deposit, and what they read back.
#include <vector>

#include "core/types.hpp"

namespace talus {

/// What the particles around a node add up to.  One cache line.
template <int D>
struct alignas(64) NodeSum {
  Real mass{};                       ///< [kg]
  Vec<D> momentum = Vec<D>::Zero();  ///< [kg m/s]
  Vec<D> force = Vec<D>::Zero();     ///< internal force and loads, without gravity [N]
  NodeSum& operator+=(const NodeSum& other) noexcept
  {
    mass += other.mass;
    momentum += other.momentum;
    force += other.force;
    return *this;
  }
};

/// How a node moves.  One cache line in 3-D.
template <int D>
struct alignas(64) NodeMotion {
  Vec<D> v = Vec<D>::Zero();       ///< velocity at the end of the step [m/s]
  Vec<D> change = Vec<D>::Zero();  ///< v minus the velocity at its beginning [m/s]
};

template <int D>
struct Nodes {
  std::vector<NodeSum<D>> sum;
  std::vector<NodeMotion<D>> motion;
  std::vector<std::uint8_t> active;  ///< takes part with a mass of its own
  std::vector<std::uint8_t> bound;   ///< under a wall condition: no local damping, its net force is known only after the wall's
  Real mass_cut{};                   ///< nodes with less do not take part by themselves [kg]
};

}  // namespace talus
