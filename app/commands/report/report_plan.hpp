#pragma once
// How much of a run goes into a page of a given size.
#include <vector>

#include "core/types.hpp"

namespace talus {

/// What one particle takes in the page, and what a frame does [B].
struct ParticleCost {
  Real once = 0;             ///< in the page: its number and its body
  Real place = 0;            ///< in a frame
  std::vector<Real> fields;  ///< in a frame, each
  Real frame = 0;            ///< of a frame, whatever is in it
};

struct PagePlan {
  std::vector<std::size_t> frames;  ///< which, ascending
  std::size_t fields = 0;           ///< the first ones
  Real share = 1;                   ///< of the particles
  Real bytes = 0;                   ///< expected
};

/// What the reader of the page has asked for is kept, whatever it takes.
struct KeptAnyway {
  bool frames = false, fields = false;
};

/// Everything, if `budget` [B] allows; else fewer frames, evenly spread from the first to the last, but not fewer than 12; then fewer fields,
/// but not fewer than 3; then fewer particles.  Error: so few that nothing could be seen.
PagePlan plan_page(std::int64_t particles, std::size_t frames, const ParticleCost& cost, Real budget, KeptAnyway saved);

/// `n` of so many numbers from zero, evenly spread, the first and the last among them.
std::vector<std::size_t> evenly_spread(std::size_t n, std::size_t of);

}  // namespace talus
