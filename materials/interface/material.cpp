#include "materials/interface/material.hpp"

#include <algorithm>
#include <bit>
#include <chrono>

namespace talus {

Material::Material(std::shared_ptr<const ConstitutiveLaw> law, Index begin_row, Index end_row, std::string of_name, SourceLocation of_where)
    : where(std::move(of_where)), name(std::move(of_name)), history(law->description().history_width), law_(std::move(law))
{
  begin_anew(begin_row, end_row, *this);
}

Material Material::without_particles() const
{
  Material bare(law_, 0, 0, name, where);
  bare.viscosity = viscosity, bare.averages_volume = averages_volume, bare.group = group;
  return bare;
}

bool Material::weaken(Real factor)
{
  std::shared_ptr<const ConstitutiveLaw> weaker = law_->weakened(factor);
  if (weaker)
    law_ = std::move(weaker);
  return law_->description().has_strength;
}

void begin_anew(Index begin, Index end, Material& material)
{
  material.begin = begin, material.end = end;
  material.history.resize(0);
  material.history.resize(material.size());
  parallel_for(material.size(), [&](Index i) { material.law().initial_history(material.history.row(i)); });
}

namespace {

/// The columns of a strip that a law reads and writes, on the stack.
template <int D>
class CopiedStrip {
 public:
  static constexpr std::size_t room = 32;

  /// `strip.errors` and the numbers of the step are set by the caller.
  CopiedStrip(Material& material, const StressBlock<D>& block)
      : material_(material), block_(block), ahead_(block.rows, {block.particles}), has_pore_(!block.pore_after.empty())
  {
    strip_.dt = block.dt, strip_.elastic = block.elastic, strip_.errors = &block.errors;
    Real* next = numbers_.data();
    const auto place = [&](auto& column) {
      column.first = next, column.stride = room;
      next += room * static_cast<std::size_t>(column.components);
    };
    place(strip_.v), place(strip_.L), place(strip_.F), place(strip_.stress);
    place(strip_.mass), place(strip_.volume0), place(strip_.volume), place(strip_.altitude);
    if (material.viscosity)
      place(strip_.viscous);
    if (material.averages_volume)
      place(strip_.averaged), place(strip_.volume_ratio);
    if (has_pore_)
      place(strip_.pore), place(strip_.pore_after);
    static thread_local std::vector<Real> histories;
    histories.resize(room * std::max<std::size_t>(1, width()));
    strip_.id = {id_.data()}, strip_.history = {histories.data(), room};
  }

  /// Copies up to `room` rows; those of the block behind them are prefetched.
  const StressStrip<D>& take(std::span<const Index> rows) noexcept
  {
    const Particles<D>& particles = block_.particles;
    const auto first = static_cast<std::size_t>(rows.data() - block_.rows.data());
    strip_.n = rows.size();
    for_each(rows, [&](const ParticlePack& pack, std::size_t i) {
      ahead_.until(first + i + pack_size);
      strip_.v.store(i, pack.load(particles.v)), strip_.L.store(i, pack.load(particles.L));
      strip_.F.store(i, pack.load(particles.F)), strip_.stress.store(i, pack.load(particles.stress));
      strip_.mass.store(i, pack.load(particles.mass)), strip_.volume0.store(i, pack.load(particles.volume0));
      strip_.volume.store(i, pack.load(particles.volume));
      strip_.altitude.store(i, pack.lanes([&](std::size_t p) { return block_.altitudes[static_cast<std::size_t>(particles.cell[p])]; }));
      if (material_.viscosity)
        strip_.viscous.store(i, pack.load(particles.viscous));
      if (material_.averages_volume)
        strip_.averaged.store(i, pack.load(block_.averaged)), strip_.volume_ratio.store(i, pack.load(particles.volume_ratio));
      if (has_pore_)
        strip_.pore.store(i, pack.load(particles.pore)), strip_.pore_after.store(i, pack.load(block_.pore_after));
      for (std::size_t lane = 0; lane < pack_size; ++lane) {
        id_[i + lane] = std::bit_cast<Real>(particles.id[pack.p[lane]]);
        const Real* const history = history_of(pack.p[lane]);
        for (std::size_t k = 0; k < width(); ++k)
          strip_.history.first[k * room + i + lane] = history[k];
      }
    });
    return strip_;
  }
  /// Copies what has changed back.
  void give(std::span<const Index> rows) noexcept
  {
    Particles<D>& particles = block_.particles;
    for_each(rows, [&](const ParticlePack& pack, std::size_t i) {
      pack.store(strip_.F.load(i), particles.F), pack.store(strip_.stress.load(i), particles.stress);
      pack.store(strip_.volume.load(i), particles.volume);
      if (material_.viscosity)
        pack.store(strip_.viscous.load(i), particles.viscous);
      if (material_.averages_volume)
        pack.store(strip_.volume_ratio.load(i), particles.volume_ratio);
      if (has_pore_)
        pack.store(strip_.pore.load(i), particles.pore);
      for (std::size_t lane = 0; lane < static_cast<std::size_t>(pack.count); ++lane) {
        Real* const history = history_of(pack.p[lane]);
        for (std::size_t k = 0; k < width(); ++k)
          history[k] = strip_.history.first[k * room + i + lane];
      }
    });
  }

 private:
  template <class F>
  static void for_each(std::span<const Index> rows, F&& f)
  {
    for (std::size_t i = 0; i < rows.size(); i += pack_size)
      f(ParticlePack(rows, i), i);
  }

  std::size_t width() const noexcept { return static_cast<std::size_t>(material_.history.width()); }
  Real* history_of(std::size_t p) noexcept { return material_.history.row(static_cast<Index>(p) - material_.begin); }

  Material& material_;
  const StressBlock<D>& block_;
  struct Prefetch {
    const Particles<D>& of;
    void operator()(std::size_t p) const noexcept { prefetch_row(p, of.F, of.stress, of.volume, of.volume0, of.mass); }
  };
  PrefetchRows<Prefetch> ahead_;
  bool has_pore_;
  StressStrip<D> strip_;
  static constexpr std::size_t columns = D + D * D + 9 + 6 + 9;  ///< v, L, F, stress and nine numbers
  alignas(64) std::array<Real, room * columns> numbers_;
  std::array<Real, room> id_;
};

}  // namespace

template <int D>
StressSums update_stress(const Material& material, const StressStrip<D>& strip) noexcept
{
  return material.law().update_stress(material, strip);
}
template <int D>
StressSums update_stress(Material& material, const StressBlock<D>& block) noexcept
{
  const auto begin = std::chrono::steady_clock::now();
  CopiedStrip<D> copy(material, block);
  StressSums sums;
  for (std::size_t first = 0; first < block.rows.size(); first += CopiedStrip<D>::room) {
    const auto rows = block.rows.subspan(first, std::min(CopiedStrip<D>::room, block.rows.size() - first));
    const StressSums part = update_stress(std::as_const(material), copy.take(rows));
    copy.give(rows);
    sums.work += part.work;
    sums.take_extremes(part);
  }
  sums.seconds = std::chrono::duration<Real>(std::chrono::steady_clock::now() - begin).count();
  return sums;
}
template StressSums update_stress<2>(const Material&, const StressStrip<2>&) noexcept;
template StressSums update_stress<3>(const Material&, const StressStrip<3>&) noexcept;
template StressSums update_stress<2>(Material&, const StressBlock<2>&) noexcept;
template StressSums update_stress<3>(Material&, const StressBlock<3>&) noexcept;

Real plastic_work(const ConstitutiveLaw& law, const Real* history, Real volume0) noexcept
{
  const auto work = law.description().scalar_variable("plastic_work");
  return work ? volume0 * history[*work] : 0;
}
Real plastic_work(const Material& material, Index i, Real volume0) noexcept
{
  return plastic_work(material.law(), material.history.row(i), volume0);
}

}  // namespace talus
