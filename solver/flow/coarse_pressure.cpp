#include "solver/flow/coarse_pressure.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "core/parallel/threads.hpp"

namespace talus {

template <int D>
CoarsePressure<D>::CoarsePressure(const Mesh<D>& mesh) : block_(to_size(mesh.n_nodes())), n_blocks_(blocks_of(mesh.n_cells()))
{
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    block_[to_size(n)] = mesh.cells_of_node()[n].front() / block_cells;
}

template <int D>
std::vector<Real>& CoarsePressure<D>::take_numbers(const Subdomain& subdomain)
{
  for (Real& block : block_)
    block = subdomain.block[to_size(static_cast<Index>(block))];
  n_blocks_ = blocks_of(subdomain.whole_cells);
  return block_;
}

template <int D>
auto CoarsePressure<D>::parts_of(const Mesh<D>& mesh, const IndexRange& nodes, const std::vector<NodePressure>& around,
                                 const SparseRows<Real>& matrix, const SparseRows<Vec<D>>& push, const std::vector<Mat<D>>& free,
                                 const std::vector<Real>& lightness, Real dt) const -> std::vector<Part>
{
  std::vector<Part> parts;
  const auto add = [&](Index row, Index column, Real value) {
    const auto same = std::ranges::find_if(parts, [&](const Part& one) { return one.row == row && one.column == column; });
    if (same != parts.end())
      same->value += value;
    else
      parts.push_back({.row = row, .column = column, .of = block(nodes.begin), .value = value});
  };
  std::vector<std::pair<Index, Vec<D>>> forces;  // of a pressure of 1 in each block around a node
  for (Index n = nodes.begin; n < nodes.end; ++n) {
    forces.clear();
    auto k = to_size(mesh.ring_of_node().begin[to_size(n)]);
    for (const Index u : mesh.ring_of_node()[n]) {
      if (around[to_size(u)] == NodePressure::unknown) {
        if (around[to_size(n)] == NodePressure::unknown && matrix[k] != 0)
          add(block(n), block(u), matrix[k]);
        const auto same = std::ranges::find(forces, block(u), &std::pair<Index, Vec<D>>::first);
        if (same != forces.end())
          same->second += push[k];
        else
          forces.emplace_back(block(u), push[k]);
      }
      ++k;
    }
    if (lightness[to_size(n)] > 0)
      for (const auto& [row, force] : forces)
        for (const auto& [column, other] : forces)
          add(row, column, dt * lightness[to_size(n)] * force.dot(free[to_size(n)] * other));
  }
  return parts;
}

template <int D>
void CoarsePressure<D>::prepare(Communicator& ranks, const Mesh<D>& mesh, const OwnNodes& own, const std::vector<NodePressure>& around,
                                const SparseRows<Real>& matrix, const SparseRows<Vec<D>>& push, const std::vector<Mat<D>>& free,
                                const std::vector<Real>& lightness, Real dt)
{
  std::vector<std::vector<Part>> of_blocks(own.of_block.size());
  parallel_for_uneven(static_cast<Index>(of_blocks.size()), [&](Index b) {
    of_blocks[to_size(b)] = parts_of(mesh, own.of_block[to_size(b)], around, matrix, push, free, lightness, dt);
  });
  std::vector<Part> parts;
  for (const std::vector<Part>& one : of_blocks)
    parts.insert(parts.end(), one.begin(), one.end());
  if (!ranks.alone()) {
    const auto bytes = std::as_bytes(std::span(parts));
    const auto all = ranks.all_to_all(std::vector(to_size(ranks.size()), std::vector<std::byte>(bytes.begin(), bytes.end())));
    parts.clear();
    for (const std::vector<std::byte>& of_rank : all) {
      const std::size_t before = parts.size();
      parts.resize(before + of_rank.size() / sizeof(Part));
      std::memcpy(parts.data() + before, of_rank.data(), of_rank.size());
    }
  }
  std::ranges::sort(parts, {}, [](const Part& one) { return std::tuple(one.row, one.column, one.of); });

  row_of_block_.assign(to_size(n_blocks_), none);
  n_rows_ = 0;
  for (const Part& one : parts)
    if (one.row == one.column && row_of_block_[to_size(one.row)] == none)
      row_of_block_[to_size(one.row)] = n_rows_++;
  std::vector<Eigen::Triplet<Real>> entries;  // those of one place are added in their order
  for (const Part& one : parts)
    if (const Index row = row_of_block_[to_size(one.row)], column = row_of_block_[to_size(one.column)]; row != none && column != none)
      entries.emplace_back(row, column, one.value);
  Eigen::SparseMatrix<Real> coarse(n_rows_, n_rows_);
  coarse.setFromTriplets(entries.begin(), entries.end());
  works_ = n_rows_ > 0;
  if (works_) {
    factors_.compute(coarse);
    works_ = factors_.info() == Eigen::Success && (factors_.vectorD().array() > 0).all();
  }
}

template <int D>
void CoarsePressure<D>::find(Communicator& ranks, const OwnNodes& own, const std::vector<NodePressure>& at, const std::vector<Real>& x)
{
  if (!works_)
    return;
  sums_.assign(to_size(n_rows_), 0);
  parallel_for(static_cast<Index>(own.of_block.size()), [&](Index b) {
    const IndexRange& nodes = own.of_block[to_size(b)];
    const Index row = row_of_block_[to_size(block(nodes.begin))];
    if (row == none)
      return;
    Real sum = 0;
    for (Index n = nodes.begin; n < nodes.end; ++n)
      sum += at[to_size(n)] == NodePressure::unknown ? x[to_size(n)] : 0;
    sums_[to_size(row)] = std::bit_cast<std::int64_t>(sum);
  });
  ranks.sum(std::span(sums_));  // each block belongs to one rank: bits plus zeros
  level_.resize(n_rows_);
  for (Index row = 0; row < n_rows_; ++row)
    level_[row] = std::bit_cast<Real>(sums_[to_size(row)]);
  level_ = factors_.solve(level_).eval();
}

template class CoarsePressure<2>;
template class CoarsePressure<3>;

}  // namespace talus
