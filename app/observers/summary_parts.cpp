#include "app/observers/summary_parts.hpp"

#include <algorithm>

#include "solver/each_particle.hpp"

namespace talus {

namespace {

struct Content {
  Real particles{}, mass{};  ///< mass [kg]
  Content& operator+=(const Content& other) noexcept
  {
    particles += other.particles, mass += other.mass;
    return *this;
  }
};

}  // namespace

template <int D>
BodySummary summary_of(const RunView<D>& view, std::size_t b)
{
  const Body& body = view.state.bodies[b];
  ExactSums<Content> sum;
  const auto number = static_cast<Index>(b);
  add_particles(view, {number, number + 1}, sum, [](const auto& p) { return Content{1, p.mass()}; });
  view.problem.ranks->sum(sum);
  const Content content = sum.value();
  const Material& material = view.state.materials[b];
  return {body.name, material.name, std::string(material.law().name()), static_cast<std::int64_t>(content.particles), content.mass};
}

template <int D>
RanksSummary ranks_of(const RunView<D>& view, const Traffic& begin, std::int64_t step_begin)
{
  Communicator& ranks = *view.problem.ranks;
  RanksSummary summary{.count = ranks.size()};
  if (ranks.alone())
    return summary;
  const Traffic now = ranks.traffic();
  const auto steps = static_cast<Real>(std::max(view.state.clock.step - step_begin, std::int64_t{1}));
  const auto a_step = [&](std::int64_t from, std::int64_t to) { return ranks.max(static_cast<Real>(to - from) / steps); };
  Index own = 0;
  for (Index c = 0; c < view.problem.mesh.n_cells(); ++c)
    own += view.problem.subdomain.owns_cell(c) ? 1 : 0;
  const std::int64_t here = view.state.particles.size(), all = std::max(ranks.sum(here), std::int64_t{1});
  summary.imbalance = static_cast<Real>(ranks.max(here)) * ranks.size() / static_cast<Real>(all);
  summary.cells_held = ranks.max(own > 0 ? static_cast<Real>(view.problem.mesh.n_cells()) / own : Real{1});
  summary.messages = a_step(begin.messages, now.messages);
  summary.bytes = a_step(begin.bytes, now.bytes);
  summary.collectives = a_step(begin.calls, now.calls);
  summary.collective_bytes = a_step(begin.bytes_to_all, now.bytes_to_all);
  summary.particles_moved = static_cast<Real>(ranks.sum(view.migrated)) / 2 / steps / static_cast<Real>(all);
  return summary;
}

template BodySummary summary_of(const RunView<2>&, std::size_t);
template BodySummary summary_of(const RunView<3>&, std::size_t);
template RanksSummary ranks_of(const RunView<2>&, const Traffic&, std::int64_t);
template RanksSummary ranks_of(const RunView<3>&, const Traffic&, std::int64_t);

}  // namespace talus
