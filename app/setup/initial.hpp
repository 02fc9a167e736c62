#pragma once
// The state at the start: bodies of a scene that begin as another run left them, where that run is and which of its bodies become which; and the
// velocity that a scene gives a body.
#include "app/observers/checkpoints.hpp"
#include "app/setup/checks/scene_error_collector.hpp"
#include "core/parallel/communicator.hpp"
#include "core/parallel/threads.hpp"
#include "core/particles.hpp"
#include "io/scene/scene.hpp"
#include "mesh/mesh.hpp"

namespace talus {

template <int D>
struct InitialState {
  KeptBodies<D> there;
  std::vector<Index> source;  ///< of each body of the scene: the number of the one there, or none
  OriginSummary origin;
};

/// Nothing if the scene takes none, or if something is wrong with what it takes.  Complains about a run that is not there or cannot be read,
/// another dimension, and bodies that are not there or are filled besides; warns of what may not be meant.
template <int D>
std::optional<InitialState<D>> find_initial_state(const Scene& scene, SceneErrorCollector& errors, std::vector<std::string>& warnings);

/// Particles of another run that a body takes, of one law there.
struct TakenParticles {
  std::size_t body;         ///< here, its first particles in the order of `rows`
  std::string law;          ///< there
  std::vector<Index> rows;  ///< there
};

/// Calls f(row of this scene, row there) for particles that stand from `begin` on in the order of `rows`, by all threads.
template <class F>
void for_each_pair(Index begin, const std::vector<Index>& rows, F&& f)
{
  parallel_for(static_cast<Index>(rows.size()), [&](Index i) { f(to_size(begin + i), to_size(rows[to_size(i)])); });
}

/// Columns that a scene may have or not, where both have them; in other bodies they are as at rest.  Returns whether water flows on: its
/// pressures are then those of that run.
template <int D>
bool carry_columns(const Scene& scene, const KeptBodies<D>& other, std::span<const TakenParticles> all, const std::vector<Body>& bodies,
                   const std::vector<Material>& materials, SceneErrorCollector& errors, Particles<D>& p);

/// What two laws both remember: rows of one history become the history of the other.
void carry_history(const Material& from, std::span<const Index> rows, Material& to);

/// The body keeps its stress if its law can start from one; the elastic strain that belongs to it is found anew where the law makes another
/// than `law_there`, which it comes from, because its constants have changed.  Any other law has the stress that it makes of the deformation.
/// `dt`: of the step that led to the state [s].  Returns by how much the stress changes, over the largest there; every rank has to ask.
template <int D>
Real settle_stress(const Body& body, std::string_view law_there, Real dt, Communicator& ranks, Material& material, Particles<D>& particles);

/// Velocity and its gradient of the particles [begin, end): without the latter, affine schemes would begin with particles that do not turn.
/// Complains about formulas.  Every rank has to ask.
template <int D>
void set_velocity(const BodySpec& spec, const Mesh<D>& mesh, Communicator& ranks, Index begin, Index end, SceneErrorCollector& errors,
                  Particles<D>& particles);

}  // namespace talus
