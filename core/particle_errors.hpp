#pragma once
// Errors in a loop over particles.  The worst kind is reported, of the particle with the lowest id, so that the message does not depend on
// the number of threads.
#include <atomic>
#include <cstdint>
#include <limits>
#include <optional>

namespace talus {

/// Kinds of errors.  Causes come before their possible consequences in the same step: the averaging of volumes passes one inverted particle
/// on to its neighbours.
enum class Trouble : std::uint8_t {
  lost,        ///< outside the mesh
  inverted,    ///< det F <= 0
  not_finite,  ///< position, velocity or deformation is NaN or infinite
  no_answer,   ///< the law returned no finite stress
};

class ParticleErrors {
 public:
  struct Finding {
    std::int64_t id;
    Trouble trouble;
  };

  ParticleErrors() = default;
  ParticleErrors(const ParticleErrors& other) noexcept : worst_(other.worst_.load()) {}
  ParticleErrors& operator=(const ParticleErrors& other) noexcept
  {
    worst_ = other.worst_.load();
    return *this;
  }

  /// Records an error.  May be called from any thread; it is called only when a run is about to end, so its cost does not matter.
  void report(std::int64_t id, Trouble trouble) noexcept
  {
    const std::int64_t word = static_cast<std::int64_t>(trouble) * ids + id;
    std::int64_t seen = worst_.load();
    while (word < seen && !worst_.compare_exchange_weak(seen, word)) {
    }
  }
  std::optional<Finding> worst() const noexcept
  {
    const std::int64_t word = worst_.load();
    if (word == fine)
      return std::nullopt;
    return Finding{word % ids, static_cast<Trouble>(word / ids)};
  }
  void clear() noexcept { worst_ = fine; }
  /// The worst error as a number, smaller being worse, for a minimum over ranks.
  std::int64_t word() const noexcept { return worst_.load(); }
  void take(std::int64_t word) noexcept { worst_ = word; }

 private:
  static constexpr std::int64_t ids = std::int64_t{1} << 60;
  static constexpr std::int64_t fine = std::numeric_limits<std::int64_t>::max();
  std::atomic<std::int64_t> worst_{fine};
};

}  // namespace talus
