#pragma once
// Stress against jumps of gradients in cells that have no particles.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <tuple>
#include <vector>

#include "core/fields.hpp"
#include "core/parallel/communicator.hpp"
#include "core/types.hpp"
#include "mesh/part.hpp"

namespace talus {

/// The stress q [Pa] of the cells beside the surface that have no particles, see JumpForces: it supports nodes beyond the surface.  A rank
/// has the cells of its part; what it may have of others is out of date.
template <int D>
class EmptyCellStress {
 public:
  bool empty() const noexcept { return cell_.empty(); }
  void clear() noexcept { cell_.clear(), stress_.clear(); }
  /// Adds a cell, by its number in the whole mesh, behind those with lower numbers.
  void add(std::int64_t whole, const Mat<D>& stress)
  {
    cell_.push_back(whole);
    stress_.insert(stress_.end(), stress.data(), stress.data() + stress.size());
  }
  /// Calls f(cell of the part, stress) for the cells of the part.
  template <class F>
  void for_each(const Subdomain& subdomain, F&& f) const
  {
    for (std::size_t i = 0; i < cell_.size(); ++i)
      if (const Index c = local(subdomain, cell_[i]); c != none)
        f(c, stress_of(i));
  }
  /// Removes the cells of the part of which is_kept(cell of the part) is false.
  template <class F>
  void keep_if(const Subdomain& subdomain, F&& is_kept)
  {
    EmptyCellStress kept;
    for (std::size_t i = 0; i < cell_.size(); ++i)
      if (const Index c = local(subdomain, cell_[i]); c == none || is_kept(c))
        kept.add(cell_[i], stress_of(i));
    *this = std::move(kept);
  }
  /// The own cells of all ranks, on all ranks.  Collective.
  EmptyCellStress of_all_ranks(Communicator& ranks, const Subdomain& subdomain) const
  {
    if (subdomain.alone())
      return *this;
    std::vector<Row> own;
    for (std::size_t i = 0; i < cell_.size(); ++i)
      if (const Index c = local(subdomain, cell_[i]); c != none && subdomain.owns_cell(c)) {
        Row& row = own.emplace_back(Row{cell_[i], {}});
        std::copy_n(stress_.data() + i * row.stress.size(), row.stress.size(), row.stress.begin());
      }
    std::vector<Row> all;
    for (const std::vector<Row>& rows : exchange_rows(ranks, std::vector<std::vector<Row>>(to_size(ranks.size()), own)))
      all.insert(all.end(), rows.begin(), rows.end());
    std::ranges::sort(all, {}, &Row::cell);
    EmptyCellStress gathered;
    for (const Row& row : all)
      gathered.add(row.cell, Eigen::Map<const Mat<D>>(row.stress.data()));
    return gathered;
  }
  /// Whether it can be that of a mesh with so many cells.
  bool fits(std::int64_t cells) const
  {
    return stress_.size() == cell_.size() * to_size(D * D) &&
           std::ranges::adjacent_find(cell_, std::ranges::greater_equal{}) == cell_.end() &&
           (empty() || (cell_.front() >= 0 && cell_.back() < cells)) &&
           std::ranges::all_of(stress_, [](Real one) { return std::isfinite(one); });
  }
  static constexpr auto fields() { return std::tuple{saved("cell", &EmptyCellStress::cell_), saved("stress", &EmptyCellStress::stress_)}; }

 private:
  struct Row {
    std::int64_t cell;
    std::array<Real, D * D> stress;
  };
  static Index local(const Subdomain& subdomain, std::int64_t whole)
  {
    return subdomain.alone() ? static_cast<Index>(whole) : subdomain.local_cell(static_cast<Index>(whole));
  }
  Mat<D> stress_of(std::size_t i) const { return Eigen::Map<const Mat<D>>(stress_.data() + i * to_size(D * D)); }

  std::vector<std::int64_t> cell_;  ///< of the whole mesh, ascending
  std::vector<Real> stress_;        ///< by cell the components, by columns [Pa]
};

}  // namespace talus
