#include "app/whole.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>

namespace talus {

namespace {

/// Where each row of each rank goes: to its body, in the order of ids.
struct Places {
  std::vector<std::vector<Index>> of_row;  // rank, row
  std::vector<Index> begin;                // body -> its first row; one more at the end
};

Places find_places(const std::vector<std::vector<std::int64_t>>& ids, const std::vector<std::vector<Index>>& sizes, std::size_t n_bodies)
{
  Places places{{}, {0}};
  for (const auto& of_rank : ids)
    places.of_row.emplace_back(of_rank.size());
  std::vector<Index> next(ids.size(), 0);  // of each rank
  for (std::size_t b = 0; b < n_bodies; ++b) {
    struct One {
      std::int64_t id;
      std::size_t rank;
      Index row;
    };
    std::vector<One> here;
    for (std::size_t r = 0; r < ids.size(); ++r)
      for (const Index end = next[r] + sizes[r][b]; next[r] < end; ++next[r])
        here.push_back({ids[r][static_cast<std::size_t>(next[r])], r, next[r]});
    std::sort(here.begin(), here.end(), [](const One& a, const One& b_) { return a.id < b_.id; });
    for (const One& one : here)
      places.of_row[one.rank][static_cast<std::size_t>(one.row)] = static_cast<Index>(places.begin.back() + (&one - here.data()));
    places.begin.push_back(places.begin.back() + static_cast<Index>(here.size()));
  }
  return places;
}

/// The rows of a column, which may be empty on ranks without particles.
template <class T, class Column>
void put(const std::vector<std::vector<T>>& rows, const std::vector<std::vector<Index>>& places, std::size_t n, Column& column)
{
  column.resize(n);
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (std::size_t i = 0; i < rows[r].size(); ++i)
      column[static_cast<std::size_t>(places[r][i])] = rows[r][i];
}

}  // namespace

template <int D>
WholeParticles<D> gather_particles(const Frame<D>& frame)
{
  Exchange& ranks = *frame.ranks;
  std::vector<Index> sizes;
  for (const Body& body : frame.bodies)
    sizes.push_back(body.size());
  const auto all_sizes = gather_rows<Index>(ranks, sizes);
  const auto ids = gather_rows<std::int64_t>(ranks, frame.particles.id);
  const Places places = ranks.is_root() ? find_places(ids, all_sizes, frame.bodies.size()) : Places{};

  WholeParticles<D> whole;
  whole.particles.keep_in(frame.particles.precision());
  frame.particles.for_each_column([&](std::string_view name, std::string_view, const auto& column) {
    using Row = std::decay_t<decltype(column[0])>;
    std::vector<std::vector<Row>> all;
    if (name == "cell") {
      std::vector<Index> cells;
      for (const Index cell : frame.particles.cell)
        cells.push_back(frame.share.whole_cell(cell));
      all = rows_of<Row>(ranks.gather(std::as_bytes(std::span(cells))));
    } else {
      all = rows_of<Row>(ranks.gather(std::as_bytes(std::span(column.data(), column.size()))));
    }
    const bool kept = std::any_of(all.begin(), all.end(), [](const auto& of_rank) { return !of_rank.empty(); });
    whole.particles.for_each_column([&](std::string_view other, std::string_view, auto& to) {
      if constexpr (std::is_same_v<std::decay_t<decltype(to[0])>, Row>)
        if (other == name && kept)
          put(all, places.of_row, static_cast<std::size_t>(places.begin.back()), to);
    });
  });
  whole.bodies = frame.bodies;
  for (std::size_t b = 0; b < whole.bodies.size(); ++b) {
    whole.materials.push_back(frame.materials[b]);
    Body& body = whole.bodies[b];
    if (ranks.is_root())
      body.begin = places.begin[b], body.end = places.begin[b + 1];
    std::visit(
        [&](auto& batch) {
          using State = std::decay_t<decltype(batch.history[0])>;
          const auto all = gather_rows<State>(ranks, std::span<const State>(batch.history));
          std::vector<std::vector<Index>> here;  // places of the rows of this body
          for (std::size_t r = 0; r < all.size(); ++r) {
            const auto first =
                places.of_row[r].begin() + std::accumulate(all_sizes[r].begin(), all_sizes[r].begin() + static_cast<Index>(b), Index{0});
            here.emplace_back(first, first + all_sizes[r][b]);
            for (Index& place : here.back())
              place -= body.begin;
          }
          batch.history.clear();
          put(all, here, ranks.is_root() ? static_cast<std::size_t>(body.size()) : 0, batch.history);
          batch.begin = body.begin, batch.end = body.end;
        },
        whole.materials.back());
  }
  return whole;
}

template <int D>
Column whole_column(const Frame<D>& frame, Column held)
{
  if (frame.ranks->alone())
    return held;
  const auto width = static_cast<std::size_t>(held.components);
  std::vector<Index> nodes;
  std::vector<float> own;
  for (Index n = 0; n < frame.mesh.n_nodes(); ++n)
    if (frame.share.owns_node(n)) {
      nodes.push_back(frame.share.node[static_cast<std::size_t>(n)]);
      const auto values = std::span(held.values).subspan(static_cast<std::size_t>(n) * width, width);
      own.insert(own.end(), values.begin(), values.end());
    }
  const auto all_nodes = gather_rows<Index>(*frame.ranks, nodes);
  const auto all_values = gather_rows<float>(*frame.ranks, own);
  held.values.assign(frame.ranks->is_root() ? static_cast<std::size_t>(frame.share.whole_nodes) * width : 0, 0);
  for (std::size_t r = 0; r < all_nodes.size(); ++r)
    for (std::size_t i = 0; i < all_nodes[r].size(); ++i)
      std::copy_n(all_values[r].begin() + static_cast<std::ptrdiff_t>(i * width), width,
                  held.values.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(all_nodes[r][i]) * width));
  return held;
}

template WholeParticles<2> gather_particles<2>(const Frame<2>&);
template WholeParticles<3> gather_particles<3>(const Frame<3>&);
template Column whole_column<2>(const Frame<2>&, Column);
template Column whole_column<3>(const Frame<3>&, Column);

}  // namespace talus
