#pragma once
// Ids of single particles that a scene tracks, to be recognised among all particles.
#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace talus {

/// Memory is proportional to the number of tracked particles only.
class TrackedIds {
 public:
  TrackedIds() = default;
  /// Ids in any order; repeated ids are allowed.
  explicit TrackedIds(std::vector<std::int64_t> ids) : ids_(std::move(ids))
  {
    std::sort(ids_.begin(), ids_.end());
    ids_.erase(std::unique(ids_.begin(), ids_.end()), ids_.end());
    constexpr std::size_t ids_in_word = 4;  // so that few other ids need a search
    maybe_.assign(ids_.size() / ids_in_word + 1, 0);
    for (const std::int64_t id : ids_)
      maybe_[word_of(id)] |= bit_of(id);
  }

  bool empty() const noexcept { return ids_.empty(); }
  std::size_t size() const noexcept { return ids_.size(); }
  /// The number of an id among the tracked ones, ascending; nothing if it is not tracked.
  std::optional<std::size_t> place(std::int64_t id) const noexcept
  {
    if (empty() || (maybe_[word_of(id)] & bit_of(id)) == 0)
      return std::nullopt;
    const auto found = std::lower_bound(ids_.begin(), ids_.end(), id);
    if (found == ids_.end() || *found != id)
      return std::nullopt;
    return static_cast<std::size_t>(found - ids_.begin());
  }

 private:
  static constexpr std::size_t bits_in_word = 64;

  std::size_t word_of(std::int64_t id) const noexcept { return static_cast<std::uint64_t>(id) / bits_in_word % maybe_.size(); }
  static std::uint64_t bit_of(std::int64_t id) noexcept { return std::uint64_t{1} << (static_cast<std::uint64_t>(id) % bits_in_word); }

  std::vector<std::int64_t> ids_;     // ascending
  std::vector<std::uint64_t> maybe_;  // filter: an id whose bit (id modulo the number of bits) is not set is not tracked
};

}  // namespace talus
