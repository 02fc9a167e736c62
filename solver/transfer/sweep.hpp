#pragma once
// One pass over the particles of a block: they read the motion of the nodes, deform and move, and are summed for the next step while their
// strip is in the cache.
#include <chrono>
#include <cstring>
#include <iterator>

#include "solver/transfer/scatter.hpp"
#include "solver/transfer/strip_deposit.hpp"

namespace talus {

/// What a transfer keeps for sweeps, beside the rows of blocks.
template <int D>
struct SweepData {
  Rows<CellMoments<D>> moments;  ///< MUSL: of each cell
  std::vector<Mat<D>> gradient;  ///< MUSL: gradient of the remapped velocities on each linear shape function [1/s]
};

/// Sweeps over the blocks of a model whose kernel has node operators.  Lives on the stack of a thread, for one block.
template <int D, Kernel<D> K>
class BlockSweep {
 public:
  BlockSweep(Model<D>& m, KernelRows<D, K>& of, SweepData<D>& data, Index block)
      : m_(m), of_(of), data_(data), block_(block), strips_(*m.work.strips), scratch_(scratch_of_thread())
  {}

  /// Sums the particles as they are, before the first step after they came into strips.
  void sum()
  {
    clear_sums();
    for_each_strip<false>([&](std::size_t key, Index number, const StripColumns<D>& columns) { deposit(key, number, columns); });
    add_arrivals_within();
  }

  /// From nodes to particles and, for the next step, back.
  void advance(Real dt, Real pic)
  {
    clear_sums();
    for_each_strip<true>([&](std::size_t key, Index number, StripColumns<D>& columns) {
      find_gradients(columns.x, columns);
      m_.problem.transfer.increments() ? move<true>(columns, dt, pic) : move<false>(columns, dt, pic);
      update(key, number, columns, dt);
      deposit(key, number, columns);
    });
    add_arrivals_within();
  }

  /// Sets L and C of the columns of a strip to gradients at the positions before the last step, whose motion the nodes still have.
  void find_gradients_again(std::size_t key, Index number, StripColumns<D>& columns)
  {
    open_cells(key, number);
    find_gradients(columns.before, columns);
  }

  /// Adds the particles that come to the block from others.
  void add_arrivals()
  {
    for (Index body = 0; body < m_.n_bodies(); ++body) {
      const auto all = strips_.arriving(strips_.key(body, block_));
      scratch_.arrivals.clear();
      std::copy_if(all.begin(), all.end(), std::back_inserter(scratch_.arrivals), [](const Arrival& one) { return !one.is_summed; });
      add_arrivals(scratch_.arrivals);
    }
  }

 private:
  static StripScratch<D>& scratch_of_thread()
  {
    static thread_local StripScratch<D> scratch;
    return scratch;
  }

  bool musl() const noexcept { return m_.problem.transfer.uses_musl(); }

  /// Clears the rows of the block and the moments of its cells, unless they are clear because it had no particles and has none.
  void clear_sums()
  {
    bool occupied = false;
    for (Index body = 0; body < m_.n_bodies(); ++body)
      occupied |= strips_.size_in_order(strips_.key(body, block_)) > 0;
    std::uint8_t& was = of_.blocks.occupied[static_cast<std::size_t>(block_)];
    if (occupied || was != 0) {
      const auto rows = of_.blocks.rows(block_);
      std::fill(rows.begin(), rows.end(), ProjectedNodeSum<D>{});
      if (musl()) {
        const Index first = block_ * block_cells, last = std::min(first + block_cells, m_.problem.mesh.n_cells());
        std::fill(data_.moments.begin() + first, data_.moments.begin() + last, CellMoments<D>{});
      }
    }
    was = occupied ? 1 : 0;
  }

  /// Calls f(key, number, strip, columns) for the strips that have particles, in order or put in order, with their cells opened.
  template <bool put_in_order, class F>
  void for_each_strip(F&& f)
  {
    for (Index body = 0; body < m_.n_bodies(); ++body) {
      const std::size_t key = strips_.key(body, block_);
      const auto strips = strips_.strips(key);
      for (std::size_t s = 0; s < strips.size(); ++s) {
        const Strip& strip = strips[s];
        const auto number = static_cast<Index>(s);
        if constexpr (put_in_order)
          strips_.order(key, number);
        if (strip.n == 0)
          continue;
        scratch_.ahead.begin(strips_.memory_of_next(key, number), 2 * static_cast<std::size_t>(strip.n) / pack_size + 2 * strip_cells);
        open_cells(key, number);
        StripColumns<D> columns = strips_.columns(strip);
        f(key, number, columns);
      }
    }
  }
  void open_cells(std::size_t key, Index number)
  {
    const Strip& strip = strips_.strips(key)[static_cast<std::size_t>(number)];
    begin_runs(static_cast<std::size_t>(strip.n));
    std::size_t begin = 0;
    for (Index c = 0; c < strip_cells; ++c) {
      const std::size_t end = begin + static_cast<std::size_t>(strip.count[static_cast<std::size_t>(c)]);
      if (end > begin)
        add_run(strips_.first_cell(key, number) + c, begin, end);
      begin = end;
    }
  }
  /// Adds the particles that change their cell within the block, while it is in the cache.
  void add_arrivals_within()
  {
    for (Index body = 0; body < m_.n_bodies(); ++body) {
      strips_.find_cells(m_.problem.mesh, m_.problem.locator, strips_.key(body, block_), scratch_.arrivals);
      add_arrivals(scratch_.arrivals);
    }
  }
  void add_arrivals(std::span<const Arrival> arriving)
  {
    if (arriving.empty())
      return;
    of_.blocks.occupied[static_cast<std::size_t>(block_)] = 1;
    const StripColumns<D> columns = copy(arriving);
    begin_runs(arriving.size());
    for (std::size_t i = 0; i < arriving.size();) {
      const std::size_t begin = i;
      while (i < arriving.size() && arriving[i].cell == arriving[begin].cell)
        ++i;
      add_run(arriving[begin].cell, begin, i);
    }
    find_shares(columns.x, scratch_);
    add(columns, arriving.size());
  }

  void begin_runs(std::size_t particles)
  {
    scratch_.resize(particles);
    scratch_.runs.clear();
    scratch_.frames.reserve(particles);  // runs keep addresses
    scratch_.frames.clear();
  }
  void add_run(Index cell, std::size_t begin, std::size_t end)
  {
    const Mesh<D>& mesh = m_.problem.mesh;
    CellFrame<D>& frame = scratch_.frames.emplace_back();
    frame.cell = cell, frame.nodes = mesh.cell(cell), frame.origin = centroid(mesh, cell);
    const auto& gradients = mesh.gradients(cell);
    for (std::size_t a = 0; a <= D; ++a) {
      for (int d = 0; d < D; ++d)
        frame.slope[d][a] = gradients[a][d];
      frame.arms[a] = of_.kernel.node_operators().centre(frame.nodes[a]) - frame.origin;
    }
    frame.altitude = mesh.altitude(cell);
    frame.least = m_.problem.locator.probe(mesh, cell).least;
    scratch_.runs.push_back({&frame, begin, end});
  }

  /// Velocity gradients at positions x in the cells of the open strip.
  void find_gradients(const StripColumn<Vec<D>>& x, StripColumns<D>& columns) noexcept
  {
    const bool with_affine = strips_.layout().has_affine();
    static const std::vector<Mat<D>> none_remapped;
    read_gradients(x, of_.projected.motion, musl() ? data_.gradient : none_remapped, with_affine, scratch_);
    columns.L = scratch_.L;
    if (with_affine)
      columns.C = scratch_.C;
  }

  /// Velocities of the particles and their new positions.
  template <bool increments>
  void move(const StripColumns<D>& columns, Real dt, Real pic) noexcept
  {
    for (const CellRun<D>& run : scratch_.runs) {
      const ProjectedNodeMotion<D>* motion[D + 1];
      for (std::size_t a = 0; a <= D; ++a)
        motion[a] = &of_.projected.motion[static_cast<std::size_t>(run.frame->nodes[a])];
      for (std::size_t i = run.begin; i < run.end; i += pack_size) {
        scratch_.ahead.next();
        const VecOf<D> x = columns.x.load(i);
        Pack share[D + 1];
        run.frame->shares(columns.x, i, share);
        // The next run has not read its places and velocities yet: they must stay behind the end of this one.
        SimdReal::Mask mine;
        for (int lane = 0; lane < pack_size; ++lane)
          mine.of[lane] = i + static_cast<std::size_t>(lane) < run.end ? -1 : 0;
        for (int d = 0; d < D; ++d) {
          SimdReal v = share[0] * motion[0]->v[d];
          for (int a = 1; a <= D; ++a)
            v += share[a] * motion[a]->v[d];
          const SimdReal before = load_loose(columns.v.component(d) + i);
          SimdReal after = v;
          if constexpr (increments) {
            SimdReal change = share[0] * motion[0]->change[d];
            for (int a = 1; a <= D; ++a)
              change += share[a] * motion[a]->change[d];
            after = SimdReal(1 - pic) * (before + change) + SimdReal(pic) * v;
          }
          store_loose(columns.v.component(d) + i, where(mine, after, before).of);
          store_loose(columns.before.component(d) + i, x[d].of);
          store_loose(columns.x.component(d) + i, where(mine, x[d] + SimdReal(dt) * v, x[d]).of);
        }
      }
    }
  }

  /// Deformation and stress.
  void update(std::size_t key, Index number, const StripColumns<D>& columns, Real dt)
  {
    const Strip& strip = strips_.strips(key)[static_cast<std::size_t>(number)];
    const auto n = static_cast<std::size_t>(strip.n);
    const std::size_t body = key / static_cast<std::size_t>(m_.work.order.blocks);
    const Material& material = m_.state.materials[body];
    for (const CellRun<D>& run : scratch_.runs)
      std::fill(scratch_.altitude + run.begin, scratch_.altitude + run.end + strip_padding - 1, run.frame->altitude);
    const StripColumn<Real> pore_after = find_pore_pressures(static_cast<Index>(body), columns, dt);
    columns.v.pad(n), columns.L.pad(n), columns.F.pad(n), columns.stress.pad(n);
    columns.mass.pad(n), columns.volume0.pad(n), columns.volume.pad(n);
    if (columns.viscous)
      columns.viscous.pad(n);
    if (pore_after)
      columns.pore.pad(n), pore_after.pad(n);
    const StripColumn<Real> history = strips_.history(strip);
    for (int k = 0; k < material.history.width(); ++k)
      StripColumn<Real>{history.component(k), history.stride}.pad(n);
    const auto start = std::chrono::steady_clock::now();
    const StressSums sums = update_stress(material, StressStrip<D>{.n = n,
                                                                   .dt = dt,
                                                                   .elastic = m_.state.stage.elastic,
                                                                   .v = columns.v,
                                                                   .L = columns.L,
                                                                   .F = columns.F,
                                                                   .stress = columns.stress,
                                                                   .mass = columns.mass,
                                                                   .volume0 = columns.volume0,
                                                                   .volume = columns.volume,
                                                                   .altitude = {scratch_.altitude, n},
                                                                   .viscous = columns.viscous,
                                                                   .pore = columns.pore,
                                                                   .pore_after = pore_after,
                                                                   .id = columns.id,
                                                                   .history = history,
                                                                   .errors = &m_.work.errors});
    StressSums& all = m_.work.stress_sums[key];
    all.work += sums.work;
    all.take_extremes(sums);
    all.seconds += std::chrono::duration<Real>(std::chrono::steady_clock::now() - start).count();
  }

  /// Pore pressures at the new positions; nothing where the law of the body uses total stress.
  StripColumn<Real> find_pore_pressures(Index body, const StripColumns<D>& columns, Real dt) noexcept
  {
    const auto water = pore_water(m_, body, m_.state.clock.time + dt);
    if (!water)
      return {};
    for (const CellRun<D>& run : scratch_.runs)
      for (std::size_t i = run.begin; i < run.end; ++i)
        scratch_.pore_after[i] = water->pressure(m_.problem.mesh, run.frame->cell, columns.x.of(i));
    return {scratch_.pore_after, 0};
  }

  /// Lists the particles that have left their cells, and sums the others.
  void deposit(std::size_t key, Index number, const StripColumns<D>& columns)
  {
    find_shares(columns.x, scratch_);
    auto run = scratch_.runs.begin();
    for (const Index i : scratch_.left) {
      while (static_cast<std::size_t>(i) >= run->end)
        ++run;
      strips_.add_leaver(key, number, columns, i, run->frame->cell);
      scratch_.stays[static_cast<std::size_t>(i)] = 0;
      for (Real* const share : scratch_.share)
        share[i] = 0;
    }
    add(columns, scratch_.runs.back().end);
  }
  void add(const StripColumns<D>& columns, std::size_t n)
  {
    const DepositColumns<D> from{columns.v, columns.affine_field(), columns.stress, columns.mass, columns.volume};
    if (m_.problem.transfer.affine())
      musl() ? deposit_strip<true, true>(from, n, scratch_, block_, of_.blocks, data_.moments)
             : deposit_strip<true, false>(from, n, scratch_, block_, of_.blocks, data_.moments);
    else
      musl() ? deposit_strip<false, true>(from, n, scratch_, block_, of_.blocks, data_.moments)
             : deposit_strip<false, false>(from, n, scratch_, block_, of_.blocks, data_.moments);
  }

  /// Particles that come, side by side.
  StripColumns<D> copy(std::span<const Arrival> arriving)
  {
    const Index width = strips_.layout().width() + strips_.layout().gradients();
    Strip& strip = scratch_.arriving;
    const auto n = static_cast<Index>(arriving.size());
    if (n + strip_padding > strip.room || scratch_.arriving_width != width) {
      strip.room = room_for(n), scratch_.arriving_width = width;
      scratch_.arriving_memory = allocate_aligned(static_cast<std::size_t>(strip.room) * static_cast<std::size_t>(width));
      strip.numbers = scratch_.arriving_memory.get();
    }
    for (Index k = 0; k < width; ++k)
      for (Index i = 0; i < n + strip_padding; ++i)
        std::memcpy(strip.array(k) + i, arriving[static_cast<std::size_t>(std::min(i, n - 1))].numbers + k, sizeof(Real));
    return strips_.columns_of_records(strip);
  }

  Model<D>& m_;
  KernelRows<D, K>& of_;
  SweepData<D>& data_;
  Index block_;
  ParticleStrips<D>& strips_;
  StripScratch<D>& scratch_;
};

/// MUSL: adds the momentum of the new velocities to the rows of a block.
template <int D, Kernel<D> K>
void add_new_momentum(const Model<D>& m, KernelRows<D, K>& of, const SweepData<D>& data, Index block, Real pic)
{
  if (!of.blocks.occupied[static_cast<std::size_t>(block)])
    return;
  const auto rows = of.blocks.rows(block);
  std::fill(rows.begin(), rows.end(), ProjectedNodeSum<D>{});
  const Index last = std::min((block + 1) * block_cells, m.problem.mesh.n_cells());
  for (Index c = block * block_cells; c < last; ++c) {
    const CellMoments<D>& moments = data.moments[static_cast<std::size_t>(c)];
    Real mass = 0;
    for (int a = 0; a <= D; ++a)
      mass += moments.of[a][D + CellMoments<D>::product(a, a)];
    if (!(mass > 0))  // no particles: not all coordinates of one are zero
      continue;
    const auto nodes = of.kernel.stencil(m.problem.mesh, c);
    const Vec<D> origin = centroid(m.problem.mesh, c);
    std::array<Vec<D>, D + 1> arms;
    for (std::size_t a = 0; a <= D; ++a)
      arms[a] = of.kernel.node_operators().centre(nodes[a]) - origin;
    std::array<const ProjectedNodeMotion<D>*, D + 1> motion;
    for (std::size_t a = 0; a <= D; ++a)
      motion[a] = &of.projected.motion[static_cast<std::size_t>(nodes[a])];
    if (m.problem.transfer.affine())
      add_new_momentum<true>(moments, arms, motion, pic, rows, of.blocks.slots(c));
    else
      add_new_momentum<false>(moments, arms, motion, pic, rows, of.blocks.slots(c));
  }
}

}  // namespace talus
