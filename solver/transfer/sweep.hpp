#pragma once
// One pass over the particles of a block: they read the motion of the nodes, deform and move, and are summed for the next step while their
// strip is in the cache.
#include <chrono>
#include <cstring>
#include <iterator>

#include "solver/strips/domain.hpp"
#include "solver/transfer/direct_strips.hpp"
#include "solver/transfer/pore_pressures.hpp"
#include "solver/transfer/vertex_strips.hpp"

namespace talus {

/// What a pass does with the particles.  All of it at once, unless something between two parts needs the particles of other blocks.
struct SweepParts {
  bool orders = false;    ///< puts the strips in order, unless an earlier pass of the step has
  bool moves = false;     ///< velocities, gradients and positions
  bool updates = false;   ///< deformation and stress
  bool deposits = false;  ///< sums for the next step
};

/// When particles are summed: at the end of a step, or when they come into strips, with references and sides of sheets that hold.
enum class DepositAt : std::uint8_t { step, load };

/// Sweeps over the blocks of a model.  Lives on the stack of a thread, for one block.
template <int D, Kernel<D> K>
class BlockSweep {
  using Through = std::conditional_t<WeighsVertices<K, D>, VertexStrips<D, K>, DirectStrips<D, K>>;

 public:
  static constexpr bool keeps_gradients = Through::keeps_gradients;

  /// `fields`: the rows of all velocity fields.
  BlockSweep(Model<D>& m, std::span<KernelRows<D, K>> fields, Index block)
      : m_(m),
        fields_(fields),
        block_(block),
        strips_(*m.work.strips),
        scratch_(scratch_of_thread()),
        through_(m, scratch_),
        moved_for_(carries_affine_field() ? m.state.clock.dt : 0)
  {}

  /// Sums the particles as they are, before the first step after they came into strips.
  void sum()
  {
    clear_sums(true);
    for_each_strip({.deposits = true}, [&](std::size_t key, Index number, const StripColumns<D>& columns) {
      deposit(key, number, columns, m_.state.clock.time, DepositAt::load);
    });
    add_arrivals_within();
  }

  /// From nodes to particles and, for the next step, back.
  void advance(const SweepParts& parts, Real dt, Real pic)
  {
    moved_for_ = carries_affine_field() ? dt : 0;
    if (parts.deposits)
      clear_sums(!parts.orders);
    for_each_strip(parts, [&](std::size_t key, Index number, StripColumns<D>& columns) {
      if (parts.moves)
        move(key, columns, parts.deposits, dt, pic);
      else if (strips_.layout().kept_gradients() == 0)
        through_.find_gradients(columns.before, parts.deposits, columns);
      if (parts.updates)
        update(key, number, columns, dt);
      if (parts.deposits)
        deposit(key, number, columns, m_.state.clock.time + dt, DepositAt::step);
    });
    if (parts.deposits)
      add_arrivals_within();
  }

  /// MUSL through weights: computes new velocities, and adds their momentum to the rows of the block.
  void return_momentum(Real pic)
  {
    clear_sums(false);
    for_each_strip({.orders = true, .moves = true},
                   [&](std::size_t, Index, StripColumns<D>& columns) { through_.return_momentum(columns, pic, block_); });
  }

  /// Sets L and C of the columns of a strip to gradients at the positions before the last step, whose motion the nodes still have.
  void find_gradients_again(std::size_t key, Index number, StripColumns<D>& columns)
  {
    open_cells(key, number);
    through_.find_gradients(columns.before, true, columns);
  }

  /// Adds the particles that come to the block from others.
  void add_arrivals()
  {
    for (Index group = 0; group < strips_.groups(); ++group) {
      const auto all = strips_.arriving(strips_.key(group, block_));
      scratch_.arrivals.clear();
      std::copy_if(all.begin(), all.end(), std::back_inserter(scratch_.arrivals), [](const Arrival& one) { return !one.is_summed; });
      add_arrivals(group, scratch_.arrivals);
    }
  }

 private:
  /// The fields of `apic` and `tpic` go back as they were read, as published: with `tpic` it gains nothing to carry them.  Where gradients jump
  /// between cells, dt C^2 is noise: carried along, `linear` turns particles inside out (docs/theory/transfers.md).
  bool carries_affine_field() const noexcept
  {
    return m_.problem.transfer.scheme == Scheme::aflip && fields_.front().kernel.claims().continuous_gradient;
  }
  static StripScratch<D>& scratch_of_thread()
  {
    static thread_local StripScratch<D> scratch;
    return scratch;
  }

  /// Clears the rows of the block and the moments of its cells, unless they are clear because it had no particles and has none.
  void clear_sums(bool are_in_order)
  {
    for (KernelRows<D, K>& of : fields_) {
      bool occupied = false;
      for (Index group = 0; group < strips_.groups(); ++group)
        if (field_of(group) == of.field) {
          const std::size_t key = strips_.key(group, block_);
          occupied |= (are_in_order ? strips_.size(key) : strips_.size_in_order(key)) > 0;
        }
      std::uint8_t& was = of.blocks.occupied[static_cast<std::size_t>(block_)];
      if (occupied || was != 0) {
        const auto rows = of.blocks.rows(block_);
        std::fill(rows.begin(), rows.end(), typename KernelRows<D, K>::Sum{});
        Through::clear(of, m_, block_);
        of.surfaces.clear(block_);
      }
      was = occupied ? 1 : 0;
    }
  }
  std::size_t field_of(Index group) const noexcept { return m_.problem.field_of(strips_.body_of(group), strips_.is_behind(group)); }
  KernelRows<D, K>& rows_of(Index group) const noexcept { return fields_[field_of(group)]; }
  void take(Index group) noexcept { through_.take(rows_of(group), strips_.body_of(group)); }

  /// Calls f(key, number, columns) for the strips that have particles, in order or put in order, with their cells opened.
  template <class F>
  void for_each_strip(const SweepParts& parts, F&& f)
  {
    const std::size_t loops = parts.moves && parts.deposits ? 2 : 1;  // over packs, while the next strip is prefetched
    for (Index group = 0; group < strips_.groups(); ++group) {
      const std::size_t key = strips_.key(group, block_);
      const auto strips = strips_.strips(key);
      for (std::size_t s = 0; s < strips.size(); ++s) {
        const Strip& strip = strips[s];
        const auto number = static_cast<Index>(s);
        if (parts.orders)
          strips_.order(key, number);
        if (strip.n == 0)
          continue;
        scratch_.ahead.begin(strips_.memory_of_next(key, number), loops * static_cast<std::size_t>(strip.n) / pack_size + 2 * strip_cells);
        open_cells(key, number);
        StripColumns<D> columns = strips_.columns(strip);
        f(key, number, columns);
      }
    }
  }
  void open_cells(std::size_t key, Index number)
  {
    const Strip& strip = strips_.strips(key)[static_cast<std::size_t>(number)];
    take(strips_.group(key));
    through_.take_strip(strip, key * to_size(strips_in_block) + to_size(number));
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
    for (Index group = 0; group < strips_.groups(); ++group) {
      strips_.find_cells(m_.problem.mesh, m_.problem.locator, strips_.key(group, block_), scratch_.within);
      for (const bool behind : {false, true})
        add_arrivals(strips_.group_of(strips_.body_of(group), behind), scratch_.within[behind ? 1 : 0]);
    }
  }
  void add_arrivals(Index group, std::span<const Arrival> arriving)
  {
    if (arriving.empty())
      return;
    take(group);
    rows_of(group).blocks.occupied[static_cast<std::size_t>(block_)] = 1;
    const StripColumns<D> columns = copy(arriving);
    begin_runs(arriving.size());
    for (std::size_t i = 0; i < arriving.size();) {
      const std::size_t begin = i;
      while (i < arriving.size() && arriving[i].cell == arriving[begin].cell)
        ++i;
      add_run(arriving[begin].cell, begin, i);
    }
    find_shares(columns.places(), scratch_);
    through_.add(columns, arriving.size(), moved_for_, block_);
    add_surface_loads(group, columns);
  }

  void begin_runs(std::size_t particles)
  {
    scratch_.resize(particles, Through::quantities);
    scratch_.runs.clear();
    scratch_.frames.reserve(particles);  // runs keep addresses
    scratch_.frames.clear();
  }
  void add_run(Index cell, std::size_t begin, std::size_t end)
  {
    const Mesh<D>& mesh = m_.problem.mesh;
    CellFrame<D>& frame = scratch_.frames.emplace_back();
    frame.cell = cell, frame.origin = centroid(mesh, cell);
    const auto& gradients = mesh.gradients(cell);
    for (std::size_t a = 0; a <= D; ++a)
      for (int d = 0; d < D; ++d)
        frame.slope[d][a] = gradients[a][d];
    frame.altitude = mesh.altitude(cell);
    frame.least = m_.problem.locator.least_inside(mesh, cell);
    through_.open(frame);
    scratch_.runs.push_back({&frame, begin, end});
  }

  /// Velocities, gradients and positions of a strip, and what loads do on the way.
  void move(std::size_t key, StripColumns<D>& columns, bool with_affine, Real dt, Real pic)
  {
    const std::size_t n = scratch_.runs.back().end;
    if (columns.applied)
      m_.work.load_sums[key].add_forces(columns, n);
    through_.move(columns, with_affine, dt, pic);
    if (columns.G)
      follow_motion(columns, n, dt);
    if (columns.applied)
      m_.work.load_sums[key].add_work(columns, n);
    if (m_.state.materials[static_cast<std::size_t>(strips_.body(key))].averages_volume)
      for (std::size_t i = 0; i < n; ++i)  // to be averaged before the stress is updated
        columns.averaged.set(i, (Mat<D>::Identity() + dt * columns.L.of(i)).determinant() * columns.volume.of(i));
  }

  /// Deformation and stress.
  void update(std::size_t key, Index number, const StripColumns<D>& columns, Real dt)
  {
    const Strip& strip = strips_.strips(key)[static_cast<std::size_t>(number)];
    const auto n = static_cast<std::size_t>(strip.n);
    const Index body = strips_.body(key);
    const Material& material = m_.state.materials[static_cast<std::size_t>(body)];
    for (const CellRun<D>& run : scratch_.runs)
      std::fill(scratch_.altitude + run.begin, scratch_.altitude + run.end + strip_padding - 1, run.frame->altitude);
    if (columns.G)
      shorten(columns, n, scratch_.altitude);
    if (columns.domain)
      deform_domains(columns, n, dt);
    const StripColumn<Real> pore_after = find_pore_pressures(m_, body, columns, dt, scratch_);
    columns.v.pad(n), columns.L.pad(n), columns.F.pad(n), columns.stress.pad(n);
    columns.mass.pad(n), columns.volume0.pad(n), columns.volume.pad(n);
    if (columns.viscous)
      columns.viscous.pad(n);
    if (columns.averaged)
      columns.averaged.pad(n), columns.volume_ratio.pad(n);
    if (pore_after)
      columns.pore.pad(n), pore_after.pad(n);
    const StripColumn<Real> history = strips_.history(strip);
    for (int k = 0; k < material.history.width(); ++k)
      StripColumn<Real>{history.component(k), history.stride}.pad(n);
    const auto start = std::chrono::steady_clock::now();
    const StressSums sums = update_stress(material, StressStrip<D>{.n = n,
                                                                   .dt = dt,
                                                                   .elastic = m_.state.stage.elastic,
                                                                   .time = m_.state.clock.time + dt,
                                                                   .x = columns.x,
                                                                   .v = columns.v,
                                                                   .L = columns.L,
                                                                   .F = columns.F,
                                                                   .stress = columns.stress,
                                                                   .mass = columns.mass,
                                                                   .volume0 = columns.volume0,
                                                                   .volume = columns.volume,
                                                                   .altitude = {scratch_.altitude, n},
                                                                   .viscous = columns.viscous,
                                                                   .averaged = columns.averaged,
                                                                   .volume_ratio = columns.volume_ratio,
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

  /// Computes the forces of loads at a time, lists the particles that have left their cells or the side of a sheet, and sums the others.
  void deposit(std::size_t key, Index number, const StripColumns<D>& columns, Real time, DepositAt at)
  {
    const std::size_t n = scratch_.runs.back().end;
    find_forces(m_, time, columns, n);
    if (columns.G)
      update_reference(key, strips_.strips(key)[to_size(number)], columns, at);
    find_shares(columns.places(), scratch_);
    if (columns.side)
      find_sides(columns, at);
    auto run = scratch_.runs.begin();
    for (const Index i : scratch_.left) {
      while (static_cast<std::size_t>(i) >= run->end)
        ++run;
      strips_.add_leaver(key, number, columns, i, run->frame->cell, probable_cell(run->frame->cell, static_cast<std::size_t>(i)));
      scratch_.stays[static_cast<std::size_t>(i)] = 0;
      for (Real* const share : scratch_.share)
        share[i] = 0;
    }
    through_.add(columns, n, moved_for_, block_);
    add_surface_loads(strips_.group(key), columns);
  }
  /// Makes the present configuration the reference of a body that is renewed, and finds out whether it will be in the next step.
  void update_reference(std::size_t key, Strip& strip, const StripColumns<D>& columns, DepositAt at)
  {
    const std::size_t body = to_size(strips_.body(key));
    const ReferenceOptions& options = m_.problem.references[body];
    if (at == DepositAt::step && m_.work.renewed[body] != 0)
      renew(columns, to_size(strip.n)), ++strip.arrangement;
    if (options.update == ReferenceUpdate::adaptive && m_.work.due[key] == 0)
      m_.work.due[key] = std::ranges::any_of(
          scratch_.runs, [&](const CellRun<D>& run) { return is_due(options, columns, run.begin, run.end, run.frame->altitude); });
  }
  /// Finds the sides of sheets that particles are on, unless they are known, and lists the particles that change theirs as leavers.
  void find_sides(const StripColumns<D>& columns, DepositAt at)
  {
    const std::size_t cell_leavers = scratch_.left.size();
    for (const CellRun<D>& run : scratch_.runs) {
      const Index cell = run.frame->cell;
      for (std::size_t i = run.begin; i < run.end; ++i) {
        SideOfSheet side(columns.side.of(i));
        if (at == DepositAt::step) {
          side = m_.work.sheets.side(m_.problem.mesh, m_.problem.rigid, m_.state.rigid, cell, columns.x.of(i), side);
          columns.side.set(i, side.number());
        }
        if (side.changes)
          scratch_.left.push_back(static_cast<Index>(i));
      }
    }
    const auto middle = scratch_.left.begin() + static_cast<std::ptrdiff_t>(cell_leavers);
    std::inplace_merge(scratch_.left.begin(), middle, scratch_.left.end());
    scratch_.left.erase(std::unique(scratch_.left.begin(), scratch_.left.end()), scratch_.left.end());
  }
  /// Adds the virtual stress of particles that stay, of a body on whose surface loads act.
  void add_surface_loads(Index group, const StripColumns<D>& columns)
  {
    for (RowsOfLoad<D>& rows : rows_of(group).surfaces.all())
      if (const SurfaceLoad<D>& load = m_.problem.loads.on_surfaces[rows.load]; load.body == strips_.body_of(group))
        through_.add_surface_load(load, columns, block_, rows.blocks);
  }

  /// The cell behind the facet that particle i of a cell has crossed; the same cell if it has crossed none, or one of the boundary.
  Index probable_cell(Index cell, std::size_t i) const noexcept
  {
    const auto lowest = std::min_element(scratch_.share, scratch_.share + D + 1, [&](const Real* a, const Real* b) { return a[i] < b[i]; });
    if (!((*lowest)[i] < 0))
      return cell;
    const Index other = m_.problem.mesh.neighbours(cell)[lowest - scratch_.share];
    return other == none ? cell : other;
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
  std::span<KernelRows<D, K>> fields_;
  Index block_;
  ParticleStrips<D>& strips_;
  StripScratch<D>& scratch_;
  Through through_;
  Real moved_for_;  ///< length of the step with which affine fields are carried to where the particles are [s]
};

}  // namespace talus
