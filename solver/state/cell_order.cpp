#include "solver/state/cell_order.hpp"

#include <array>
#include <numeric>

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

/// Sorts the rows of one block by cell, keeping the order within each cell; each(f) calls f(row) for all of them.
template <class Each>
void count_cells(std::span<const Index> cell, Each&& each, std::span<Index> to)
{
  std::array<Index, block_cells> position{};
  each([&](Index row) { ++at(position, at(cell, row) % block_cells); });
  Index sum = 0;
  for (Index& count : position)
    sum += std::exchange(count, sum);
  each([&](Index row) { at(to, at(position, at(cell, row) % block_cells)++) = row; });
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
  order.is_new = true;
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

void sort_again(std::span<const Index> cell, std::span<const std::int64_t> id, CellOrder& order)
{
  const std::size_t keys = order.keys();
  const auto n_keys = static_cast<Index>(keys);
  // the body of a row does not change
  const auto base_of = [&](std::size_t key) { return key - key % static_cast<std::size_t>(order.blocks); };
  const auto key_of = [&](std::size_t base, Index row) { return base + static_cast<std::size_t>(at(cell, row) / block_cells); };
  order.is_new = true;
  order.arrived.reserve(order.row.size());  // does not grow within a step
  order.moved.resize(order.row.size());
  order.next_row.resize(order.row.size());
  order.left.assign(keys, 0);
  parallel_for(n_keys, [&](Index k) {
    const auto key = static_cast<std::size_t>(k), base = base_of(key);
    auto leaving = part(order.moved, order.first, key);
    for (const Index row : order.rows(key))
      if (key_of(base, row) != key)
        at(leaving, order.left[key]++) = row;
  });

  // The particles that leave their block, few, are counted at their destination.
  order.next_first.assign(keys + 1, 0);
  for (std::size_t key = 0; key < keys; ++key)
    for (Index i = 0; i < order.left[key]; ++i)
      ++order.next_first[key_of(base_of(key), at(order.moved, order.first[key] + i)) + 1];
  for (std::size_t key = 0; key < keys; ++key)
    order.next_first[key + 1] += order.next_first[key];
  std::vector<Index>& arrivals = order.next_first;  // first entry in `arrived` of each key
  order.arrived.resize(static_cast<std::size_t>(arrivals.back()));
  order.count.assign(arrivals.begin(), arrivals.end());
  for (std::size_t key = 0; key < keys; ++key)
    for (Index i = 0; i < order.left[key]; ++i) {
      const Index row = at(order.moved, order.first[key] + i);
      at(order.arrived, order.count[key_of(base_of(key), row)]++) = row;
    }

  order.count.assign(keys + 1, 0);  // first row of each key in the new order
  for (std::size_t key = 0; key < keys; ++key)
    order.count[key + 1] = order.count[key] + order.first[key + 1] - order.first[key] - order.left[key] + arrivals[key + 1] - arrivals[key];
  parallel_for(n_keys, [&](Index k) {
    const auto key = static_cast<std::size_t>(k), base = base_of(key);
    const auto rows = order.rows(key);
    const auto sorted = part(order.next_row, order.count, key);
    if (order.left[key] == 0 && arrivals[key + 1] == arrivals[key] &&
        std::is_sorted(rows.begin(), rows.end(), [&](Index a, Index b) { return at(cell, a) < at(cell, b); })) {
      std::copy(rows.begin(), rows.end(), sorted.begin());
    } else {
      const auto each = [&](auto&& f) {
        for (const Index row : rows)
          if (key_of(base, row) == key)
            f(row);
        for (Index i = arrivals[key]; i < arrivals[key + 1]; ++i)
          f(at(order.arrived, i));
      };
      count_cells(cell, each, sorted);
    }
    insertion_sort(cell, id, sorted);
  });
  std::swap(order.row, order.next_row);
  std::swap(order.first, order.count);
}

void follow_moves(std::span<const Index> cell, std::span<const std::int64_t> id, std::span<const Body> bodies, std::span<const Index> left,
                  std::span<const std::pair<Index, Index>> moves, std::span<const Index> arrived, CellOrder& order)
{
  const auto blocks = static_cast<std::size_t>(order.blocks);
  order.is_new = true;
  std::vector<Index> stood(std::max(order.row.size(), cell.size()));  // old row of each row
  std::iota(stood.begin(), stood.end(), 0);
  for (const auto& [from, to] : moves)
    at(stood, to) = at(stood, from);
  std::vector<Index> stands(stood.size());  // the inverse of `stood`
  std::iota(stands.begin(), stands.end(), 0);
  for (const auto& [from, to] : moves)
    if (static_cast<std::size_t>(to) < cell.size())
      at(stands, at(stood, to)) = to;

  std::vector<std::uint8_t> is_left(blocks, 0);
  for (const Index block : left)
    at(is_left, block) = 1;
  std::vector<std::vector<Index>> here(order.keys());  // particles that arrive
  std::size_t body = 0;
  for (const Index row : arrived) {
    while (row >= bodies[body].end)
      ++body;
    here[body * blocks + static_cast<std::size_t>(at(cell, row) / block_cells)].push_back(row);
  }

  order.next_row.resize(cell.size());
  order.next_first.assign(order.keys() + 1, 0);
  for (std::size_t key = 0; key < order.keys(); ++key)
    order.next_first[key + 1] = order.next_first[key] + static_cast<Index>(here[key].size()) +
                                (is_left[key % blocks] != 0 ? 0 : order.first[key + 1] - order.first[key]);
  parallel_for(static_cast<Index>(order.keys()), [&](Index k) {
    const auto key = static_cast<std::size_t>(k);
    const auto sorted = part(order.next_row, order.next_first, key);
    auto to = sorted.begin();
    if (is_left[key % blocks] == 0)
      to = std::transform(order.rows(key).begin(), order.rows(key).end(), to, [&](Index row) { return at(stands, row); });
    std::copy(here[key].begin(), here[key].end(), to);
    insertion_sort(cell, id, sorted);
  });
  std::swap(order.row, order.next_row);
  std::swap(order.first, order.next_first);
}

Real disorder(const CellOrder& order) noexcept
{
  const auto n = static_cast<Index>(order.row.size());
  const Index jumps = parallel_sum<Index>(n, [&](Index k) { return k > 0 && at(order.row, k) != at(order.row, k - 1) + 1 ? 1 : 0; });
  return order.row.empty() ? 0 : static_cast<Real>(jumps) / static_cast<Real>(order.row.size());
}

}  // namespace talus
