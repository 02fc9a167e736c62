#include "app/setup/stage_changes.hpp"

#include <numeric>

#include "app/setup/initial.hpp"
#include "app/setup/parameter_fields.hpp"
#include "core/parallel/threads.hpp"
#include "materials/interface/varied_law.hpp"

namespace talus {

namespace {

/// All that is in some rows, of all ranks.  Every rank has to ask.
template <int D>
RemovedParticles<D> content_of(const std::vector<Body>& bodies, const std::vector<Material>& materials, const Particles<D>& particles,
                               Index begin, Index end, Communicator& ranks)
{
  ExactSums<RemovedParticles<D>> sum;
  for (Index row = begin; row < end; ++row)
    sum.add(content_of(bodies, materials, particles, row));
  ranks.sum(sum);
  return sum.value();
}

template <int D>
std::string in_words(const RemovedParticles<D>& content)
{
  return fmt::format("{} particles, {:.6g} kg", static_cast<std::int64_t>(content.count), content.mass);
}

/// Forces of artificial viscosity that the new law does not know become stress, and stay that.
template <int D>
void drop_viscosity(const Body& body, Particles<D>& particles)
{
  for (Index row = body.begin; row < body.end; ++row) {
    const auto p = static_cast<std::size_t>(row);
    particles.stress.set(p, add_diagonal(particles.stress[p], particles.viscous[p]));
    particles.viscous.set(p, 0);
  }
}

}  // namespace

template <int D>
void vanish(const std::vector<Index>& bodies, State<D>& state, Communicator& ranks, StageReport& news)
{
  const ParticleSet<D> gone = extract_bodies(std::span(bodies), state.bodies, state.materials, state.particles);
  for (const Index b : bodies) {
    const Body& body = gone.bodies[static_cast<std::size_t>(b)];
    const RemovedParticles<D> content = content_of(gone.bodies, gone.materials, gone.particles, body.begin, body.end, ranks);
    state.mass.taken += content.mass, state.mass.taken_count += static_cast<Index>(content.count);
    state.momentum.changes += -1 * content.momentum;
    news.told.push_back(fmt::format("body \"{}\" vanishes: {}", body.name, in_words(content)));
  }
}

template <int D>
void renew(const std::vector<Renewal>& bodies, std::span<const Material> laws, State<D>& state, Communicator& ranks, StageReport& news)
{
  constexpr Real worth_a_word = 0.01;
  Particles<D>& particles = state.particles;
  for (const auto& [b, becomes] : bodies) {
    const Body& body = state.bodies[static_cast<std::size_t>(b)];
    Material& material = state.materials[static_cast<std::size_t>(b)];
    const Material before = std::exchange(material, laws[static_cast<std::size_t>(b)]);
    begin_anew(body.begin, body.end, material);
    const bool same_law = before.law().name() == material.law().name();
    if (same_law) {
      std::vector<Index> same(static_cast<std::size_t>(body.size()));
      std::iota(same.begin(), same.end(), 0);
      carry_history(before, same, material);
    }
    if (!same_law || !varies_alike(before.law(), material.law()))
      for (const ParameterTrouble& one : set_parameters_in_space(particles, ranks, material))
        throw RunError(fmt::format("body \"{}\" cannot become {}: {}: {}", body.name, material.name, to_string(one.where), one.message));
    if (!same_law)
      state.empty_cells.clear();  // of all bodies, as cells beside several have one stress
    if (!same_law && !particles.jump_stress.empty())
      for (Index p = body.begin; p < body.end; ++p)
        particles.jump_stress.set(static_cast<std::size_t>(p), Mat<D>::Zero());
    if (before.viscosity && !material.viscosity)
      drop_viscosity(body, particles);
    if (const Real heavier = material.law().density() / before.law().density(); heavier != 1) {
      const RemovedParticles<D> then = content_of(state.bodies, state.materials, particles, body.begin, body.end, ranks);
      parallel_for(body.size(), [&](Index i) {
        const auto p = static_cast<std::size_t>(body.begin + i);
        particles.mass.set(p, heavier * particles.mass[p]);
      });
      const RemovedParticles<D> now = content_of(state.bodies, state.materials, particles, body.begin, body.end, ranks);
      (heavier > 1 ? state.mass.placed : state.mass.taken) += std::abs(now.mass - then.mass);
      state.momentum.changes += now.momentum + -1 * then.momentum;
    }
    const Real change = settle_stress(body, before.law().name(), state.clock.dt, ranks, material, particles);
    news.told.push_back(fmt::format("body \"{}\" {}", body.name, becomes));
    if (change > worth_a_word)
      news.warnings.push_back(
          fmt::format("the stress of body \"{}\" changes with its material, by up to {:.3g} % of the largest: law \"{}\" makes another of "
                      "the same state",
                      body.name, 100 * change, material.law().name()));
  }
}

template <int D>
void appear(const std::vector<Index>& bodies, ParticleSet<D> coming, const Mesh<D>& mesh, const CellOrder& order, const Stage& stage,
            State<D>& state, Communicator& ranks, StageReport& news)
{
  const auto all = [](Index) { return true; };
  CellOrder order_of_coming;
  sort_by_cell(coming.particles.cell, coming.particles.id, coming.bodies, mesh.n_cells(), order_of_coming);
  const auto there = volume_in_cells(mesh, state.particles, order, all);
  for (const Index b : bodies) {
    const Body& body = coming.bodies[static_cast<std::size_t>(b)];
    const auto its = volume_in_cells(mesh, coming.particles, order_of_coming, [&](Index other) { return other == b; });
    const Overlap<D> taken = overlap<D>(mesh, there, its, ranks);
    if (taken.share() > most_overlap)
      throw RunError(fmt::format("stage \"{}\"{}: body \"{}\" cannot appear: {}", stage.name,
                                 stage.where.line > 0 ? fmt::format(" ({})", to_string(stage.where)) : "", body.name, describe(taken)));
    if (taken.cells > 0)
      news.warnings.push_back(fmt::format("body \"{}\" appears although {}", body.name, describe(taken)));
    const RemovedParticles<D> content = content_of(coming.bodies, coming.materials, coming.particles, body.begin, body.end, ranks);
    state.mass.placed += content.mass, state.mass.placed_count += static_cast<Index>(content.count);
    state.momentum.changes += content.momentum;
    news.told.push_back(fmt::format("body \"{}\" appears: {}", body.name, in_words(content)));
  }
  insert_particles(std::move(coming), state.bodies, state.materials, state.particles);
}

template void vanish<2>(const std::vector<Index>&, State<2>&, Communicator&, StageReport&);
template void vanish<3>(const std::vector<Index>&, State<3>&, Communicator&, StageReport&);
template void renew<2>(const std::vector<Renewal>&, std::span<const Material>, State<2>&, Communicator&, StageReport&);
template void renew<3>(const std::vector<Renewal>&, std::span<const Material>, State<3>&, Communicator&, StageReport&);
template void appear<2>(const std::vector<Index>&, ParticleSet<2>, const Mesh<2>&, const CellOrder&, const Stage&, State<2>&, Communicator&,
                        StageReport&);
template void appear<3>(const std::vector<Index>&, ParticleSet<3>, const Mesh<3>&, const CellOrder&, const Stage&, State<3>&, Communicator&,
                        StageReport&);

}  // namespace talus
