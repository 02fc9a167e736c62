#include "app/observers/validate_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/parallel/threads.hpp"
#include "solver/run_limits.hpp"

namespace talus {

namespace {

/// The lowest i in [0, n) with is_bad(i), or none.
template <class F>
Index first_bad(Index n, F&& is_bad)
{
  const auto first = static_cast<Index>(parallel_min(n, n, [&](Index i) { return is_bad(i) ? i : n; }));
  return first < n ? first : none;
}

void must_not_be_negative(std::string_view name, Real value, std::vector<std::string>& faults)
{
  if (!std::isfinite(value) || value < 0)
    faults.push_back(fmt::format("{} is {:.6g} s, not a time from 0 on", name, value));
}

/// Adds the faults of particles.
template <int D>
class Inspection {
 public:
  Inspection(const Particles<D>& particles, const std::vector<Body>& bodies, std::vector<std::string>& faults)
      : particles_(particles), bodies_(bodies), faults_(faults)
  {}

  /// Checks that ids are unique.
  void ids()
  {
    std::vector<std::int64_t> ids(particles_.id);
    std::sort(ids.begin(), ids.end());
    if (!ids.empty() && ids.front() < 0)
      faults_.push_back(fmt::format("there is a particle of number {}", ids.front()));
    if (const auto twice = std::adjacent_find(ids.begin(), ids.end()); twice != ids.end())
      faults_.push_back(fmt::format("there is more than one particle {}", *twice));
  }

  /// Checks a column.
  template <class Column>
  void finite(std::string_view name, const Column& column)
  {
    const Index bad = first_bad(static_cast<Index>(column.size()), [&](Index row) {
      const auto* const numbers = numbers_of(column, static_cast<std::size_t>(row));
      return !std::all_of(numbers, numbers + RowsOf<Column>::components,
                          [](auto number) { return std::isfinite(static_cast<Real>(number)); });
    });
    if (bad != none)
      add(bad, fmt::format("{} is not finite", name));
  }

  void finite(const HistoryVariable& variable, Index begin, const Material& material)
  {
    const auto is_bad = [&](Index i) {
      const Real* const first = &history_value(material, variable, i);
      return !std::all_of(first, first + variable.components, [](Real value) { return std::isfinite(value); });
    };
    if (const Index bad = first_bad(material.history.size(), is_bad); bad != none)
      add(begin + bad, fmt::format("{} is not finite", variable.key));
  }

  /// Checks value(row) of each particle.
  template <class F>
  void positive(std::string_view name, std::string_view unit, F&& value)
  {
    const auto at = [&](Index row) { return Real{value(static_cast<std::size_t>(row))}; };
    const Index bad = first_bad(particles_.size(), [&](Index row) { return at(row) <= 0; });
    if (bad != none)
      add(bad, fmt::format("{} is {:.6g}{}, not above 0", name, at(bad), unit));
  }

 private:
  void add(Index row, const std::string& what) { faults_.push_back(fmt::format("{}: {}", describe(particles_, bodies_, row), what)); }

  const Particles<D>& particles_;
  const std::vector<Body>& bodies_;
  std::vector<std::string>& faults_;
};

}  // namespace

void find_invalid(const Clock& clock, std::vector<std::string>& faults)
{
  if (clock.step < 0)
    faults.push_back(fmt::format("clock/step is {}, not a number from 0 on", clock.step));
  must_not_be_negative("clock/time", clock.time, faults);
  must_not_be_negative("clock/dt", clock.dt, faults);
  must_not_be_negative("clock/lag", clock.lag, faults);
}

void find_invalid(const StageState& stage, const Clock& now, std::vector<std::string>& faults)
{
  must_not_be_negative("stage/begin", stage.begin, faults);
  must_not_be_negative("stage/ramp_time", stage.ramp_time, faults);
  if (!(stage.altitude > 0))
    faults.push_back(fmt::format("stage/altitude is {} m, not above 0", stage.altitude));
  if (!(stage.pull >= 0 && std::isfinite(stage.pull)))
    faults.push_back(fmt::format("stage/pull is {} m/s^2, not a number from 0 on", stage.pull));
  if (stage.ramp_shape != RampShape::linear && stage.ramp_shape != RampShape::smooth)
    faults.push_back(fmt::format("stage/ramp_shape is {}, which is none", static_cast<int>(stage.ramp_shape)));
  if (std::isgreater(stage.begin, now.time) || stage.first_step > now.step)
    faults.push_back(fmt::format("the stage began at step {}, t = {:.6g} s, and the state is of step {}, t = {:.6g} s", stage.first_step,
                                 stage.begin, now.step, now.time));
}

void find_invalid(const EnergyLedger& energy, std::vector<std::string>& faults)
{
  for_each_field<EnergyLedger>([&](const auto& field) {
    if (const Real value = energy.*field.member; !std::isfinite(value))
      faults.push_back(fmt::format("energy/{} is {} J", field.key, value));
  });
}

template <int D>
void find_invalid(const Particles<D>& particles, const std::vector<Body>& bodies, const std::vector<Material>& materials,
                  std::vector<std::string>& faults)
{
  const std::size_t before = faults.size();
  Inspection<D> inspection(particles, bodies, faults);
  inspection.ids();
  particles.for_each_column([&](std::string_view name, std::string_view, const auto& rows) { inspection.finite(name, rows); });
  for (std::size_t b = 0; b < materials.size(); ++b)
    for (const HistoryVariable& variable : materials[b].law().variables())
      inspection.finite(variable, bodies[b].begin, materials[b]);
  if (faults.size() > before)
    return;  // values that are not finite cannot be compared
  constexpr std::string_view volume_unit = D == 2 ? " m^2" : " m^3";
  inspection.positive("mass", " kg", [&](std::size_t p) { return particles.mass[p]; });
  inspection.positive("volume0", volume_unit, [&](std::size_t p) { return particles.volume0[p]; });
  inspection.positive("volume", volume_unit, [&](std::size_t p) { return particles.volume[p]; });
  inspection.positive("det F", "", [&](std::size_t p) { return particles.F[p].determinant(); });
}

template void find_invalid<2>(const Particles<2>&, const std::vector<Body>&, const std::vector<Material>&, std::vector<std::string>&);
template void find_invalid<3>(const Particles<3>&, const std::vector<Body>&, const std::vector<Material>&, std::vector<std::string>&);

}  // namespace talus
