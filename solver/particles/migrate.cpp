#include "solver/particles/migrate.hpp"

#include <algorithm>
#include <cstring>

#include "solver/halo/halo_exchange.hpp"
#include "solver/state/saved_columns.hpp"

namespace talus {

namespace {

template <class T>
void append_bytes(const T& value, std::vector<std::byte>& to)
{
  const auto* const from = reinterpret_cast<const std::byte*>(&value);
  to.insert(to.end(), from, from + sizeof(T));
}
template <class T>
void take_bytes(std::span<const std::byte>& from, T& value)
{
  std::memcpy(static_cast<void*>(&value), from.data(), sizeof(T));
  from = from.subspan(sizeof(T));
}

/// How many of a body go and come.
struct Turnover {
  std::vector<Index> leaving;  ///< rows, ascending
  Index arriving = 0;
};

/// Rows [begin, end) of each body so that the leaving ones are gone and there is room at the end for those who arrive: others take their
/// places, as few as possible, whatever the order.
template <int D>
void make_room(const std::vector<Turnover>& turnovers, std::vector<Body>& bodies, std::vector<Material>& materials, Particles<D>& particles,
               std::span<const std::int64_t> keepers, std::vector<std::pair<Index, Index>>& moves)
{
  moves.clear();
  // Holes are filled from the end of the body.
  std::vector<Index> stay(bodies.size());
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const std::vector<Index>& leaving = turnovers[b].leaving;
    Index last = bodies[b].end;  // rows from here on are settled
    std::size_t behind = leaving.size();
    for (const Index hole : leaving) {
      while (behind > 0 && leaving[behind - 1] == last - 1)
        --last, --behind;
      if (hole >= last)
        break;
      moves.emplace_back(--last, hole);
      materials[b].history.copy_row(last - materials[b].begin, hole - materials[b].begin);
    }
    stay[b] = bodies[b].size() - static_cast<Index>(leaving.size());
  }
  // Bodies move up or down by moving rows from one of their ends to the other.
  std::vector<Index> begin(bodies.size());
  Index total = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    begin[b] = std::exchange(total, total + stay[b] + turnovers[b].arriving);
  const auto rotate = [&](std::size_t b, Index by) {  // to the left; of a history, whose rows count from the body's first
    materials[b].history.resize(stay[b]);
    materials[b].history.rotate(by);
  };
  for (std::size_t b = 0; b < bodies.size(); ++b)  // down: the last rows become the first
    if (const Index by = std::min(bodies[b].begin - begin[b], stay[b]); begin[b] < bodies[b].begin) {
      for (Index i = 0; i < by; ++i)
        moves.emplace_back(bodies[b].begin + stay[b] - by + i, begin[b] + i);
      rotate(b, stay[b] - by);
    }
  for (std::size_t b = bodies.size(); b-- > 0;)  // up: the first rows become the last
    if (const Index by = std::min(begin[b] - bodies[b].begin, stay[b]); begin[b] > bodies[b].begin) {
      for (Index i = 0; i < by; ++i)
        moves.emplace_back(bodies[b].begin + i, begin[b] + stay[b] - by + i);
      rotate(b, by);
    }
  const auto n = static_cast<std::size_t>(total);
  for_each_kept_column(particles, keepers, [&](auto& column) {
    column.resize(std::max(column.size(), n));
    for (const auto& [from, to] : moves)
      copy_row(column, static_cast<std::size_t>(from), column, static_cast<std::size_t>(to));
    column.resize(n);
  });
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    bodies[b].begin = begin[b];
    bodies[b].end = begin[b] + stay[b] + turnovers[b].arriving;
    materials[b].set_range(bodies[b]);
    materials[b].history.resize(materials[b].size());
  }
}

}  // namespace

template <int D>
Migration<D>::Migration(Communicator& ranks, const Subdomain& subdomain) : ranks_(&ranks), border_of_block_(subdomain.block.size(), none)
{
  for (const int rank : subdomain.rank_of_block)
    if (rank != subdomain.rank)
      neighbours_.push_back(rank);
  std::sort(neighbours_.begin(), neighbours_.end());
  neighbours_.erase(std::unique(neighbours_.begin(), neighbours_.end()), neighbours_.end());
  for (std::size_t b = 0; b < subdomain.block.size(); ++b)
    if (const int rank = subdomain.rank_of_block[b]; rank != subdomain.rank) {
      foreign_.push_back(static_cast<Index>(b));
      border_of_block_[b] = static_cast<Index>(std::lower_bound(neighbours_.begin(), neighbours_.end(), rank) - neighbours_.begin());
    }
  out_.resize(neighbours_.size());
}

template <int D>
void Migration<D>::agree_on_columns(const Particles<D>& particles)
{
  keepers_ = count_keepers(*ranks_, particles);
}

template <int D>
void Migration<D>::add(const MigratingParticle::Head& head, Index block, std::span<const Real> numbers)
{
  static_assert(sizeof(head) == sizeof(Real));
  std::vector<std::byte>& message = out_[static_cast<std::size_t>(border_of_block_[static_cast<std::size_t>(block)])];
  append_bytes(head, message);
  const auto bytes = std::as_bytes(numbers);
  message.insert(message.end(), bytes.begin(), bytes.end());
  ++moved_;
}

template <int D>
void Migration<D>::receive()
{
  const auto messages = ranks_->neighbours(neighbours_, out_, static_cast<int>(MessageTag::particles));
  in_.resize(messages.size());
  for (std::size_t i = 0; i < messages.size(); ++i) {
    in_[i].resize(messages[i].size() / sizeof(Real));
    if (!messages[i].empty())
      std::memcpy(in_[i].data(), messages[i].data(), messages[i].size());
  }
  for (auto& message : out_)
    message.clear();
}

template <int D>
bool Migration<D>::operator()(const Subdomain& subdomain, std::vector<Body>& bodies, std::vector<Material>& materials,
                              Particles<D>& particles, CellOrder& order)
{
  if (neighbours_.empty())
    return false;
  std::vector<Turnover> turnovers(bodies.size());
  for (auto& messages : out_)
    messages.clear();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    for (const Index block : foreign_)
      for (const Index row : order.rows(static_cast<Index>(b), block)) {
        const auto p = static_cast<std::size_t>(row);
        auto& message = out_[static_cast<std::size_t>(border_of_block_[static_cast<std::size_t>(block)])];
        append_bytes(static_cast<Index>(b), message);
        append_bytes(subdomain.whole_cell(particles.cell[p]), message);
        for_each_kept_column(particles, keepers_, [&](auto& column) {
          message.resize(message.size() + row_bytes<std::decay_t<decltype(column)>>);
          save_row(column, p, message.data() + message.size() - row_bytes<std::decay_t<decltype(column)>>);
        });
        const auto history = std::as_const(materials[b].history).bytes_of_row(row - materials[b].begin);
        message.insert(message.end(), history.begin(), history.end());
        turnovers[b].leaving.push_back(row);
      }
    std::sort(turnovers[b].leaving.begin(), turnovers[b].leaving.end());
  }
  const auto in = ranks_->neighbours(neighbours_, out_, static_cast<int>(MessageTag::particles));

  // How long a record is depends on its body alone.
  std::size_t columns = 2 * sizeof(Index);
  for_each_kept_column(particles, keepers_, [&](auto& column) { columns += row_bytes<std::decay_t<decltype(column)>>; });
  std::vector<std::vector<std::span<const std::byte>>> records(bodies.size());
  bool busy = false;
  for (std::span<const std::byte> message : in)
    while (!message.empty()) {
      Index body{};
      std::memcpy(&body, message.data(), sizeof(Index));
      const std::size_t bytes = columns + materials[static_cast<std::size_t>(body)].history.row_bytes();
      records[static_cast<std::size_t>(body)].push_back(message.first(bytes));
      message = message.subspan(bytes);
    }
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    turnovers[b].arriving = static_cast<Index>(records[b].size());
    moved_ += turnovers[b].arriving + static_cast<Index>(turnovers[b].leaving.size());
    busy = busy || turnovers[b].arriving > 0 || !turnovers[b].leaving.empty();
  }
  if (!busy)
    return false;

  std::vector<std::pair<Index, Index>> moves;
  make_room(turnovers, bodies, materials, particles, keepers_, moves);
  std::vector<Index> arrived;  // rows, body by body
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    Index row = bodies[b].end - turnovers[b].arriving;
    for (std::span<const std::byte> record : records[b]) {
      const auto p = static_cast<std::size_t>(row);
      Index body{}, cell{};
      take_bytes(record, body), take_bytes(record, cell);
      for_each_kept_column(particles, keepers_, [&](auto& column) {
        load_row(record.data(), column, p);
        record = record.subspan(row_bytes<std::decay_t<decltype(column)>>);
      });
      std::ranges::copy(record, materials[b].history.bytes_of_row(row - materials[b].begin).begin());
      particles.cell[p] = subdomain.local_cell(cell);
      arrived.push_back(row++);
    }
  }
  follow_moves(particles.cell, particles.id, bodies, foreign_, moves, arrived, order);
  return true;
}

template class Migration<2>;
template class Migration<3>;

}  // namespace talus
