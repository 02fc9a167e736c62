#include "solver/strips/rearrangement.hpp"

#include <array>

namespace talus {

void Rearrangement::plan(Index n, std::span<const Index> leaving, std::span<const Insertion> coming)
{
  coming_ = coming;
  size_ = n + static_cast<Index>(coming.size()) - static_cast<Index>(leaving.size());
  const auto room = static_cast<std::size_t>(padded(size_) + stretch);
  if (from_.size() < room)
    from_.resize(room), down_.resize(room), up_.resize(room), mixed_.resize(room);

  Index at = 0, place = 0;  // in the old order and in the new one
  const auto stay = [&](Index limit) {
    Index* const to = from_.data() + place;
    for (Index i = 0; i < limit - at; i += stretch)
      for (Index k = 0; k < stretch; ++k)
        to[i + k] = at + i + k;
    place += limit - at, at = limit;
  };
  auto next = leaving.begin();
  const auto leave_before = [&](Index limit) {
    for (; next != leaving.end() && *next < limit; ++next)
      stay(*next), ++at;
  };
  for (std::size_t k = 0; k < coming.size(); ++k) {
    leave_before(coming[k].before);
    stay(coming[k].before);
    from_[static_cast<std::size_t>(place++)] = -1 - static_cast<Index>(k);
  }
  leave_before(n);
  stay(n);
  for (Index k = 0; k < pack_size; ++k)  // what stands behind the last particle does not matter
    from_[static_cast<std::size_t>(place + k)] = at + k;

  n_down_ = n_up_ = n_mixed_ = 0;
  for (std::size_t to = 0; to < static_cast<std::size_t>(size_); to += pack_size) {  // no branches: they could not be predicted
    const Index* const from = from_.data() + to;
    const bool in_one = from[0] >= 0 && from[1] == from[0] + 1 && from[2] == from[0] + 2 && from[3] == from[0] + 3;
    down_[n_down_] = up_[n_up_] = {static_cast<std::size_t>(from[0]), to};
    mixed_[n_mixed_] = to;
    n_down_ += in_one & (from[0] > static_cast<Index>(to));
    n_up_ += in_one & (from[0] < static_cast<Index>(to));
    n_mixed_ += !in_one;
  }
}

// Particles keep their order, so none is written over before it has been read: mixed packs are read first and written last; a pack that goes
// down ends in front of what later packs, ascending, and packs that go up read; those that go up are taken descending.
void Rearrangement::move(Real* first, std::size_t room, Index n_arrays, Index number)
{
  const auto arrays = static_cast<std::size_t>(n_arrays);
  saved_.resize(n_mixed_ * arrays * pack_size);
  Real* saved = saved_.data();
  for (const std::size_t to : std::span(mixed_).first(n_mixed_)) {
    std::array<const Real*, pack_size> from;
    std::array<std::size_t, pack_size> step;
    for (std::size_t lane = 0; lane < pack_size; ++lane) {
      const Index place = from_[to + lane];
      from[lane] = place < 0 ? coming_[static_cast<std::size_t>(-1 - place)].numbers + number : first + place;
      step[lane] = place < 0 ? 1 : room;
    }
    for (std::size_t k = 0; k < arrays; ++k, saved += pack_size) {
      store_loose(saved, Pack{*from[0], *from[1], *from[2], *from[3]});
      for (std::size_t lane = 0; lane < pack_size; ++lane)
        from[lane] += step[lane];
    }
  }
  const auto shift = [&](const Shift& one) {
    const Real* from = first + one.from;
    Real* to = first + one.to;
    for (std::size_t k = 0; k < arrays; ++k, from += room, to += room)
      store_loose(to, load_loose(from));
  };
  for (std::size_t i = 0; i < n_down_; ++i)
    shift(down_[i]);
  for (std::size_t i = n_up_; i-- > 0;)
    shift(up_[i]);
  saved = saved_.data();
  for (const std::size_t place : std::span(mixed_).first(n_mixed_)) {
    Real* to = first + place;
    for (std::size_t k = 0; k < arrays; ++k, saved += pack_size, to += room)
      store_loose(to, load_loose(saved));
  }
}

}  // namespace talus
