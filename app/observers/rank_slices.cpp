#include "app/observers/rank_slices.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>

#include "solver/particles/redistribute.hpp"

namespace talus {

namespace {

/// Ids of all ranks, sorted: each rank has the ids in a range.
struct SortedIds {
  struct One {
    std::int64_t id;
    std::size_t rank, place;  ///< rank that has the particle, and index in its message
  };
  std::vector<One> here;
  std::vector<std::vector<std::int64_t>> sent;  ///< row on this rank for each rank and index
  std::vector<std::size_t> received;            ///< number from each rank
};

SortedIds sort_ids(Communicator& ranks, std::span<const std::int64_t> ids)
{
  const std::int64_t most = ranks.max(ids.empty() ? std::int64_t{0} : *std::ranges::max_element(ids));
  const Real share = static_cast<Real>(ranks.size()) / (static_cast<Real>(most) + 1);
  SortedIds sorted;
  sorted.sent.resize(static_cast<std::size_t>(ranks.size()));
  std::vector<std::vector<std::int64_t>> out(sorted.sent.size());
  for (std::size_t row = 0; row < ids.size(); ++row) {
    const auto last = static_cast<Real>(ranks.size() - 1);
    const auto owner = static_cast<std::size_t>(std::clamp(static_cast<Real>(ids[row]) * share, Real{0}, last));  // monotonic in the id
    out[owner].push_back(ids[row]);
    sorted.sent[owner].push_back(static_cast<std::int64_t>(row));
  }
  const auto in = exchange_rows(ranks, out);
  for (std::size_t r = 0; r < in.size(); ++r) {
    sorted.received.push_back(in[r].size());
    for (std::size_t i = 0; i < in[r].size(); ++i)
      sorted.here.push_back({in[r][i], r, i});
  }
  std::ranges::sort(sorted.here, [](const SortedIds::One& a, const SortedIds::One& b) {
    return std::tie(a.id, a.rank, a.place) < std::tie(b.id, b.rank, b.place);
  });
  return sorted;
}

/// The number of each row among the rows of all ranks in the order of ids.
std::vector<std::int64_t> numbers_by_id(Communicator& ranks, std::span<const std::int64_t> ids)
{
  const SortedIds sorted = sort_ids(ranks, ids);
  const auto counts = of_all_ranks(ranks, static_cast<std::int64_t>(sorted.here.size()));
  std::int64_t next = std::accumulate(counts.begin(), counts.begin() + ranks.rank(), std::int64_t{0});
  std::vector<std::vector<std::int64_t>> answers;
  for (const std::size_t n : sorted.received)
    answers.emplace_back(n);
  for (const SortedIds::One& one : sorted.here)
    answers[one.rank][one.place] = next++;
  answers = exchange_rows(ranks, answers);
  std::vector<std::int64_t> numbers(ids.size());
  for (std::size_t r = 0; r < answers.size(); ++r)
    for (std::size_t i = 0; i < answers[r].size(); ++i)
      numbers[static_cast<std::size_t>(sorted.sent[r][i])] = answers[r][i];
  return numbers;
}

/// Sends items of `width` values to the ranks whose slice contains their number; returns those of this rank, in the order of numbers.
template <class T>
std::vector<T> dealt(Communicator& ranks, const Slices& slices, std::span<const Index> number, std::span<const T> values, std::size_t width)
{
  std::vector<std::vector<Index>> numbers(static_cast<std::size_t>(ranks.size()));
  std::vector<std::vector<T>> items(numbers.size());
  for (std::size_t i = 0; i < number.size(); ++i) {
    const auto to = static_cast<std::size_t>(slices.rank_of(number[i]));
    const auto item = values.subspan(i * width, width);
    numbers[to].push_back(number[i]);
    items[to].insert(items[to].end(), item.begin(), item.end());
  }
  numbers = exchange_rows(ranks, numbers);
  items = exchange_rows(ranks, items);
  std::vector<T> mine(slices.size(ranks.rank()) * width);
  for (std::size_t r = 0; r < numbers.size(); ++r)
    for (std::size_t i = 0; i < numbers[r].size(); ++i)
      std::copy_n(items[r].begin() + static_cast<std::ptrdiff_t>(i * width), width,
                  mine.begin() + (numbers[r][i] - slices.begin(ranks.rank())) * static_cast<std::ptrdiff_t>(width));
  return mine;
}

template <int D>
Slices slices_of_nodes(const RunView<D>& view, std::int64_t piece)
{
  return {view.problem.subdomain.alone() ? view.problem.mesh.n_nodes() : view.problem.subdomain.whole_nodes, view.problem.ranks->size(),
          piece};
}

}  // namespace

std::optional<std::int64_t> doubled_id(Communicator& ranks, std::span<const std::int64_t> ids)
{
  const SortedIds sorted = sort_ids(ranks, ids);
  const auto twice = std::ranges::adjacent_find(sorted.here, [](const SortedIds::One& a, const SortedIds::One& b) { return a.id == b.id; });
  constexpr std::int64_t no_id = std::numeric_limits<std::int64_t>::max();
  const std::int64_t least = ranks.min(twice == sorted.here.end() ? no_id : twice->id);
  return least == no_id ? std::nullopt : std::optional(least);
}

template <int D>
ParticleSlice<D> slice_of_particles(const RunView<D>& view, std::int64_t piece)
{
  Communicator& ranks = *view.problem.ranks;
  const std::vector<std::int64_t> number = numbers_by_id(ranks, view.state.particles.id);
  const Slices slices{ranks.sum(static_cast<std::int64_t>(number.size())), ranks.size(), piece};
  std::vector<int> rank_of_row;
  for (const std::int64_t n : number)
    rank_of_row.push_back(slices.rank_of(n));

  ParticleSlice<D> slice{view.state, view.state.bodies, slices.of(ranks.rank())};
  if (!view.problem.subdomain.alone())
    for (Index& cell : slice.state.particles.cell)
      cell = view.problem.subdomain.whole_cell(cell);
  redistribute(ranks, rank_of_row, slice.state.bodies, slice.state.materials, slice.state.particles);
  std::vector<std::int64_t> sizes;
  for (const Body& body : view.state.bodies)
    sizes.push_back(body.size());
  ranks.sum(sizes);
  Index end = 0;
  for (std::size_t b = 0; b < sizes.size(); ++b) {
    slice.whole_bodies[b].begin = end;
    slice.whole_bodies[b].end = end += static_cast<Index>(sizes[b]);
  }
  return slice;
}

template <int D>
MeshSlice slice_of_mesh(const RunView<D>& view, std::int64_t piece)
{
  Communicator& ranks = *view.problem.ranks;
  const Subdomain& subdomain = view.problem.subdomain;
  const Mesh<D>& mesh = view.problem.mesh;
  const Slices nodes = slices_of_nodes(view, piece);
  const Slices cells{subdomain.alone() ? mesh.n_cells() : subdomain.whole_cells, ranks.size(), piece};
  std::vector<Index> number;
  std::vector<Real> positions;
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    if (subdomain.alone() || subdomain.owns_node(n)) {
      number.push_back(subdomain.alone() ? n : subdomain.node[static_cast<std::size_t>(n)]);
      for (int d = 0; d < 3; ++d)
        positions.push_back(d < D ? mesh.node(n)[std::min(d, D - 1)] : 0.0);
    }
  MeshSlice slice{D, nodes.of(ranks.rank()), dealt<Real>(ranks, nodes, number, positions, 3), cells.of(ranks.rank()), {}};
  number.clear();
  std::vector<Index> corners;
  for (Index c = 0; c < mesh.n_cells(); ++c)
    if (subdomain.alone() || subdomain.owns_cell(c)) {
      number.push_back(subdomain.alone() ? c : subdomain.whole_cell(c));
      for (const Index n : mesh.cell(c))
        corners.push_back(subdomain.alone() ? n : subdomain.node[static_cast<std::size_t>(n)]);
    }
  slice.corners = dealt<Index>(ranks, cells, number, corners, D + 1);
  return slice;
}

template <int D>
Column slice_of_column(const RunView<D>& view, Column held, std::int64_t piece)
{
  if (view.problem.subdomain.alone())
    return held;
  const auto width = static_cast<std::size_t>(held.components);
  std::vector<Index> number;
  std::vector<float> own;
  for (Index n = 0; n < view.problem.mesh.n_nodes(); ++n)
    if (view.problem.subdomain.owns_node(n)) {
      number.push_back(view.problem.subdomain.node[static_cast<std::size_t>(n)]);
      const auto values = std::span(held.values).subspan(static_cast<std::size_t>(n) * width, width);
      own.insert(own.end(), values.begin(), values.end());
    }
  held.values = dealt<float>(*view.problem.ranks, slices_of_nodes(view, piece), number, own, width);
  return held;
}

template ParticleSlice<2> slice_of_particles<2>(const RunView<2>&, std::int64_t);
template ParticleSlice<3> slice_of_particles<3>(const RunView<3>&, std::int64_t);
template MeshSlice slice_of_mesh<2>(const RunView<2>&, std::int64_t);
template MeshSlice slice_of_mesh<3>(const RunView<3>&, std::int64_t);
template Column slice_of_column<2>(const RunView<2>&, Column, std::int64_t);
template Column slice_of_column<3>(const RunView<3>&, Column, std::int64_t);

}  // namespace talus
