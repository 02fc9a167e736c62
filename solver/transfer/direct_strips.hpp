#pragma once
// Between the particles of strips and the nodes, through the weights of a kernel.
#include "solver/model/model.hpp"
#include "solver/strips/reference.hpp"
#include "solver/transfer/deposit.hpp"
#include "solver/transfer/interpolate.hpp"
#include "solver/transfer/kernel_rows.hpp"
#include "solver/transfer/strip_scratch.hpp"

namespace talus {

/// Whether the force of particles uses the slopes of their weights.
template <int D, Kernel<D> K>
bool pairs_force_with_slopes([[maybe_unused]] const K& kernel) noexcept
{
  if constexpr (HasSlopesOfValues<K, D>)
    return kernel.pairs_force_with_slopes();
  else
    return false;
}

/// A cell, the weights of its particles, and the sums over them.
template <int D, Kernel<D> K>
class DirectCell {
 public:
  typename K::Cell cell;
  Weights<D, K::max_nodes> weights;
  CellSums<D, K::max_nodes> sums;
  CellMotion<D, K::max_nodes> motion;
  LaneSlopes<D, K::max_nodes> slopes[HasSlopesOfValues<K, D> ? pack_size : 1];  ///< if the force uses them
  KeptWeights<D, K::max_nodes>* kept = nullptr;                                 ///< of the strip, if they are kept or read
  KeptUse use = KeptUse::compute;

  void begin_run(const CellRun<D>& run, const std::vector<CellRun<D>>& runs) noexcept
  {
    if (kept != nullptr)
      kept->begin_run(use, static_cast<std::size_t>(&run - runs.data()));
  }

  /// Finds the weights of `count` particles from number i on; of those that do not stay at the origin, which is in the cell.  With
  /// `with_slopes` also their slopes.
  void place(const K& kernel, const StripColumn<Vec<D>>& places, std::size_t i, int count, const std::uint8_t* stays, bool with_slopes)
  {
    LaneSlopes<D, K::max_nodes>* const kept_slopes = pairs_force_with_slopes<D>(kernel) ? slopes : nullptr;
    if (use == KeptUse::read)
      return kept->read(cell, count, weights, kept_slopes);
    compute(kernel, places, i, count, stays, with_slopes || (use == KeptUse::keep && kept_slopes != nullptr));
    if (use == KeptUse::keep)
      kept->keep(cell, count, weights, kept_slopes);
  }

 private:
  void compute(const K& kernel, const StripColumn<Vec<D>>& places, std::size_t i, int count, const std::uint8_t* stays,
               [[maybe_unused]] bool with_slopes) noexcept
  {
    Pack x[D];
    for (int d = 0; d < D; ++d)
      x[d] = load_loose(places.component(d) + i);
    if (count < pack_size || std::find(stays + i, stays + i + pack_size, 0) != stays + i + pack_size)
      for (int lane = 0; lane < pack_size; ++lane) {
        const std::size_t p = i + static_cast<std::size_t>(std::min(lane, count - 1));
        for (int d = 0; d < D; ++d)
          x[d][lane] = stays[p] != 0 ? places.component(d)[p] : cell.origin[d];
      }
    kernel.evaluate(cell, x, count, weights);
    if constexpr (HasSlopesOfValues<K, D>)
      for (int lane = 0; with_slopes && lane < count; ++lane)
        kernel.slopes_of_values(cell, x, lane, weights, slopes[lane].dw);
  }
};

/// Adds particles [run.begin, run.end), which have moved for a time dt, to `at.sums`.
template <bool affine, bool loaded, bool forces, int D, Kernel<D> K>
void deposit_run(const K& kernel, const StripColumns<D>& columns, Real dt, const CellRun<D>& run, StripScratch<D>& scratch,
                 DirectCell<D, K>& at)
{
  const std::uint8_t* const stays = scratch.stays.data();
  for (std::size_t i = run.begin; i < run.end; i += pack_size) {
    scratch.ahead.next();
    const int count = run.count(i);
    const bool exact = forces && pairs_force_with_slopes<D>(kernel);
    at.place(kernel, columns.places(), i, count, stays, exact);
    const Tension<D> tension = forces && !exact ? tension_of(columns, i, at.weights) : Tension<D>{};
    deposit<affine, loaded, forces>(columns, i, count, stays, at.cell, at.weights, tension, dt, at.sums);
    if constexpr (HasSlopesOfValues<K, D>)
      for (int lane = 0; exact && lane < count; ++lane)
        if (const std::size_t p = i + static_cast<std::size_t>(lane); stays[p] != 0)
          deposit_force(columns, p, at.slopes[lane].dw, at.weights.padded_size[lane], at.sums);
  }
}

/// Adds the particles of all runs that stay to the rows of their block.
template <bool affine, bool loaded, int D, Kernel<D> K>
TALUS_ONE_COPY void deposit_directly(const K& kernel, const Mesh<D>& mesh, const StripColumns<D>& columns, Real dt,
                                     StripScratch<D>& scratch, Index block, BlockRows<D>& blocks, DirectCell<D, K>& at)
{
  for (const CellRun<D>& run : scratch.runs) {
    const auto lightest = lightest_of(run, columns.mass, scratch);
    if (!lightest)
      continue;
    kernel.open(mesh, run.frame->cell, at.cell);
    at.begin_run(run, scratch.runs);
    at.sums.clear(at.cell.padded_size);
    deposit_run<affine, loaded, true>(kernel, columns, dt, run, scratch, at);
    at.sums.add_to(blocks.rows(block), blocks.slots(run.frame->cell), *lightest);
  }
}

/// Adds the virtual stress of a load to the rows of a block, through the weights of the particles of all runs that stay.
template <int D, Kernel<D> K>
TALUS_ONE_COPY void add_virtual_stress(const K& kernel, const Mesh<D>& mesh, const SurfaceLoad<D>& load, const StripColumns<D>& columns,
                                       StripScratch<D>& scratch, Index block, BlockRows<D, SurfaceSum<D>>& blocks, DirectCell<D, K>& at)
{
  const std::span<SurfaceSum<D>> rows = blocks.rows(block);
  for (const CellRun<D>& run : scratch.runs) {
    kernel.open(mesh, run.frame->cell, at.cell);
    at.begin_run(run, scratch.runs);
    const std::span<const std::uint16_t> slots = blocks.slots(run.frame->cell);
    for (std::size_t i = run.begin; i < run.end; i += pack_size) {
      const int count = run.count(i);
      const bool exact = pairs_force_with_slopes<D>(kernel);
      at.place(kernel, columns.places(), i, count, scratch.stays.data(), exact);
      for (int lane = 0; lane < count; ++lane) {
        const std::size_t p = i + static_cast<std::size_t>(lane);
        if (scratch.stays[p] == 0)
          continue;
        NodeWeights<D, K::max_nodes> of;
        at.weights.spell_out(lane, of);
        if constexpr (HasSlopesOfValues<K, D>)
          for (int d = 0; exact && d < D; ++d)
            std::copy_n(at.slopes[lane].dw[d], at.weights.padded_size[lane], of.dw[d]);
        const Real volume = columns.volume.of(p);
        VirtualStress<D> stress =
            virtual_stress<D>(load, columns.id[p], columns.F.of(p).template topLeftCorner<D, D>(), columns.volume0.of(p), volume);
        pull_back(columns, p, stress.tension);
        for (std::size_t a = 0; a < slots.size(); ++a) {
          SurfaceSum<D>& row = rows[slots[a]];
          for (int d = 0; d < D; ++d)
            row.force += stress.tension.col(d) * of.dw[d][a];
          const Real share = std::abs(of.w[a]) * volume;
          row.volume += share;
          row.depth += share * stress.depth;
        }
      }
    }
  }
}

/// The particles of one block.  VertexStrips has the same interface.
template <int D, Kernel<D> K>
class DirectStrips {
 public:
  static constexpr bool keeps_gradients = true;
  static constexpr int quantities = 0;

  DirectStrips(const Model<D>& m, StripScratch<D>& scratch) : m_(m), scratch_(scratch) {}

  void take(KernelRows<D, K>& of, Index) noexcept { of_ = &of, strip_ = nullptr; }  ///< all bodies of a field alike
  /// Says that the particles that come next are those of a strip of this number.
  void take_strip(const Strip& strip, std::size_t number) noexcept { strip_ = &strip, number_ = number; }
  void open(CellFrame<D>&) const noexcept {}
  static void clear(KernelRows<D, K>&, const Model<D>&, Index) noexcept {}
  void find_gradients(const StripColumn<Vec<D>>&, bool, StripColumns<D>&) const noexcept {}

  void move(StripColumns<D>& columns, bool, Real dt, Real pic)
  {
    in_pass(columns, [&] {
      if (m_.problem.transfer.uses_musl())
        return move_with_remapped_gradient(columns, dt);
      m_.problem.transfer.increments() ? move<true>(columns, dt, pic) : move<false>(columns, dt, pic);
    });
  }
  void add(const StripColumns<D>& columns, std::size_t, Real dt, Index block)
  {
    if (m_.problem.transfer.affine())
      columns.applied ? add<true, true>(columns, dt, block) : add<true, false>(columns, dt, block);
    else
      columns.applied ? add<false, true>(columns, dt, block) : add<false, false>(columns, dt, block);
  }
  void add_surface_load(const SurfaceLoad<D>& load, const StripColumns<D>& columns, Index block, BlockRows<D, SurfaceSum<D>>& blocks)
  {
    in_pass(columns, [&] { add_virtual_stress(of_->kernel, m_.problem.mesh, load, columns, scratch_, block, blocks, at_); });
  }
  /// MUSL: new velocities and the affine field; adds their momentum to the rows of the block with the same weights.
  void return_momentum(StripColumns<D>& columns, Real pic, Index block)
  {
    in_pass(columns, [&] {
      if (!m_.problem.transfer.affine())
        return return_momentum<true, false>(columns, pic, block);
      m_.problem.transfer.increments() ? return_momentum<true, true>(columns, pic, block)
                                       : return_momentum<false, true>(columns, pic, block);
    });
  }

 private:
  /// A pass over particles: keeps the weights of those of a strip that have references, or reads those that are kept.
  template <class F>
  void in_pass(const StripColumns<D>& columns, F&& pass)
  {
    if (strip_ != nullptr && columns.G) {
      at_.kept = &of_->kept[number_];
      const bool all_stay = std::find(scratch_.stays.begin(), scratch_.stays.end(), 0) == scratch_.stays.end();
      at_.use = at_.kept->begin(strip_->arrangement, scratch_.runs.size(), all_stay);
    }
    pass();
    if (at_.use == KeptUse::keep)
      at_.kept->end(strip_->arrangement);
    at_.kept = nullptr, at_.use = KeptUse::compute;
  }
  template <bool affine, bool loaded>
  void add(const StripColumns<D>& columns, Real dt, Index block)
  {
    in_pass(columns,
            [&] { deposit_directly<affine, loaded>(of_->kernel, m_.problem.mesh, columns, dt, scratch_, block, of_->blocks, at_); });
  }
  /// Opens the cell of a run with the motion of its nodes, and calls f(i, count) for its packs, with their weights.
  void for_each_pack(const CellRun<D>& run, const StripColumn<Vec<D>>& places, const SparseRows<NodeMotion<D>>& motion, auto&& f)
  {
    of_->kernel.open(m_.problem.mesh, run.frame->cell, at_.cell);
    at_.begin_run(run, scratch_.runs);
    at_.motion.read(motion, at_.cell.nodes, at_.cell.padded_size);
    for (std::size_t i = run.begin; i < run.end; i += pack_size) {
      scratch_.ahead.next();
      at_.place(of_->kernel, places, i, run.count(i), scratch_.stays.data(), false);
      f(i, run.count(i));
    }
  }
  template <bool with_change, bool with_gradient>
  Interpolated<D> see(int count) const noexcept
  {
    return talus::see<with_change, with_gradient>(at_.motion, at_.weights, count);
  }

  template <bool increments>
  void move(const StripColumns<D>& columns, Real dt, Real pic)
  {
    for (const CellRun<D>& run : scratch_.runs)
      for_each_pack(run, columns.places(), nodes_of(m_, *of_).motion, [&](std::size_t i, int count) {
        const Interpolated<D> seen = see<increments, true>(count);
        store_gradient(i, count, seen, columns.L);
        if (columns.C)
          store_gradient(i, count, seen, columns.C);
        find_apic_field(columns, i, count, columns.L);
        store_velocity<increments>(columns, i, count, seen, pic);
        store_place(columns, i, count, seen.v, dt);
      });
  }
  /// MUSL: L from the remapped velocities, while the particles move with the velocities of the step, which stand in `change`.
  void move_with_remapped_gradient(const StripColumns<D>& columns, Real dt)
  {
    for (const CellRun<D>& run : scratch_.runs)
      for_each_pack(run, columns.places(), nodes_of(m_, *of_).remapped, [&](std::size_t i, int count) {
        const Interpolated<D> seen = see<true, true>(count);
        store_gradient(i, count, seen, columns.L);
        store_place(columns, i, count, seen.change, dt);
      });
  }
  template <bool increments, bool affine>
  void return_momentum(const StripColumns<D>& columns, Real pic, Index block)
  {
    for (const CellRun<D>& run : scratch_.runs) {
      at_.sums.clear(K::max_nodes);
      for_each_pack(run, columns.places(), nodes_of(m_, *of_).motion, [&](std::size_t i, int count) {
        const Interpolated<D> seen = see<increments, affine>(count);
        if constexpr (affine) {
          store_gradient(i, count, seen, columns.C);
          find_apic_field(columns, i, count, columns.C);
        }
        store_velocity<increments>(columns, i, count, seen, pic);
        deposit<affine, false, false>(columns, i, count, scratch_.stays.data(), at_.cell, at_.weights, Tension<D>{}, 0, at_.sums);
      });
      at_.sums.add_to(of_->blocks.rows(block), of_->blocks.slots(run.frame->cell), NodeSum<D>::unseen);
    }
  }

  /// Particles behind the run, whose turn comes later, keep theirs.
  static void store_some(Real* to, const Pack& values, int count) noexcept
  {
    if (count == pack_size)
      store_loose(to, values);
    else
      for (int lane = 0; lane < count; ++lane)
        to[lane] = values[lane];
  }
  static void store_gradient(std::size_t i, int count, const Interpolated<D>& seen, const StripColumn<Mat<D>>& to) noexcept
  {
    for (int row = 0; row < D; ++row)
      for (int column = 0; column < D; ++column)
        store_some(to.component(column * D + row) + i, seen.L[row][column], count);
  }
  /// The affine field of APIC, where it is the scheme.
  void find_apic_field(const StripColumns<D>& columns, std::size_t i, int count, const StripColumn<Mat<D>>& gradients) const noexcept
  {
    if (m_.problem.transfer.scheme == Scheme::apic)
      for (int lane = 0; lane < count; ++lane) {
        const std::size_t p = i + static_cast<std::size_t>(lane);
        columns.C.set(p, apic_field(at_.cell, at_.motion, at_.weights, lane, columns.places().of(p), gradients.of(p)));
      }
  }
  template <bool increments>
  static void store_velocity(const StripColumns<D>& columns, std::size_t i, int count, const Interpolated<D>& seen, Real pic) noexcept
  {
    for (int d = 0; d < D; ++d) {
      SimdReal v = seen.v[d];
      if constexpr (increments)
        v = SimdReal(1 - pic) * (SimdReal(load_loose(columns.v.component(d) + i)) + SimdReal(seen.change[d])) + SimdReal(pic) * v;
      store_some(columns.v.component(d) + i, v.of, count);
    }
  }
  static void store_place(const StripColumns<D>& columns, std::size_t i, int count, const Pack (&v)[D], Real dt) noexcept
  {
    for (int d = 0; d < D; ++d) {
      const Pack x = load_loose(columns.x.component(d) + i);
      store_some(columns.before.component(d) + i, x, count);
      store_some(columns.x.component(d) + i, x + dt * v[d], count);
    }
  }

  const Model<D>& m_;
  KernelRows<D, K>* of_ = nullptr;
  StripScratch<D>& scratch_;
  const Strip* strip_ = nullptr;  ///< null for particles that come from elsewhere
  std::size_t number_ = 0;        ///< of the strip among all
  DirectCell<D, K> at_;
};

}  // namespace talus
