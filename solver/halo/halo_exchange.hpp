#pragma once
// Exchange of rows between neighbouring ranks, one message for each neighbour.
#include <algorithm>
#include <cstring>
#include <tuple>
#include <utility>

#include "core/parallel/communicator.hpp"
#include "core/parallel/threads.hpp"
#include "mesh/part.hpp"

namespace talus {

/// The kind of a message; messages of different kinds do not mix.
enum class MessageTag : int {
  rows = 1,
  sums = 2,
  particles = 3,
  motion = 4,
  felt = 5,
  small_mass_nodes = 6,
  hosts = 7,
  cells = 8,
  near = 9,
  contact_nodes = 10,
  contact_cells = 11,
  contact_reach = 12,
  surfaces = 13,
  cut_nodes = 14,
  cut_reach = 15,
  rigid_nodes = 16,
  rigid_touches = 17,
  wall_nodes = 18,
  wall_touches = 19,
  sheet_nodes = 20,
  flow_cells = 21,
  flow_nodes = 22,
  equations = 23
};

/// Selects the parts of a row to be sent: the whole row.
struct Whole {
  template <class Row>
  static auto parts(Row& row) noexcept
  {
    return std::decay_t<Row>::parts(row);
  }
  template <class Row>
  static bool is_there(const Row& row, Index) noexcept
  {
    return row.is_seen();
  }
  template <class Row>
  static void clear(Row& row) noexcept
  {
    row = Row{};
  }
  template <class Row>
  static void add(const Row& row, Row& sum) noexcept
  {
    sum += row;
  }
};
/// Selects the velocity only.
struct VelocityAlone : Whole {
  template <class Row>
  static auto parts(Row& row) noexcept
  {
    return std::tie(row.v);
  }
};
/// Selects the momentum only.
struct MomentumAlone {
  template <class Sum>
  static auto parts(Sum& sum) noexcept
  {
    return std::decay_t<Sum>::momentum_parts(sum);
  }
  template <class Sum>
  static bool is_there(const Sum& sum, Index) noexcept
  {
    return sum.has_momentum();
  }
  template <class Sum>
  static void clear(Sum& sum) noexcept
  {
    sum.clear_momentum();
  }
  template <class Sum>
  static void add(const Sum& row, Sum& sum) noexcept
  {
    sum.add_momentum(row);
  }
};

/// Selects `parts` of the rows that `sends` marks.  Rows of other nodes are not changed.
template <class Parts>
struct OfMarked {
  Parts parts;
  const std::vector<std::uint8_t>& sends;
  template <class Row>
  bool is_there(const Row&, Index row) const noexcept
  {
    return sends[static_cast<std::size_t>(row)] != 0;
  }
  template <class Row>
  static void clear(const Row&) noexcept
  {}
};
template <class Parts>
OfMarked(Parts, const std::vector<std::uint8_t>&) -> OfMarked<Parts>;

/// The parts of a row that is a number or a vector.
inline constexpr auto itself = [](auto& row) { return std::tie(row); };

/// Selects whole numbers or vectors.
struct Numbers {
  template <class Row>
  static auto parts(Row& row) noexcept
  {
    return std::tie(row);
  }
  template <class Row>
  static bool is_there(const Row&, Index) noexcept
  {
    return true;
  }
  template <class Row>
  static void clear(const Row&) noexcept
  {}
};

/// Rows in a message: first one bit for each row that tells whether it is present, then the parts of the rows that are.  `Rows` are
/// accessed by number.
class Sheet {
 public:
  /// Writes the rows rows[which[k]].
  template <class What, class Rows>
  std::span<std::byte> fill(const std::vector<Index>& which, Rows& rows, const What& what)
  {
    std::byte* to = make_room(which.size(), rows, what);
    std::fill(bytes_.data(), to, std::byte{0});
    for (std::size_t k = 0; k < which.size(); ++k)
      if (const auto& row = rows[static_cast<std::size_t>(which[k])]; what.is_there(row, which[k])) {
        bytes_[k / 8] |= std::byte{1} << (k % 8);
        std::apply([&](const auto&... part) { (write(part, to), ...); }, what.parts(row));
      }
    return {bytes_.data(), to};
  }
  template <class What, class Rows>
  std::span<std::byte> room(std::size_t n_rows, Rows& rows, const What& what)
  {
    make_room(n_rows, rows, what);
    return bytes_;
  }
  template <class What, class Rows>
  void take(const std::vector<Index>& which, Rows& rows, const What& what) const
  {
    const std::byte* from = bytes_.data() + head(which.size());
    for (std::size_t k = 0; k < which.size(); ++k)
      if (auto&& row = rows[static_cast<std::size_t>(which[k])]; (bytes_[k / 8] >> (k % 8) & std::byte{1}) != std::byte{0})
        std::apply([&](auto&... part) { (read(from, part), ...); }, what.parts(row));
      else
        what.clear(row);
  }

 private:
  static std::size_t head(std::size_t n_rows) noexcept { return (n_rows + 63) / 64 * 8; }
  template <class What, class Rows>
  std::byte* make_room(std::size_t n_rows, Rows& rows, const What& what)
  {
    using Parts = decltype(what.parts(rows[0]));
    constexpr std::size_t each = [&]<class... Part>(std::type_identity<std::tuple<Part...>>) {
      return (std::size_t{0} + ... + sizeof(std::remove_reference_t<Part>));
    }(std::type_identity<Parts>{});
    bytes_.resize(head(n_rows) + n_rows * each);
    return bytes_.data() + head(n_rows);
  }
  template <class Part>
  static void write(const Part& part, std::byte*& to) noexcept
  {
    std::memcpy(std::exchange(to, to + sizeof(Part)), static_cast<const void*>(&part), sizeof(Part));
  }
  template <class Part>
  static void read(const std::byte*& from, Part& part) noexcept
  {
    std::memcpy(static_cast<void*>(&part), std::exchange(from, from + sizeof(Part)), sizeof(Part));
  }
  std::vector<std::byte> bytes_;
};

/// Rows exchanged between this rank and another one: the rows `out` on one side are the rows `in` on the other.
struct NeighbourRank {
  int rank = 0;
  std::vector<Index> out, in;
};

/// The exchange with all neighbouring ranks, for messages of one kind.  A single rank has no neighbours.
class HaloExchange {
 public:
  HaloExchange() = default;
  HaloExchange(Communicator& ranks, MessageTag topic, std::vector<NeighbourRank> borders)
      : ranks_(&ranks), topic_(topic), borders_(std::move(borders)), sheets_out_(borders_.size()), sheets_in_(borders_.size())
  {}
  const std::vector<NeighbourRank>& borders() const noexcept { return borders_; }

  /// Sends rows `out` to the neighbours that to(border) selects, and expects rows from those that from(border) selects; both sides must
  /// agree.
  template <class What, class Rows, class To, class From>
  void send(Rows& rows, const What& what, To&& to, From&& from)
  {
    if (borders_.empty())
      return;
    parcels_out_.clear(), parcels_in_.clear(), expected_.clear();
    for (std::size_t q = 0; q < borders_.size(); ++q) {
      const NeighbourRank& border = borders_[q];
      if (!border.in.empty() && from(q)) {
        parcels_in_.push_back({border.rank, sheets_in_[q].room(border.in.size(), rows, what), true});
        expected_.push_back(q);
      }
      if (!border.out.empty() && to(q))
        parcels_out_.push_back({border.rank, sheets_out_[q].fill(border.out, rows, what)});
    }
    ranks_->start(parcels_out_, parcels_in_, static_cast<int>(topic_), pending_);
  }
  template <class What, class Rows>
  void send(Rows& rows, const What& what)
  {
    const auto all = [](std::size_t) { return true; };
    send(rows, what, all, all);
  }
  /// Receives the expected rows; rows that are not present are cleared.
  template <class What, class Rows>
  void take(Rows& rows, const What& what)
  {
    if (borders_.empty())
      return;
    pending_.wait();
    for (const std::size_t q : expected_)
      sheets_in_[q].take(borders_[q].in, rows, what);
    expected_.clear();
  }

 private:
  Communicator* ranks_ = nullptr;
  MessageTag topic_{};
  std::vector<NeighbourRank> borders_;
  std::vector<Sheet> sheets_out_, sheets_in_;  // by neighbour
  std::vector<Message> parcels_out_, parcels_in_;
  std::vector<std::size_t> expected_;  // numbers of neighbours
  PendingMessages pending_;
};

/// The nodes within `rings` rings of the nodes in `marked`.
template <int D>
std::vector<std::uint8_t> spread_by_rings(const Mesh<D>& mesh, std::vector<std::uint8_t> marked, int rings)
{
  for (; rings > 0; --rings) {
    const std::vector<std::uint8_t> before = marked;
    parallel_for(mesh.n_nodes(), [&](Index n) {
      for (const Index m : mesh.ring_of_node()[n])
        marked[static_cast<std::size_t>(n)] |= before[static_cast<std::size_t>(m)];
    });
  }
  return marked;
}

/// The exchange from owners to the ranks that hold copies.  `asked` has the numbers in the whole mesh of the copies on this rank, by owner,
/// whose local numbers are `in` of `all`; local_number(whole) finds those that others ask for.  Collective.
template <class LocalNumber>
HaloExchange copies_from_owners(Communicator& ranks, MessageTag topic, std::vector<NeighbourRank> all,
                                std::vector<std::vector<Index>> asked, LocalNumber&& local_number)
{
  asked = exchange_rows(ranks, asked);
  std::vector<NeighbourRank> borders;
  for (std::size_t q = 0; q < all.size(); ++q) {
    all[q].rank = static_cast<int>(q);
    for (const Index whole : asked[q])
      all[q].out.push_back(local_number(whole));
    if (!all[q].out.empty() || !all[q].in.empty())
      borders.push_back(std::move(all[q]));
  }
  return HaloExchange(ranks, topic, std::move(borders));
}

/// The exchange of the values of nodes; `wanted` marks those needed here, own ones included.  Collective.
inline HaloExchange copies_of_nodes(Communicator& ranks, const Subdomain& subdomain, MessageTag topic, std::span<const std::uint8_t> wanted)
{
  std::vector<NeighbourRank> all(static_cast<std::size_t>(ranks.size()));
  std::vector<std::vector<Index>> asked(all.size());
  for (std::size_t n = 0; n < wanted.size(); ++n)
    if (wanted[n] != 0 && !subdomain.owns_node(static_cast<Index>(n))) {
      const auto owner = static_cast<std::size_t>(subdomain.rank_of_node[n]);
      all[owner].in.push_back(static_cast<Index>(n));
      asked[owner].push_back(subdomain.node[n]);
    }
  return copies_from_owners(ranks, topic, std::move(all), std::move(asked), [&](Index whole) { return subdomain.local_node(whole); });
}

/// The exchange of the values of all cells of the part.  Collective.
inline HaloExchange copies_of_cells(Communicator& ranks, const Subdomain& subdomain, MessageTag topic, Index n_cells)
{
  std::vector<NeighbourRank> all(static_cast<std::size_t>(ranks.size()));
  std::vector<std::vector<Index>> asked(all.size());
  for (Index c = 0; c < n_cells; ++c)
    if (!subdomain.owns_cell(c)) {
      const auto owner = static_cast<std::size_t>(subdomain.rank_of_block[static_cast<std::size_t>(c / block_cells)]);
      all[owner].in.push_back(c);
      asked[owner].push_back(subdomain.whole_cell(c));
    }
  return copies_from_owners(ranks, topic, std::move(all), std::move(asked), [&](Index whole) { return subdomain.local_cell(whole); });
}

/// The way back of an exchange from owners to copies: what ranks have found for copies of nodes goes to the owners.
template <class Row>
class ReturnToOwners {
 public:
  ReturnToOwners() = default;
  /// A row of which nothing is sent is `nothing`.
  ReturnToOwners(Communicator& ranks, MessageTag topic, const HaloExchange& copies, const Row& nothing)
  {
    std::vector<NeighbourRank> borders;
    for (const NeighbourRank& border : copies.borders()) {
      NeighbourRank& back = borders.emplace_back(NeighbourRank{border.rank, border.in, {}});
      for (const Index n : border.out) {
        back.in.push_back(static_cast<Index>(owned_.size()));
        owned_.push_back(n);
      }
    }
    exchange_ = HaloExchange(ranks, topic, std::move(borders));
    of_others_.assign(owned_.size(), nothing);
  }
  /// Calls add(own row, that of another rank) for the rows of own nodes that others hold copies of.
  template <class What, class Add>
  void operator()(std::vector<Row>& rows, const What& what, Add&& add)
  {
    exchange_.send(rows, what);
    exchange_.take(of_others_, what);
    for (std::size_t k = 0; k < owned_.size(); ++k)
      add(rows[static_cast<std::size_t>(owned_[k])], of_others_[k]);
  }

 private:
  HaloExchange exchange_;
  std::vector<Index> owned_;  // nodes of other ranks' copies, one after the other
  std::vector<Row> of_others_;
};

}  // namespace talus
