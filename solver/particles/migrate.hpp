#pragma once
// Particles that have entered a block of another rank go there, with all that is theirs.
#include <cstring>
#include <span>
#include <vector>

#include "core/parallel/communicator.hpp"
#include "mesh/part.hpp"

namespace talus {

/// A particle in a message: its numbers are columns and history as the two ranks agree.
struct MigratingParticle {
  struct Head {
    Index body, whole_cell;  ///< a cell of the whole mesh
  } head;
  const Real* numbers;
};

/// Of a rank alone there are no neighbours.
template <int D>
class Migration {
 public:
  Migration() = default;
  Migration(Communicator& ranks, const Subdomain& subdomain);

  /// Adds a particle that goes to the owner of a block to the message for that rank.
  void add(const MigratingParticle::Head& head, Index block, std::span<const Real> numbers);
  /// Sends all that has been added; returns what comes, valid until the next call.  width(body): how many numbers a particle of it has.
  /// Neighbours have to call alike.
  template <class F>
  const std::vector<MigratingParticle>& exchange(F&& width)
  {
    receive();
    came_.clear();
    for (const std::vector<Real>& message : in_)
      for (std::size_t at = 0; at < message.size();) {
        MigratingParticle one{{}, message.data() + at + 1};
        std::memcpy(&one.head, message.data() + at, sizeof(one.head));
        came_.push_back(one);
        at += 1 + static_cast<std::size_t>(width(one.head.body));
      }
    moved_ += static_cast<std::int64_t>(came_.size());
    return came_;
  }
  /// Particles that came or went so far.
  std::int64_t moved() const noexcept { return moved_; }
  /// Goes on with the count of another model.
  void count_from(std::int64_t moved) noexcept { moved_ = moved; }

 private:
  void receive();

  Communicator* ranks_ = nullptr;
  std::vector<int> neighbours_;         // ranks, ascending
  std::vector<Index> border_of_block_;  // local block -> number of its rank among the neighbours
  std::vector<std::vector<std::byte>> out_;
  std::vector<std::vector<Real>> in_;  // messages of exchange()
  std::vector<MigratingParticle> came_;
  std::int64_t moved_ = 0;
};

extern template class Migration<2>;
extern template class Migration<3>;

}  // namespace talus
