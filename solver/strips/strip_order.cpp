#include "solver/strips/particle_strips.hpp"

#include <algorithm>

namespace talus {

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

template <int D>
void ParticleStrips<D>::order(std::size_t key, Index number)
{
  const BlockOfStrips& block = block_[key];
  const auto leavers = left(block, number);
  const auto arrivals = coming(block, number);
  if (leavers.empty() && arrivals.empty())
    return;

  Strip& strip = block_[key].strips[to_size(number)];
  const Index first = first_cell(key, number);
  static thread_local std::vector<Index> leaving;
  static thread_local std::vector<Insertion> coming_here;
  static thread_local Rearrangement rearrangement;
  leaving.clear(), coming_here.clear();
  const Real* const id = strip.array(layout_.step_arrays().id);
  const auto is_less = [](const Real& a, std::int64_t b) { return StripIds::id_of(a) < b; };
  Index begin = 0, c = 0;
  for (const Arrival& arrival : arrivals) {
    for (; first + c < arrival.cell; ++c)
      begin += strip.count[to_size(c)];
    const Real* const of_cell = id + begin;
    coming_here.push_back(
        {static_cast<Index>(std::lower_bound(of_cell, of_cell + strip.count[to_size(c)], arrival.id, is_less) - id), arrival.numbers});
  }
  for (const Leavers::Leaver& leaver : leavers) {
    leaving.push_back(leaver.position);
    --strip.count[to_size(leaver.cell - first)];
  }
  for (const Arrival& arrival : arrivals)
    ++strip.count[to_size(arrival.cell - first)];
  rearrangement.plan(strip.n, leaving, coming_here);

  const Index n = rearrangement.size();
  if (n + strip_padding > strip.room)
    grow(strip, n, strip_width(key));
  const std::size_t room = to_size(strip.room);
  rearrangement.move(strip.numbers, room, layout_.step_arrays().before, 0);  // the step is about to write the other arrays of the layout
  rearrangement.move(strip.array(first_of_law()), room, history_width(body(key)), layout_.width() + layout_.gradients());
  strip.n = n;
  ++strip.arrangement;
  if (n == 0 && strip.room > 0) {
    pool_->give_back(strip.numbers, room * strip_width(key));
    strip.numbers = nullptr, strip.room = 0;
  }
}

template void ParticleStrips<2>::order(std::size_t, Index);
template void ParticleStrips<3>::order(std::size_t, Index);

}  // namespace talus
