#pragma once
// What stages of a scene change between two steps: bodies appear, vanish and become another material, other boundary conditions act, the water table moves.
#include "solver/model/model.hpp"
#include "solver/particles/redistribute.hpp"
#include "solver/particles/staged_bodies.hpp"
#include "solver/stages.hpp"

namespace talus {

/// A body whose law is another from a stage on.
struct Renewal {
  Index body;
  std::string becomes;  ///< in words
};

/// Found at set-up, done before the first step of the stage.
template <int D>
struct StageChange {
  std::vector<Index> appear, vanish;  ///< bodies
  ParticleSet<D> coming;              ///< particles of those that appear, in cells of the whole mesh: a share of them on each rank
  std::vector<Renewal> renew;
  std::optional<BoundaryConditions<D>> boundary;  ///< conditions from here on, of the whole mesh; none: those of the stage before
  std::optional<std::vector<Real>> table;  ///< of the water from here on, at the nodes of the whole mesh; none: that of the stage before
  std::vector<std::string> told;           ///< changes of boundary conditions and water, in words
  bool any() const noexcept { return !appear.empty() || !vanish.empty() || !renew.empty() || boundary || table; }
};

/// What has been done, a line for each body.
struct StageReport {
  std::vector<std::string> told, warnings;
};

/// More than this share of what appears must not come where other material is: as much is round-off of surfaces that have settled.
inline constexpr Real most_overlap = 0.05;

/// In words, whichever body it is that comes.
template <int D>
std::string describe(const Overlap<D>& overlap)
{
  return fmt::format("other material is in its place: {:.3g} % of its volume in {} cell{}, the fullest at {}", 100 * overlap.share(),
                     overlap.cells, overlap.cells == 1 ? "" : "s", overlap.place);
}

/// The verbs; each books mass and momentum.  Every rank has to ask.
template <int D>
void vanish(const std::vector<Index>& bodies, State<D>& state, Communicator& ranks, StageReport& news);
/// The bodies keep their stress as in app/setup/initial.hpp.  `laws` are those of all bodies in the stage.
template <int D>
void renew(const std::vector<Renewal>& bodies, std::span<const Material> laws, State<D>& state, Communicator& ranks, StageReport& news);
/// RunError naming `stage`: the place is taken.  Cells are those of this rank's mesh; `order` is that of the particles that are there.
template <int D>
void appear(const std::vector<Index>& bodies, ParticleSet<D> coming, const Mesh<D>& mesh, const CellOrder& order, const Stage& stage,
            State<D>& state, Communicator& ranks, StageReport& news);

/// The boundary conditions of a stage, of the whole mesh, replace those that acted before and continue their sums.
template <int D>
void take_boundary(Model<D>& m, BoundaryConditions<D> boundary)
{
  if (!m.problem.subdomain.alone())
    boundary.restrict_to(m.problem.subdomain);
  boundary.continue_from(m.state.boundary);
  m.state.boundary = std::move(boundary);
  bind_boundary_conditions(m);
}

/// The water table of a stage, of the whole mesh, takes the place of that which was.  Pore pressures follow when the stage begins.
template <int D>
void take_table(Model<D>& m, const std::vector<Real>& table)
{
  m.problem.water.table = m.problem.subdomain.alone() ? table : part_of_table(m.problem.subdomain, table);
}

/// Does all that the stage changes, between two steps, before the stage begins.  What comes is moved out of `change`.
template <int D>
StageReport enter(Model<D>& m, StageChange<D>& change, std::span<const Material> laws, const Stage& stage)
{
  StageReport news{.told = change.told, .warnings = {}};
  if (!change.vanish.empty()) {
    vanish(change.vanish, m.state, *m.problem.ranks, news);
    update_rows(m);
  }
  if (!change.renew.empty())
    renew(change.renew, laws, m.state, *m.problem.ranks, news);
  if (!change.appear.empty()) {
    ParticleSet<D> coming = std::exchange(change.coming, {});
    if (!m.problem.subdomain.alone())
      receive_owned_particles(*m.problem.ranks, m.problem.subdomain, coming.bodies, coming.materials, coming.particles);
    fill_columns(m.problem.columns, coming.particles);
    appear(change.appear, std::move(coming), m.problem.mesh, m.work.order, stage, m.state, *m.problem.ranks, news);
    update_rows(m);
  }
  if (change.boundary)
    take_boundary(m, *change.boundary);
  if (change.table)
    take_table(m, *change.table);
  return news;
}

}  // namespace talus
