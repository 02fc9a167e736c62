#pragma once
// Puts the particles of a strip in their new places: some have left, others come.
#include <span>
#include <vector>

#include "core/simd.hpp"

namespace talus {

/// A particle that comes to a strip: in front of the one that stands at place `before`, with its numbers one after the other.
struct Insertion {
  Index before;
  const Real* numbers;
};

/// The way of all particles of a strip to their new places: found once, it is taken by each array of the strip in turn.
///
/// Places are looked at in packs.  A pack whose particles stand side by side before and afterwards is one load and one store.  The packs
/// where particles leave or come are put together number by number.
class Rearrangement {
 public:
  /// Of n particles those at the places `leaving`, ascending, leave; `coming`, which move() still reads, are in their new order.
  void plan(Index n, std::span<const Index> leaving, std::span<const Insertion> coming);
  /// The particles that a strip will have.
  Index size() const noexcept { return size_; }
  /// Moves the numbers in so many arrays, which begin every `room` numbers from `first` on and have pack_size - 1 numbers more than
  /// particles, before and afterwards.  `number`: the place of the number of the first of them among those of a particle that comes.
  void move(Real* first, std::size_t room, Index arrays, Index number);

 private:
  /// A pack goes from place `from` to place `to`.
  struct Shift {
    std::size_t from, to;
  };
  /// Places are written so many at a time.
  static constexpr Index stretch = 8;

  std::span<const Insertion> coming_;
  Index size_ = 0;
  std::vector<Index> from_;         ///< the place from which each particle comes; -1 - k: it is coming[k]
  std::vector<Shift> down_, up_;    ///< packs that go to lower and to higher places, ascending
  std::vector<std::size_t> mixed_;  ///< places of packs of particles that stand apart or come
  std::size_t n_down_ = 0, n_up_ = 0, n_mixed_ = 0;
  std::vector<Real> saved_;
};

}  // namespace talus
