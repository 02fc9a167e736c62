#include "app/setup/parameter_fields.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "app/setup/expression.hpp"
#include "core/parallel/threads.hpp"
#include "materials/interface/varied_law.hpp"

namespace talus {

namespace {

template <int D>
std::vector<Vec3> places_of(const Particles<D>& particles, const Material& material)
{
  std::vector<Vec3> places(static_cast<std::size_t>(material.size()), Vec3::Zero());
  for (Index i = 0; i < material.size(); ++i)
    places[static_cast<std::size_t>(i)].template head<D>() = particles.x[static_cast<std::size_t>(material.begin + i)];
  return places;
}

/// Multiplies factor k of all particles by its trend.  What is wrong with the formula, in words.
std::string multiply_by_trend(const ParameterVariation& entry, std::span<const Vec3> places, int number, Material& material)
{
  try {
    const std::vector<Real> trend = evaluate(entry.trend, places);
    for (Index i = 0; i < material.size(); ++i)
      material.history.row(i)[number] *= trend[static_cast<std::size_t>(i)];
  } catch (const std::invalid_argument& wrong) {
    return wrong.what();
  }
  return {};
}

}  // namespace

template <int D>
std::vector<ParameterTrouble> set_parameters_in_space(const Particles<D>& particles, Communicator& ranks, Material& material)
{
  const auto* const law = dynamic_cast<const VariedLaw*>(&material.law());
  if (law == nullptr)
    return {};
  std::vector<ParameterTrouble> troubles;
  const std::vector<Vec3> places = places_of(particles, material);
  const VariationFields fields(law->variation());
  const std::size_t n = law->variation().size();
  parallel_for(material.size(),
               [&](Index i) { fields(places[static_cast<std::size_t>(i)], std::span(material.history.row(i) + law->first_factor(), n)); });
  for (std::size_t k = 0; k < n; ++k) {
    const ParameterVariation& entry = law->variation()[k];
    const int number = law->first_factor() + static_cast<int>(k);
    if (!entry.trend.empty())
      if (const std::string wrong = ranks.first(multiply_by_trend(entry, places, number, material)); !wrong.empty())
        troubles.push_back({entry.where, "trend", wrong});
    const Real mean = law->varied()[k].value;
    for (Index i = 0; i < material.size(); ++i) {
      Real& factor = material.history.row(i)[number];
      if (const Real value = mean * factor; entry.minimum && value < *entry.minimum)
        factor = *entry.minimum / mean;
      else if (entry.maximum && value > *entry.maximum)
        factor = *entry.maximum / mean;
    }
  }
  if (!troubles.empty())
    return troubles;

  std::int64_t count = 0, first = std::numeric_limits<std::int64_t>::max();
  std::string message;
  for (Index i = 0; i < material.size(); ++i)
    if (const std::string wrong = law->problem(material.history.row(i)); !wrong.empty()) {
      ++count;
      const auto row = static_cast<std::size_t>(material.begin + i);
      if (particles.id[row] < first) {
        first = particles.id[row];
        const Vec<D> x = particles.x[row];
        message = fmt::format("the first at ({:.6g}), where {}", fmt::join(x.begin(), x.end(), ", "), wrong);
      }
    }
  const std::int64_t of_all = ranks.sum(count), first_of_all = ranks.min(first);
  message = ranks.first(first == first_of_all && count > 0 ? message : std::string());
  if (of_all > 0)
    troubles.push_back({law->variation().front().where, "",
                        fmt::format("the law does not take the values at {} particle{}, {}; minimum, maximum and another distribution keep "
                                    "values within limits",
                                    of_all, of_all == 1 ? "" : "s", message)});
  return troubles;
}

template std::vector<ParameterTrouble> set_parameters_in_space<2>(const Particles<2>&, Communicator&, Material&);
template std::vector<ParameterTrouble> set_parameters_in_space<3>(const Particles<3>&, Communicator&, Material&);

}  // namespace talus
