#include "solver/state/cell_order.hpp"

#include "core/parallel/threads.hpp"

namespace talus {

namespace {

auto& at(auto& array, Index i) { return array[static_cast<std::size_t>(i)]; }

bool before(std::span<const Index> cell, std::span<const std::int64_t> id, Index a, Index b)
{
  return at(cell, a) != at(cell, b) ? at(cell, a) < at(cell, b) : at(id, a) < at(id, b);
}

/// Insertion sort for rows that are almost in order.
void insertion_sort(std::span<const Index> cell, std::span<const std::int64_t> id, std::span<Index> rows)
{
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const Index row = rows[i];
    std::size_t j = i;
    for (; j > 0 && before(cell, id, row, rows[j - 1]); --j)
      rows[j] = rows[j - 1];
    rows[j] = row;
  }
}

std::span<Index> part(std::vector<Index>& rows, const std::vector<Index>& first, std::size_t key)
{
  return std::span(rows).subspan(static_cast<std::size_t>(first[key]), static_cast<std::size_t>(first[key + 1] - first[key]));
}

}  // namespace

void sort_by_cell(std::span<const Index> cell, std::span<const std::int64_t> id, std::span<const Body> bodies, Index n_cells,
                  CellOrder& order)
{
  order.blocks = blocks_of(n_cells);
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

  parallel_for(static_cast<Index>(order.keys()),
               [&](Index key) { insertion_sort(cell, id, part(order.row, order.first, static_cast<std::size_t>(key))); });
}

}  // namespace talus
