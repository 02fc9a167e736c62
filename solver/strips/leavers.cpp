#include "solver/strips/particle_strips.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <utility>

namespace talus {

template <int D>
void ParticleStrips<D>::add_leaver(std::size_t key, Index number, const StripColumns<D>& from, Index i, Index cell, Index to_cell)
{
  BlockOfStrips& block = block_[key];
  const Strip& strip = block.strips[to_size(number)];
  block.leaving.all.push_back({number, i, cell, to_cell});
  std::vector<Real>& numbers = block.leaving.numbers;
  const std::size_t first = numbers.size();
  numbers.resize(first + record_width(key));
  Real* to = numbers.data() + first;
  for (Index k = 0; k < layout_.width(); ++k)
    std::memcpy(to++, strip.array(k) + i, sizeof(Real));
  for (const StripColumn<Mat<D>>* const column : {&from.L, &from.C})
    for (int c = 0; *column && c < D * D; ++c)
      *to++ = column->component(c)[i];
  for (int k = 0; k < history_width(body(key)); ++k)
    *to++ = history(strip).component(k)[i];
}

template <int D>
void ParticleStrips<D>::find_cells(const Mesh<D>& mesh, const Locator<D>& locator, std::size_t key,
                                   std::array<std::vector<Arrival>, 2>& within)
{
  for (std::vector<Arrival>& of_side : within)
    of_side.clear();
  Leavers& leavers = block_[key].leaving;
  for (std::size_t i = 0; i < leavers.all.size(); ++i) {
    const Real* const record = leavers.numbers.data() + i * record_width(key);
    Vec<D> x;
    for (int d = 0; d < D; ++d)
      x[d] = record[layout_.place() + d];
    Leavers::Leaver& leaver = leavers.all[i];
    leaver.to = locator(mesh, x, leaver.to).value_or(none);  // also nothing for a position that is not finite
    leaver.is_summed = leaver.to != none && leaver.to / block_cells == leaver.cell / block_cells;
    if (leaver.is_summed)
      within[is_behind(new_group(body(key), record)) ? 1 : 0].push_back(
          {leaver.to, StripIds::id_of(record[layout_.step_arrays().id]), record, true});
  }
}

template <int D>
void ParticleStrips<D>::take_exits(const Mesh<D>& mesh, const Locator<D>& locator, const Exits& exits,
                                   const std::vector<Material>& materials, const SetForces& set_forces, StepSums<D>& sums,
                                   ParticleErrors& errors)
{
  for (std::size_t key = 0; key < block_.size(); ++key)
    for (std::size_t i = 0; i < block_[key].leaving.all.size(); ++i) {
      Leavers::Leaver& leaver = block_[key].leaving.all[i];
      if (leaver.to != none)
        continue;
      // Rare: outside the mesh.
      Strip one;
      one.numbers = block_[key].leaving.numbers.data() + i * record_width(key), one.room = 1;
      const StripColumns<D> all = columns(one);
      const Vec<D> x = all.x.of(0);
      if (!x.allFinite()) {
        errors.report(all.id[0], Trouble::not_finite);
      } else if (const auto back = set_back(mesh, locator, exits, x)) {
        all.x.set(0, back->x);
        if (all.reference)
          all.reference.set(0, back->x);
        set_forces(all);
        leaver.to = back->cell;
        sums.removed.add({.held_count = 1});
        sums.largest_set_back = std::max(sums.largest_set_back, back->distance);
      } else if (exits.policy == OnExit::remove) {
        const Material& material = materials[to_size(body(key))];
        const Real* const of_law = one.numbers + layout_.width() + layout_.gradients();
        sums.removed.add(content_of<D>(x, all.v.of(0), all.mass.of(0), plastic_work(material.law(), of_law, all.volume0.of(0))));
      } else {
        errors.report(all.id[0], Trouble::lost);
      }
    }
}

template <int D>
void ParticleStrips<D>::send_leavers(const Subdomain& subdomain, Migration<D>& migration)
{
  unsorted_.clear();
  for (std::size_t key = 0; key < block_.size(); ++key) {
    BlockOfStrips& block = block_[key];
    std::swap(block.left, block.leaving);
    block.leaving.clear();
    const Index of_body = body(key);
    const std::span<Real> numbers(block.left.numbers);
    for (std::size_t i = 0; i < block.left.all.size(); ++i) {
      const Index cell = block.left.all[i].to;
      const auto record = numbers.subspan(i * record_width(key), record_width(key));
      if (cell == none)
        continue;
      const Index to_group = new_group(of_body, record.data());
      if (sides_ > 1) {
        Real& number = record[to_size(layout_.step_arrays().side)];
        SideOfSheet side(number);
        side.changes = false;
        number = side.number();
      }
      if (!subdomain.alone() && !subdomain.owns_cell(cell))
        migration.add({of_body, subdomain.whole_cell(cell)}, cell / block_cells, record);
      else
        unsorted_.push_back(
            {key_of(to_group, cell),
             {cell, StripIds::id_of(record[to_size(layout_.step_arrays().id)]), record.data(), block.left.all[i].is_summed}});
    }
  }
  if (!subdomain.alone())
    for (const MigratingParticle& one :
         migration.exchange([&](Index b) { return layout_.width() + layout_.gradients() + history_width(b); })) {
      const Index cell = subdomain.local_cell(one.head.whole_cell);
      unsorted_.push_back({key_of(new_group(one.head.body, one.numbers), cell),
                           {cell, StripIds::id_of(one.numbers[layout_.step_arrays().id]), one.numbers, false}});
    }
  sort_arrivals();
}

template <int D>
void ParticleStrips<D>::sort_arrivals()
{
  for (BlockOfStrips& block : block_)
    block.arrivals = 0;
  for (const auto& [key, arrival] : unsorted_)
    ++block_[key].arrivals;
  std::size_t first = 0;
  for (BlockOfStrips& block : block_) {
    block.first_arrival = first;
    first += std::exchange(block.arrivals, 0);
  }
  arrivals_.resize(first);
  for (const auto& [key, arrival] : unsorted_) {
    BlockOfStrips& block = block_[key];
    block.strips.resize(to_size(strips_in_block));
    arrivals_[block.first_arrival + block.arrivals++] = arrival;
  }
  parallel_for_uneven(static_cast<Index>(block_.size()), [&](Index k) {
    BlockOfStrips& block = block_[to_size(k)];
    const auto here = std::span(arrivals_).subspan(block.first_arrival, block.arrivals);
    std::ranges::sort(here, [](const Arrival& a, const Arrival& b) { return a.cell != b.cell ? a.cell < b.cell : a.id < b.id; });
    block.first_left.fill(0), block.first_coming.fill(0);
    for (const Leavers::Leaver& leaver : block.left.all)
      ++block.first_left[to_size(leaver.strip) + 1];
    for (const Arrival& arrival : here)
      ++block.first_coming[to_size(arrival.cell % block_cells / strip_cells) + 1];
    std::partial_sum(block.first_left.begin(), block.first_left.end(), block.first_left.begin());
    std::partial_sum(block.first_coming.begin(), block.first_coming.end(), block.first_coming.begin());
  });
  first_memory_.assign(to_size(blocks_), {});
  for (std::size_t key = block_.size(); key-- > 0;)
    if (const std::vector<Strip>& strips = block_[key].strips; !strips.empty())
      first_memory_[key % to_size(blocks_)] = memory(key, strips.front());
}

template void ParticleStrips<2>::add_leaver(std::size_t, Index, const StripColumns<2>&, Index, Index, Index);
template void ParticleStrips<2>::find_cells(const Mesh<2>&, const Locator<2>&, std::size_t, std::array<std::vector<Arrival>, 2>&);
template void ParticleStrips<2>::take_exits(const Mesh<2>&, const Locator<2>&, const Exits&, const std::vector<Material>&, const SetForces&,
                                            StepSums<2>&, ParticleErrors&);
template void ParticleStrips<2>::send_leavers(const Subdomain&, Migration<2>&);
template void ParticleStrips<3>::add_leaver(std::size_t, Index, const StripColumns<3>&, Index, Index, Index);
template void ParticleStrips<3>::find_cells(const Mesh<3>&, const Locator<3>&, std::size_t, std::array<std::vector<Arrival>, 2>&);
template void ParticleStrips<3>::take_exits(const Mesh<3>&, const Locator<3>&, const Exits&, const std::vector<Material>&, const SetForces&,
                                            StepSums<3>&, ParticleErrors&);
template void ParticleStrips<3>::send_leavers(const Subdomain&, Migration<3>&);

}  // namespace talus
