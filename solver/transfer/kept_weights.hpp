#pragma once
// Weights of particles whose places do not change: computed once, read until the strip or its reference is renewed.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/kernel.hpp"

namespace talus {

/// What a pass over a strip does with the weights of its particles.
enum class KeptUse : std::uint8_t { compute, keep, read };

/// grad w_v of one particle, for the first nodes [1/m].
template <int D, int N>
struct LaneSlopes {
  alignas(64) Real dw[D][N];
};

/// The weights of the particles of one strip, pack by pack in the order of its runs.
template <int D, int N>
class KeptWeights {
 public:
  /// Begins a pass over a strip in this arrangement, see Strip; weights that it has can be kept only if `all_stay` where they are.
  KeptUse begin(Index arrangement, std::size_t runs, bool all_stay)
  {
    if (arrangement == arrangement_)
      return KeptUse::read;
    arrangement_ = none;
    if (!all_stay)
      return KeptUse::compute;
    numbers_.clear(), lanes_.clear(), first_.assign(runs, {});
    return KeptUse::keep;
  }
  /// The pass has kept all weights.
  void end(Index arrangement) noexcept { arrangement_ = arrangement; }

  void begin_run(KeptUse use, std::size_t run) noexcept
  {
    if (use == KeptUse::keep)
      first_[run] = {numbers_.size(), lanes_.size()};
    at_ = use == KeptUse::read ? first_[run] : Place{};
  }

  /// Appends the weights of up to four particles and, unless null, the slopes of each lane.
  template <class Cell>
  void keep(const Cell& cell, int count, const Weights<D, N>& weights, const LaneSlopes<D, N>* slopes)
  {
    append(weights.value);
    for (int d = 0; d < D; ++d)
      append(weights.slope[d]), append(weights.shift[d]);
    for (const Pack& entry : weights.H.entry)
      append(entry);
    for (int lane = 0; lane < count; ++lane) {
      Lane& of = lanes_.emplace_back();
      of.size = weights.padded_size[lane];
      for (int d = 0; d < D; ++d)
        of.y[static_cast<std::size_t>(d)] = reinterpret_cast<const char*>(weights.y[lane][d]) - reinterpret_cast<const char*>(&cell);
      numbers_.insert(numbers_.end(), weights.s[lane], weights.s[lane] + of.size);
      if (slopes != nullptr)
        for (const auto& slope : slopes[lane].dw)
          numbers_.insert(numbers_.end(), slope, slope + of.size);
    }
  }
  template <class Cell>
  void read(const Cell& cell, int count, Weights<D, N>& weights, LaneSlopes<D, N>* slopes) noexcept
  {
    const Real* next = numbers_.data() + at_.number;
    const auto take = [&](Pack& pack) { pack = load_loose(next), next += pack_size; };
    take(weights.value);
    for (int d = 0; d < D; ++d)
      take(weights.slope[d]), take(weights.shift[d]);
    for (Pack& entry : weights.H.entry)
      take(entry);
    for (int lane = 0; lane < count; ++lane) {
      const Lane& of = lanes_[at_.lane++];
      weights.padded_size[lane] = of.size;
      for (int d = 0; d < D; ++d)
        weights.y[lane][d] = reinterpret_cast<const Real*>(reinterpret_cast<const char*>(&cell) + of.y[static_cast<std::size_t>(d)]);
      const auto take_nodes = [&](Real* to) { std::copy_n(next, of.size, to), next += of.size; };
      take_nodes(weights.s[lane]);
      if (slopes != nullptr)
        for (auto& slope : slopes[lane].dw)
          take_nodes(slope);
    }
    at_.number = static_cast<std::size_t>(next - numbers_.data());
  }
  std::size_t bytes() const noexcept { return numbers_.size() * sizeof(Real) + lanes_.size() * sizeof(Lane); }

 private:
  struct Place {
    std::size_t number = 0, lane = 0;
  };
  /// Nodes with weight, and where in the open cell the numbers y of Weights are [B].
  struct Lane {
    int size;
    std::array<std::ptrdiff_t, D> y;
  };
  void append(const Pack& pack)
  {
    for (int lane = 0; lane < pack_size; ++lane)
      numbers_.push_back(pack[lane]);
  }

  Index arrangement_ = none;
  std::vector<Real> numbers_;
  std::vector<Lane> lanes_;
  std::vector<Place> first_;
  Place at_;
};

}  // namespace talus
