#pragma once
// Between the particles of strips and the vertices of their cells, for kernels whose weights are barycentric coordinates: four particles at a
// time.
#include "solver/model/model.hpp"
#include "solver/strips/affine_field.hpp"
#include "solver/strips/reference.hpp"
#include "solver/transfer/contributions.hpp"
#include "solver/transfer/kernel_rows.hpp"
#include "solver/transfer/strip_scratch.hpp"
#include "solver/transfer/vertex_motion.hpp"

namespace talus {

/// Velocity gradients of particles of a body at positions x: L, which strains them, and with `with_affine` the affine field C; of the
/// remapped velocities under MUSL, and else the same, is L.
template <int D, Kernel<D> K>
TALUS_ONE_COPY void read_gradients(const Model<D>& m, const KernelRows<D, K>& of, Index body, const StripColumn<Vec<D>>& x,
                                   const StripColumn<Mat<D>>& L, const StripColumn<Mat<D>>& C, const StripScratch<D>& scratch) noexcept
{
  for (const CellRun<D>& run : scratch.runs) {
    const VertexMotion<D, K> motion(m, of, body, run.frame->cell);
    for (std::size_t i = run.begin; i < run.end; i += pack_size) {
      Pack share[D + 1];
      run.frame->shares(x, i, share);
      const auto store_sum = [&](const std::array<const Mat<D>*, D + 1>& gradients, const StripColumn<Mat<D>>& to)
          __attribute__((always_inline))
      {
        for (int k = 0; k < D * D; ++k) {
          Pack sum = share[0] * (*gradients[0])(k);
          for (std::size_t a = 1; a <= D; ++a)
            sum += share[a] * (*gradients[a])(k);
          store_loose(to.component(k) + i, sum);
        }
      };
      store_sum(motion.strain, L);
      if (C)
        store_sum(m.problem.transfer.own_affine_field() ? motion.L : motion.strain, C);
    }
  }
}

/// Computes the contributions of n particles that have moved for a time dt.
template <bool affine, bool loaded, bool moments, bool pulled, int D>
TALUS_ONE_COPY void find_contributions(const StripColumns<D>& columns, std::size_t n, Real dt, StripScratch<D>& scratch) noexcept
{
  using Of = Contribution<D, affine, loaded, moments, pulled>;
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
    if constexpr (affine) {
      const MatOf<D> field = affine_field(columns, i, dt);
      for (int j = 0; j < D; ++j) {
        const Pack centre = load_loose(scratch.centre[j] + i);
        for (int d = 0; d < D; ++d) {
          const Pack A = field(d, j).of;
          v[d] -= A * centre;
          q[Of::field + j * D + d] = m * A;
        }
      }
    }
    for (int d = 0; d < D; ++d)
      q[d] = m * v[d];
    q[Of::mass] = m;
    if constexpr (pulled) {
      const MatOf<D> tension = pulled_back_tension(columns, i);
      for (int k = 0; k < D * D; ++k)
        q[Of::tension + k] = tension(k).of;
    } else {
      for (int d = 0; d < D; ++d)
        for (int e = d; e < D; ++e)
          q[Of::tension + Symmetric<D>::place(d, e)] = volume * load_loose(columns.stress.component(Symmetric<3>::place(d, e)) + i);
    }
    if constexpr (loaded)
      for (int d = 0; d < D; ++d) {
        q[Of::load + d] = load_loose(columns.applied.component(d) + i);
        for (std::size_t lane = 0; lane < pack_size; ++lane)
          if (scratch.stays[i + lane] == 0)  // outside the mesh a force may not be finite
            q[Of::load + d][lane] = 0;
      }
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
template <class Of, int D>
void sum_run(const CellRun<D>& run, const StripScratch<D>& scratch, CornerSums<D, Of>& sums) noexcept
{
  constexpr int size = Of::padded_size, both = 2 * pack_size;
  int k = 0;
  for (; k + both <= size; k += both)
    sum_packs<2, size>(run, scratch, k, sums.of);
  if constexpr (size % both != 0)
    sum_packs<1, size>(run, scratch, k, sums.of);
}

/// Adds the sums of a cell to the rows of its block.
template <bool affine, bool loaded, class Of, int D, class Row>
void add_to(const CornerSums<D, Of>& sums, const CellFrame<D>& frame, std::span<Row> rows, std::span<const std::uint16_t> slots,
            float lightest) noexcept
{
  constexpr bool projects = std::is_same_v<Row, ProjectedNodeSum<D>>;
  [[maybe_unused]] Mat<D> tension = Mat<D>::Zero();
  if constexpr (!projects)
    for (std::size_t a = 0; a <= D; ++a)
      tension += Of::tension_in(sums.of[a]);
  for (std::size_t a = 0; a <= D; ++a) {
    Row& row = rows[slots[a]];
    const Real* const of = sums.of[a];
    row.see_particles(lightest);
    row.momentum += Eigen::Map<const Vec<D>>(of);
    if constexpr (affine)
      for (int j = 0; j < D; ++j)
        for (int i = 0; i < D; ++i)
          row.momentum[i] += of[Of::field + j * D + i] * frame.arms[a][j];
    row.mass += of[Of::mass];
    if constexpr (projects) {
      if constexpr (affine)
        add_numbers<D * D>(of + Of::field, row.affine.data());
      row.tension += Of::tension_in(of);
    } else {
      row.gross += static_cast<float>(of[Of::mass]);
      for (int i = 0; i < D; ++i)
        for (int j = 0; j < D; ++j)
          row.force[i] -= tension(i, j) * frame.slope[j][a];
    }
    if constexpr (loaded)
      row.force += Eigen::Map<const Vec<D>>(of + Of::load);
  }
}

/// Adds the particles of a run to the sums of their group in the cell; `sums` are those of their contributions.
template <class Of, int D>
void add_to_group(const CornerSums<D, Of>& sums, const StripColumn<Real>& volume, const CellRun<D>& run, const StripScratch<D>& scratch,
                  CellGroupSum<D>& sum) noexcept
{
  for (std::size_t a = 0; a <= D; ++a) {
    sum.tension[a] += Of::tension_in(sums.of[a]);
    for (std::size_t i = run.begin; i < run.end; ++i)
      sum.volume[a] += scratch.share[a][i] * volume.first[i];
  }
}

/// Adds the volume of the particles of a run to the rows of their block.
template <int D, class Row>
void add_volume(const StripColumn<Real>& volume, const CellRun<D>& run, const StripScratch<D>& scratch, std::span<Row> rows,
                std::span<const std::uint16_t> slots) noexcept
{
  if constexpr (std::is_same_v<Row, ProjectedNodeSum<D>>)
    for (std::size_t a = 0; a <= D; ++a)
      for (std::size_t i = run.begin; i < run.end; ++i)
        rows[slots[a]].volume += scratch.share[a][i] * volume.first[i];
}

/// Adds the contributions of the first n particles, of a body, to the rows of their block, `with_volume` their volume too, to the moments of
/// their cells and to the sums of its group; find_shares() has been called.
template <bool affine, bool loaded, bool with_moments, bool pulled, int D, class Row>
TALUS_ONE_COPY void deposit_strip(const StripColumns<D>& columns, std::size_t n, Real dt, StripScratch<D>& scratch, Index block,
                                  BlockRows<D, Row>& blocks, SparseRows<CellMoments<D>>& moments, Index body, Interfaces<D>& interfaces,
                                  bool with_volume) noexcept
{
  using Of = Contribution<D, affine, loaded, with_moments, pulled>;
  find_contributions<affine, loaded, with_moments, pulled>(columns, n, dt, scratch);
  const std::span<Row> rows = blocks.rows(block);
  CornerSums<D, Of> sums;
  for (const CellRun<D>& run : scratch.runs) {
    const auto lightest = lightest_of(run, columns.mass, scratch);
    if (!lightest)
      continue;
    scratch.ahead.next();
    sum_run(run, scratch, sums);
    add_to<affine, loaded>(sums, *run.frame, rows, blocks.slots(run.frame->cell), *lightest);
    if constexpr (with_moments) {
      CellMoments<D>& cell = moments[static_cast<std::size_t>(run.frame->cell)];
      for (int a = 0; a <= D; ++a)
        add_numbers<CellMoments<D>::numbers>(sums.of[a] + Of::momentum, cell.of[a]);
    }
    if (with_volume)
      add_volume(columns.volume, run, scratch, rows, blocks.slots(run.frame->cell));
    if (interfaces.any())
      add_to_group(sums, columns.volume, run, scratch, interfaces.sum(body, run.frame->cell));
  }
}

/// The particles of one block.  DirectStrips has the same interface.
template <int D, Kernel<D> K>
class VertexStrips {
 public:
  static constexpr bool keeps_gradients = false;
  static constexpr int quantities = Contribution<D, true, true, true, true>::padded_size;

  VertexStrips(const Model<D>& m, StripScratch<D>& scratch) : m_(m), scratch_(scratch) {}

  void open(CellFrame<D>& frame) const noexcept { frame.arms = arms_of(m_.problem.mesh, *of_, frame.cell, frame.origin); }
  /// Says of which body the particles are that come next, and which rows are those of its velocity field.
  void take(KernelRows<D, K>& of, Index body) noexcept { of_ = &of, body_ = body; }
  void take_strip(const Strip&, std::size_t) const noexcept {}  ///< weights are not kept
  /// Clears what is summed apart from the rows of a block.
  static void clear(KernelRows<D, K>& of, const Model<D>& m, Index block) noexcept
  {
    const Index first = block * block_cells, last = std::min(first + block_cells, m.problem.mesh.n_cells());
    of.interfaces.clear(first, last);
    if (m.problem.transfer.uses_musl())
      std::fill(of.moments.begin() + first, of.moments.begin() + last, CellMoments<D>{});
  }
  /// Sets L and, if asked for and different, C of the columns to velocity gradients at positions x in the cells of the open strip.
  void find_gradients(const StripColumn<Vec<D>>& x, bool with_affine, StripColumns<D>& columns) noexcept
  {
    if (m_.work.strips->layout().kept_gradients() == 0) {
      columns.L = scratch_.L;
      if (with_affine && m_.work.strips->layout().has_affine())
        columns.C = scratch_.C;
    }
    read_gradients(m_, *of_, body_, x, columns.L, columns.C, scratch_);
  }
  /// Velocities and their gradients, and new positions.
  void move(StripColumns<D>& columns, bool with_affine, Real dt, Real pic) noexcept
  {
    find_gradients(columns.places(), with_affine, columns);
    m_.problem.transfer.increments() ? move<true>(columns, dt, pic) : move<false>(columns, dt, pic);
  }
  /// Adds the first n particles, which have moved for a time dt, to the rows of the block.
  void add(const StripColumns<D>& columns, std::size_t n, Real dt, Index block)
  {
    if (m_.problem.transfer.affine())
      columns.applied ? add<true, true>(columns, n, dt, block) : add<true, false>(columns, n, dt, block);
    else
      columns.applied ? add<false, true>(columns, n, dt, block) : add<false, false>(columns, n, dt, block);
  }
  /// Adds the virtual stress of the same particles.
  void add_surface_load(const SurfaceLoad<D>& load, const StripColumns<D>& columns, Index block,
                        BlockRows<D, SurfaceSum<D>>& blocks) const noexcept
  {
    add_virtual_stress<KernelRows<D, K>::projects>(load, columns, scratch_, block, blocks);
  }

 private:
  template <bool affine, bool loaded>
  void add(const StripColumns<D>& columns, std::size_t n, Real dt, Index block)
  {
    m_.problem.transfer.uses_musl() ? add<affine, loaded, true>(columns, n, dt, block) : add<affine, loaded, false>(columns, n, dt, block);
  }
  template <bool affine, bool loaded, bool moments>
  void add(const StripColumns<D>& columns, std::size_t n, Real dt, Index block)
  {
    const auto deposit = [&](auto pulled) {
      deposit_strip<affine, loaded, moments, pulled>(columns, n, dt, scratch_, block, of_->blocks, of_->moments, body_, of_->interfaces,
                                                     of_->extension.any());
    };
    columns.G ? deposit(std::true_type()) : deposit(std::false_type());
  }
  /// Velocities of the particles and their new positions.
  template <bool increments>
  void move(const StripColumns<D>& columns, Real dt, Real pic) noexcept
  {
    for (const CellRun<D>& run : scratch_.runs) {
      const VertexMotion<D, K> motion(m_, *of_, none, run.frame->cell);
      for (std::size_t i = run.begin; i < run.end; i += pack_size) {
        scratch_.ahead.next();
        const VecOf<D> x = columns.x.load(i);
        Pack share[D + 1];
        run.frame->shares(columns.places(), i, share);
        // The next run has not read its places and velocities yet: they must stay behind the end of this one.
        SimdReal::Mask mine;
        for (int lane = 0; lane < pack_size; ++lane)
          mine.of[lane] = i + static_cast<std::size_t>(lane) < run.end ? -1 : 0;
        for (int d = 0; d < D; ++d) {
          SimdReal v = share[0] * (*motion.v[0])[d];
          for (std::size_t a = 1; a <= D; ++a)
            v += share[a] * (*motion.v[a])[d];
          const SimdReal before = load_loose(columns.v.component(d) + i);
          SimdReal after = v;
          if constexpr (increments) {
            SimdReal change = share[0] * (*motion.change[0])[d];
            for (std::size_t a = 1; a <= D; ++a)
              change += share[a] * (*motion.change[a])[d];
            after = SimdReal(1 - pic) * (before + change) + SimdReal(pic) * v;
          }
          store_loose(columns.v.component(d) + i, where(mine, after, before).of);
          store_loose(columns.before.component(d) + i, x[d].of);
          store_loose(columns.x.component(d) + i, where(mine, x[d] + SimdReal(dt) * v, x[d]).of);
        }
      }
    }
  }

  const Model<D>& m_;
  KernelRows<D, K>* of_ = nullptr;
  StripScratch<D>& scratch_;
  Index body_ = none;
};

/// MUSL: adds the momentum of the new velocities to the rows of a block.
template <int D, Kernel<D> K>
void add_new_momentum(const Model<D>& m, KernelRows<D, K>& of, Index block, Real pic)
{
  for_each_cell_with_moments(m, of, block, [&](Index c, const CellMoments<D>& moments, const auto& arms, auto rows, auto slots) {
    const VertexMotion<D, K> motion(m, of, none, c);
    if (m.problem.transfer.affine())
      add_new_momentum<true>(moments, arms, motion, pic, rows, slots);
    else
      add_new_momentum<false>(moments, arms, motion, pic, rows, slots);
  });
}

}  // namespace talus
