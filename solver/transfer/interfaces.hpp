#pragma once
// Nodes between materials: each group of bodies of one material has gradients of its own there.
#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "kernels/group_gradients.hpp"
#include "kernels/node_operators.hpp"
#include "solver/halo/halo_exchange.hpp"
#include "solver/model/state.hpp"
#include "solver/state/nodes.hpp"
#include "solver/state/nodes_in_use.hpp"
#include "solver/transfer/extension.hpp"

namespace talus {

/// Sums over the particles of a group in a cell, for each of its vertices a.
template <int D>
struct CellGroupSum {
  std::array<Real, D + 1> volume{};             ///< sum B_a V [m^D]
  std::array<Mat<D>, D + 1> tension = zeros();  ///< sum B_a V sigma, see ProjectedNodeSum [N m]
  bool is_seen() const noexcept
  {
    return std::ranges::any_of(volume, [](Real of) { return of != 0; });
  }
  template <class Self>
  static auto parts(Self& sum) noexcept
  {
    return std::tie(sum.volume, sum.tension);
  }

 private:
  static std::array<Mat<D>, D + 1> zeros() noexcept
  {
    std::array<Mat<D>, D + 1> all;
    all.fill(Mat<D>::Zero());
    return all;
  }
};

/// The averaged gradient at a node reaches over all cells around it.  Where a shear band runs along a boundary between materials, the
/// strain of the band would then act on the particles of the stronger one, which resist: strength too high by about two cells over the
/// height of what slides.  So at mixed nodes,
/// whose cells hold particles of several groups, each group has a gradient D^b (kernels/group_gradients.hpp) for its strain and its force:
///
///     L^b_n = sum_v v_v (x) D^b_nv          f_v = -sum_n sum_b Z^b_n D^b_nv
///
/// All groups have one velocity field.  Where the affine field of the transfer is not L itself (MUSL), it keeps the gradient D of all.
template <int D>
class Interfaces {
 public:
  /// Whether there are several groups.
  bool any() const noexcept { return groups_ > 1; }
  /// Sets the groups by the materials of the bodies for which is_of_field(body) holds, one group of all unless they are to be `separate`,
  /// and makes room for their sums.
  template <class IsOfField>
  void begin(const Mesh<D>& mesh, const std::vector<Material>& materials, IsOfField&& is_of_field)
  {
    group_of_body_.assign(materials.size(), 0);
    std::vector<Index> kinds;
    for (std::size_t body = 0; body < materials.size(); ++body) {
      if (!is_of_field(static_cast<Index>(body)))
        continue;
      const Material& material = materials[body];
      const auto same = std::ranges::find(kinds, material.kind);
      if (material.kind == none || same == kinds.end()) {
        group_of_body_[body] = kinds.size();
        kinds.push_back(material.kind);
      } else {
        group_of_body_[body] = static_cast<std::size_t>(same - kinds.begin());
      }
    }
    groups_ = kinds.size();
    place_.assign(static_cast<std::size_t>(any() ? mesh.n_nodes() : 0), none);
    cells_.clear();
    for (std::size_t group = 0; any() && group < groups_; ++group)
      cells_.emplace_back(static_cast<std::size_t>(mesh.n_cells()));
    mixed_.clear();
  }

  CellGroupSum<D>& sum(Index body, Index cell) noexcept
  {
    return cells_[group_of_body_[static_cast<std::size_t>(body)]][static_cast<std::size_t>(cell)];
  }
  /// Clears the sums of cells [first, last).
  void clear(Index first, Index last) noexcept
  {
    for (auto& cells : cells_)
      std::fill(cells.begin() + first, cells.begin() + last, CellGroupSum<D>{});
  }

  /// Finds the mixed nodes among those in use, their rows and tensions; `cells` receives the sums of cells of other ranks.
  void find_rows(const Mesh<D>& mesh, const NodesInUse& in_use, HaloExchange& cells)
  {
    if (!any())
      return;
    for (auto& of_group : cells_) {
      cells.send(of_group, Whole{});
      cells.take(of_group, Whole{});
    }
    for (const Index n : mixed_)
      place_[static_cast<std::size_t>(n)] = none;
    mixed_.clear(), first_row_.clear();
    in_use.for_each([&](Index n) { place_[static_cast<std::size_t>(n)] = count_groups(mesh, n) > 1 ? 0 : none; });
    std::size_t rows = 0;
    in_use.for_each_ascending([&](Index n) {
      if (place_[static_cast<std::size_t>(n)] == none)
        return;
      place_[static_cast<std::size_t>(n)] = static_cast<Index>(mixed_.size());
      mixed_.push_back(n), first_row_.push_back(rows);
      rows += groups_ * mesh.ring_of_node()[n].size();
    });
    rows_.resize(rows);
    tension_.resize(mixed_.size() * groups_);
    gradient_.resize(mixed_.size() * groups_);
    parallel_for(static_cast<Index>(mixed_.size()), [&](Index i) { find_rows_of(mesh, static_cast<std::size_t>(i)); });
  }

  bool is_mixed(Index n) const noexcept { return any() && place_[static_cast<std::size_t>(n)] != none; }
  /// sum_b Z^b_n D^b_nv of a mixed node n and a node v of its ring [N].
  Vec<D> pull(const Mesh<D>& mesh, Index n, Index v) const noexcept
  {
    const auto i = static_cast<std::size_t>(place_[static_cast<std::size_t>(n)]);
    const std::size_t ring = mesh.ring_of_node()[n].size();
    const std::size_t entry =
        entry_of(mesh.ring_of_node(), n, v) - static_cast<std::size_t>(mesh.ring_of_node().begin[static_cast<std::size_t>(n)]);
    Vec<D> force = Vec<D>::Zero();
    for (std::size_t b = 0; b < groups_; ++b)
      force += pull_of<D>(tension_[i * groups_ + b], rows_[first_row_[i] + b * ring + entry]);
    return force;
  }
  /// Computes the velocity gradients of the groups at mixed nodes.
  void find_gradients(const Mesh<D>& mesh, const Extension<D>& extension, const SparseRows<NodeMotion<D>>& nodes)
  {
    parallel_for(static_cast<Index>(mixed_.size()), [&](Index k) {
      const auto i = static_cast<std::size_t>(k);
      const auto ring = mesh.ring_of_node()[mixed_[i]];
      const Vec<D>* row = rows_.data() + first_row_[i];
      for (std::size_t b = 0; b < groups_; ++b) {
        Mat<D> L = Mat<D>::Zero();
        for (const Index v : ring)
          L += extension.velocity(v, nodes[static_cast<std::size_t>(v)].v) * (row++)->transpose();
        gradient_[i * groups_ + b] = L;
      }
    });
  }
  /// The velocity gradient of the group of a body at a mixed node [1/s].
  const Mat<D>& gradient(Index n, Index body) const noexcept
  {
    return gradient_[static_cast<std::size_t>(place_[static_cast<std::size_t>(n)]) * groups_ +
                     group_of_body_[static_cast<std::size_t>(body)]];
  }
  std::size_t mixed_nodes() const noexcept { return mixed_.size(); }
  /// The memory of the sums of all cells [B], and of all else.
  std::size_t bytes_of_cells() const noexcept { return cells_.empty() ? 0 : cells_.size() * bytes_of_all(cells_.front()); }
  std::size_t bytes_of_nodes() const noexcept { return bytes_of_all(place_, rows_, tension_, gradient_); }

 private:
  static std::size_t vertex_of(const Mesh<D>& mesh, Index cell, Index n) noexcept
  {
    return static_cast<std::size_t>(std::ranges::find(mesh.cell(cell), n) - mesh.cell(cell).begin());
  }
  std::size_t count_groups(const Mesh<D>& mesh, Index n) const noexcept
  {
    std::size_t count = 0;
    for (const auto& cells : cells_)
      if (std::ranges::any_of(mesh.cells_of_node()[n],
                              [&](Index c) { return cells[static_cast<std::size_t>(c)].volume[vertex_of(mesh, c, n)] > 0; }))
        ++count;
    return count;
  }
  void find_rows_of(const Mesh<D>& mesh, std::size_t i)
  {
    const Index n = mixed_[i];
    thread_local std::vector<Real> shares;
    shares.clear();
    std::fill_n(tension_.begin() + static_cast<std::ptrdiff_t>(i * groups_), groups_, Mat<D>::Zero());
    for (const Index c : mesh.cells_of_node()[n]) {
      const std::size_t a = vertex_of(mesh, c, n);
      for (std::size_t b = 0; b < groups_; ++b) {
        const CellGroupSum<D>& sum = cells_[b][static_cast<std::size_t>(c)];
        shares.push_back(std::max(sum.volume[a], Real{0}));  // a particle on a facet may lie outside of its cell by rounding
        tension_[i * groups_ + b] += sum.tension[a];
      }
    }
    fit_shares(mesh, n, groups_, std::span(shares));
    group_gradients(mesh, n, groups_, std::span<const Real>(shares),
                    std::span(rows_).subspan(first_row_[i], groups_ * mesh.ring_of_node()[n].size()));
  }

  std::size_t groups_ = 0;
  std::vector<std::size_t> group_of_body_;
  std::vector<SparseRows<CellGroupSum<D>>> cells_;  ///< by group and cell
  std::vector<Index> mixed_, place_;                ///< mixed nodes, ascending; of each node where it is among them, or `none`
  std::vector<std::size_t> first_row_;
  std::vector<Vec<D>> rows_;      ///< of each mixed node, by group
  std::vector<Mat<D>> tension_;   ///< of each mixed node, by group
  std::vector<Mat<D>> gradient_;  ///< of each mixed node, by group
};

}  // namespace talus
