#pragma once
// A tree of bounding boxes over items that are sorted along a space-filling curve, to find the items at a point and the nearest item.
// Every box covers four consecutive items, every box of the next level four boxes; the order of the items determines the tree.  Unlike a
// grid of bins it does not depend on similar sizes of the items.
#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

#include "core/types.hpp"

namespace talus {

template <int D>
struct Extent {
  Vec<D> low = Vec<D>::Constant(std::numeric_limits<Real>::infinity());
  Vec<D> high = Vec<D>::Constant(-std::numeric_limits<Real>::infinity());
  void take(const Extent& other) noexcept
  {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
  void take(const Vec<D>& x) noexcept
  {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  bool meets(const Extent& other) const noexcept
  {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }
  bool holds(const Vec<D>& x) const noexcept { return (x.array() >= low.array()).all() && (x.array() <= high.array()).all(); }
  Real squared_distance(const Vec<D>& x) const noexcept { return (low - x).cwiseMax(x - high).cwiseMax(0).squaredNorm(); }
};

template <int D>
class BoxTree {
 public:
  /// Builds the tree; box_of(i) returns the box of item i, 0 <= i < n.
  template <class BoxOf>
  BoxTree(Index n, BoxOf&& box_of) : n_items_(n)
  {
    levels_.emplace_back((n + fan - 1) / fan);
    for (Index i = 0; i < n; ++i)
      levels_[0][i / fan].take(box_of(i));
    while (levels_.back().size() > 1) {
      const std::vector<Extent<D>>& below = levels_.back();
      std::vector<Extent<D>> level((below.size() + fan - 1) / fan);
      for (std::size_t i = 0; i < below.size(); ++i)
        level[i / fan].take(below[i]);
      levels_.push_back(std::move(level));
    }
  }

  /// Calls visit(i), ascending, for the items of every lowest box that contains x, until visit returns true.
  template <class Visit>
  void around(const Vec<D>& x, Visit&& visit) const noexcept
  {
    where([&](const Extent<D>& box) { return box.holds(x); }, visit);
  }
  /// Calls visit(i), ascending, for the items of every lowest box that meets the other box, until visit returns true.
  template <class Visit>
  void around(const Extent<D>& other, Visit&& visit) const noexcept
  {
    where([&](const Extent<D>& box) { return box.meets(other); }, visit);
  }

  /// The item with the smallest squared_distance(i), the lowest of equals.  The tree must not be empty.
  template <class SquaredDistance>
  Index nearest(const Vec<D>& x, SquaredDistance&& squared_distance) const noexcept
  {
    Index best = 0;
    Real least = std::numeric_limits<Real>::infinity();
    Stack stack;
    stack.push(top(), 0);
    while (!stack.empty()) {
      const auto [level, i] = stack.pop();
      if (!(levels_[level][i].squared_distance(x) <= least))
        continue;
      const Index first = i * fan, last = std::min(first + fan, level == 0 ? n_items_ : size_of(level - 1));
      if (level == 0) {
        for (Index item = first; item < last; ++item) {
          const Real distance = squared_distance(item);
          if (distance < least || (distance == least && item < best)) {
            least = distance;
            best = item;
          }
        }
      } else {
        push_nearest_last(stack, level - 1, first, last, x);
      }
    }
    return best;
  }

 private:
  static constexpr Index fan = 4;
  struct Stack {
    std::array<std::pair<Index, Index>, 64> entry;  // 16 levels hold 4^16 > 2^31 items; each level leaves at most 3 entries
    int size = 0;
    bool empty() const noexcept { return size == 0; }
    void push(Index level, Index i) noexcept { entry[size++] = {level, i}; }
    std::pair<Index, Index> pop() noexcept { return entry[--size]; }
  };
  Index top() const noexcept { return static_cast<Index>(levels_.size()) - 1; }
  Index size_of(Index level) const noexcept { return static_cast<Index>(levels_[level].size()); }

  /// Calls visit(i), ascending, for the items of every lowest box for which, and for all boxes above it, `wanted` is true, until visit
  /// returns true.
  template <class Wanted, class Visit>
  void where(Wanted&& wanted, Visit&& visit) const noexcept
  {
    Stack stack;
    if (n_items_ > 0)
      stack.push(top(), 0);
    while (!stack.empty()) {
      const auto [level, i] = stack.pop();
      if (!wanted(levels_[level][i]))
        continue;
      const Index first = i * fan, last = std::min(first + fan, level == 0 ? n_items_ : size_of(level - 1));
      if (level == 0) {
        for (Index item = first; item < last; ++item)
          if (visit(item))
            return;
      } else {
        for (Index child = last; child-- > first;)
          stack.push(level - 1, child);
      }
    }
  }

  void push_nearest_last(Stack& stack, Index level, Index first, Index last, const Vec<D>& x) const noexcept
  {
    std::array<std::pair<Real, Index>, fan> children;
    const Index n = last - first;
    for (Index i = 0; i < n; ++i) {
      children[i] = {levels_[level][first + i].squared_distance(x), first + i};
      for (Index j = i; j > 0 && children[j] < children[j - 1]; --j)
        std::swap(children[j], children[j - 1]);
    }
    for (Index i = n; i-- > 0;)
      stack.push(level, children[i].second);
  }

  Index n_items_;
  std::vector<std::vector<Extent<D>>> levels_;
};

}  // namespace talus
