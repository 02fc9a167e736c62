#include "solver/state/cell_order.hpp"

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
  order.is_tested = false;
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
  // The body of a row does not change.
  const auto key_of = [&](std::size_t key, Index row) {
    return key - key % static_cast<std::size_t>(order.blocks) + static_cast<std::size_t>(at(cell, row) / block_cells);
  };
  const auto in_order = [&](Index a, Index b) { return before(cell, id, a, b); };
  order.is_new = true;
  order.is_tested = false;
  order.arrived.reserve(order.row.size());  // does not grow within a step
  order.next_row.resize(order.row.size());

  // The particles that change cells, few, are sorted by where they go.
  std::vector<Index>& arrivals = order.next_first;  // first entry in `arrived` of each key
  arrivals.assign(keys + 1, 0);
  for (std::size_t key = 0; key < keys; ++key)
    for (const Index position : order.leaving_of(key))
      ++arrivals[key_of(key, at(order.row, position)) + 1];
  std::partial_sum(arrivals.begin(), arrivals.end(), arrivals.begin());
  order.arrived.resize(static_cast<std::size_t>(arrivals.back()));
  order.count.assign(arrivals.begin(), arrivals.end());
  for (std::size_t key = 0; key < keys; ++key)
    for (const Index position : order.leaving_of(key))
      at(order.arrived, order.count[key_of(key, at(order.row, position))]++) = at(order.row, position);

  order.count.assign(keys + 1, 0);  // first row of each key in the new order
  for (std::size_t key = 0; key < keys; ++key)
    order.count[key + 1] =
        order.count[key] + order.first[key + 1] - order.first[key] - order.n_leaving[key] + arrivals[key + 1] - arrivals[key];
  parallel_for(n_keys, [&](Index k) {
    const auto key = static_cast<std::size_t>(k);
    const auto rows = part(order.row, order.first, key), coming = part(order.arrived, arrivals, key);
    auto stay = rows.begin();  // the rows that stay close up
    auto next = rows.begin();
    const auto close_up = [&](auto end) { return stay == next ? end : std::copy(next, end, stay); };
    for (const Index position : order.leaving_of(key)) {
      const auto gap = rows.begin() + (position - order.first[key]);
      stay = close_up(gap);
      next = gap + 1;
    }
    stay = close_up(rows.end());
    std::sort(coming.begin(), coming.end(), in_order);
    auto to = part(order.next_row, order.count, key).begin();
    auto from = rows.begin();
    for (const Index row : coming) {
      const auto place = std::lower_bound(from, stay, row, in_order);
      to = std::copy(from, place, to);
      *to++ = row;
      from = place;
    }
    std::copy(from, stay, to);
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
