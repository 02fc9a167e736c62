#include "materials/interface/material.hpp"

#include "core/parallel/threads.hpp"

namespace talus {

Material::Material(std::shared_ptr<const ConstitutiveLaw> law, Index begin_row, Index end_row, std::string of_name, SourceLocation of_where)
    : where(std::move(of_where)), name(std::move(of_name)), history(law->description().history_width), law_(std::move(law))
{
  begin_anew(begin_row, end_row, *this);
}

Material Material::without_particles() const
{
  Material bare(law_, 0, 0, name, where);
  bare.viscosity = viscosity, bare.averages_volume = averages_volume, bare.group = group, bare.kind = kind;
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

template <int D>
StressSums update_stress(const Material& material, const StressStrip<D>& strip) noexcept
{
  return material.law().update_stress(material, strip);
}
template StressSums update_stress<2>(const Material&, const StressStrip<2>&) noexcept;
template StressSums update_stress<3>(const Material&, const StressStrip<3>&) noexcept;

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
