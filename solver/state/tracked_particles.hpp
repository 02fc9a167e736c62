#pragma once
// The rows of single particles that are tracked by id; they may be deleted or on another rank.
#include <algorithm>
#include <cstdint>
#include <optional>
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
      if (const auto tracked = place(here))
        rows_[*tracked] = row;  // ids are unique: no other thread writes here
    });
  }
  std::size_t size() const noexcept { return ids_.size(); }
  /// The number of an id among the tracked ones; nothing if it is not tracked.
  std::optional<std::size_t> place(std::int64_t id) const noexcept
  {
    if (empty() || (maybe_[word_of(id)] & bit_of(id)) == 0)
      return std::nullopt;
    const auto found = std::lower_bound(ids_.begin(), ids_.end(), id);
    if (found == ids_.end() || *found != id)
      return std::nullopt;
    return static_cast<std::size_t>(found - ids_.begin());
  }
  /// The row of a particle; `none` if it is not on this rank or not tracked.
  Index row(std::int64_t id) const noexcept
  {
    const auto tracked = place(id);
    return tracked ? rows_[*tracked] : none;
  }

 private:
  static constexpr std::size_t bits_in_word = 64;

  std::size_t word_of(std::int64_t id) const noexcept { return static_cast<std::uint64_t>(id) / bits_in_word % maybe_.size(); }
  static std::uint64_t bit_of(std::int64_t id) noexcept { return std::uint64_t{1} << (static_cast<std::uint64_t>(id) % bits_in_word); }

  std::vector<std::int64_t> ids_;     // ascending
  std::vector<Index> rows_;           // row of each id
  std::vector<std::uint64_t> maybe_;  // filter: an id whose bit (id modulo the number of bits) is not set is not tracked
};

}  // namespace talus
