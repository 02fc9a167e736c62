#include "solver/strips/particle_strips.hpp"

namespace talus {

template <int D>
Index ParticleStrips<D>::size() const noexcept
{
  Index n = 0;
  for (std::size_t key = 0; key < block_.size(); ++key)
    n += size(key);
  return n;
}

template <int D>
Index ParticleStrips<D>::size(std::size_t key) const noexcept
{
  Index n = 0;
  for (const Strip& strip : block_[key].strips)
    n += strip.n;
  return n;
}

template <int D>
std::size_t ParticleStrips<D>::bytes_moved() const noexcept
{
  const auto has = [&](std::string_view name, Index numbers) { return layout_.at(name) == none ? 0 : numbers; };
  const Index constant = has("mass", 1) + has("volume0", 1) + has("id", 1) + has("start", D);
  const auto of_columns =
      to_size(2 * (layout_.width() + layout_.kept_gradients() - D - constant) + constant + D);  // `before` is only written
  std::size_t numbers = 0;
  for (std::size_t key = 0; key < block_.size(); ++key)
    for (const Strip& strip : block_[key].strips)
      numbers += to_size(strip.n) * (of_columns + 2 * to_size(history_width(body(key))));
  return numbers * sizeof(Real);
}

template <int D>
StripColumns<D> ParticleStrips<D>::columns(const Strip& strip) const noexcept
{
  StripColumns<D> all;
  const StepArrays& at = layout_.step_arrays();
  const auto find = [&](Index array, auto& column) {
    if (array != none)
      column.first = strip.array(array), column.stride = to_size(strip.room);
  };
  find(at.x, all.x), find(at.before, all.before), find(at.x0, all.x0), find(at.v, all.v), find(at.F, all.F), find(at.stress, all.stress);
  find(at.mass, all.mass), find(at.volume0, all.volume0), find(at.volume, all.volume);
  find(at.viscous, all.viscous), find(at.pore, all.pore), find(at.side, all.side);
  find(at.water, all.water), find(at.water_gradient, all.water_gradient), find(at.water_at_rest, all.water_at_rest);
  find(at.jump_stress, all.jump_stress);
  find(at.reference, all.reference), find(at.since_reference, all.G), find(at.domain, all.domain);
  find(at.applied, all.applied), find(at.volume_ratio, all.volume_ratio), find(at.averaged, all.averaged);
  all.id = {strip.array(at.id)};
  if (layout_.kept_gradients() > 0)
    set_gradients(strip.array(layout_.width()), to_size(strip.room), all);
  else if (!loaded_gradients_.empty())
    set_gradients(strip.loaded_gradients, to_size(strip.room), all);
  return all;
}

template <int D>
StripColumns<D> ParticleStrips<D>::columns_of_records(const Strip& records) const noexcept
{
  StripColumns<D> all = columns(records);
  set_gradients(records.array(layout_.width()), to_size(records.room), all);
  return all;
}

template <int D>
void ParticleStrips<D>::set_gradients(Real* first, std::size_t stride, StripColumns<D>& all) const noexcept
{
  all.L = {first, stride};
  if (layout_.has_affine())
    all.C = {first + D * D * stride, stride};
}

template <int D>
void ParticleStrips<D>::drop_loaded_gradients() noexcept
{
  loaded_gradients_ = {};
}

template <int D>
Index ParticleStrips<D>::size_in_order(std::size_t key) const noexcept
{
  const BlockOfStrips& block = block_[key];
  return size(key) + static_cast<Index>(block.arrivals) - static_cast<Index>(block.left.all.size());
}

template <int D>
Totals<D> totals(const ParticleStrips<D>& strips, Communicator& ranks)
{
  ExactSums<Totals<D>> sum;
  add_parts(static_cast<Index>(strips.keys()), sum, [&](Index key) {
    Totals<D> part{};
    for (const Strip& strip : strips.strips(to_size(key))) {
      const StripColumns<D> all = strips.columns(strip);
      for (std::size_t i = 0; i < to_size(strip.n); ++i)
        part += totals_of<D>(all.mass.of(i), all.x.of(i), all.v.of(i));
    }
    return part;
  });
  ranks.sum(sum);
  return sum.value();
}

template Totals<2> totals(const ParticleStrips<2>&, Communicator&);
template Index ParticleStrips<2>::size() const noexcept;
template std::size_t ParticleStrips<2>::bytes_moved() const noexcept;
template std::size_t ParticleStrips<3>::bytes_moved() const noexcept;
template Index ParticleStrips<2>::size(std::size_t) const noexcept;
template Index ParticleStrips<3>::size(std::size_t) const noexcept;
template Index ParticleStrips<2>::size_in_order(std::size_t) const noexcept;
template StripColumns<2> ParticleStrips<2>::columns(const Strip&) const noexcept;
template StripColumns<2> ParticleStrips<2>::columns_of_records(const Strip&) const noexcept;
template void ParticleStrips<2>::drop_loaded_gradients() noexcept;
template Totals<3> totals(const ParticleStrips<3>&, Communicator&);
template Index ParticleStrips<3>::size() const noexcept;
template Index ParticleStrips<3>::size_in_order(std::size_t) const noexcept;
template StripColumns<3> ParticleStrips<3>::columns(const Strip&) const noexcept;
template StripColumns<3> ParticleStrips<3>::columns_of_records(const Strip&) const noexcept;
template void ParticleStrips<3>::drop_loaded_gradients() noexcept;

}  // namespace talus
