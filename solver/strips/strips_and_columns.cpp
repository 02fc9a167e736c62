#include "solver/strips/particle_strips.hpp"

#include <cstring>
#include <numeric>

#include "solver/state/saved_columns.hpp"

namespace talus {

namespace {

/// The numbers of a row of a column; an id has the size of a number.
template <class Column>
void read_row(const Column& column, std::size_t row, Real* first, std::size_t stride) noexcept
{
  static_assert(sizeof(typename RowsOf<Column>::Number) == sizeof(Real));
  const auto* const numbers = numbers_of(column, row);
  for (int c = 0; c < RowsOf<Column>::components; ++c)
    std::memcpy(first + static_cast<std::size_t>(c) * stride, numbers + c, sizeof(Real));
}
template <class Column>
void write_row(const Real* first, std::size_t stride, Column& column, std::size_t row) noexcept
{
  auto* const numbers = numbers_of(column, row);
  for (int c = 0; c < RowsOf<Column>::components; ++c)
    std::memcpy(numbers + c, first + static_cast<std::size_t>(c) * stride, sizeof(Real));
}

/// The rows of each key in front of sheets, then of each behind them.
template <int D>
std::vector<std::vector<Index>> rows_by_side(const Particles<D>& particles, const CellOrder& sorted)
{
  std::vector<std::vector<Index>> rows(2 * sorted.keys());
  for (std::size_t key = 0; key < sorted.keys(); ++key)
    for (const Index row : sorted.rows(key))
      rows[SideOfSheet(particles.side[to_size(row)]).is_stored_behind() ? sorted.keys() + key : key].push_back(row);
  return rows;
}

}  // namespace

template <int D>
void ParticleStrips<D>::load(Communicator& ranks, Index n_cells, bool keep_gradients, const std::vector<Body>& bodies,
                             std::vector<Material>& materials, Particles<D>& particles, CellOrder& sorted)
{
  sort_by_cell(particles.cell, particles.id, bodies, n_cells, sorted);
  layout_ = StripLayout(particles, count_keepers(ranks, particles), keep_gradients);
  history_width_.clear();
  for (const Material& material : materials)
    history_width_.push_back(material.history.width());
  blocks_ = sorted.blocks;
  sides_ = layout_.step_arrays().side == none ? 1 : 2;

  block_ = std::vector<BlockOfStrips>(to_size(sides_) * sorted.keys());
  const std::vector<std::vector<Index>> on_side = sides_ == 1 ? std::vector<std::vector<Index>>() : rows_by_side(particles, sorted);
  const auto rows_of = [&](std::size_t key) { return sides_ == 1 ? sorted.rows(key) : std::span<const Index>(on_side[key]); };
  std::size_t numbers = 0, gradients = 0;
  for (std::size_t key = 0; key < block_.size(); ++key) {
    if (rows_of(key).empty())
      continue;
    std::vector<Strip>& strips = block_[key].strips;
    strips.resize(to_size(strips_in_block));
    const Index first = first_cell(key, 0);
    for (const Index row : rows_of(key)) {
      const Index cell = particles.cell[to_size(row)] - first;
      ++strips[to_size(cell / strip_cells)].count[to_size(cell % strip_cells)];
    }
    for (Strip& strip : strips) {
      strip.n = std::accumulate(strip.count.begin(), strip.count.end(), Index{0});
      strip.room = strip.n > 0 ? room_for(strip.n) : 0;
      numbers += to_size(strip.room) * strip_width(key);
      gradients += to_size(strip.room) * to_size(layout_.gradients() - layout_.kept_gradients());
    }
  }
  memory_.assign(numbers + 8, 0);
  loaded_gradients_.assign(gradients, 0);
  Real* next_gradients = loaded_gradients_.data();
  Real* next = memory_.data();
  while (reinterpret_cast<std::uintptr_t>(next) % 64 != 0)
    ++next;
  for (std::size_t key = 0; key < block_.size(); ++key)
    for (Strip& strip : block_[key].strips) {
      strip.numbers = next;
      next += to_size(strip.room) * strip_width(key);
      strip.loaded_gradients = next_gradients;
      next_gradients += to_size(strip.room) * to_size(layout_.gradients() - layout_.kept_gradients());
    }

  parallel_for_uneven(static_cast<Index>(block_.size()), [&](Index k) {
    const auto rows = rows_of(to_size(k));
    Material& material = materials[to_size(body(to_size(k)))];
    std::size_t first = 0;
    for (Strip& strip : block_[to_size(k)].strips) {
      const auto here = rows.subspan(first, to_size(strip.n));
      first += to_size(strip.n);
      std::size_t number = 0;
      particles.for_each_column([&](std::string_view, std::string_view, const auto& column) {
        if constexpr (sizeof(typename RowsOf<std::decay_t<decltype(column)>>::Number) == sizeof(Real))
          if (const Index at = layout_.at(number); at != none)
            for (std::size_t i = 0; i < here.size(); ++i)
              read_row(column, to_size(here[i]), strip.array(at) + i, to_size(strip.room));
        ++number;
      });
      const StripColumns<D> all = columns(strip);
      for (std::size_t i = 0; i < here.size(); ++i) {
        all.before.set(i, all.x.of(i));
        all.L.set(i, particles.L[to_size(here[i])]);
        if (all.C)
          all.C.set(i, particles.C[to_size(here[i])]);
      }
      for (std::size_t i = 0; i < here.size() && material.history.width() > 0; ++i) {
        const Real* const from = material.history.row(here[i] - material.begin);
        for (int of_law = 0; of_law < material.history.width(); ++of_law)
          history(strip).component(of_law)[i] = from[of_law];
      }
    }
  });
  clear(materials, particles, sorted);
}

template <int D>
void ParticleStrips<D>::clear(std::vector<Material>& materials, Particles<D>& particles, CellOrder& sorted)
{
  particles.for_each_column([](std::string_view, std::string_view, auto& column) { column = {}; });
  for (Material& material : materials)
    material.history = HistoryRows(material.history.width());
  sorted.row = {};
}

template <int D>
void ParticleStrips<D>::store(std::vector<Body>& bodies, std::vector<Material>& materials, Particles<D>& particles, CellOrder& sorted,
                              const FindGradients& find_gradients) const
{
  const std::size_t keys_in_front = block_.size() / to_size(sides_);
  sorted.first.assign(keys_in_front + 1, 0);
  for (std::size_t key = 0; key < keys_in_front; ++key)
    sorted.first[key + 1] = sorted.first[key] + size(key) + (sides_ > 1 ? size(keys_in_front + key) : 0);
  sorted.blocks = blocks_;
  const auto n = to_size(sorted.first.back());
  sorted.row.resize(n);
  std::iota(sorted.row.begin(), sorted.row.end(), 0);
  std::size_t number = 0;
  particles.for_each_column([&](std::string_view name, std::string_view, auto& column) {
    if (layout_.at(number++) != none || name == "cell" || name == StripLayout::gradient ||
        (name == StripLayout::affine && layout_.has_affine()))
      column.resize(n);
  });
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    bodies[b].begin = sorted.first[b * to_size(blocks_)], bodies[b].end = sorted.first[(b + 1) * to_size(blocks_)];
    materials[b].set_range(bodies[b]);
    materials[b].history.resize(bodies[b].size());
  }
  parallel_for_uneven(static_cast<Index>(block_.size()), [&](Index k) {
    Material& material = materials[to_size(body(to_size(k)))];
    const bool behind = to_size(k) >= keys_in_front;
    const std::size_t in_front = to_size(k) - (behind ? keys_in_front : 0);
    auto first = to_size(sorted.first[in_front] + (behind ? size(in_front) : 0));
    for (std::size_t s = 0; s < block_[to_size(k)].strips.size(); ++s) {
      const Strip& strip = block_[to_size(k)].strips[s];
      std::size_t at_column = 0;
      particles.for_each_column([&](std::string_view, std::string_view, auto& column) {
        if constexpr (sizeof(typename RowsOf<std::decay_t<decltype(column)>>::Number) == sizeof(Real))
          if (const Index at = layout_.at(at_column); at != none)
            for (std::size_t i = 0; i < to_size(strip.n); ++i)
              write_row(strip.array(at) + i, to_size(strip.room), column, first + i);
        ++at_column;
      });
      if (StripColumns<D> all = columns(strip); strip.n > 0) {
        if (!all.L)
          find_gradients(to_size(k), static_cast<Index>(s), all);
        for (std::size_t i = 0; i < to_size(strip.n); ++i) {
          particles.L.set(first + i, all.L.of(i));
          if (all.C)
            particles.C.set(first + i, all.C.of(i));
        }
      }
      auto row = static_cast<Index>(first);
      for (Index c = 0; c < strip_cells; ++c)
        for (Index i = 0; i < strip.count[to_size(c)]; ++i)
          particles.cell[to_size(row++)] = first_cell(to_size(k), static_cast<Index>(s)) + c;
      for (Index i = 0; i < strip.n && material.history.width() > 0; ++i) {
        Real* const to = material.history.row(static_cast<Index>(first) + i - material.begin);
        for (int of_law = 0; of_law < material.history.width(); ++of_law)
          to[of_law] = history(strip).component(of_law)[i];
      }
      first += to_size(strip.n);
    }
  });
}

template void ParticleStrips<2>::load(Communicator&, Index, bool, const std::vector<Body>&, std::vector<Material>&, Particles<2>&,
                                      CellOrder&);
template void ParticleStrips<2>::clear(std::vector<Material>&, Particles<2>&, CellOrder&);
template void ParticleStrips<2>::store(std::vector<Body>&, std::vector<Material>&, Particles<2>&, CellOrder&, const FindGradients&) const;
template void ParticleStrips<3>::load(Communicator&, Index, bool, const std::vector<Body>&, std::vector<Material>&, Particles<3>&,
                                      CellOrder&);
template void ParticleStrips<3>::clear(std::vector<Material>&, Particles<3>&, CellOrder&);
template void ParticleStrips<3>::store(std::vector<Body>&, std::vector<Material>&, Particles<3>&, CellOrder&, const FindGradients&) const;

}  // namespace talus
