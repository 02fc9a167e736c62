#pragma once
// Choice of the contents of a page of a given size.
#include <vector>

#include "core/types.hpp"

namespace talus {

/// The size of one particle and one frame in the page [B].
struct ParticleCost {
  Real once = 0;             ///< once per page: its number and its body
  Real place = 0;            ///< position, per frame
  std::vector<Real> fields;  ///< values of each field, per frame
  Real frame = 0;            ///< per frame, independent of particles
};

struct PagePlan {
  std::vector<std::size_t> frames;  ///< numbers of the frames, ascending
  std::size_t fields = 0;           ///< number of fields, from the first
  Real share = 1;                   ///< fraction of the particles
  Real bytes = 0;                   ///< expected size [B]
};

/// Requests of the reader that are kept whatever their size.
struct KeptAnyway {
  bool frames = false, fields = false;
};

/// Plans everything if `budget` [B] allows; otherwise fewer frames, evenly spread from the first to the last, but at least 12; then fewer
/// fields, but at least 3; then fewer particles.  Throws Error if too few remain.
PagePlan plan_page(std::int64_t particles, std::size_t frames, const ParticleCost& cost, Real budget, KeptAnyway requested);

/// `n` evenly spread numbers in [0, of), including the first and the last.
std::vector<std::size_t> evenly_spread(std::size_t n, std::size_t of);

}  // namespace talus
