#include "solver/cell_order.hpp"

#include <algorithm>
#include <utility>

#include "core/parallel.hpp"

namespace talus {

void sort_by_cell(std::span<const Index> cell, std::span<const std::int64_t> id, std::span<const Body> bodies, Index n_cells,
                  CellOrder& order)
{
  const auto at = [](auto& array, Index i) -> auto& { return array[static_cast<std::size_t>(i)]; };
  order.blocks = (n_cells + block_cells - 1) / block_cells;
  order.row.resize(cell.size());
  order.first.assign(bodies.size() * static_cast<std::size_t>(order.blocks) + 1, 0);
  order.count.resize(static_cast<std::size_t>(n_cells));

  for (std::size_t b = 0; b < bodies.size(); ++b) {
    std::fill(order.count.begin(), order.count.end(), 0);
    for (Index p = bodies[b].begin; p < bodies[b].end; ++p)
      ++at(order.count, at(cell, p));
    Index position = bodies[b].begin;
    for (Index c = 0; c < n_cells; ++c) {
      if (c % block_cells == 0)
        order.first[b * static_cast<std::size_t>(order.blocks) + static_cast<std::size_t>(c / block_cells)] = position;
      position += std::exchange(at(order.count, c), position);
    }
    for (Index p = bodies[b].begin; p < bodies[b].end; ++p)
      at(order.row, at(order.count, at(cell, p))++) = p;
  }
  order.first.back() = static_cast<Index>(cell.size());

  // rows of a cell by id: a few items each, almost in order already
  const auto all = static_cast<Index>(bodies.size()) * order.blocks;
  parallel_for(all, [&](Index key) {
    const auto rows = std::span(order.row).subspan(static_cast<std::size_t>(at(order.first, key)),
                                                   static_cast<std::size_t>(at(order.first, key + 1) - at(order.first, key)));
    for (std::size_t i = 1; i < rows.size(); ++i)
      for (std::size_t j = i; j > 0 && at(cell, rows[j]) == at(cell, rows[j - 1]) && at(id, rows[j]) < at(id, rows[j - 1]); --j)
        std::swap(rows[j], rows[j - 1]);
  });
}

Real disorder(const CellOrder& order) noexcept
{
  Index misplaced = 0;
  for (std::size_t k = 0; k < order.row.size(); ++k)
    misplaced += order.row[k] != static_cast<Index>(k) ? 1 : 0;
  return order.row.empty() ? 0 : static_cast<Real>(misplaced) / static_cast<Real>(order.row.size());
}

}  // namespace talus
