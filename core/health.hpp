#pragma once
// What went wrong in a loop over particles: the lowest particle id wins, so the message is the same for any number of threads.
#include <atomic>
#include <cstdint>
#include <limits>
#include <optional>

namespace talus {

enum class Trouble : std::uint8_t {
  lost,        ///< outside the mesh
  inverted,    ///< det F <= 0
  no_answer,   ///< the law returned no finite stress
  not_finite,  ///< position or velocity is NaN or infinite
};

class Health {
 public:
  struct Finding {
    std::int64_t id;
    Trouble trouble;
  };

  Health() = default;
  Health(const Health& other) noexcept : worst_(other.worst_.load()) {}
  Health& operator=(const Health& other) noexcept
  {
    worst_ = other.worst_.load();
    return *this;
  }

  /// Called from any thread; only ever on the way to the end of a run, so its cost does not matter.
  void report(std::int64_t id, Trouble trouble) noexcept
  {
    const std::int64_t word = id * kinds + static_cast<std::int64_t>(trouble);
    std::int64_t seen = worst_.load();
    while (word < seen && !worst_.compare_exchange_weak(seen, word)) {
    }
  }
  std::optional<Finding> worst() const noexcept
  {
    const std::int64_t word = worst_.load();
    if (word == fine)
      return std::nullopt;
    return Finding{word / kinds, static_cast<Trouble>(word % kinds)};
  }
  void clear() noexcept { worst_ = fine; }

 private:
  static constexpr std::int64_t kinds = 4;
  static constexpr std::int64_t fine = std::numeric_limits<std::int64_t>::max();
  std::atomic<std::int64_t> worst_{fine};
};

}  // namespace talus
