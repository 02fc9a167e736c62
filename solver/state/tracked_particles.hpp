#pragma once
// The rows of single particles that are tracked by id; they may be deleted or on another rank.
#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/parallel/threads.hpp"
#include "core/types.hpp"

namespace talus {

/// Rows of tracked particles.  Memory is proportional to the number of tracked particles only.
class FollowedRows {
 public:
  FollowedRows() = default;
  /// Ids in any order; repeated ids are allowed.
  explicit FollowedRows(std::vector<std::int64_t> ids) : ids_(std::move(ids))
  {
    std::sort(ids_.begin(), ids_.end());
    ids_.erase(std::unique(ids_.begin(), ids_.end()), ids_.end());
    rows_.assign(ids_.size(), none);
    constexpr std::size_t ids_in_word = 4;  // so that few other ids need a search
    maybe_.assign(ids_.size() / ids_in_word + 1, 0);
    for (const std::int64_t id : ids_)
      maybe_[word_of(id)] |= bit_of(id);
  }

  bool empty() const noexcept { return ids_.empty(); }
  /// To be called after rows have changed; `id` has the id of each row.
  void find(std::span<const std::int64_t> id) noexcept
  {
    std::fill(rows_.begin(), rows_.end(), none);
    if (empty())
      return;
    parallel_for(static_cast<Index>(id.size()), [&](Index row) {
      const std::int64_t here = id[static_cast<std::size_t>(row)];
      if ((maybe_[word_of(here)] & bit_of(here)) != 0)
        if (const std::size_t place = place_of(here); place < ids_.size())
          rows_[place] = row;  // ids are unique: no other thread writes here
    });
  }
  /// The row of a particle; `none` if it is not on this rank or not tracked.
  Index row(std::int64_t id) const noexcept
  {
    const std::size_t place = place_of(id);
    return place < ids_.size() ? rows_[place] : none;
  }

 private:
  static constexpr std::size_t bits_in_word = 64;

  /// The index of an id among the tracked ones; their number if it is not tracked.
  std::size_t place_of(std::int64_t id) const noexcept
  {
    const auto found = std::lower_bound(ids_.begin(), ids_.end(), id);
    return found != ids_.end() && *found == id ? static_cast<std::size_t>(found - ids_.begin()) : ids_.size();
  }
  std::size_t word_of(std::int64_t id) const noexcept { return static_cast<std::uint64_t>(id) / bits_in_word % maybe_.size(); }
  static std::uint64_t bit_of(std::int64_t id) noexcept { return std::uint64_t{1} << (static_cast<std::uint64_t>(id) % bits_in_word); }

  std::vector<std::int64_t> ids_;     // ascending
  std::vector<Index> rows_;           // row of each id
  std::vector<std::uint64_t> maybe_;  // filter: an id whose bit (id modulo the number of bits) is not set is not tracked
};

}  // namespace talus
