#pragma once
// From the particles of a strip to the vertices of their cells, for kernels with node operators.
#include "solver/strips/particle_strips.hpp"
#include "solver/transfer/cell_moments.hpp"

namespace talus {

/// A cell as its particles use it.
template <int D>
struct CellFrame {
  Index cell;
  std::span<const Index> nodes;
  Vec<D> origin;                         ///< its centroid [m]
  alignas(32) Real slope[D][pack_size];  ///< gradients of the barycentric coordinates [1/m]
  std::array<Vec<D>, D + 1> arms;        ///< centres of the linear shape functions relative to the origin [m]
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
};

/// The contributions of a particle, with its quantities in this order: those of Deposit, and m v and m B_j B_k for CellMoments.
template <int D, bool affine, bool moments>
struct Contribution : Deposit<D, affine, false, true> {
  using Base = Deposit<D, affine, false, true>;
  static constexpr int momentum = Base::size, products = momentum + D, size = moments ? products + CellMoments<D>::products : Base::size,
                       padded_size = padded(size);
};

/// Prefetches the memory of a strip in small parts, while another one is computed: too many outstanding requests stall a core.
class PrefetchAhead {
 public:
  void begin(std::span<const Real> memory, std::size_t calls) noexcept
  {
    at_ = memory.data(), end_ = at_ + memory.size();
    part_ = memory.size() / calls + numbers_in_line;
  }
  void next() noexcept
  {
    for (const Real* const last = std::min(at_ + part_, end_); at_ < last; at_ += numbers_in_line)
      __builtin_prefetch(at_, 1, 2);
  }

 private:
  static constexpr std::size_t numbers_in_line = 64 / sizeof(Real);
  const Real* at_ = nullptr;
  const Real* end_ = nullptr;
  std::size_t part_ = 0;
};

/// What a sweep computes of the particles of one strip on its way.  Lives as long as its thread.
template <int D>
class StripScratch {
 public:
  Real* share[D + 1];        ///< barycentric coordinates; zero for particles that leave
  Real* centre[D];           ///< sum_a B_a arm_a, relative to the origin of the cell [m]
  Real* altitude;            ///< of the cell [m]
  Real* pore_after;          ///< pore pressure at the end of the step [Pa]
  StripColumn<Mat<D>> L, C;  ///< gradients [1/s]
  Real* quantities;          ///< Contribution, particle by particle
  std::vector<Index> left;   ///< particles that may have left their cells, ascending
  std::vector<std::uint8_t> stays;
  std::vector<CellFrame<D>> frames;
  std::vector<CellRun<D>> runs;
  PrefetchAhead ahead;
  std::vector<Arrival> arrivals;
  Strip arriving;  ///< particles that come to a block
  AlignedNumbers arriving_memory;
  Index arriving_width = 0;

  void resize(std::size_t n)
  {
    const std::size_t room = (n + strip_padding + pack_size - 1) / pack_size * pack_size;
    stays.assign(room, 1);
    if (room <= room_)
      return;
    room_ = room;
    constexpr std::size_t arrays = (D + 1) + D + 2 + 2 * D * D;
    memory_ = allocate_aligned(room * (arrays + Contribution<D, true, true>::padded_size));
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

/// The columns of which a deposit consists.
template <int D>
struct DepositColumns {
  StripColumn<Vec<D>> v;
  StripColumn<Mat<D>> A;
  StripColumn<Sym3> stress;
  StripColumn<Real> mass, volume;
};

// The functions below exist once, in no inlined or specialised copies: contributions must be bitwise identical wherever a particle is summed,
// and a compiler may round a b + c differently in each copy.
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

/// Velocity gradients at positions x: L, and the affine field C if it differs.  With `remapped`, gradients on the linear shape functions of
/// remapped velocities, L is of these.
template <int D>
TALUS_ONE_COPY void read_gradients(const StripColumn<Vec<D>>& x, const std::vector<ProjectedNodeMotion<D>>& motion,
                                   const std::vector<Mat<D>>& remapped, bool with_affine, StripScratch<D>& scratch) noexcept
{
  for (const CellRun<D>& run : scratch.runs) {
    const Mat<D>*of_step[D + 1], *of_remapped[D + 1];
    for (std::size_t a = 0; a <= D; ++a) {
      const auto node = static_cast<std::size_t>(run.frame->nodes[a]);
      of_step[a] = &motion[node].L;
      of_remapped[a] = remapped.empty() ? of_step[a] : &remapped[node];
    }
    for (std::size_t i = run.begin; i < run.end; i += pack_size) {
      Pack share[D + 1];
      run.frame->shares(x, i, share);
      const auto store_sum = [&](const Mat<D>* const(&of)[D + 1], const StripColumn<Mat<D>>& to) __attribute__((always_inline))
      {
        for (int k = 0; k < D * D; ++k) {
          Pack sum = share[0] * (*of[0])(k);
          for (int a = 1; a <= D; ++a)
            sum += share[a] * (*of[a])(k);
          store_loose(to.component(k) + i, sum);
        }
      };
      store_sum(of_remapped, scratch.L);
      if (with_affine)
        store_sum(of_step, scratch.C);
    }
  }
}

/// Computes the contributions of n particles.
template <bool affine, bool moments, int D>
TALUS_ONE_COPY void find_contributions(const DepositColumns<D>& columns, std::size_t n, StripScratch<D>& scratch) noexcept
{
  using Of = Contribution<D, affine, moments>;
  for (std::size_t i = 0; i < n; i += pack_size) {
    scratch.ahead.next();
    Pack q[Of::padded_size]{};
    const Pack m = load_loose(columns.mass.first + i), volume = load_loose(columns.volume.first + i);
    Pack v[D];
    for (int d = 0; d < D; ++d) {
      v[d] = load_loose(columns.v.component(d) + i);
      if constexpr (moments)
        q[Of::momentum + d] = m * v[d];
    }
    if constexpr (affine)
      for (int j = 0; j < D; ++j) {
        const Pack centre = load_loose(scratch.centre[j] + i);
        for (int d = 0; d < D; ++d) {
          const Pack A = load_loose(columns.A.component(j * D + d) + i);
          v[d] -= A * centre;
          q[Of::field + j * D + d] = m * A;
        }
      }
    for (int d = 0; d < D; ++d)
      q[d] = m * v[d];
    q[Of::mass] = m;
    for (int d = 0; d < D; ++d)
      for (int e = d; e < D; ++e)
        q[Of::tension + Symmetric<D>::place(d, e)] = volume * load_loose(columns.stress.component(Symmetric<3>::place(d, e)) + i);
    if constexpr (moments)
      for (int j = 0; j <= D; ++j) {
        const Pack share = m * load_loose(scratch.share[j] + i);
        for (int k = j; k <= D; ++k)
          q[Of::products + CellMoments<D>::product(j, k)] = share * load_loose(scratch.share[k] + i);
      }
    for (int k = 0; k < Of::padded_size; k += pack_size) {
      transpose(q[k], q[k + 1], q[k + 2], q[k + 3]);
      for (std::size_t lane = 0; lane < pack_size; ++lane)
        store(scratch.quantities + (i + lane) * Of::padded_size + k, q[k + static_cast<int>(lane)]);
    }
  }
}

/// Sums over a run, on each vertex of its cell, of so many packs of contributions from number k on.  Two packs leave room for the sums in
/// the registers of a processor with AVX2.
template <int packs, int size, int D>
[[gnu::always_inline]] inline void sum_packs(const CellRun<D>& run, const StripScratch<D>& scratch, int k,
                                             Real (&sums)[D + 1][size]) noexcept
{
  Pack sum[D + 1][packs]{};
  for (std::size_t i = run.begin; i < run.end; ++i) {
    Pack q[packs];
    for (int p = 0; p < packs; ++p)
      q[p] = load(scratch.quantities + i * size + k + p * pack_size);
    for (int n = 0; n <= D; ++n) {
      const Pack share = broadcast(scratch.share[n][i]);
      for (int p = 0; p < packs; ++p)
        sum[n][p] += share * q[p];
    }
  }
  for (int n = 0; n <= D; ++n)
    for (int p = 0; p < packs; ++p)
      store(sums[n] + k + p * pack_size, sum[n][p]);
}

/// Sums of the contributions of a run on each vertex of its cell.
template <bool affine, bool moments, int D>
void sum_run(const CellRun<D>& run, const StripScratch<D>& scratch, CornerSums<D, Contribution<D, affine, moments>::size>& sums) noexcept
{
  constexpr int size = Contribution<D, affine, moments>::padded_size, both = 2 * pack_size;
  int k = 0;
  for (; k + both <= size; k += both)
    sum_packs<2, size>(run, scratch, k, sums.of);
  if constexpr (size % both != 0)
    sum_packs<1, size>(run, scratch, k, sums.of);
}

/// Adds the contributions of the first n particles to the rows of their block, and to the moments of their cells; find_shares() has been
/// called.
template <bool affine, bool with_moments, int D>
TALUS_ONE_COPY void deposit_strip(const DepositColumns<D>& columns, std::size_t n, StripScratch<D>& scratch, Index block,
                                  BlockRows<D, ProjectedNodeSum<D>>& blocks, Rows<CellMoments<D>>& moments) noexcept
{
  using Of = Contribution<D, affine, with_moments>;
  find_contributions<affine, with_moments>(columns, n, scratch);
  const std::span<ProjectedNodeSum<D>> rows = blocks.rows(block);
  CornerSums<D, Of::size> sums;
  for (const CellRun<D>& run : scratch.runs) {
    float lightest = NodeSum<D>::unseen;
    for (std::size_t i = run.begin; i < run.end; ++i)
      if (scratch.stays[i] != 0)
        lightest = std::min(lightest, static_cast<float>(columns.mass.first[i]));
    if (!(lightest < NodeSum<D>::unseen))
      continue;
    scratch.ahead.next();
    sum_run<affine, with_moments>(run, scratch, sums);
    add_to<affine, false, true>(sums, run.frame->arms, rows, blocks.slots(run.frame->cell), lightest);
    if constexpr (with_moments) {
      CellMoments<D>& cell = moments[static_cast<std::size_t>(run.frame->cell)];
      for (int a = 0; a <= D; ++a)
        add_numbers<CellMoments<D>::numbers>(sums.of[a] + Of::momentum, cell.of[a]);
    }
  }
}

#undef TALUS_ONE_COPY

}  // namespace talus
