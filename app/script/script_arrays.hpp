#pragma once
// Arrays of particles and nodes for a script: the columns of the run themselves where it has them, otherwise computed.
#include <string>
#include <vector>

#include "io/python/python_script.hpp"
#include "solver/run_view.hpp"

namespace talus {

/// Columns of particles, in those of a run or a copy.
template <int D>
struct ParticleColumns {
  const Particles<D>& particles;
  const std::vector<Body>& bodies;
  const std::vector<Material>& materials;
  std::shared_ptr<const void> owner;  ///< of arrays that are columns
};

/// The names of all arrays: columns, history variables of laws, fields of files.  `body`: of the history variables those of the law of this
/// body only.
template <int D>
std::vector<std::string> names_of_particles(const RunView<D>& view, std::optional<std::size_t> body);
/// Rows of one body, or all.  The order is that of `columns`.  Throws std::out_of_range.
template <int D>
ScriptArray particles_of(const RunView<D>& view, const ParticleColumns<D>& columns, const std::string& name,
                         std::optional<std::size_t> body);

template <int D>
std::vector<std::string> names_of_nodes();
/// Throws std::out_of_range.
template <int D>
ScriptArray nodes_of(const RunView<D>& view, const std::string& name);

}  // namespace talus
