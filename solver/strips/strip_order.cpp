#include "solver/strips/particle_strips.hpp"

#include <algorithm>
#include <cstring>

namespace talus {

/// Particles that stand side by side before and afterwards, or one that comes.
template <int D>
struct ParticleStrips<D>::Run {
  Index from, to, count;
  const Real* arriving;
};

template <int D>
void ParticleStrips<D>::grow(Strip& strip, Index n, std::size_t width)
{
  const Index room = room_for(n);
  Real* const numbers = pool_->take(to_size(room) * width);
  for (std::size_t k = 0; k < width; ++k) {
    Real* const to = numbers + k * to_size(room);
    std::fill(std::copy_n(strip.array(static_cast<Index>(k)), strip.n, to), to + room, 0.0);
  }
  if (strip.room > 0)
    pool_->give_back(strip.numbers, to_size(strip.room) * width);
  strip.numbers = numbers, strip.room = room;
}

/// Moves particles to their new places in an array; `number` is the place of its number in the record of an arrival.
/// Runs are in order before and afterwards, so none is written over if those that move down come first, ascending, then those that move up,
/// descending.
template <int D>
void ParticleStrips<D>::move_runs(std::span<const Run> runs, Real* array, Index number) noexcept
{
  for (const Run& run : runs)
    if (run.to < run.from) {
      const Real* const from = array + run.from;
      Real* const to = array + run.to;
      Index i = 0;
      for (; i + pack_size <= run.count; i += pack_size)
        store_loose(to + i, load_loose(from + i));
      for (; i < run.count; ++i)
        to[i] = from[i];
    }
  for (auto run = runs.rbegin(); run != runs.rend(); ++run)
    if (run->arriving == nullptr && run->to > run->from) {
      const Real* const from = array + run->from;
      Real* const to = array + run->to;
      Index i = run->count;
      for (; i >= pack_size; i -= pack_size)
        store_loose(to + i - pack_size, load_loose(from + i - pack_size));
      for (; i > 0; --i)
        to[i - 1] = from[i - 1];
    }
  for (const Run& run : runs)
    if (run.arriving != nullptr)
      std::memcpy(array + run.to, run.arriving + number, sizeof(Real));
}

template <int D>
void ParticleStrips<D>::order(std::size_t key, Index number)
{
  BlockOfStrips& block = block_[key];
  Strip& strip = block.strips[to_size(number)];
  // Iterators: clang 14 does not know the ranges of this library.
  const auto of_strip = [](const Leavers::Leaver& a, const Leavers::Leaver& b) { return a.strip < b.strip; };
  const auto [first_leaver, last_leaver] =
      std::equal_range(block.left.all.begin(), block.left.all.end(), Leavers::Leaver{number, 0, 0}, of_strip);
  const Index first = first_cell(key, number);
  const auto all_arriving = arriving(key);
  const auto begin = std::ranges::lower_bound(all_arriving, first, {}, &Arrival::cell);
  const auto end = std::ranges::lower_bound(begin, all_arriving.end(), first + strip_cells, {}, &Arrival::cell);
  if (first_leaver == last_leaver && begin == end)
    return;

  static thread_local std::vector<Run> runs;
  runs.clear();
  Index n = 0;
  const auto add = [&](Index from, Index to) {
    if (to <= from)
      return;
    if (!runs.empty() && runs.back().arriving == nullptr && runs.back().from + runs.back().count == from)
      runs.back().count += to - from;
    else
      runs.push_back({from, n, to - from, nullptr});
    n += to - from;
  };
  const Real* const id = strip.array(layout_.step_arrays().id);
  const auto is_less = [](const Real& a, std::int64_t b) { return StripIds::id_of(a) < b; };
  auto leaver = first_leaver;
  auto arrival = begin;
  Index old = 0;
  for (Index c = 0; c < strip_cells; ++c) {
    const Index last = old + strip.count[to_size(c)], before = n;
    while (old < last || (arrival != end && arrival->cell == first + c)) {
      if (old < last && leaver != last_leaver && leaver->position == old) {
        ++old, ++leaver;
        continue;
      }
      const Index limit = leaver != last_leaver ? std::min(leaver->position, last) : last;
      const bool comes = arrival != end && arrival->cell == first + c;
      const Index stop = comes ? static_cast<Index>(std::lower_bound(id + old, id + limit, arrival->id, is_less) - id) : limit;
      add(old, stop);
      old = stop;
      if (comes && (stop < limit || limit == last)) {
        runs.push_back({none, n, 1, arrival->numbers});
        ++n, ++arrival;
      }
    }
    strip.count[to_size(c)] = n - before;
  }
  std::erase_if(runs, [](const Run& run) { return run.from == run.to; });  // they stand where they stood

  if (n + strip_padding > strip.room)
    grow(strip, n, strip_width(key));
  for (Index k = 0; k < layout_.step_arrays().before; ++k)  // what stands behind is about to be written by the step
    move_runs(runs, strip.array(k), k);
  for (Index k = 0; k < history_width(body(key)); ++k)
    move_runs(runs, strip.array(first_of_law() + k), layout_.width() + layout_.gradients() + k);
  strip.n = n;
  if (n == 0 && strip.room > 0) {
    pool_->give_back(strip.numbers, to_size(strip.room) * strip_width(key));
    strip.numbers = nullptr, strip.room = 0;
  }
}

template void ParticleStrips<2>::order(std::size_t, Index);
template void ParticleStrips<3>::order(std::size_t, Index);

}  // namespace talus
