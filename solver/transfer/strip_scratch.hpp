#pragma once
// What a sweep computes of the particles of one strip on its way, and where they are in their cells.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "kernels/pack.hpp"
#include "solver/strips/particle_strips.hpp"

namespace talus {

/// Barycentric coordinates of four particles at x [m] in a cell, one vertex per pack.
template <int D>
[[gnu::always_inline]] inline void barycentric_coordinates(const Real (&slope)[D][pack_size], const Vec<D>& centroid, const Pack (&x)[D],
                                                           Pack (&of)[D + 1]) noexcept
{
  for (int a = 0; a <= D; ++a) {
    of[a] = broadcast(1.0 / (D + 1));
    for (int d = 0; d < D; ++d)
      of[a] += slope[d][a] * (x[d] - centroid[d]);
  }
}

/// A cell as its particles use it.
template <int D>
struct CellFrame {
  Index cell;
  Vec<D> origin;                         ///< its centroid [m]
  alignas(32) Real slope[D][pack_size];  ///< gradients of the barycentric coordinates [1/m]
  std::array<Vec<D>, D + 1> arms{};      ///< node operators: centres of the linear shape functions relative to the origin [m]
  Real altitude;                         ///< smallest altitude [m]
  Real least;                            ///< a particle whose barycentric coordinates are all above this lies in no other cell

  /// Barycentric coordinates of particles i to i + 3 of a column of positions.
  void shares(const StripColumn<Vec<D>>& positions, std::size_t i, Pack (&of)[D + 1]) const noexcept
  {
    Pack x[D];
    for (int d = 0; d < D; ++d)
      x[d] = load_loose(positions.component(d) + i);
    barycentric_coordinates<D>(slope, origin, x, of);
  }
};

/// Particles [begin, end) of a strip, in one cell.
template <int D>
struct CellRun {
  const CellFrame<D>* frame;
  std::size_t begin, end;
  /// How many of particles i to i + 3 belong to the run.
  int count(std::size_t i) const noexcept { return static_cast<int>(std::min<std::size_t>(pack_size, end - i)); }
};

/// Prefetches the memory of a strip in small parts, while another one is computed: too many outstanding requests stall a core.  It goes to
/// the second cache: the first one holds little more than the strip that is computed.
class PrefetchAhead {
 public:
  void begin(std::span<const Real> memory, std::size_t calls) noexcept
  {
    memory_ = memory, at_ = 0;
    part_ = memory.size() / calls + numbers_in_line;
  }
  void next() noexcept
  {
    for (const std::size_t last = std::min(at_ + part_, memory_.size()); at_ < last; at_ += numbers_in_line)
      __builtin_prefetch(memory_.data() + at_, 0, 2);  // a request to write, 1, would fill the first cache
  }

 private:
  static constexpr std::size_t numbers_in_line = 64 / sizeof(Real);
  std::span<const Real> memory_;
  std::size_t at_ = 0, part_ = 0;
};

/// Lives as long as its thread.
template <int D>
class StripScratch {
 public:
  Real* share[D + 1];        ///< barycentric coordinates; zero for particles that leave
  Real* centre[D];           ///< sum_a B_a arm_a, relative to the origin of the cell [m]
  Real* altitude;            ///< of the cell [m]
  Real* pore_after;          ///< pore pressure at the end of the step [Pa]
  StripColumn<Mat<D>> L, C;  ///< gradients [1/s], of strips that do not keep them
  Real* quantities;          ///< numbers that each particle adds to the vertices of its cell, particle by particle
  std::vector<Index> left;   ///< particles that may have left their cells, ascending
  std::vector<std::uint8_t> stays;
  std::vector<CellFrame<D>> frames;
  std::vector<CellRun<D>> runs;
  PrefetchAhead ahead;
  std::vector<Arrival> arrivals;
  std::array<std::vector<Arrival>, 2> within;  ///< those that stay in the block, in front of sheets and behind
  Strip arriving;                              ///< particles that come to a block
  AlignedNumbers arriving_memory;
  Index arriving_width = 0;

  /// Makes room for n particles with so many quantities each.
  void resize(std::size_t n, std::size_t n_quantities)
  {
    const std::size_t room = (n + strip_padding + pack_size - 1) / pack_size * pack_size;
    stays.assign(room, 1);
    if (room <= room_)
      return;
    room_ = room;
    constexpr std::size_t arrays = (D + 1) + D + 2 + 2 * D * D;
    memory_ = allocate_aligned(room * (arrays + n_quantities));
    std::fill_n(memory_.get(), room * arrays, 0.0);
    Real* next = memory_.get();
    for (Real*& array : share)
      array = std::exchange(next, next + room);
    for (Real*& array : centre)
      array = std::exchange(next, next + room);
    altitude = std::exchange(next, next + room);
    pore_after = std::exchange(next, next + room);
    L = {std::exchange(next, next + D * D * room), room};
    C = {std::exchange(next, next + D * D * room), room};
    quantities = next;
  }

 private:
  AlignedNumbers memory_;
  std::size_t room_ = 0;
};

/// The mass of the lightest particle of a run that stays in its cell [kg]; nothing if none does.
template <int D>
std::optional<float> lightest_of(const CellRun<D>& run, const StripColumn<Real>& mass, const StripScratch<D>& scratch) noexcept
{
  float lightest = std::numeric_limits<float>::infinity();
  for (std::size_t i = run.begin; i < run.end; ++i)
    if (scratch.stays[i] != 0)
      lightest = std::min(lightest, static_cast<float>(mass.first[i]));
  return std::isfinite(lightest) ? std::optional(lightest) : std::nullopt;
}

// What finds or adds contributions exists once, in no inlined or specialised copies: they must be bitwise identical wherever a particle is
// summed, and a compiler may round a b + c differently in each copy.
#if defined(__clang__)
#define TALUS_ONE_COPY [[gnu::noinline]]
#else
#define TALUS_ONE_COPY [[gnu::noinline, gnu::noclone]]
#endif

/// Finds the barycentric coordinates of the particles of all runs, and lists those that may have left their cells in `scratch.left`.
template <int D>
TALUS_ONE_COPY void find_shares(const StripColumn<Vec<D>>& x, StripScratch<D>& scratch)
{
  scratch.left.clear();
  for (const CellRun<D>& run : scratch.runs) {
    const CellFrame<D>& frame = *run.frame;
    for (std::size_t i = run.begin; i < run.end; i += pack_size) {
      Pack share[D + 1];
      frame.shares(x, i, share);
      Pack least = share[0];
      for (int a = 1; a <= D; ++a)
        least = share[a] < least ? share[a] : least;
      for (int a = 0; a <= D; ++a)
        store_loose(scratch.share[a] + i, share[a]);
      for (int d = 0; d < D; ++d) {
        Pack centre{};
        for (int a = 0; a <= D; ++a)
          centre += share[a] * frame.arms[static_cast<std::size_t>(a)][d];
        store_loose(scratch.centre[d] + i, centre);
      }
      if (const SimdReal::Mask deep = SimdReal(least) > frame.least; !all_of(deep))
        for (std::size_t lane = 0; lane < pack_size && i + lane < run.end; ++lane)
          if (!deep[static_cast<int>(lane)])
            scratch.left.push_back(static_cast<Index>(i + lane));
    }
  }
}

}  // namespace talus
