#pragma once
// Particles that have entered a block of another rank go there, with all that is theirs.
#include "core/parallel/communicator.hpp"
#include "materials/interface/material.hpp"
#include "mesh/part.hpp"
#include "solver/state/cell_order.hpp"

namespace talus {

/// Of a rank alone there are no neighbours.
template <int D>
class Migration {
 public:
  Migration() = default;
  Migration(Communicator& ranks, const Subdomain& subdomain);

  /// Columns that some rank keeps are kept by all: one that has no particles yet cannot tell.  Once, every rank has to.
  void agree_on_columns(const Particles<D>& particles);
  /// `order` is that of the cells, those of other ranks included; so it is afterwards, without them.  Neighbours have to ask alike.
  /// True if rows changed place.
  bool operator()(const Subdomain& subdomain, std::vector<Body>& bodies, std::vector<Material>& materials, Particles<D>& particles,
                  CellOrder& order);
  /// Particles that came or went so far.
  std::int64_t moved() const noexcept { return moved_; }
  /// Goes on with the count of another model.
  void count_from(std::int64_t moved) noexcept { moved_ = moved; }

 private:
  Communicator* ranks_ = nullptr;
  std::vector<int> neighbours_;         // ranks, ascending
  std::vector<Index> foreign_;          // local blocks of others
  std::vector<Index> border_of_block_;  // local block -> number of its rank among the neighbours
  std::vector<std::vector<std::byte>> out_;
  std::vector<std::int64_t> keepers_;  // how many ranks keep each column
  std::int64_t moved_ = 0;
};

extern template class Migration<2>;
extern template class Migration<3>;

}  // namespace talus
