#include "solver/particles/redistribute.hpp"

#include <algorithm>
#include <cassert>
#include <tuple>

#include "solver/state/saved_columns.hpp"

namespace talus {

namespace {

using RowsOfRanks = std::vector<std::vector<Index>>;

/// Sends out[r] of the rows to rank r; what comes from rank r is put in the rows in[r].  Rows are `bytes` long: save(i, to) copies row i to an
/// address, load(from, i) back.  make_room() makes the rows those that there are then.
template <class Save, class Load, class MakeRoom>
void send_rows(Communicator& ranks, const RowsOfRanks& out, const RowsOfRanks& in, std::size_t bytes, Save&& save, Load&& load,
               MakeRoom&& make_room)
{
  std::vector<std::vector<std::byte>> messages(out.size());
  for (std::size_t r = 0; r < out.size(); ++r) {
    messages[r].resize(out[r].size() * bytes);
    for (std::size_t i = 0; i < out[r].size() && bytes > 0; ++i)
      save(out[r][i], messages[r].data() + i * bytes);
  }
  messages = ranks.all_to_all(messages);
  make_room();
  for (std::size_t r = 0; r < in.size(); ++r)
    for (std::size_t i = 0; i < in[r].size() && bytes > 0; ++i)
      load(messages[r].data() + i * bytes, in[r][i]);
}
template <class Column>
void send_column(Communicator& ranks, const RowsOfRanks& out, const RowsOfRanks& in, std::size_t n, Column& rows)
{
  send_rows(
      ranks, out, in, row_bytes<Column>, [&](Index row, std::byte* to) { save_row(rows, static_cast<std::size_t>(row), to); },
      [&](const std::byte* from, Index row) { load_row(from, rows, static_cast<std::size_t>(row)); },
      [&] {
        rows = {};
        rows.resize(n);
      });
}

/// What says where a row comes to stand.
struct Name {
  std::int64_t body, id;
};

/// Of the rows that those in `all` name the places in the order of bodies and ids.  Rows come body by body.
RowsOfRanks places_of(const std::vector<std::vector<Name>>& all)
{
  struct One {
    Name name;
    std::size_t rank, row;
  };
  std::vector<One> order;
  RowsOfRanks places;
  for (std::size_t r = 0; r < all.size(); ++r) {
    places.emplace_back(all[r].size());
    for (std::size_t i = 0; i < all[r].size(); ++i)
      order.push_back({all[r][i], r, i});
  }
  std::sort(order.begin(), order.end(), [](const One& a, const One& b) {
    return std::tie(a.name.body, a.name.id, a.rank, a.row) < std::tie(b.name.body, b.name.id, b.rank, b.row);
  });
  for (std::size_t i = 0; i < order.size(); ++i)
    places[order[i].rank][order[i].row] = static_cast<Index>(i);
  return places;
}

/// Of ascending rows, less `begin`, those in [begin, end); of a sender's places those of a body, which ascend as well.
RowsOfRanks within(const RowsOfRanks& rows, Index begin, Index end)
{
  RowsOfRanks some;
  for (const std::vector<Index>& of_rank : rows) {
    some.emplace_back();
    for (const Index row : of_rank)
      if (begin <= row && row < end)
        some.back().push_back(row - begin);
  }
  return some;
}

}  // namespace

template <int D>
void redistribute(Communicator& ranks, std::span<const int> rank_of_row, std::vector<Body>& bodies, std::vector<Material>& materials,
                  Particles<D>& particles)
{
  assert(rank_of_row.size() == particles.id.size());
  const std::vector<std::int64_t> keepers = count_keepers(ranks, particles);
  RowsOfRanks out(static_cast<std::size_t>(ranks.size()));
  std::vector<std::vector<Name>> names(out.size());
  for (std::size_t b = 0; b < bodies.size(); ++b)
    for (Index row = bodies[b].begin; row < bodies[b].end; ++row) {
      const auto p = static_cast<std::size_t>(row);
      const auto to = static_cast<std::size_t>(rank_of_row[p]);
      out[to].push_back(row);
      names[to].push_back({static_cast<std::int64_t>(b), particles.id[p]});
    }
  names = exchange_rows(ranks, names);
  const RowsOfRanks in = places_of(names);

  std::vector<Index> size_of_body(bodies.size(), 0);
  std::size_t n = 0;
  for (const std::vector<Name>& of_rank : names) {
    n += of_rank.size();
    for (const Name& name : of_rank)
      size_of_body[static_cast<std::size_t>(name.body)] += 1;
  }
  names = {};
  for_each_kept_column(particles, keepers, [&](auto& column) { send_column(ranks, out, in, n, column); });
  Index begin = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    Body& body = bodies[b];
    const RowsOfRanks leaving = within(out, body.begin, body.end);
    body.begin = begin, body.end = begin += size_of_body[b];
    const RowsOfRanks arriving = within(in, body.begin, body.end);
    HistoryRows& history = materials[b].history;
    send_rows(
        ranks, leaving, arriving, history.row_bytes(),
        [&](Index row, std::byte* to) { std::ranges::copy(std::as_const(history).bytes_of_row(row), to); },
        [&](const std::byte* from, Index row) { std::copy_n(from, history.row_bytes(), history.bytes_of_row(row).data()); },
        [&] { history.resize(body.size()); });
    materials[b].set_range(body);
  }
}

template <int D>
void receive_owned_particles(Communicator& ranks, const Subdomain& subdomain, std::vector<Body>& bodies, std::vector<Material>& materials,
                             Particles<D>& particles)
{
  std::vector<int> rank_of_row;
  rank_of_row.reserve(particles.cell.size());
  for (const Index cell : particles.cell)
    rank_of_row.push_back(subdomain.rank_of_whole_block[static_cast<std::size_t>(cell / block_cells)]);
  redistribute(ranks, rank_of_row, bodies, materials, particles);
  for (Index& cell : particles.cell)
    cell = subdomain.local_cell(cell);
}

template void redistribute<2>(Communicator&, std::span<const int>, std::vector<Body>&, std::vector<Material>&, Particles<2>&);
template void redistribute<3>(Communicator&, std::span<const int>, std::vector<Body>&, std::vector<Material>&, Particles<3>&);
template void receive_owned_particles<2>(Communicator&, const Subdomain&, std::vector<Body>&, std::vector<Material>&, Particles<2>&);
template void receive_owned_particles<3>(Communicator&, const Subdomain&, std::vector<Body>&, std::vector<Material>&, Particles<3>&);

}  // namespace talus
