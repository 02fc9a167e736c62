#pragma once
// The particles of each cell: rows sorted by body, cell and id, and the beginning of each block of cells.
#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "core/particle_pack.hpp"
#include "mesh/blocks.hpp"

namespace talus {

/// The order of particles.  Within a cell particles are sorted by id, so nodal sums depend on the state only, not on its history.
struct CellOrder {
  std::vector<Index> row;    ///< particle rows sorted by (body, cell, id)
  std::vector<Index> first;  ///< first position in `row` for each (body * blocks + block); one more at the end
  Index blocks = 0;
  bool is_new = false;  ///< whether it changed since the last call of follow_order()

  /// The index in `first` for the particles of a body in a block.
  std::size_t key(Index body, Index block) const noexcept
  {
    return static_cast<std::size_t>(body) * static_cast<std::size_t>(blocks) + static_cast<std::size_t>(block);
  }
  std::size_t keys() const noexcept { return first.size() - 1; }
  std::span<const Index> rows(Index body, Index block) const noexcept { return rows(key(body, block)); }
  std::span<const Index> rows(std::size_t at) const noexcept
  {
    return std::span(row).subspan(static_cast<std::size_t>(first[at]), static_cast<std::size_t>(first[at + 1] - first[at]));
  }

  /// Particles that may have left their cells since the last sort: their positions in `row`, ascending, for each key from `first` on.
  std::vector<Index> leaving;
  std::vector<Index> n_leaving;  ///< how many, for each key
  bool is_tested = false;        ///< whether `leaving` holds for the present positions

  /// Prepares for the test of all particles, each by the thread that has its key.
  void begin_test()
  {
    leaving.resize(row.size());
    n_leaving.assign(keys(), 0);
    is_tested = true;
  }
  void add_leaving(std::size_t key, const Index* listed) noexcept
  {
    leaving[static_cast<std::size_t>(first[key] + n_leaving[key]++)] = static_cast<Index>(listed - row.data());
  }
  std::span<Index> leaving_of(std::size_t key) noexcept
  {
    return std::span(leaving).subspan(static_cast<std::size_t>(first[key]), static_cast<std::size_t>(n_leaving[key]));
  }

  // Buffers of the sorts.
  std::vector<Index> count;  ///< particles per cell, or per block
  std::vector<Index> next_row, next_first, arrived;
};

/// Sorts by `cell` and `id` from scratch; `order` keeps its buffers.  Linear in particles and cells.
void sort_by_cell(std::span<const Index> cell, std::span<const std::int64_t> id, std::span<const Body> bodies, Index n_cells,
                  CellOrder& order);

/// Sorts after some particles have changed their cells.  All of them must be in `leaving`, which is invalid afterwards; it may also contain
/// particles whose cell is unchanged.  The result is that of sort_by_cell(), but only these are moved, in parallel.
void sort_again(std::span<const Index> cell, std::span<const std::int64_t> id, CellOrder& order);

/// Updates the order after all rows in the blocks `left` have been removed and other rows have moved to their places: `moves` lists the
/// moves in sequence.  `arrived` are new rows, body by body; their cells and ids and the ranges of bodies are already up to date.
void follow_moves(std::span<const Index> cell, std::span<const std::int64_t> id, std::span<const Body> bodies, std::span<const Index> left,
                  std::span<const std::pair<Index, Index>> moves, std::span<const Index> arrived, CellOrder& order);

/// The fraction of the particles whose row does not follow that of the previous particle in the order.
Real disorder(const CellOrder& order) noexcept;

/// Calls f(cell, run) for the particles of each single cell in `rows`, which are sorted by cell; `ask` as in PrefetchRows.
template <class F, class Ask = AskForNothing>
void for_each_run(std::span<const Index> rows, std::span<const Index> cell, F&& f, Ask ask = {})
{
  PrefetchRows ahead(rows, ask);
  for (std::size_t begin = 0; begin < rows.size();) {
    const Index c = cell[static_cast<std::size_t>(rows[begin])];
    std::size_t end = begin + 1;
    while (end < rows.size() && cell[static_cast<std::size_t>(rows[end])] == c)
      ++end;
    ahead.until(end);
    f(c, rows.subspan(begin, end - begin));
    begin = end;
  }
}

/// Calls f(cell, runs) for each cell of a block that contains particles of the bodies, ascending; runs(g) calls g(run) for the particles of
/// each of these bodies in the cell.  Allocates nothing.
template <class F>
void for_each_cell_of(const CellOrder& order, std::span<const Index> bodies, Index block, std::span<const Index> cell, F&& f)
{
  if (bodies.size() == 1)
    return for_each_run(order.rows(bodies.front(), block), cell,
                        [&](Index c, std::span<const Index> run) { f(c, [run](auto&& g) { g(run); }); });
  const auto cell_of = [cell](Index row) { return cell[static_cast<std::size_t>(row)]; };
  const auto run_of = [&](Index body, Index c) {
    const auto rows = order.rows(body, block);
    const auto begin = std::partition_point(rows.begin(), rows.end(), [&](Index row) { return cell_of(row) < c; });
    return std::span(begin, std::partition_point(begin, rows.end(), [&](Index row) { return cell_of(row) == c; }));
  };
  const auto next_cell = [&](Index after) {
    Index next = none;
    for (const Index body : bodies) {
      const auto rows = order.rows(body, block);
      const auto found = std::partition_point(rows.begin(), rows.end(), [&](Index row) { return cell_of(row) <= after; });
      if (found != rows.end() && (next == none || cell_of(*found) < next))
        next = cell_of(*found);
    }
    return next;
  };
  for (Index c = next_cell(none); c != none; c = next_cell(c))
    f(c, [&](auto&& g) {
      for (const Index body : bodies)
        if (const auto run = run_of(body, c); !run.empty())
          g(run);
    });
}

}  // namespace talus
