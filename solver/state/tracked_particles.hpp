#pragma once
// Where single particles stand that somebody follows by their ids: some of many, that may be gone or on another rank.
#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/parallel/threads.hpp"
#include "core/types.hpp"

namespace talus {

/// Costs nothing where nobody is followed, and room for those alone who are.
class FollowedRows {
 public:
  FollowedRows() = default;
  /// Ids in any order; an id may come more than once.
  explicit FollowedRows(std::vector<std::int64_t> ids) : ids_(std::move(ids))
  {
    std::sort(ids_.begin(), ids_.end());
    ids_.erase(std::unique(ids_.begin(), ids_.end()), ids_.end());
    rows_.assign(ids_.size(), none);
    constexpr std::size_t ids_in_word = 4;  // so that few others are searched for
    maybe_.assign(ids_.size() / ids_in_word + 1, 0);
    for (const std::int64_t id : ids_)
      maybe_[word_of(id)] |= bit_of(id);
  }

  bool empty() const noexcept { return ids_.empty(); }
  /// To be called when rows have changed; `id` is that of each row.
  void find(std::span<const std::int64_t> id) noexcept
  {
    std::fill(rows_.begin(), rows_.end(), none);
    if (empty())
      return;
    parallel_for(static_cast<Index>(id.size()), [&](Index row) {
      const std::int64_t here = id[static_cast<std::size_t>(row)];
      if ((maybe_[word_of(here)] & bit_of(here)) != 0)
        if (const std::size_t place = place_of(here); place < ids_.size())
          rows_[place] = row;  // ids are unique: nobody else writes here
    });
  }
  /// `none` if the particle is not here; also if nobody follows it.
  Index row(std::int64_t id) const noexcept
  {
    const std::size_t place = place_of(id);
    return place < ids_.size() ? rows_[place] : none;
  }

 private:
  static constexpr std::size_t bits_in_word = 64;

  /// Of an id among those that are followed; their number if it is not.
  std::size_t place_of(std::int64_t id) const noexcept
  {
    const auto found = std::lower_bound(ids_.begin(), ids_.end(), id);
    return found != ids_.end() && *found == id ? static_cast<std::size_t>(found - ids_.begin()) : ids_.size();
  }
  std::size_t word_of(std::int64_t id) const noexcept { return static_cast<std::uint64_t>(id) / bits_in_word % maybe_.size(); }
  static std::uint64_t bit_of(std::int64_t id) noexcept { return std::uint64_t{1} << (static_cast<std::uint64_t>(id) % bits_in_word); }

  std::vector<std::int64_t> ids_;     // ascending
  std::vector<Index> rows_;           // of each id
  std::vector<std::uint64_t> maybe_;  // an id whose bit is not set, the ids taken modulo the number of bits, is not among them
};

}  // namespace talus
