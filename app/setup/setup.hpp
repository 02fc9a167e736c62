#pragma once
// Scene + Mesh -> everything a model is made of that does not depend on the kernel.
#include <filesystem>

#include "app/setup/stage_changes.hpp"
#include "io/output/run_summary.hpp"
#include "io/scene/scene.hpp"
#include "solver/stages.hpp"

namespace talus {

template <int D>
struct Setup {
  State<D> state;         ///< at the start, with the particles of the bodies that are there then
  Index n_particles = 0;  ///< of all bodies, on all ranks
  SceneConditions<D> conditions;
  std::vector<Stage> stages;
  std::vector<StageChange<D>> changes;      ///< of each stage
  std::vector<std::vector<Material>> laws;  ///< of all bodies in each stage, without particles
  StepLimits limits;
  std::vector<std::string> warnings;
  std::vector<std::string> notes;               ///< worth knowing before a run, such as how strong a record is
  std::optional<OriginSummary> origin;          ///< of bodies that come from another run
  std::vector<StartStateSummary> start_states;  ///< of bodies that start with a table
  std::vector<Real> start_digest;               ///< the bits of the digests of their tables
  std::uint64_t from_files = 0;  ///< digest of what files beside scene and mesh tell the steps: records, the water table, surfaces
};

/// Throws SceneErrors with everything that is wrong: groups the mesh does not have, bodies without particles, loads on nothing.
/// Particles stand in the order of body and id, ids being 0, 1, 2, ...; those of a body that was filled are in the order of cells as well.
///
/// Every rank has to ask, with the same mesh.  Each gets the particles in an even share of the blocks of cells; all else is of the whole mesh and
/// of all particles, and the same on all ranks, and so is what is thrown.
template <int D>
Setup<D> set_up(const Scene& scene, const Mesh<D>& mesh, Communicator& ranks = one_rank());

/// Leaves what concerns the cells and nodes of one of several ranks, in the numbers of its part.  Particles are not looked at.
template <int D>
void restrict_to(const Subdomain& subdomain, Setup<D>& setup);

/// Numbers of a scene as a vector; zero where there are none.
template <int D>
Vec<D> vector_of(const std::vector<Real>& numbers)
{
  return numbers.empty() ? Vec<D>(Vec<D>::Zero()) : Vec<D>(Eigen::Map<const Vec<D>>(numbers.data()));
}

/// A line for each body that comes from another run, and where that is.
std::string describe(const OriginSummary& origin);

/// The transfer of a run in words, with its damping.
std::string describe(const TransferOptions& transfer);

/// As many threads as were asked for, or else as the scene says, or all that this rank has for itself.
void take_threads(std::optional<int> asked, const Scene& scene);

/// Folder of relative paths in the scene.
std::filesystem::path folder_of(const Scene& scene);

}  // namespace talus
