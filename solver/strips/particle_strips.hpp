#pragma once
// All particles of a rank in strips.
#include <array>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "core/huge_page_allocator.hpp"
#include "core/parallel/threads.hpp"
#include "materials/interface/material.hpp"
#include "mesh/locate.hpp"
#include "mesh/part.hpp"
#include "solver/particles/migrate.hpp"
#include "solver/particles/removal.hpp"
#include "solver/state/cell_order.hpp"
#include "solver/state/sums.hpp"
#include "solver/strips/rearrangement.hpp"
#include "solver/strips/side_of_sheet.hpp"
#include "solver/strips/strip.hpp"

namespace talus {

/// The particles between load() and store().  A key is the number of a group of particles and a block of cells.  Each body is a group, with
/// the number of the body; where sheets part velocities, groups of the particles of each body behind sheets follow.
///
/// A step moves the particles, and lists those that have left their cell.  They stay where they are in the strip until the next step has
/// found their new cells: order() then puts them there.  So the strips between two steps follow from the particles alone, and a run that
/// goes on from a checkpoint has the same ones.
template <int D>
class ParticleStrips {
 public:
  /// Takes the particles over; their columns and histories are empty afterwards.  Sorts them by cell.  Strips hold gradients only if
  /// `keep_gradients`.  Collective.
  void load(Communicator& ranks, Index n_cells, bool keep_gradients, const std::vector<Body>& bodies, std::vector<Material>& materials,
            Particles<D>& particles, CellOrder& order);
  /// Writes the particles into columns, sorted by cell; the strips keep them too.  Where they do not hold gradients,
  /// find_gradients(key, strip, columns) sets L and C to arrays of those of the particles of a strip; called by several threads.
  using FindGradients = std::function<void(std::size_t key, Index strip, StripColumns<D>& columns)>;
  void store(std::vector<Body>& bodies, std::vector<Material>& materials, Particles<D>& particles, CellOrder& order,
             const FindGradients& find_gradients) const;

  /// Empties the columns and histories, as load() does.
  static void clear(std::vector<Material>& materials, Particles<D>& particles, CellOrder& order);

  std::size_t key(Index group, Index block) const noexcept
  {
    return static_cast<std::size_t>(group) * static_cast<std::size_t>(blocks_) + static_cast<std::size_t>(block);
  }
  std::size_t keys() const noexcept { return block_.size(); }
  Index blocks() const noexcept { return blocks_; }
  /// Groups; all of them, those in front of sheets being bodies.
  Index groups() const noexcept { return sides_ * bodies(); }
  Index group(std::size_t key) const noexcept { return static_cast<Index>(key / to_size(blocks_)); }
  Index group_of(Index body, bool behind) const noexcept { return behind ? bodies() + body : body; }
  bool is_behind(Index group) const noexcept { return group >= bodies(); }
  /// The body of a group, or of a key.
  Index body_of(Index group) const noexcept { return is_behind(group) ? group - bodies() : group; }
  Index body(std::size_t key) const noexcept { return body_of(group(key)); }
  /// The group that a particle that leaves goes to; its numbers are those of a record, see Arrival.
  Index new_group(Index body, const Real* record) const noexcept
  {
    return sides_ == 1 ? body : group_of(body, SideOfSheet(record[layout_.step_arrays().side]).behind);
  }
  /// Calls f(key) for each group of a body in a block, the one in front first.
  template <class F>
  void for_each_key_of(Index body, Index block, F&& f) const
  {
    for (Index side = 0; side < sides_; ++side)
      f(key(group_of(body, side != 0), block));
  }
  Index size() const noexcept;
  /// The bytes that a step must read and write of the particles: each number that changes twice, mass, initial volume, id and start
  /// position once.
  std::size_t bytes_moved() const noexcept;
  /// The memory of the strips [B].
  std::size_t bytes() const noexcept { return memory_.size() * sizeof(Real) + pool_->bytes(); }

  /// The strips of a group in a block; none where it has no particles.
  std::span<Strip> strips(std::size_t key) noexcept { return block_[key].strips; }
  std::span<const Strip> strips(std::size_t key) const noexcept { return block_[key].strips; }
  /// Without gradients, unless strips keep them or those that were loaded still hold.
  StripColumns<D> columns(const Strip& strip) const noexcept;
  /// The same of an array of records, see Arrival: with gradients.
  StripColumns<D> columns_of_records(const Strip& records) const noexcept;
  /// Frees the gradients that load() has taken over; to be called when nodes move the particles, as gradients then follow from the nodes.
  void drop_loaded_gradients() noexcept;
  /// component(k) is the array of number k of the history of the law.
  StripColumn<Real> history(const Strip& strip) const noexcept { return {strip.array(first_of_law()), to_size(strip.room)}; }
  Index history_width(Index body) const noexcept { return history_width_[static_cast<std::size_t>(body)]; }
  const StripLayout& layout() const noexcept { return layout_; }
  /// The memory of a strip.
  std::span<const Real> memory(std::size_t key, const Strip& strip) const noexcept
  {
    return {strip.numbers, static_cast<std::size_t>(strip.room) * strip_width(key)};
  }
  /// The memory of the strip that a thread visits next: of the block, of this body or the next, then of the block that it probably takes
  /// next, as it was before the blocks were visited; empty if there is none.  Strips of other blocks may be changing.
  std::span<const Real> memory_of_next(std::size_t key, Index strip) const noexcept
  {
    const std::size_t next = to_size(strip) + 1, of_next_body = key + to_size(blocks_);
    if (next < block_[key].strips.size())
      return memory(key, block_[key].strips[next]);
    if (of_next_body < block_.size() && !block_[of_next_body].strips.empty())
      return memory(of_next_body, block_[of_next_body].strips.front());
    const std::size_t of_next_block = key % to_size(blocks_) + to_size(threads());
    return of_next_block < first_memory_.size() ? first_memory_[of_next_block] : std::span<const Real>();
  }
  /// The first cell of a strip.
  Index first_cell(std::size_t key, Index strip) const noexcept
  {
    return static_cast<Index>(key % static_cast<std::size_t>(blocks_)) * block_cells + strip * strip_cells;
  }

  /// Lists particle i of a strip, in this cell, as one that leaves, probably to cell `to`; to be called in the order of strips and
  /// positions.  `columns` are those of the strip, with gradients.
  void add_leaver(std::size_t key, Index strip, const StripColumns<D>& columns, Index i, Index cell, Index to);
  /// Finds the new cells of the particles of a key that leave, once all are listed, and lists those that stay in the block, for each group of
  /// the body that they come to.
  void find_cells(const Mesh<D>& mesh, const Locator<D>& locator, std::size_t key, std::array<std::vector<Arrival>, 2>& within);
  /// The particles of a key, and how many they will be once its strips are in order.
  Index size(std::size_t key) const noexcept;
  Index size_in_order(std::size_t key) const noexcept;
  /// The particles that come to its cells, in the order of cells and ids.
  std::span<const Arrival> arriving(std::size_t key) const noexcept
  {
    return std::span(arrivals_).subspan(block_[key].first_arrival, block_[key].arrivals);
  }

  /// A particle outside the mesh behind a closed facet is set back onto it; others are deleted or reported lost, as `exits` says.  Mass,
  /// momentum and energy of deleted particles are added to `sums`.  set_forces(columns) computes the forces of loads on a particle that was
  /// set back, the only one of `columns`, at its new position.
  using SetForces = std::function<void(const StripColumns<D>& columns)>;
  void take_exits(const Mesh<D>& mesh, const Locator<D>& locator, const Exits& exits, const std::vector<Material>& materials,
                  const SetForces& set_forces, StepSums<D>& sums, ParticleErrors& errors);
  /// Makes arrivals of the particles that leave, of this rank and of others.  Collective.
  void send_leavers(const Subdomain& subdomain, Migration<D>& migration);
  /// Puts a strip in order: without those who have left, with those who come.
  void order(std::size_t key, Index strip);

 private:
  struct BlockOfStrips {
    std::vector<Strip> strips;
    Leavers leaving;  ///< since the last call of send_leavers()
    Leavers left;     ///< those before, whose places order() gives to others
    std::size_t first_arrival = 0, arrivals = 0;
    /// The first of those that have left each strip, and the first that come, in their order; one more at the end.
    std::array<Index, strips_in_block + 1> first_left{}, first_coming{};
  };
  static std::span<const Leavers::Leaver> left(const BlockOfStrips& block, Index strip) noexcept
  {
    const auto s = to_size(strip);
    return std::span(block.left.all).subspan(to_size(block.first_left[s]), to_size(block.first_left[s + 1] - block.first_left[s]));
  }
  std::span<const Arrival> coming(const BlockOfStrips& block, Index strip) const noexcept
  {
    const auto s = to_size(strip), first = block.first_arrival + to_size(block.first_coming[s]);
    return std::span(arrivals_).subspan(first, to_size(block.first_coming[s + 1] - block.first_coming[s]));
  }

  Index bodies() const noexcept { return static_cast<Index>(history_width_.size()); }
  std::size_t key_of(Index group, Index cell) const noexcept { return key(group, cell / block_cells); }
  /// Numbers of a record: those of the layout, gradients, those of the law.
  std::size_t record_width(std::size_t key) const noexcept
  {
    return to_size(layout_.width() + layout_.gradients() + history_width(body(key)));
  }
  /// Numbers of a particle in its strip, and the first of them of its law.
  std::size_t strip_width(std::size_t key) const noexcept { return to_size(first_of_law() + history_width(body(key))); }
  Index first_of_law() const noexcept { return layout_.width() + layout_.kept_gradients(); }
  void set_gradients(Real* first, std::size_t stride, StripColumns<D>& columns) const noexcept;
  void grow(Strip& strip, Index n, std::size_t width);
  void sort_arrivals();

  StripLayout layout_;
  std::vector<Index> history_width_;
  Index blocks_ = 0, sides_ = 1;
  std::vector<BlockOfStrips> block_;  ///< one per key
  Rows<Real> memory_;                 ///< of the strips at the beginning
  Rows<Real> loaded_gradients_;
  std::unique_ptr<StripMemory> pool_ = std::make_unique<StripMemory>();  ///< of those that have grown

  std::vector<std::span<const Real>> first_memory_;        ///< of the first strip of each block, before the last call of send_leavers()
  std::vector<std::pair<std::size_t, Arrival>> unsorted_;  ///< with their keys
  std::vector<Arrival> arrivals_;
};

/// The totals over all ranks, bitwise identical to those of particles in columns.  Collective.
template <int D>
Totals<D> totals(const ParticleStrips<D>& strips, Communicator& ranks);

}  // namespace talus
